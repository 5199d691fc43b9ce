"""Shifts at which isotherms lie best on one smooth curve, their covariance, and whether isotherms overlap there.

The curve is a cubic spline of log modulus over log reduced frequency, storage and loss each with its own, fitted together
with the shifts by least squares (variable projection). It has as many knots as the points call for: what bumps of a spectrum
leave on too few of them would pass for shifts. Errors are of two kinds, of single points and of whole isotherms, as a sample
that is clamped anew has them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError
from .modulus import DynamicModulus
from .readings import degrees

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult

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
class Shifts:
    """log10 of the shift factors (n,) of isotherms, 0 at the reference; the exponent of b_T; and the rms distance of points from
    the smooth curve in decades of modulus."""

    log_a: np.ndarray
    exponent: float
    rms: float


@dataclass(frozen=True, eq=False)
class Superposition(Shifts):
    """Shifts with the covariance (n, n) of ``log_a`` and the standard error of the exponent."""

    covariance: np.ndarray
    exponent_error: float


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


def apart(isotherms: list[DynamicModulus], found: Shifts, least: float) -> list[tuple[int, float]]:
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


@dataclass(frozen=True, eq=False)
class _Points:
    """The points of all isotherms: log10 of omega ``x`` (m,) and of storage and loss ``y`` (2, m), which isotherm each belongs to
    (``owner``), and log10 of its temperature over the reference's (``warmth``). Parameters are the shifts of the isotherms
    ``free`` and, if it is fitted, the ``vertical`` exponent."""

    x: np.ndarray
    y: np.ndarray
    owner: np.ndarray
    warmth: np.ndarray
    free: np.ndarray
    isotherms: int
    vertical: bool

    @classmethod
    def of(cls, isotherms: list[DynamicModulus], at: int, vertical: bool) -> _Points:
        logs = [_logs(each) for each in isotherms]
        owner = np.repeat(np.arange(len(logs)), [x.size for x, _ in logs])
        T = np.array([each.temperature for each in isotherms])
        x, y = np.concatenate([x for x, _ in logs]), np.concatenate([y for _, y in logs], axis=1)
        return cls(x, y, owner, np.log10(T / T[at])[owner], np.delete(np.arange(T.size), at), T.size, vertical)

    def log_a(self, parameters: np.ndarray) -> np.ndarray:
        out = np.zeros(self.isotherms)
        out[self.free] = parameters[: self.free.size]
        return out

    def places(self, parameters: np.ndarray) -> np.ndarray:
        """log10 of reduced frequencies, (m,)."""
        return self.x + self.log_a(parameters)[self.owner]

    def off(self, parameters: np.ndarray, goal: np.ndarray, pieces: int) -> np.ndarray:
        """Distances of ``goal`` (m, k) at the points from the nearest splines of so many pieces."""
        rows = _splines(self.places(parameters), pieces)
        return goal - rows @ np.linalg.lstsq(rows, goal, rcond=None)[0]

    def residuals(self, parameters: np.ndarray, pieces: int) -> np.ndarray:
        """Of both moduli at each point, (2 m,)."""
        shifted = self.y - parameters[-1] * self.warmth if self.vertical else self.y
        return self.off(parameters, shifted.T, pieces).ravel()

    def shifts(self, found: OptimizeResult) -> Shifts:
        exponent = float(found.x[-1]) if self.vertical else 0.0
        return Shifts(self.log_a(found.x), exponent, float(np.sqrt(np.mean(found.fun**2))))


def _fitted(isotherms: list[DynamicModulus], points: _Points, first: np.ndarray) -> tuple[OptimizeResult, int, int]:
    """The fit from the parameters ``first``, with as many knots as lower Akaike's criterion, corrected for few points; the pieces
    of its curve, and how many unknowns it has."""
    from scipy.optimize import least_squares

    bounds = np.full((2, first.size), [[-np.inf], [np.inf]])
    bounds[:, points.free.size :] = [[-LARGEST_EXPONENT], [LARGEST_EXPONENT]]
    best, least = None, np.inf
    # a curve through all points tells no errors: its unknowns and the shifts are at most three quarters as many as numbers
    most = 3 * points.x.size // 4 - 3 - (first.size + 1) // 2
    for knots in _KNOTS:
        # as many while shifts change: with another number the residuals would jump
        pieces = int(max(min(np.ceil(knots * np.ptp(points.places(first))), np.inf if best else most), 1))
        how = {"x_scale": 0.1, "xtol": 1e-8, "ftol": 1e-8, "max_nfev": _MOST_STEPS if best else None}
        found = least_squares(points.residuals, first, bounds=bounds, args=(pieces,), **how)
        unknowns = 2 * np.linalg.matrix_rank(_splines(points.places(found.x), pieces)) + found.x.size
        spare, first = found.fun.size - unknowns - 1, found.x
        score = found.fun.size * (np.log(found.cost + 1e-300) + 2 * unknowns / spare) if spare > 0 else np.inf
        # or a curve that follows any shift
        if best and (score >= least or not found.success or np.linalg.norm(found.jac, -2) < _FLAT):
            break
        best, least = (found, pieces, unknowns), score
        if apart(isotherms, points.shifts(found), _LEAST_SHARED):  # across a gap more knots determine no shift
            break
    return best


def _together(isotherms: list[DynamicModulus], at: int, start: np.ndarray, vertical: bool) -> tuple[Superposition, float | None]:
    """All shifts at once; and the temperature (K) of an isotherm whose shift nothing determines, or None."""
    points = _Points.of(isotherms, at, vertical)
    free, T = points.free, [each.temperature for each in isotherms]
    found, pieces, unknowns = _fitted(isotherms, points, np.append(start[free], [0.5] if vertical else []))
    _, sizes, ways = np.linalg.svd(found.jac, full_matrices=False)
    loose = T[free[np.argmax(np.abs(ways[-1, : free.size]))]] if sizes[-1] < _FLAT else None
    inverse = (ways.T / np.maximum(sizes, _FLAT) ** 2) @ ways
    # of an isotherm as a whole
    of_one = np.repeat(points.off(found.x, np.eye(len(T))[points.owner], pieces), 2, axis=0)
    point, whole = _variances(found.fun, found.jac, of_one, unknowns)
    moved = inverse @ (found.jac.T @ of_one)
    together = point * inverse + whole * (moved @ moved.T)
    covariance = np.zeros((len(T), len(T)))
    covariance[np.ix_(free, free)] = together[: free.size, : free.size]
    error = float(np.sqrt(together[-1, -1])) if vertical else 0.0
    return Superposition(**vars(points.shifts(found)), covariance=covariance, exponent_error=error), loose


def _variances(residuals: np.ndarray, jacobian: np.ndarray, of_one: np.ndarray, unknowns: int) -> tuple[float, float]:
    """Variances of single points, and of isotherms as a whole, by what residuals (m,) of a fit of so many ``unknowns`` share with
    columns ``of_one`` (m, n) beyond their ``jacobian`` (Henderson's third method)."""
    beyond = of_one - jacobian @ np.linalg.lstsq(jacobian, of_one, rcond=None)[0]
    directions, sizes, _ = np.linalg.svd(beyond, full_matrices=False)
    kept = sizes > 1e-6 * np.sqrt(len(residuals))
    shared = np.sum((directions[:, kept].T @ residuals) ** 2)
    freedom = max(residuals.size - unknowns, 1)
    point = (np.sum(residuals**2) - shared) / max(freedom - kept.sum(), 1)
    whole = (shared - kept.sum() * point) / np.sum(sizes[kept] ** 2) if kept.any() else 0.0
    return (point, whole) if whole > 0 else (np.sum(residuals**2) / freedom, 0.0)


def _splines(x: np.ndarray, pieces: int) -> np.ndarray:
    """Cubic B-splines over the range of ``x``, of so many pieces, (points, splines)."""
    from scipy.interpolate import BSpline

    low, high = x.min(), x.max()
    knots = np.concatenate((np.full(3, low), np.linspace(low, high, pieces + 1), np.full(3, high)))
    return BSpline.design_matrix(np.clip(x, low, high), knots, 3).toarray()
