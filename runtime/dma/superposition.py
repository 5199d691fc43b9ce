"""Shifts at which isotherms lie best on one smooth curve, their covariance, and whether isotherms overlap there.

The curve is a cubic spline of log modulus over log reduced frequency, storage and loss each with its own, fitted together
with the shifts by least squares (variable projection). It has as many knots as the points call for: what bumps of a spectrum
leave on too few of them would pass for shifts. Errors are of two kinds, of single points and of whole isotherms, as a sample
that is clamped anew has them.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError
from .modulus import DynamicModulus
from .readings import degrees

#: knots of the smooth curve per decade of reduced frequency, the next ones where they lower Akaike's criterion
_KNOTS = (1, 2, 3, 4)
#: steps of a fit with more knots: one that takes more is of a curve that they leave loose
_MOST_STEPS = 100
#: exponents of b_T are sought up to this
LARGEST_EXPONENT = 3.0
#: steps per decade in which the first guess of a shift is sought
_STEPS = 20
#: share of the narrower of two bands that has to overlap in the first guess
_OVERLAP = 0.2
#: decades that isotherms have to share (narrow ones half of their band): with less, what is between them is extrapolated
_LEAST_SHARED = 0.2
#: in decades of modulus per decade of frequency: curves flatter than this determine no shift
_FLAT = 1e-5


@dataclass(frozen=True, eq=False)
class Superposition:
    """log10 of the shift factors (n,) of isotherms, 0 at the reference; their covariance (n, n); the exponent of b_T and its
    standard error; and the rms distance of points from the smooth curve in decades of modulus."""

    log_a: np.ndarray
    covariance: np.ndarray
    exponent: float
    exponent_error: float
    rms: float


def superpose(isotherms: list[DynamicModulus], at: int, vertical: bool) -> Superposition:
    """Shift isotherms, sorted by temperature, onto the one of index ``at``.

    Raises ``InputError`` for neighbours that do not overlap, and for moduli that do not change with frequency.
    """
    found, loose = _together(isotherms, at, _sequential(isotherms, at), vertical)
    parted = apart(isotherms, found, _LEAST_SHARED)
    if parted:
        i, shared = parted[0]
        others = f", and {len(parted) - 1} more" * (len(parted) > 1)
        lack = "they have no modulus in common"
        if shared < 0:  # the curve cannot be continued by more than a decade
            lack = f"about {-shared:.1f} decades are missing" if shared > -1 else "more than a decade is missing"
        elif shared < _LEAST_SHARED:
            lack = f"they share {shared:.2f}"
        between = f"{degrees(isotherms[i].temperature)} and {degrees(isotherms[i + 1].temperature)}{others}"
        allowed = f"neighbours that overlap after shifting, by {_LEAST_SHARED:g} decades; here {lack}: measure between them, or "
        raise InputError("isotherms", between, f"{allowed}over a wider band, or leave out what lies beyond")
    if loose is not None:
        allowed = "moduli whose change with frequency determines the shift: here they are flat, or their frequencies too few"
        raise InputError("isotherms", degrees(loose), allowed)
    return found


def apart(isotherms: list[DynamicModulus], found: Superposition, least: float) -> list[tuple[int, float]]:
    """Each i for which isotherms up to i and from i + 1 on share fewer than ``least`` decades of reduced frequency or no
    modulus, directly or by way of others; and the decades that i and i + 1 share, negative for a gap."""
    from scipy.sparse.csgraph import connected_components

    T = np.array([each.temperature for each in isotherms])
    log_T = np.log10(T)[:, None]
    edges = np.array([[_ends(row) for row in (x, *y)] for x, y in map(_logs, isotherms)])  # (n, 3, 2)
    edges[:, 0] += found.log_a[:, None]
    edges[:, 1:] -= (found.exponent * log_T)[:, :, None]
    low, high = edges[..., 0], edges[..., 1]
    shared = np.minimum(high[:, None], high) - np.maximum(low[:, None], low)  # (n, n, 3)
    width = high[:, 0] - low[:, 0]
    enough = shared[..., 0] >= np.minimum(least, 0.5 * np.minimum(width[:, None], width))
    # what overlaps has moduli in common, but for noise and for a vertical shift left out
    modulus = (shared[..., 1:] >= -(3 * found.rms + np.abs(log_T - log_T.T))[..., None]).all(axis=-1)
    part = connected_components(enough & modulus, directed=False)[1]
    return [(i, float(shared[i, i + 1, 0])) for i in np.flatnonzero(np.diff(part))]


def _ends(row: np.ndarray) -> tuple[float, float]:
    return row.min(), row.max()


def _logs(each: DynamicModulus) -> tuple[np.ndarray, np.ndarray]:
    """log10 of omega (n,) and of storage and loss (2, n)."""
    return np.log10(each.omega), np.log10((each.storage, each.loss))


def _sequential(isotherms: list[DynamicModulus], at: int) -> np.ndarray:
    """First guesses of log10 a_T, (n,): each isotherm on its neighbour nearer to the reference."""
    found = np.zeros(len(isotherms))
    order = [(i, i - 1) for i in range(at + 1, len(isotherms))] + [(i, i + 1) for i in range(at - 1, -1, -1)]
    for i, neighbour in order:
        found[i] = found[neighbour] + _onto(isotherms[i], isotherms[neighbour], i > at)
    return found


def _onto(moved: DynamicModulus, fixed: DynamicModulus, hotter: bool) -> float:
    """log10 of the factor that brings one isotherm onto another: hotter ones go to lower frequencies."""
    from scipy.optimize import minimize_scalar

    (x, y), (x_0, y_0) = _logs(moved), _logs(fixed)
    overlap = _OVERLAP * min(np.ptp(x), np.ptp(x_0))
    lowest, highest = x_0[0] - x[-1] + overlap, x_0[-1] - x[0] - overlap
    lowest, highest = (lowest, min(highest, 0.0)) if hotter else (max(lowest, 0.0), highest)
    if lowest > highest:
        temperatures = f"{degrees(fixed.temperature)} and {degrees(moved.temperature)}"
        raise InputError("isotherms", temperatures, "neighbours that overlap after the hotter is shifted to lower frequencies")

    def mismatch(shift):
        """Mean square over the points of each that lie in the band of the other."""
        apart = [*_off(x + shift, y, x_0, y_0), *_off(x_0 - shift, y_0, x, y)]
        return float(np.mean(np.square(apart))) if len(apart) > 2 else np.inf

    steps = np.linspace(lowest, highest, int(np.ceil(_STEPS * (highest - lowest))) + 1)
    best = steps[int(np.argmin([mismatch(step) for step in steps]))]
    near = (max(lowest, best - 1 / _STEPS), min(highest, best + 1 / _STEPS))
    return float(minimize_scalar(mismatch, bounds=near, method="bounded").x) if near[0] < near[1] else float(best)


def _off(x: np.ndarray, y: np.ndarray, x_0: np.ndarray, y_0: np.ndarray) -> np.ndarray:
    """Distance of points from a curve, of those within its band."""
    inside = (x >= x_0[0]) & (x <= x_0[-1])
    return np.ravel([row[inside] - np.interp(x[inside], x_0, row_0) for row, row_0 in zip(y, y_0, strict=True)])


def _together(isotherms: list[DynamicModulus], at: int, start: np.ndarray, vertical: bool) -> tuple[Superposition, float | None]:
    """All shifts at once; and the temperature (K) of an isotherm whose shift nothing determines, or None."""
    from scipy.optimize import least_squares

    logs = [_logs(each) for each in isotherms]
    owner = np.repeat(np.arange(len(logs)), [x.size for x, _ in logs])
    x, y = np.concatenate([x for x, _ in logs]), np.concatenate([y for _, y in logs], axis=1)
    T = np.array([each.temperature for each in isotherms])
    warmth = np.log10(T / T[at])[owner]
    free = np.flatnonzero(np.arange(len(logs)) != at)
    bounds = np.full((2, free.size + vertical), [[-np.inf], [np.inf]])
    bounds[:, free.size :] = [[-LARGEST_EXPONENT], [LARGEST_EXPONENT]]

    def places(parameters):
        out = np.zeros(len(logs))
        out[free] = parameters[: free.size]
        return x + out[owner]

    def off(parameters, goal, pieces):
        rows = _splines(places(parameters), pieces)
        return goal - rows @ np.linalg.lstsq(rows, goal, rcond=None)[0]

    def residuals(parameters, pieces):
        return off(parameters, (y - parameters[-1] * warmth).T if vertical else y.T, pieces).ravel()

    def superposition(found):
        """What is found, but for errors."""
        log_a = np.zeros(len(logs))
        log_a[free] = found.x[: free.size]
        exponent = float(found.x[-1]) if vertical else 0.0
        return Superposition(log_a, np.zeros((len(logs), len(logs))), exponent, 0.0, float(np.sqrt(np.mean(found.fun**2))))

    best, least, first = None, np.inf, np.append(start[free], [0.5] if vertical else [])
    # a curve through all points tells no errors: its unknowns and the shifts are at most three quarters as many as numbers
    most = 3 * x.size // 4 - 3 - (first.size + 1) // 2
    for knots in _KNOTS:
        # as many while shifts change: with another number the residuals would jump
        pieces = int(max(min(np.ceil(knots * np.ptp(places(first))), np.inf if best else most), 1))
        how = {"x_scale": 0.1, "xtol": 1e-8, "ftol": 1e-8, "max_nfev": _MOST_STEPS if best else None}
        found = least_squares(residuals, first, bounds=bounds, args=(pieces,), **how)
        known = 2 * np.linalg.matrix_rank(_splines(places(found.x), pieces)) + found.x.size
        spare, first = found.fun.size - known - 1, found.x
        # Akaike's criterion, corrected for few points
        score = found.fun.size * (np.log(found.cost + 1e-300) + 2 * known / spare) if spare > 0 else np.inf
        # or a curve that follows any shift
        if best and (score >= least or not found.success or np.linalg.norm(found.jac, -2) < _FLAT):
            break
        best, least = (found, pieces, known), score
        if apart(isotherms, superposition(found), _LEAST_SHARED):  # across a gap more knots determine no shift
            break
    found, pieces, known = best
    _, sizes, ways = np.linalg.svd(found.jac, full_matrices=False)
    loose = float(T[free[np.argmax(np.abs(ways[-1, : free.size]))]]) if sizes[-1] < _FLAT else None
    inverse = (ways.T / np.maximum(sizes, _FLAT) ** 2) @ ways
    of_one = np.repeat(off(found.x, np.eye(len(logs))[owner], pieces), 2, axis=0)  # of an isotherm as a whole
    point, whole = _variances(found.fun, found.jac, of_one, known)
    moved = inverse @ (found.jac.T @ of_one)
    together = point * inverse + whole * (moved @ moved.T)
    out = superposition(found)
    out.covariance[np.ix_(free, free)] = together[: free.size, : free.size]
    return replace(out, exponent_error=float(np.sqrt(together[-1, -1])) if vertical else 0.0), loose


def _variances(residuals: np.ndarray, jacobian: np.ndarray, of_one: np.ndarray, known: int) -> tuple[float, float]:
    """Variances of single points, and of isotherms as a whole, by what residuals (m,) with ``known`` unknowns share with columns
    ``of_one`` (m, n) beyond their ``jacobian`` (Henderson's third method)."""
    beyond = of_one - jacobian @ np.linalg.lstsq(jacobian, of_one, rcond=None)[0]
    directions, sizes, _ = np.linalg.svd(beyond, full_matrices=False)
    kept = sizes > 1e-6 * np.sqrt(len(residuals))
    shared = np.sum((directions[:, kept].T @ residuals) ** 2)
    freedom = max(residuals.size - known, 1)
    point = (np.sum(residuals**2) - shared) / max(freedom - kept.sum(), 1)
    whole = (shared - kept.sum() * point) / np.sum(sizes[kept] ** 2) if kept.any() else 0.0
    return (point, whole) if whole > 0 else (np.sum(residuals**2) / freedom, 0.0)


def _splines(x: np.ndarray, pieces: int) -> np.ndarray:
    """Cubic B-splines over the range of ``x``, of so many pieces, (points, splines)."""
    from scipy.interpolate import BSpline

    low, high = x.min(), x.max()
    knots = np.concatenate((np.full(3, low), np.linspace(low, high, pieces + 1), np.full(3, high)))
    return BSpline.design_matrix(np.clip(x, low, high), knots, 3).toarray()
