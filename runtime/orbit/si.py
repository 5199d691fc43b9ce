"""Strips in SI units: their dimensionless groups, the flat strip apart, and the refusal of what could not be certified."""

from functools import partial

import numpy as np

from ..errors import InputError, SolverError
from ..numerics.rounding import LARGEST
from .engine import solve_strips
from .flat import is_flat, solve_with_flat
from .groups import Strips, slowed, snaps_in
from .solved import Solved

#: beta, or its largest, up to which the emitted functions are certified (the domain in generated/certificates.json)
CERTIFIED = 1e30


def _each(function, *arrays) -> np.ndarray:
    """``function`` of flat arrays, once for all where they are views of single numbers."""
    if all(array.strides == (0,) for array in arrays):
        return np.broadcast_to(function(*(array[:1] for array in arrays)), arrays[0].shape)
    return function(*arrays)


def _product(k, V, T):
    return k * V * T


def dimensionless(l, A, D, V, K, T_eps, T_sigma, p_0, delta_0, J, L, edge) -> tuple[Strips, dict]:  # noqa: E741
    """Groups of flat SI arrays of shape (n,), and the scales back to SI.

    A strip whose wave is negligible, ``scales["flat"]``, is in units of K alone. Nothing is refused here but groups that
    overflow.
    """
    with np.errstate(over="ignore"):  # refused below, by name
        k = _each(lambda l: 2 * np.pi / l, l)  # noqa: E741
        alpha, beta = _each(_product, k, V, T_sigma), _each(_product, k, V, T_eps)
    if np.any(beta > LARGEST):
        raise InputError("V", float(V[beta > LARGEST][0]), f"k V T_eps at most {LARGEST:g}")
    pace = _each(slowed, alpha)
    if np.any(beta * pace > CERTIFIED):
        fast = float(V[beta * pace > CERTIFIED][0])
        raise InputError("V", fast, f"k V T_eps at most {CERTIFIED:g} where T_sigma is so small")
    traction = _each(np.divide, p_0, K)
    flat = is_flat(A, beta, D, traction, delta_0)
    unit = np.where(flat, 1.0, A) if flat.any() else A
    chi = np.broadcast_to(float(edge == "constitutive"), D.shape)
    snaps = _each(lambda J, p_0, delta_0: snaps_in(J * p_0, delta_0) & (edge == "constitutive"), J, traction, delta_0)
    lengths = (_each(np.divide, v, unit) for v in (traction, delta_0, D))
    strips = Strips(alpha * pace, beta * pace, J, L, *lengths, chi, np.broadcast_to(snaps, D.shape))
    scales = {"k": k, "A": A, "D": D, "p": _each(np.multiply, K, unit), "length": unit, "flat": flat, "pace": pace}
    return strips, scales


def solve_si(kernel, *inputs, edge, branch) -> tuple[Solved, Strips, dict]:
    """Solve flat SI arrays, in the order of ``dimensionless``; returns the solutions, the groups and the scales back to SI."""
    strips, scales = dimensionless(*inputs, edge)
    solved = solve_with_flat(partial(solve_strips, kernel), strips, scales["flat"], branch == "unloading")
    return _at_full_speed(solved, strips, scales["pace"]), strips, scales


def _at_full_speed(solved: Solved, strips: Strips, pace: np.ndarray) -> Solved:
    """Friction of strips that were solved at a share ``pace`` of their speed, in the limit of infinite speed: it falls like 1/V
    where nothing steps, that is but for adhesion that begins and ends under the constitutive closure."""
    fast = np.flatnonzero(pace < 1)
    if fast.size:
        falls = (strips.chi[fast] == 0) | np.isnan(solved.c[fast])
        solved.tau_mean[fast] *= np.where(falls, pace[fast], 1.0)
    return solved


def refuse_uncertified(solved: Solved, inputs: dict[str, np.ndarray], edge: str, branch: str) -> None:
    """``SolverError`` naming the first strip that did not pass its certificate, by its inputs (name to flat array)."""
    bad = np.flatnonzero(~solved.certified)
    if not bad.size:
        return
    strip = ", ".join(f"{n}={float(v[bad[0]])!r}" for n, v in inputs.items())
    raise SolverError(
        f"{bad.size} of {solved.certified.size} strips could not be certified; the first, strip {bad[0]}: "
        f"{strip}, edge={edge!r}, branch={branch!r}"
    )
