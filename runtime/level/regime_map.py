"""The map of regimes: where a level crosses the curves that divide the plane of strips.

A level at penetration D is a horizontal segment of the plane of strips (``plane``), ``E = D - h``. Straight curves are thresholds
in closed form. Others are met between two strips in different regimes, and located by the equation of the orbit that ends there,
from that orbit's edges. What was located is remembered: neighbouring segments cross the same curve nearby.

Two questions are answered, over y at a penetration and over D at the crest: where breaks are known before strips are solved
(``known_breaks``), and where those are that lie between two strips (``by_equation``). Nothing here decides what a strip does: a
curve that is not found is met by bisection (and counted), one too many costs a panel.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ..numerics.rounding import EPS
from ..orbit.foundation import foundation_of
from ..orbit.regimes import CODE, ZONES
from .changes import Changes
from .plane import BOUNDARIES, Boundary, CurvePoints, Turns, grazing, locate, locate_turns, together, turning

if TYPE_CHECKING:
    from .strips import LevelBatch

#: place of each regime in the order in which a strip that is drawn out passes them: up to 1 it is engaged all along
_RANK = np.array([{"c": 0, "a": 1, "ac": 1, "af": 3, "f": 4}.get(sequence, 2) for sequence in CODE])
#: of the lines of ``straight``: where a gap that adheres throughout opens, and closes, and the first one of a pressure
OPENS, _CLOSES, _PRESSURES = 2, 3, 4
#: how far beyond the outermost points that are known of a curve it is expected to go on, as a share of their distance
_BEYOND = 0.5
#: points of a curve that are kept for each natural logarithm of the amplitude: next to the valley all of it is small
_GRID = 256


def straight(columns: LevelBatch) -> tuple[np.ndarray, np.ndarray]:
    """Straight curves ``E + f A = c`` of the plane, f and c (lines, n), m: what a closed form tells of every state. Where
    saturated contact opens; strips are touched; a gap that adheres throughout opens over its valley; and where it closes at its
    crest (NaN: not on this branch); where pressures of saturated contact, ``K (E + A (1 +- R))``, are breaks of the law below."""
    P, reach, none = columns.stretch, columns.adhesion.delta_0 if columns.stretch > 0 else 0.0, np.nan
    unloading = columns.branch == "unloading"
    R = foundation_of(columns.material).modulus_ratio(columns.level.k * columns.V)
    opens, closes = (columns.opens if unloading else none, -P) if P > 0 else (none, none)
    c = [np.full(R.size, at) for at in (-P, none if unloading and P > 0 else -reach, opens, closes)]
    f = [1 - R, *(np.full(R.size, slope) for slope in (2.0, 0.0, 2.0))]
    if columns.carry is not None:
        level = columns.carry.laws.breaks[columns.group].T / columns.material.K
        c, f = [*c, *level, *level], f + [1 + R] * len(level) + [1 - R] * len(level)
    return np.array(f), np.array(c)


def thresholds(columns: LevelBatch) -> tuple[np.ndarray, np.ndarray]:
    """States and thetas (k,) at which strips pass a threshold in closed form."""
    f, c = straight(columns)
    D, h, P = columns.D, columns.level.h, columns.stretch
    with np.errstate(all="ignore"):
        # shares of the amplitude of the crest that are left and lost: next to either end to all digits of that
        left, lost = 2 * (c + (h - D)) / (f * h), ((f - 2) * h + 2 * (D - c)) / (f * h)
        inside = (left > 0) & (lost > 0)
        # a gap that adheres throughout is nowhere wider than delta_0
        inside[_CLOSES] &= D - h + P >= -columns.adhesion.delta_0
        # pressures of saturated contact, where there is any
        inside[_PRESSURES:] &= -0.5 * f[0] * h * left[_PRESSURES:] <= (D - h + P) * (1 + 1e-9)
    kind, state = np.nonzero(inside)
    return state, 2 * np.arctan2(np.sqrt(lost[inside]), np.sqrt(left[inside]))


def known_breaks(columns: LevelBatch) -> tuple[np.ndarray, np.ndarray]:
    """States and thetas (k,) at which strips pass a threshold in closed form, or a curve that is known nearby."""
    every = thresholds(columns), *columns.crossings.predicted(columns)
    return tuple(np.concatenate(v) for v in zip(*every, strict=True))


def theta_of(columns: LevelBatch, A) -> np.ndarray:
    """``k y`` of the strips with amplitude ``A``, m."""
    # a level without height has one strip, the crest
    h = columns.level.h
    return 2 * np.arccos(np.sqrt(np.clip(2 * A / h, 0.0, 1.0))) if h > 0 else np.zeros(np.shape(A))


def _equations(columns: LevelBatch, changes: Changes, side: int) -> Iterator[tuple[Boundary, np.ndarray]]:
    """Boundaries at which orbits on one side of the ``changes`` may give way to those on the other: each with the rows it is for.

    Orbits are ordered: pressed deeper a strip is more engaged. So unloading leaves an orbit that is engaged all along only where
    that ends itself, and loading one with a free part; contact that appears in an adhesion zone ends neither."""
    code, other = (changes.codes[:, k] % len(CODE) for k in (side, 1 - side))
    to_engaged, unloading = _RANK[other] <= 1, columns.branch == "unloading"
    for boundary in BOUNDARIES:
        rows = code == CODE[boundary.sequence]
        if boundary.event == "peak":
            greatest = changes.passed[:, : changes.over_breaks.shape[2] // 2]
            rows &= (code == other) & greatest.any(axis=1)
        elif boundary.event == "release":
            rows &= unloading
        elif boundary.event == "closing":
            # contact may vanish within a zone that goes on without it, before that ends too
            rows = rows & (other == CODE["acaf"]) | (code == CODE["acaf"]) & np.isin(other, [CODE["af"], CODE["f"]])
        else:
            rows &= ~to_engaged if unloading else other != CODE["f"]
        yield boundary, np.flatnonzero(rows)


def locate_boundaries(
    columns: LevelBatch, changes: Changes, A: np.ndarray, E: np.ndarray, unknown: str
) -> tuple[np.ndarray, np.ndarray]:
    """Where regimes that meet between two strips of the plane do, by the equation of an orbit that ends there; or where its
    greatest pressure passes a break of the law below.

    ``A`` and ``E`` (m, 2) of the ends of the ``changes``; ``unknown`` "A" or "E": the coordinate they differ in. ``columns``: the
    state of each. Returns that coordinate and which were found, (m,); the points of curves are remembered."""
    ends = A if unknown == "A" else E
    low, high = ends.min(axis=1), ends.max(axis=1)
    # along y thresholds are known before any strip is solved
    place, found = np.full(changes.size, np.nan), np.zeros(changes.size, bool)
    if unknown == "E":
        place, found = _by_threshold(columns, changes, A[:, 0], low, high)
    index, pressure = np.zeros(changes.size, int), np.zeros(changes.size)
    if columns.carry is not None:
        breaks = columns.carry.laws.breaks[columns.group]
        index = changes.passed.argmax(axis=1) % breaks.shape[1]
        pressure = breaks[np.arange(changes.size), index]
    for side in (0, 1):
        for boundary, rows in _equations(columns, changes, side):
            rows = rows[~found[rows]]
            if not rows.size:
                continue
            names, peak = ["dbac".index(name) for name in ZONES[boundary.sequence][1]], boundary.event == "peak"
            ends = [v[rows] for v in (A, E, changes.edges[:, :, names])]
            near = [v[:, side] for v in ends]
            if peak and not side:
                # between two orbits of one regime, as far along as their greatest pressures tell
                height = changes.over_breaks[rows, :, index[rows]].T
                near = [((height[0] * v[:, 1].T - height[1] * v[:, 0].T) / (height[0] - height[1])).T for v in ends]
            start = CurvePoints(columns.V[rows], *near, pressure[rows] * peak, index[rows] * peak)
            got, good = locate(columns, boundary, grazing(columns, boundary, start), unknown)
            at = getattr(got, unknown)
            good &= (at > low[rows]) & (at < high[rows])
            place[rows[good]], found[rows[good]] = at[good], True
            if good.any():
                columns.crossings.remember(boundary, got.take(np.flatnonzero(good)))
    return place, found


def _by_threshold(columns: LevelBatch, changes: Changes, A, low, high) -> tuple[np.ndarray, np.ndarray]:
    """E between ``low`` and ``high`` (m,) where the ``changes`` are on a straight curve, and which of them are of that kind."""
    f, c = straight(columns)
    code, unloading = changes.codes % len(CODE), columns.branch == "unloading"
    some = lambda *sequences: np.isin(code, [CODE[s] for s in sequences]).any(axis=1)  # noqa: E731
    differ = code[:, 0] != code[:, 1]
    kinds = [
        # drawn out, what is engaged all along stays so until it opens, whatever it opens to
        some("c") & differ & (unloading | some("ac", "cf")),
        some("f") & differ,
        # all along y at once
        some("a") & (_RANK[code] > 1).any(axis=1),
        some("a") & some("ac", "c"),
        *(some("c") & ~differ & changes.passed.T),
    ]
    known = np.array(kinds) & ~np.isnan(c)
    # of several the last holds
    line = len(kinds) - 1 - known[::-1].argmax(axis=0)
    place = (c - f * A)[line, np.arange(changes.size)]
    # a curve over penetration ends at saturation, but for rounding
    slack = 64 * EPS * (np.abs(low) + np.abs(high) + columns.level.h)
    return np.clip(place, low, high), known.any(axis=0) & (place >= low - slack) & (place <= high + slack)


def hides_another(code: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Codes of regimes, (m,) both, that do not follow one another as a strip is drawn out: a third may lie between."""
    return np.abs(_RANK[code % len(CODE)] - _RANK[other % len(CODE)]) > 1


def by_equation(columns: LevelBatch, changes: Changes, unknown: str) -> tuple[np.ndarray, np.ndarray]:
    """Which changes equations locate completely, once for each break of the law below that is passed, and where, (k,) both:
    along y at the penetration of each of the ``columns`` (``unknown`` "A"), or over penetration at the crest ("E")."""
    ends, h = np.stack((changes.low, changes.high), axis=1), columns.level.h
    if unknown == "A":
        A, E = columns.level.amplitude(ends), np.repeat(columns.D - h, 2).reshape(-1, 2)
    else:
        A, E = np.full(ends.shape, 0.5 * h), ends - h
    passed = changes.passed & (changes.codes[:, :1] % len(CODE) == changes.codes[:, 1:] % len(CODE))
    parent, which = np.nonzero(passed)
    none = np.flatnonzero(~passed.any(axis=1))
    parts = changes.take(parent)
    # of the other breaks nothing is known, so that they are not passed
    parts.over_breaks = np.where((np.arange(passed.shape[1]) != which[:, None])[:, None], np.nan, parts.over_breaks)
    each, parent = Changes.joined([changes.take(none), parts]), np.concatenate((none, parent))
    place, found = locate_boundaries(columns.at(parent, columns.D[parent]), each, A[parent], E[parent], unknown)
    every = np.bincount(parent[~found], minlength=changes.size)[parent] == 0
    parent, place = parent[every], place[every]
    return parent, theta_of(columns, place) if unknown == "A" else place + h


@dataclass
class Crossings:
    """Points of the curves of the plane that were located, for every velocity, and where they turn, once that was asked. Belongs
    to one level with one material, adhesion, closure and branch."""

    points: dict[Boundary, CurvePoints] = field(default_factory=dict)
    turns: dict[Boundary, Turns] = field(default_factory=dict)

    def remember(self, boundary: Boundary, points: CurvePoints) -> None:
        known = self.points.get(boundary)
        if known is not None:
            points = CurvePoints.joined([known, points])
        # by velocity and along the curve, which has one E for each A; what is closer than this says nothing new, but a turn does
        place = np.floor(_GRID * np.log(points.A))
        others = ~np.isin(points.A, self.turns[boundary].A if boundary in self.turns else ())
        order = np.lexsort((points.A, others, place, points.index, points.velocity))
        points, place = points.take(order), place[order]
        fresh = np.append(True, ~together(points) | (np.diff(place) != 0))
        self.points[boundary] = points.take(np.flatnonzero(fresh))

    def predicted(self, columns: LevelBatch) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Columns and thetas (k,) at which ``columns`` cross what is known of each curve, by Newton from between the two points
        nearest on it, or from the parabola through three where it turns, or pass by a turn."""
        E = columns.D - columns.level.h
        for boundary, known in self.points.items():
            starts = _between(known, columns.V, E), _next_to_turns(known, columns.V, E)
            state, lower, share = (np.concatenate(v) for v in zip(*starts, strict=True))
            if not state.size:
                continue
            blend = lambda x: (x[lower].T + share * (x[lower + 1] - x[lower]).T).T  # noqa: E731, B023
            A, passed = np.maximum(blend(known.A), 0.5 * known.A[lower]), (known.pressure[lower], known.index[lower])
            start = CurvePoints(columns.V[state], A, E[state], blend(known.edges), *passed)
            points, found = locate(columns, boundary, start, "A")
            found &= (points.A > 0) & (2 * points.A < columns.level.h)
            points, state = points.take(np.flatnonzero(found)), state[found]
            self.remember(boundary, points)
            yield state, theta_of(columns, points.A)
        # just beyond a turn strips come close to an end: their contact all but closes, say
        for turns in (turns for boundary, turns in self.turns.items() if boundary.event != "peak"):
            beyond = turns.way * (E[:, None] - turns.E) >= 0
            state, turn = np.nonzero((columns.V[:, None] == turns.velocity) & beyond)
            yield state, theta_of(columns, turns.A[turn])

    def turned(self, columns: LevelBatch) -> Turns:
        """Where the curves turn, as far as is known at the velocities of ``columns``."""
        none = Turns(*np.empty((4, 0)))
        for boundary in list(self.points):
            had = self.turns.get(boundary, none)
            turns, points = locate_turns(columns, boundary, self.points[boundary], had)
            self.turns[boundary] = Turns.joined([had, turns])
            self.remember(boundary, points)
        return Turns.joined([none, *self.turns.values()])


def _between(known: CurvePoints, velocity, E) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """States that cross a curve between two neighbouring points of it, or not far beyond its ends; the first of the two, and the
    share of the straight line through them on which that is."""
    first = np.searchsorted(known.velocity, velocity, "left")
    segments = np.maximum(np.searchsorted(known.velocity, velocity, "right") - 1 - first, 0)
    state = np.repeat(np.arange(E.size), segments)
    lower = first[state] + np.arange(state.size) - np.repeat(np.cumsum(segments) - segments, segments)
    one = np.concatenate(([False], together(known), [False]))
    rise = known.E[lower + 1] - known.E[lower]
    share = np.divide(E[state] - known.E[lower], rise, out=np.full(state.size, np.inf), where=rise != 0)
    # only the outermost segments of a curve go on beyond their ends
    low, high = np.where(one[lower], 0.0, -_BEYOND), np.where(one[lower + 2], 1.0, 1 + _BEYOND)
    near = one[lower + 1] & (share >= low) & (share <= high)
    turns = np.isin(np.arange(known.size), turning(known))
    near &= ~(turns[lower] | turns[lower + 1]) | (share < 0) | (share > 1)
    return state[near], lower[near], share[near]


def _next_to_turns(known: CurvePoints, velocity, E) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """``_between`` for states next to the last point before a curve turns back in E, or beyond it, which cross the parabola
    through it and its neighbours."""
    middle = turning(known)
    # E = E_middle + slope (A - A_middle) + bend (A - A_middle)^2
    ends = np.array([-1, 1])[:, None]
    (before, after), rises = (v[middle + ends] - v[middle] for v in (known.A, known.E))
    low, high = rises / (before, after)
    bend = (high - low) / (after - before)
    slope = low - bend * before
    off = E - known.E[middle, None]
    square = off / bend[:, None] + 0.25 * (slope / bend)[:, None] ** 2
    # on either side as far as the neighbour there
    there = (known.velocity[middle, None] == velocity) & (square > 0) & ((off - rises[:, :, None]) * bend[:, None] <= 0)
    side, at, state = np.nonzero(there)
    moved = ends[side, 0] * np.sqrt(square[at, state]) - 0.5 * (slope / bend)[at]
    lower = middle[at] - (moved < 0)
    share = (known.A[middle[at]] + moved - known.A[lower]) / (known.A[lower + 1] - known.A[lower])
    return state, lower, share
