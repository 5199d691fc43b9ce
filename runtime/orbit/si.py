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


def dimensionless(l, A, D, V, K, T_eps, T_sigma, p_0, delta_0, J, L, edge) -> tuple[Strips, dict]:  # noqa: E741
    """Groups of flat SI arrays of shape (n,), some perhaps single numbers, and the scales back to SI.

    A strip whose wave is negligible, ``scales["flat"]``, is in units of K alone. Nothing is refused here but groups that
    overflow.
    """
    shape = D.shape
    # what is the same for all strips is worked out once, and left a view
    l, A, D, V, K, T_eps, T_sigma, p_0, delta_0, J, L = map(_once, (l, A, D, V, K, T_eps, T_sigma, p_0, delta_0, J, L))  # noqa: E741
    with np.errstate(over="ignore"):  # refused below, by name
        k = 2 * np.pi / l
        alpha, beta = k * V * T_sigma, k * V * T_eps
    _refuse(V, beta > LARGEST, f"k V T_eps at most {LARGEST:g}")
    pace = slowed(alpha)
    _refuse(V, beta * pace > CERTIFIED, f"k V T_eps at most {CERTIFIED:g} where T_sigma is so small")
    traction, constitutive = p_0 / K, edge == "constitutive"
    flat = is_flat(A, beta, D, traction, delta_0)
    unit = np.where(flat, 1.0, A) if flat.any() else A
    snaps = constitutive & snaps_in(J * traction, delta_0)
    groups = (alpha * pace, beta * pace, J, L, traction / unit, delta_0 / unit, D / unit, float(constitutive), snaps)
    scales = {"k": k, "A": A, "D": D, "p": K * unit, "length": unit, "flat": flat, "pace": pace}
    return Strips(*(_every(v, shape) for v in groups)), {name: _every(v, shape) for name, v in scales.items()}


def _once(values) -> np.ndarray:
    """One element of a view of a single number, else the array itself."""
    values = np.asarray(values, float)
    return values[:1] if values.strides == (0,) else values


def _every(values, shape) -> np.ndarray:
    return values if np.shape(values) == shape else np.broadcast_to(values, shape)


def _refuse(V, where, allowed: str) -> None:
    """``InputError`` with the first of the velocities ``where`` they are not ``allowed``."""
    if np.any(where):
        raise InputError("V", float(np.broadcast_to(V, where.shape)[where][0]), allowed)


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
    strip = ", ".join(f"{n}={float(np.broadcast_to(v, solved.certified.shape)[bad[0]])!r}" for n, v in inputs.items())
    raise SolverError(
        f"{bad.size} of {solved.certified.size} strips could not be certified; the first, strip {bad[0]}: "
        f"{strip}, edge={edge!r}, branch={branch!r}"
    )
