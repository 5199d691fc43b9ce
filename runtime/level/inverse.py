"""From nominal pressure to penetration along a branch of loading.

The curve is interpolated piece by piece from the end its branch comes from, down to where it first passes the pressure; what it
does between samples is bounded by the interpolation's error. Where that leaves open whether a turn reaches the pressure, the
piece is interpolated again, finer.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .branches import Branch, loaded, rising
from .breaks import breaks_on, first_contact, threshold_width
from .curve import PressureQuery, interpolate
from .effort import CURVE_LIMIT
from .interval import Interval
from .means import level_means
from .monotone import enclosed
from .strips import LevelBatch

#: accuracy of the first look, of the pressure's scale, and how much finer each further one is
_COARSE, _FINER = 2e-3, 0.03
#: width of the first part of the curve to be looked at, in heights; each further one is twice as wide
_NEXT = 0.3
#: penetrations in each of them at which the crest is looked at
_LOOKS = 12
#: how much more than the estimated error of the interpolation a turn has to keep away from the pressure
_DOUBT = 2.0
_NEWTON, _STEPS = 6, 60
_CLOSE = 0.3
#: place of a pressure that loading never comes to carry
_PULLED_OFF = -1
_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class Inverse:
    """Penetrations that carry given pressures, arrays (n,): ``D`` (NaN below pull-off), the slope d(tau)/dp of the level there,
    how uncertain the slope is, and which are ``undecided``: the work ended before it was known which part of the curve it is."""

    D: np.ndarray
    slope: np.ndarray
    doubt: np.ndarray
    undecided: np.ndarray

    def take(self, index) -> Inverse:
        """Those at ``index``."""
        return Inverse(self.D[index], self.slope[index], self.doubt[index], self.undecided[index])


def cut_penetration(columns: LevelBatch, p_max: np.ndarray, full: np.ndarray) -> np.ndarray:
    """A penetration from which the level carries more than ``p_max`` (Pa, (n,)) on either branch, at most ``full`` (m, (n,)).

    Averaged over a period Eq. 5 says ``p_mean = K w_mean`` (the steps of w and p cancel), and w is nowhere below the profile: so
    ``p_mean >= K (D - 3 h/4)``. No pressure is below ``-p_0``; -inf, for a level that nothing presses on, counts as that.
    """
    level = columns.level
    p_max = np.maximum(p_max, -columns.adhesion.p_0)
    return np.minimum(p_max / columns.material.K + 0.75 * level.h + 1e-9 * (level.h + np.abs(p_max) / columns.material.K), full)


def invert(columns: LevelBatch, p: np.ndarray, full: np.ndarray, rtol: float) -> Inverse:
    """Largest penetration (``unloading``) or smallest (``loading``) at which each column carries ``p`` (Pa, (n,)), below
    saturation.

    ``full`` (n,): penetration of saturated contact. The root is refined with averages to ``rtol``.
    """
    D, slope, doubt = np.full(p.size, np.nan), np.zeros(p.size), np.zeros(p.size)
    columns = replace(columns, frictional=True)
    if not columns.adhesion.p_0 > 0:
        loaded = np.flatnonzero(p > 0)
        if loaded.size:
            some = columns.at(loaded, D[loaded])
            D[loaded], slope[loaded], doubt[loaded] = _refine(some, p[loaded], enclosed(some, p[loaded]), rtol)
        return Inverse(D, slope, doubt, np.zeros(p.size, bool))
    descent = _Descent(columns, p, cut_penetration(columns, p, full), rtol)
    roots = descent.run()
    found = np.array([i for i, root in enumerate(roots) if root is not None], int)
    if found.size:
        near = [np.array([getattr(roots[i], name) for i in found]) for name in ("D", "slope", "friction_slope", "low", "high")]
        D[found], slope[found], doubt[found] = _refine(columns.at(found, D[found]), p[found], near, rtol)
    return Inverse(D, slope, doubt, descent.undecided)


@dataclass(frozen=True)
class _Root:
    """Where a coarse curve passes the pressure: on ``part``, whose pressures enclose it, or (None) in the jump at ``D``."""

    D: float
    slope: float = 0.0
    friction_slope: float = 0.0
    low: float = np.nan
    high: float = np.nan


class _Descent:
    """All columns go along their curves together, one piece each at a time."""

    def __init__(self, columns: LevelBatch, p, top, rtol):
        self.columns, self.p, self.rtol = columns, p, rtol
        self.unloading = columns.branch == "unloading"
        scale = columns.scales[0]
        self.scale, self.finest = np.abs(p) + scale, rtol * (np.abs(p) + 1e-3 * scale)
        self.inside = threshold_width(columns, top)
        self.undecided = np.zeros(p.size, bool)
        #: loading: intervals below zero pressure, and what rises in them, until it is known where it is least
        self.hanging: list[list[tuple[Interval, list[Branch]]]] = [[] for _ in p]
        bottom = first_contact(columns)
        # the next one last; ``unbroken`` ones are known to hold no break
        # at the top the curve is but cut, or saturates
        every = (Interval(i, bottom, D, smooth_high=True) for i, D in enumerate(top))
        self.waiting = [self._parts(interval) if interval.high > bottom else [] for interval in every]
        self.unbroken: set[Interval] = set()

    def _parts(self, interval: Interval) -> list[Interval]:
        """An interval in parts that grow from the end at which the branch arrives; the last one first."""
        parts, rest, width = [], interval, _NEXT * self.columns.level.h
        while rest.high - rest.low > 2 * width:
            lower, upper = rest.split(rest.high - width if self.unloading else rest.low + width, soft=True)
            rest, part = (lower, upper) if self.unloading else (upper, lower)
            parts.append(part)
            width *= 2
        return [rest, *parts[::-1]]

    def run(self) -> list[_Root | None]:
        roots: list[_Root | None] = [None] * self.p.size
        goal = np.maximum(_COARSE * self.scale, self.finest)
        strips = np.zeros(self.p.size, int)
        while True:
            now = self._next()
            if not now:
                return roots
            pieces = interpolate(self.columns, np.minimum(goal / self.scale, 0.1), now, strips, PressureQuery(self.p, goal))
            for interval in now:
                i = interval.column
                row = sorted(pieces[i], key=lambda piece: -piece.low if self.unloading else piece.low)
                parts = [part for piece in row for part in self._along(piece)]
                along, hanging = [interval], self.p[i] < 0 and not self.unloading
                if hanging:
                    self.hanging[i].append((interval, parts))
                    parts = [part for _, some in self.hanging[i] for part in some]
                    if self.waiting[i] and not any(part.p_high >= 0 for part in parts):
                        continue
                    parts = loaded(parts)
                    along, self.hanging[i] = [other for other, _ in self.hanging[i]], []
                root, doubtful = self._first(parts, self.p[i], goal[i] > self.finest[i])
                if doubtful and strips[i] > CURVE_LIMIT:
                    self.undecided[i] = True
                    root, doubtful = self._first(parts, self.p[i], False)
                if doubtful:
                    goal[i] = max(_FINER * goal[i], self.finest[i])
                    self.waiting[i] += along[::-1]
                elif root is not None or hanging:
                    roots[i], self.waiting[i] = root, []

    def _next(self) -> list[Interval]:
        """The next interval of every column, taken from those that wait, free of breaks."""
        fresh = [row.pop() for row in self.waiting if row and row[-1] not in self.unbroken]
        if fresh:
            share = np.linspace(0, 1, _LOOKS)
            D = np.array([i.low + (i.high - i.low) * share for i in fresh])
            found, _ = breaks_on(self.columns, np.array([i.column for i in fresh]), D)
            for interval, breaks in zip(fresh, found, strict=True):
                self._put(interval, breaks)
        return [row.pop() for row in self.waiting if row]

    def _put(self, interval: Interval, breaks) -> None:
        i, inside = interval.column, self.inside[interval.column]
        parts, rest = [], interval
        for D in breaks:
            if D - inside > rest.low:
                parts.append(replace(rest, high=D - inside, inner_high=False, smooth_high=False))
            rest = replace(rest, low=min(D + inside, rest.high), inner_low=False, smooth_low=False)
        parts.append(rest)
        parts = [part for part in parts if part.high > part.low]
        self.unbroken.update(parts)
        self.waiting[i] += parts if self.unloading else parts[::-1]

    def _along(self, piece) -> list[Branch]:
        parts = rising(piece)
        return parts if self.unloading else parts[::-1]

    def _first(self, parts: list[Branch], p: float, refinable: bool) -> tuple[_Root | None, bool]:
        """The first part that goes past the pressure, as a root, and whether the error of the curve leaves open which it is."""
        index = self._passing(parts, p, 0.0)
        if refinable:
            around = {self._passing(parts, p, -_DOUBT), index, self._passing(parts, p, _DOUBT)}
            if len(around) > 1:
                return None, True
        if index is None or index == _PULLED_OFF:
            return None, False
        part = parts[index]
        edge = part.t_high if self.unloading else part.t_low
        outside = p > part.p_high if self.unloading else p < part.p_low
        if outside:  # between two pieces the curve jumps over the pressure
            return _Root(float(part.piece.penetration(edge))), False
        t = part.reaches(p)
        step = 1e-4 * (part.t_high - part.t_low)
        ends = np.clip([t - step, t + step], part.t_low, part.t_high)
        values, D = part.piece.values(ends), part.piece.penetration(ends)
        rise, wide = np.diff(values, axis=0)[0], D[1] - D[0]
        slope = rise[0] / wide if wide > 0 else 0.0
        friction_slope = rise[1] / rise[0] if rise[0] > 0 else 0.0
        low, high = (float(part.piece.penetration(e)) for e in (part.t_low, part.t_high))
        return _Root(float(part.piece.penetration(t)), slope, friction_slope, low, high), False

    def _passing(self, parts, p, doubts) -> int | None:
        if not self.unloading and parts and p + doubts * parts[0].errors.most[0] < min(parts[0].p_low, 0.0):
            return _PULLED_OFF
        for k, part in enumerate(parts):
            shifted = p + doubts * part.errors.most[0]
            if part.p_low < shifted if self.unloading else part.p_high >= shifted:
                return k
        return None


def _refine(columns: LevelBatch, p, near, rtol):
    """Penetrations, d(tau)/dp and how uncertain that is at the roots ``near`` these (arrays of the fields of ``_Root``): Newton
    with the slope of the coarse curve, then of the last two averages."""
    D, slope, friction_slope, low, high = near
    # nothing but the coarse curve says what it is
    doubt = np.abs(friction_slope)
    goal = _CLOSE * rtol * (np.abs(p) + 1e-3 * columns.scales[0])
    active = np.flatnonzero((slope > 0) & (high > low))
    known = None
    for _ in range(_NEWTON):
        if not active.size:
            return D, friction_slope, doubt
        values = level_means(columns.at(active, D[active]), np.full(active.size, rtol)).values
        miss = values[:, 0] - p[active]
        if known is not None:
            rows = np.searchsorted(known[0], active)
            moved, rise, rub = D[active] - known[1][rows], values[:, 0] - known[2][rows], values[:, 1] - known[3][rows]
            better = moved * rise > 0
            slope[active[better]] = (rise[better]) / moved[better]
            secant = rub[better] / rise[better]
            doubt[active[better]] = np.abs(secant - friction_slope[active[better]])
            friction_slope[active[better]] = secant
        going = np.abs(miss) > goal[active]
        known = tuple(v[going] for v in (active, D[active], values[:, 0], values[:, 1]))
        # what is close enough takes the step too: the average made there afterwards is next to the pressure
        D[active] = np.clip(D[active] - miss / slope[active], low[active], high[active])
        active = active[going]
    if active.size:
        D[active], friction_slope[active] = _bracketed(columns, p, active, low[active], high[active], rtol)
        doubt[active] = np.abs(friction_slope[active])
    return D, friction_slope, doubt


def _bracketed(columns: LevelBatch, p, index, low, high, rtol):
    """Root of p_mean(D) - p in each bracket: false position with halving of stale ends (Illinois), averages ever finer."""
    goal = p[index]
    scale = 1e-3 * columns.scales[0]
    n = index.size

    def sample(pick, D, accuracy):
        values = level_means(columns.at(index[pick], D), np.full(pick.size, accuracy)).values
        return values[:, 0] - goal[pick], values[:, 1]

    every = np.arange(n)
    ends = [low.copy(), high.copy()]
    value, tau = zip(*(sample(every, D, rtol) for D in ends), strict=True)
    value, tau = [v.copy() for v in value], [t.copy() for t in tau]
    weight = [v.copy() for v in value]
    root, slope = low.copy(), np.zeros(n)
    # an end on the wrong side by the coarse scan's error is the root itself, to that accuracy: widen it
    active = every[(value[0] * value[1] < 0)]
    for side in (0, 1):
        exact = value[side] == 0
        root[exact] = ends[side][exact]
    stray = every[(value[0] * value[1] > 0)]
    if stray.size:
        best = np.where(np.abs(value[0]) < np.abs(value[1]), ends[0], ends[1])
        root[stray] = best[stray]
    last = np.full(n, -1)
    for _ in range(_STEPS):
        if not active.size:
            break
        a, b, wa, wb = ends[0][active], ends[1][active], weight[0][active], weight[1][active]
        D = (a * wb - b * wa) / (wb - wa)
        edge = np.minimum(a, b) + 1e-3 * np.abs(b - a), np.maximum(a, b) - 1e-3 * np.abs(b - a)
        D = np.clip(D, *edge)
        v, t = sample(active, D, rtol)
        side = np.where(v * value[0][active] > 0, 0, 1)
        for k in (0, 1):
            mine = active[side == k]
            other = 1 - k
            run = last[mine] == k
            weight[other][mine[run]] *= 0.5
            for store, new in ((ends, D), (value, v), (weight, v), (tau, t)):
                store[k][mine] = new[side == k]
        last[active] = side
        root[active] = D
        rise = value[1][active] - value[0][active]
        slope[active] = np.divide(tau[1][active] - tau[0][active], rise, out=np.zeros(active.size), where=np.abs(rise) > 0)
        done = (np.abs(v) <= 0.3 * rtol * (np.abs(goal[active]) + scale)) | (
            np.abs(ends[1] - ends[0])[active] <= 8 * _EPS * np.maximum(np.abs(D), columns.level.h)
        )
        active = active[~done]
    return root, slope
