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


def solve_flat(D, p_0_over_K, delta_0, unloading: bool):
    """Regime code and mean pressure over K of a flat strip; arrays of shape (n,).

    Contact carries ``p = K D`` down to ``-p_0``; the gap adheres (``w = -p_0/K``) while it is at most ``delta_0``. Unloading
    holds on as long as it can; loading stays free until the gap of the undeformed surface is ``delta_0``.
    """
    contact = D >= -p_0_over_K
    clinging = ~contact & (-p_0_over_K - D <= delta_0)
    free = ~contact & ~clinging
    if not unloading:
        free |= D <= -delta_0
    code = np.where(free, CODE["f"], np.where(contact, CODE["c"], CODE["a"]))
    p = np.where(free, 0.0, np.where(contact, D, -p_0_over_K))
    return code.astype(np.int8), p


def solve_with_flat(solve, strips, flat, unloading: bool) -> Solved:
    """Solve strips of which some are ``flat``, in units of K alone, the others by ``solve(strips, unloading)``."""
    if not flat.any():
        return solve(strips, unloading)
    solved = Solved.empty(strips.size)
    wavy, level = np.flatnonzero(~flat), np.flatnonzero(flat)
    if wavy.size:
        solved.put(wavy, solve(strips.take(wavy), unloading))
    code, p = solve_flat(strips.D[level], strips.p_0[level], strips.delta_0[level], unloading)
    solved.code[level], solved.p_mean[level], solved.tau_mean[level] = code, p, 0.0
    solved.contact_fraction[level], solved.adhesion_fraction[level] = code == CODE["c"], code == CODE["a"]
    solved.certified[level] = True
    return solved


def once(values) -> np.ndarray:
    """One element of a view of a single number, else the array itself: what is the same for all strips is worked out once."""
    values = np.asarray(values, float)
    return values[:1] if values.strides == (0,) else values


def every(values, shape) -> np.ndarray:
    """The values for all strips, left a view where they are a single number."""
    return values if np.shape(values) == shape else np.broadcast_to(values, shape)


def refuse_velocity(V, where, most: float) -> None:
    """``InputError`` with the first of the velocities ``where`` ``k V`` is too large."""
    if np.any(where):
        allowed = f"k V times the longest retardation time at most {most:g}"
        raise InputError("V", float(np.broadcast_to(V, where.shape)[where][0]), allowed)


def refuse_uncertified(certified: np.ndarray, inputs: dict[str, np.ndarray], edge: str, branch: str) -> None:
    """``SolverError`` naming the first strip that is not ``certified``, by its inputs (name to number or flat array)."""
    bad = np.flatnonzero(~certified)
    strip = ", ".join(f"{n}={float(np.broadcast_to(v, certified.shape)[bad[0]])!r}" for n, v in inputs.items())
    raise SolverError(
        f"{bad.size} of {certified.size} strips could not be certified; the first, strip {bad[0]}: "
        f"{strip}, edge={edge!r}, branch={branch!r}"
    )
