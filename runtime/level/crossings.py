"""Points of the curves of the plane of strips that were located, as a memory: neighbouring states cross a curve nearby."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from . import plane
from .plane import Boundary, Points

if TYPE_CHECKING:
    from .strips import LevelBatch

#: how far beyond the outermost points that are known of a curve it is expected to go on, as a share of their distance
_BEYOND = 0.5
#: points of a curve that are kept, over the amplitude of the crest
_GRID = 512


@dataclass
class Crossings:
    """Points of the curves of the plane that were located, for every velocity. Belongs to one level with one material, adhesion,
    closure and branch."""

    points: dict[Boundary, Points] = field(default_factory=dict)

    def remember(self, columns: LevelBatch, boundary: Boundary, points: Points) -> None:
        known = self.points.get(boundary)
        if known is not None:
            points = Points.joined([known, points])
        # by velocity and along the curve, which has one E for each A; what is closer than this says nothing new
        place = np.floor(points.A * (_GRID / columns.level.h))
        order = np.lexsort((points.A, points.index, points.velocity))
        points, place = points.take(order), place[order]
        fresh = np.append(True, ~_together(points) | (np.diff(place) != 0))
        self.points[boundary] = points.take(np.flatnonzero(fresh))

    def expected(self, columns: LevelBatch) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Columns and amplitudes, m, at which ``columns`` cross what is known of the curves, by Newton from between the two
        points nearest on each, or from the parabola through three where the curve turns; and which orbits end there; (k,)."""
        E = columns.D - columns.level.h
        states, amplitudes, ends = [np.empty(0, int)], [np.empty(0)], [np.empty(0, bool)]
        for boundary, known in self.points.items():
            parts = [part for part in (_between(known, columns.V, E), _at_turns(known, columns.V, E)) if part[0].size]
            if not parts:
                continue
            state, start = np.concatenate([state for state, _ in parts]), Points.joined([start for _, start in parts])
            points, found = plane.locate(columns, boundary, start, "A")
            found &= (points.A > 0) & (2 * points.A < columns.level.h)
            points, state = points.take(np.flatnonzero(found)), state[found]
            self.remember(columns, boundary, points)
            states.append(state)
            amplitudes.append(points.A)
            ends.append(np.full(state.size, boundary.event in ("fold", "release")))
        return np.concatenate(states), np.concatenate(amplitudes), np.concatenate(ends)


def _between(known: Points, velocity, E) -> tuple[np.ndarray, Points]:
    """States that cross a curve between two neighbouring points of it, or not far beyond its ends; points on the straight line
    through these."""
    first = np.searchsorted(known.velocity, velocity, "left")
    segments = np.maximum(np.searchsorted(known.velocity, velocity, "right") - 1 - first, 0)
    state = np.repeat(np.arange(E.size), segments)
    lower = first[state] + np.arange(state.size) - np.repeat(np.cumsum(segments) - segments, segments)
    together = _together(known)
    inside = together[lower]
    state, lower = state[inside], lower[inside]
    upper = lower + 1
    rise = known.E[upper] - known.E[lower]
    share = np.divide(E[state] - known.E[lower], rise, out=np.full(state.size, np.inf), where=rise != 0)
    # only the outermost segments of a curve go on beyond their ends
    padded = np.concatenate(([False], together, [False]))
    low = np.where(padded[lower], 0.0, -_BEYOND)
    high = np.where(padded[upper + 1], 1.0, 1 + _BEYOND)
    near = np.flatnonzero((share >= low) & (share <= high))
    state, share, lower, upper = state[near], share[near], lower[near], upper[near]
    blend = lambda x: (x[lower].T + share * (x[upper] - x[lower]).T).T  # noqa: E731
    A = np.maximum(blend(known.A), 0.5 * known.A[lower])
    return state, Points(velocity[state], A, E[state], blend(known.edges), known.pressure[lower], known.index[lower])


def _at_turns(known: Points, velocity, E) -> tuple[np.ndarray, Points]:
    """States beyond the last point of a curve before it turns back in E, and where each of them crosses the parabola through the
    three points there, twice."""
    together = _together(known)
    steps = np.diff(known.E)
    middle = 1 + np.flatnonzero(together[:-1] & together[1:] & (steps[:-1] != 0) & (steps[:-1] * steps[1:] <= 0))
    # E = E_middle + slope (A - A_middle) + bend (A - A_middle)^2
    before, after = (known.A[middle + k] - known.A[middle] for k in (-1, 1))
    low, high = ((known.E[middle + k] - known.E[middle]) / (known.A[middle + k] - known.A[middle]) for k in (-1, 1))
    bend = (high - low) / (after - before)
    slope = low - bend * before
    turn = known.E[middle] - 0.25 * slope**2 / bend
    square = (E - turn[:, None]) / bend[:, None]
    beyond = (E - known.E[middle, None]) * bend[:, None] < 0
    at, state = np.nonzero((known.velocity[middle, None] == velocity) & beyond & (square > 0))
    root = np.sqrt(square[at, state])
    state, at, root = np.tile(state, 2), np.tile(at, 2), np.concatenate((-root, root))
    moved = root - 0.5 * slope[at] / bend[at]
    weights = [  # of Lagrange
        moved * (moved - after[at]) / (before * (before - after))[at],
        (moved - before[at]) * (moved - after[at]) / (before * after)[at],
        moved * (moved - before[at]) / (after * (after - before))[at],
    ]
    points = middle[at]
    edges = sum(weight[:, None] * known.edges[points + k] for k, weight in zip((-1, 0, 1), weights, strict=True))
    return state, Points(velocity[state], known.A[points] + moved, E[state], edges, known.pressure[points], known.index[points])


def _together(points: Points) -> np.ndarray:
    """Which points stand on the same curve as the next one."""
    return (np.diff(points.velocity) == 0) & (np.diff(points.index) == 0)
