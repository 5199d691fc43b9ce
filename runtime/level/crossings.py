"""Points of the curves of the plane of strips that were located, as a memory: neighbouring states cross a curve nearby."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from . import plane
from .plane import Boundary, Points

if TYPE_CHECKING:
    from .strips import Columns

#: how far beyond the outermost points that are known of a curve it is expected to go on, as a share of their distance
_BEYOND = 0.5
#: points of a curve that are kept, over the amplitude of the crest
_GRID = 512


@dataclass
class Crossings:
    """Points of the curves of the plane that were located, for every velocity. Belongs to one
    level with one material, adhesion, closure and branch."""

    points: dict[Boundary, Points] = field(default_factory=dict)

    def remember(self, columns: Columns, boundary: Boundary, points: Points) -> None:
        known = self.points.get(boundary)
        if known is not None:
            points = Points.joined(known, points)
        # by velocity and along the curve, which has one E for each A; what is closer than this says nothing new
        place = np.floor(points.A * (_GRID / columns.level.h))
        order = np.lexsort((points.A, points.index, points.velocity))
        points, place = points.take(order), place[order]
        fresh = np.append(True, ~_together(points) | (np.diff(place) != 0))
        self.points[boundary] = points.take(np.flatnonzero(fresh))

    def expected(self, columns: Columns) -> tuple[np.ndarray, np.ndarray]:
        """Columns and amplitudes (k,), m, at which ``columns`` cross what is known of the curves, by Newton from between the two
        points nearest on each."""
        E = columns.D - columns.level.h
        states, amplitudes = [], []
        for boundary, known in self.points.items():
            state, start = _between(known, columns.V, E)
            if not state.size:
                continue
            points, found = plane.locate(columns, boundary, start, "A")
            found &= (points.A > 0) & (2 * points.A < columns.level.h)
            points, state = points.take(np.flatnonzero(found)), state[found]
            self.remember(columns, boundary, points)
            states.append(state)
            amplitudes.append(points.A)
        if not states:
            return np.empty(0, int), np.empty(0)
        return np.concatenate(states), np.concatenate(amplitudes)


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
    blend = lambda x: x[..., lower] + share * (x[..., upper] - x[..., lower])  # noqa: E731
    A = np.maximum(blend(known.A), 0.5 * known.A[lower])
    return state, Points(velocity[state], A, E[state], blend(known.edges), known.pressure[lower], known.index[lower])


def _together(points: Points) -> np.ndarray:
    """Which points stand on the same curve as the next one."""
    return (np.diff(points.velocity) == 0) & (np.diff(points.index) == 0)
