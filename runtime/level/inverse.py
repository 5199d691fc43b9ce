"""From nominal pressure to penetration along a branch of loading.

The curve is interpolated piece by piece from the end its branch comes from, down to where it first passes the pressure; what it
does between samples is bounded by the interpolation's error. Where that leaves open whether a turn reaches the pressure, the
piece is interpolated again, finer.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from ..numerics.rounding import EPS
from .branches import Branch, loaded, rising
from .breaks import breaks_on, first_contact, threshold_width
from .curve import interpolate
from .effort import CURVE_LIMIT
from .interval import Interval
from .means import level_means
from .piece import Piece
from .saturated import saturated_level
from .strips import LevelBatch

#: accuracy of the first look, of the pressure's scale, and how much finer each further one is
_COARSE, _FINER = 2e-3, 0.03
#: width of the first part of the curve to be looked at, in heights; each further one is twice as wide
_NEXT = 0.3
#: penetrations in each of them at which the crest is looked at
_LOOKS = 12
#: how much more than the estimated error of the interpolation a turn has to keep away from the pressure
_DOUBT = 2.0
#: steps of Newton's method, and of that with bisection; and the share of what is allowed that a pressure may be off
_NEWTON, _STEPS, _CLOSE = 6, 60, 0.3
#: accuracy of averages on the way to a root that nothing is known of
_ROUGH = 1e-2
#: place of a pressure that loading never comes to carry
_PULLED_OFF = -1


@dataclass(frozen=True)
class Inverse:
    """Penetrations that carry given pressures, arrays (n,): ``D`` (NaN below pull-off), the slope d(tau)/dp of the level there,
    how uncertain the slope is; which are ``undecided``: the work ended before it was known which part of the curve it is; and
    which lie ``in_jump``, where D stands for one side of a curve that jumps over the pressure."""

    D: np.ndarray
    slope: np.ndarray
    doubt: np.ndarray
    undecided: np.ndarray
    in_jump: np.ndarray

    def take(self, index) -> Inverse:
        """Those at ``index``."""
        return Inverse(*(getattr(self, f.name)[index] for f in fields(self)))

    def put(self, index, found: Inverse) -> None:
        """Write those ``found`` at ``index``."""
        for f in fields(self):
            getattr(self, f.name)[index] = getattr(found, f.name)


def cut_penetration(columns: LevelBatch, p_max: np.ndarray, full: np.ndarray) -> np.ndarray:
    """A penetration from which the level carries more than ``p_max`` (Pa, (n,)) on either branch, at most ``full`` (m, (n,)).

    Averaged over a period Eq. 5 says ``p_mean = K w_mean`` (the steps of w and p cancel), and w is nowhere below the profile: so
    ``p_mean >= K (D - 3 h/4)``. No pressure is below ``-p_0``; -inf, for a level that nothing presses on, counts as that.
    """
    level = columns.level
    p_max = np.maximum(p_max, -columns.adhesion.p_0)
    return np.minimum(p_max / columns.material.K + 0.75 * level.h + 1e-9 * (level.h + np.abs(p_max) / columns.material.K), full)


def invert(columns: LevelBatch, p: np.ndarray, rtol: float) -> Inverse:
    """Largest penetration (``unloading``) or smallest (``loading``) at which each column carries ``p`` (Pa, (n,)).

    The root is refined with averages to ``rtol``.
    """
    level, K = columns.level, columns.material.K
    saturated = saturated_level(columns.material, columns.adhesion, level, columns.V, columns.branch)
    out = Inverse(
        np.where(p >= saturated.p_sat, p / K + 0.75 * level.h, np.nan), *np.zeros((2, p.size)), *np.zeros((2, p.size), bool)
    )
    # without adhesion there is no contact at no pressure
    rest = np.flatnonzero((p < saturated.p_sat) & ((p > 0) | (columns.adhesion.p_0 > 0)))
    if rest.size:
        search = _with_adhesion if columns.adhesion.p_0 > 0 else _without_adhesion
        asked = replace(columns.asked, fractions=1.0)
        found = search(replace(columns, asked=asked).at(rest, np.zeros(rest.size)), p[rest], saturated.D_sat[rest], rtol)
        out.put(rest, found)
    return out


def _without_adhesion(columns: LevelBatch, p: np.ndarray, full: np.ndarray, rtol: float) -> Inverse:
    """``invert`` at p > 0 without adhesion. Orbits are in the order of w, which rises with D, no faster: there is one root, and
    no turn to look for; and w lies between the profile, 3 h/4 below its crests on average, and these."""
    rise, friction_slope = np.full(p.size, columns.material.K), np.zeros(p.size)
    low, high = p / rise, np.minimum(p / rise + 0.75 * columns.level.h, full)
    D = high.copy()
    for accuracy in (max(rtol, _ROUGH), rtol):
        near = D, rise, friction_slope, low.copy(), high.copy()
        # however little the pressure is, friction goes with it
        D, friction_slope, doubt = _refine(columns, p, near, accuracy, floor=0.0)
    return Inverse(D, friction_slope, doubt, *np.zeros((2, p.size), bool))


def _with_adhesion(columns: LevelBatch, p: np.ndarray, full: np.ndarray, rtol: float) -> Inverse:
    """``invert`` with adhesion."""
    D, slope, doubt = np.full(p.size, np.nan), np.zeros(p.size), np.zeros(p.size)
    roots, undecided = _Descent(columns, p, cut_penetration(columns, p, full), rtol).run()
    in_jump = np.array([root is not None and np.isnan(root.low) for root in roots])
    found = np.array([i for i, root in enumerate(roots) if root is not None], int)
    if found.size:
        near = [np.array([getattr(roots[i], name) for i in found]) for name in ("D", "slope", "friction_slope", "low", "high")]
        D[found], slope[found], doubt[found] = _refine(
            columns.at(found, D[found]), p[found], near, rtol, 1e-3 * columns.scales[0]
        )
    return Inverse(D, slope, doubt, undecided, in_jump)


@dataclass(frozen=True)
class _Root:
    """Where a coarse curve passes the pressure: between the penetrations ``low`` and ``high``, or (nan) in the jump at ``D``."""

    D: float
    slope: float = 0.0
    friction_slope: float = 0.0
    low: float = np.nan
    high: float = np.nan


class _Descent:
    """All columns go along their curves together, one piece each at a time."""

    def __init__(self, columns: LevelBatch, p: np.ndarray, top: np.ndarray, rtol: float):
        self.columns, self.p = columns, p
        self.scale = np.abs(p) + columns.scales[0]
        finest = rtol * (np.abs(p) + 1e-3 * columns.scales[0])
        self.inside = threshold_width(columns, top)
        bottom, width = first_contact(columns), _NEXT * columns.level.h
        # at the top the curve is but cut, or saturates
        every = [Interval(i, bottom, D, inner_high=True) for i, D in enumerate(top)]
        self.walks = [
            _Walk(columns.branch == "unloading", *of, width if interval.high > bottom else None, interval)
            for *of, interval in zip(p, np.maximum(_COARSE * self.scale, finest), finest, every, strict=True)
        ]
        #: intervals that are known to hold no break
        self.unbroken: set[Interval] = set()

    def run(self) -> tuple[list[_Root | None], np.ndarray]:
        """Where each column carries its pressure (None: nowhere), and which are undecided."""
        strips = np.zeros(self.p.size, int)
        while now := self._next():
            goal = np.array([walk.goal for walk in self.walks])
            pieces = interpolate(self.columns, np.minimum(goal / self.scale, 0.1), now, strips, goal)
            for interval in now:
                i = interval.column
                self.walks[i].go_on(interval, pieces[i], bool(strips[i] > CURVE_LIMIT))
        return [walk.root for walk in self.walks], np.array([walk.undecided for walk in self.walks])

    def _next(self) -> list[Interval]:
        """The next interval of every column, taken from those that wait, free of breaks."""
        rows = [walk.waiting for walk in self.walks]
        fresh = [row.pop() for row in rows if row and row[-1] not in self.unbroken]
        if fresh:
            share = np.linspace(0, 1, _LOOKS)
            D = np.array([i.low + (i.high - i.low) * share for i in fresh])
            found, _ = breaks_on(self.columns, np.array([i.column for i in fresh]), D)
            for interval, breaks in zip(fresh, found, strict=True):
                parts = self._between(interval, breaks)
                self.unbroken.update(parts)
                self.walks[interval.column].waits(parts)
        return [row.pop() for row in rows if row]

    def _between(self, interval: Interval, breaks: np.ndarray) -> list[Interval]:
        """The parts of an interval between its breaks, ascending."""
        parts, rest, inside = [], interval, self.inside[interval.column]
        for D in breaks:
            if D - inside > rest.low:
                parts.append(replace(rest, high=D - inside, inner_high=False))
            rest = replace(rest, low=min(D + inside, rest.high), inner_low=False)
        return [part for part in (*parts, rest) if part.high > part.low]


class _Walk:
    """One column along its curve, from the end its branch comes from to where it first passes the pressure ``p``.

    ``goal``: error of the curve's pressure that it may have so far, at last ``finest``, Pa. ``width``: of the first part that is
    looked at, m; None if there is no curve.
    """

    def __init__(self, unloading: bool, p: float, goal: float, finest: float, width: float | None, interval: Interval):
        self.unloading, self.p, self.goal, self.finest = unloading, p, goal, finest
        #: intervals ahead, the next one last
        self.waiting = [] if width is None else self._growing(interval, width)
        #: loading to less than no pressure: what was gone along until it is known where the curve is least, and rises there
        self.held: list[tuple[Interval, list[Branch]]] = []
        self.passed: Branch | None = None
        self.root: _Root | None = None
        self.undecided = False

    def _growing(self, rest: Interval, width: float) -> list[Interval]:
        """An interval in parts that grow from the end at which the branch arrives; the last one first."""
        parts = []
        while rest.high - rest.low > 2 * width:
            lower, upper = rest.split(rest.high - width if self.unloading else rest.low + width, soft=True)
            rest, part = (lower, upper) if self.unloading else (upper, lower)
            parts.append(part)
            width *= 2
        return [rest, *parts[::-1]]

    def waits(self, ascending: list[Interval]) -> None:
        """These intervals are next."""
        self.waiting += ascending if self.unloading else ascending[::-1]

    def go_on(self, interval: Interval, pieces: list[Piece], exhausted: bool) -> None:
        """Along the ``pieces`` of an interval; where the work is not ``exhausted`` these may be asked for again, finer."""
        every = [part for piece in pieces for part in rising(piece)]
        parts = sorted(every, key=lambda part: (part.piece.low, part.t_low), reverse=self.unloading)
        along, clings = [interval], self.p < 0 and not self.unloading
        if clings:
            self.held.append((interval, parts))
            parts = [part for _, some in self.held for part in some]
            if self.waiting and not any(part.p_high >= 0 for part in parts):
                return
            parts, along, self.held = loaded(parts), [other for other, _ in self.held], []
        if self.goal > self.finest and len({self._passing(parts, doubts) for doubts in (-_DOUBT, 0.0, _DOUBT)}) > 1:
            if not exhausted:
                self.goal = max(_FINER * self.goal, self.finest)
                self.waiting += along[::-1]
                return
            self.undecided = True
        self.root = self._root(parts)
        if self.root is not None or clings:
            self.waiting = []
        elif parts:
            self.passed = parts[-1]

    def _passing(self, parts: list[Branch], doubts: float) -> int | None:
        """The first part that goes past the pressure, if that is so many errors of the curve greater."""
        if not self.unloading and parts and self.p + doubts * parts[0].errors.most[0] < min(parts[0].p_low, 0.0):
            return _PULLED_OFF
        for k, part in enumerate(parts):
            shifted = self.p + doubts * part.errors.most[0]
            if part.p_low < shifted if self.unloading else part.p_high >= shifted:
                return k
        return None

    def _root(self, parts: list[Branch]) -> _Root | None:
        index = self._passing(parts, 0.0)
        if index is None or index == _PULLED_OFF:
            return None
        part = parts[index]
        if self.p > part.p_high if self.unloading else self.p < part.p_low:
            return self._in_jump(parts[index - 1] if index else self.passed or part, part)
        t = part.reaches(self.p)
        step = 1e-4 * (part.t_high - part.t_low)
        ends = np.clip([t - step, t + step], part.t_low, part.t_high)
        values, D = part.piece.values(ends), part.piece.penetration(ends)
        rise, wide = np.diff(values, axis=0)[0], D[1] - D[0]
        slope = rise[0] / wide if wide > 0 else 0.0
        friction_slope = rise[1] / rise[0] if rise[0] > 0 else 0.0
        low, high = (float(part.piece.penetration(e)) for e in (part.t_low, part.t_high))
        return _Root(float(part.piece.penetration(t)), slope, friction_slope, low, high)

    def _in_jump(self, before: Branch, after: Branch) -> _Root:
        """A curve that jumps over the pressure carries it at the jump, where strips of both sides can stand side by side: as more
        of them have changed over, friction goes from that of one side to that of the other, evenly as far as is known."""
        t_before, t_after = (before.t_low, after.t_high) if self.unloading else (before.t_high, after.t_low)
        ends = [part.piece.values(np.array([t]))[0] for part, t in ((before, t_before), (after, t_after))]
        pressure, friction = (ends[1] - ends[0])[:2]
        slope = friction / pressure if pressure else 0.0
        return _Root(float(after.piece.penetration(t_after)), friction_slope=slope)


def _refine(columns: LevelBatch, p, near, rtol, floor):
    """Penetrations, d(tau)/dp and how uncertain that is at the roots ``near`` these (arrays of the fields of ``_Root``): Newton
    with the slope of the coarse curve, then of the last two averages; bisection where that does not settle. The pressure is met
    to a share of ``rtol`` of itself and the ``floor``, Pa."""
    D, slope, friction_slope, low, high = near
    # nothing but the coarse curve says what it is
    doubt = np.abs(friction_slope)
    goal = _CLOSE * rtol * (np.abs(p) + floor)
    active = np.flatnonzero((slope > 0) & (high > low))
    known = None
    for k in range(_STEPS):
        if not active.size:
            break
        values = level_means(columns.at(active, D[active]), np.full(active.size, rtol)).values
        here, miss, late = D[active], values[:, 0] - p[active], np.full(active.size, k >= _NEWTON)
        low[active], high[active] = np.where(miss < 0, here, low[active]), np.where(miss < 0, high[active], here)
        if known is not None:
            rows = np.searchsorted(known[0], active)
            moved, rise, rub = here - known[1][rows], values[:, 0] - known[2][rows], values[:, 1] - known[3][rows]
            better = moved * rise > 0
            slope[active[better]] = rise[better] / moved[better]
            secant = rub[better] / rise[better]
            doubt[active[better]] = np.abs(secant - friction_slope[active[better]])
            friction_slope[active[better]] = secant
            late &= np.abs(miss) > 0.5 * np.abs(known[2][rows] - p[active])
        going = np.abs(miss) > goal[active]
        known = tuple(v[going] for v in (active, here, values[:, 0], values[:, 1]))
        # what is close enough takes the step too: the average made there afterwards is next to the pressure
        new = np.clip(here - miss / slope[active], low[active], high[active])
        D[active] = np.where(late, _middle(low[active], high[active]), new)
        wide = (high - low)[active] > 8 * EPS * np.maximum(np.abs(here), columns.level.h)
        active = active[going & wide]
        if not wide.all():
            known = tuple(v[wide[going]] for v in known)
    return D, friction_slope, doubt


def _middle(low, high):
    """Between two penetrations, in the middle of their logarithms where they are above zero."""
    return np.where(low > 0, np.sqrt(np.maximum(low, 0.0)) * np.sqrt(np.maximum(high, 0.0)), 0.5 * (low + high))
