"""Strips in SI units: the flat strip apart, and the refusal of what could not be certified."""

import numpy as np

from ..errors import InputError, SolverError
from .regimes import CODE
from .solved import Solved

#: beta, or its largest, up to which the emitted functions are certified (the domain in generated/certificates.json)
CERTIFIED = 1e30
#: a wave this much smaller than every other length is below their rounding
_NEGLIGIBLE = 1e-18


def is_flat(A, beta, D, p_0_over_K, delta_0):
    """Where the amplitude A does not count: nothing of the wave, stiffened by the motion, shows in the other lengths."""
    return A * (1 + beta) <= _NEGLIGIBLE * (np.abs(D) + p_0_over_K + delta_0)


def solve_with_flat(solve, strips, flat, unloading: bool) -> Solved:
    """Solve strips of which some are ``flat``, in units of K alone, the others by ``solve(strips, unloading)``.

    Flat contact carries ``p = K D`` down to ``-p_0``; the gap adheres (``w = -p_0/K``) while it is at most ``delta_0``. Unloading
    holds on as long as it can; loading stays free until the gap of the undeformed surface is ``delta_0``.
    """
    if not flat.any():
        return solve(strips, unloading)
    solved = Solved.empty(strips.size)
    wavy, level = np.flatnonzero(~flat), np.flatnonzero(flat)
    if wavy.size:
        solved.put(wavy, solve(strips.take(wavy), unloading))
    D, p_0, delta_0 = strips.D[level], strips.p_0[level], strips.delta_0[level]
    free = (D < -p_0) & (-p_0 - D > delta_0) | (D <= -delta_0) & (not unloading)
    contact, clinging = ~free & (D >= -p_0), ~free & (D < -p_0)
    solved.code[level] = np.select((free, contact), (CODE["f"], CODE["c"]), CODE["a"])
    solved.p_mean[level], solved.tau_mean[level] = np.select((free, contact), (0.0, D), -p_0), 0.0
    solved.contact_fraction[level], solved.adhesion_fraction[level] = contact, clinging
    solved.certified[level] = True
    return solved


def once(values) -> np.ndarray:
    """One element of a view of a single number, else the array itself: what is the same for all strips is worked out once."""
    values = np.asarray(values, float)
    return values[:1] if values.strides == (0,) else values


def every(values, shape) -> np.ndarray:
    """The values for all strips, left a view where they are a single number."""
    return values if np.shape(values) == shape else np.broadcast_to(values, shape)


def refuse_velocity(V, where) -> None:
    """``InputError`` with the first of the velocities ``where`` ``k V`` is too large."""
    if np.any(where):
        allowed = f"k V times the longest retardation time at most {CERTIFIED:g}"
        raise InputError("V", float(np.broadcast_to(V, where.shape)[where][0]), allowed)


def refuse_uncertified(certified: np.ndarray, inputs: dict[str, np.ndarray], edge: str, branch: str) -> None:
    """``SolverError`` naming the first strip that is not ``certified``, by its inputs (name to number or flat array)."""
    bad = np.flatnonzero(~certified)
    strip = ", ".join(f"{n}={float(np.broadcast_to(v, certified.shape)[bad[0]])!r}" for n, v in inputs.items())
    raise SolverError(
        f"{bad.size} of {certified.size} strips could not be certified; the first, strip {bad[0]}: "
        f"{strip}, edge={edge!r}, branch={branch!r}"
    )
