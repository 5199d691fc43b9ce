"""Means of a level over intervals of penetration, on nested nodes that are doubled together."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..numerics.chebyshev import flat_ended, lobatto
from ..numerics.quadrature import interleaved
from .error_budget import ErrorBudget
from .interval import Interval
from .means import level_means
from .strips import LevelBatch

#: share of the error allowed that each mean may have
MEAN = 0.4


class Batch:
    """Intervals that are sampled together on nested nodes: means and errors (intervals, nodes, q), and the zones met at each."""

    def __init__(self, columns: LevelBatch, rtol, intervals: list[Interval], strips):
        self.columns, self.rtol, self.strips = columns, rtol, strips
        self.intervals = intervals
        self.values = self.errors = None
        self.zones: list[list] = [[] for _ in intervals]

    @property
    def column(self) -> np.ndarray:
        return np.array([i.column for i in self.intervals], int)

    @property
    def accuracy(self) -> np.ndarray:
        """What is asked of each interval."""
        return self.rtol[self.column] * [i.asked.coarser for i in self.intervals]

    @property
    def floors(self) -> np.ndarray:
        """``LevelBatch.floors`` of the columns of the intervals, (intervals, q)."""
        return self._at(np.arange(len(self.intervals)), self.column).floors

    def _at(self, interval: np.ndarray, D: np.ndarray) -> LevelBatch:
        columns = self.columns.at(self.column[interval], D)
        return replace(columns, asked=columns.asked.within([i.asked for i in self.intervals], interval))

    @property
    def coefficients(self) -> np.ndarray:
        """Of the interpolants through the values, (intervals, nodes, q)."""
        return flat_ended(self.values.shape[1] + 1) @ self.values

    def weigh(self, budget: ErrorBudget, ceiling: np.ndarray | None) -> None:
        """Let intervals be as coarse as what is asked of their pressures allows."""
        p, frictions = self.values[:, :, 0], self.columns.frictions
        floors = replace(self.columns, asked=replace(self.columns.asked, friction=0.0)).floors[self.column]
        # what an accuracy is relative to, of its own friction and all that it carries
        friction = (np.abs(self.values[:, :, frictions]).min(axis=1) + floors[:, frictions]).sum(axis=1)
        high = p.max(axis=1) if ceiling is None else np.minimum(p.max(axis=1), ceiling[self.column])
        ranges = zip(self.intervals, p.min(axis=1), high, friction, strict=True)
        self.intervals = [
            replace(i, asked=i.asked.relaxed(budget.tolerance_factor(i.column, *of), budget.fractions(i.column, *of[:2])))
            for i, *of in ranges
        ]

    def sample(self, n: int) -> None:
        """Go on to the interior nodes of ``lobatto(n)``, of which every other one is known, unless they are the first."""
        first = self.values is None
        nodes = lobatto(n)[1:-1]
        t = nodes if first else nodes[::2]
        D = np.concatenate([i.penetrations(t) for i in self.intervals])
        rows, number = np.repeat(self.column, t.size), np.repeat(np.arange(len(self.intervals)), t.size)
        means = level_means(
            self._at(number, D), MEAN * np.repeat(self.accuracy * [i.asked.means for i in self.intervals], t.size)
        )
        np.add.at(self.strips, rows, means.strips)
        shape = (len(self.intervals), t.size, -1)
        values, errors = means.values.reshape(shape), means.errors.reshape(shape)
        zones = [means.zones[i : i + t.size] for i in range(0, rows.size, t.size)]
        if first:
            self.values, self.errors, self.zones = values, errors, zones
            return
        self.values, self.errors = interleaved(values, self.values), interleaved(errors, self.errors)
        self.zones = [_alternating(old, new) for old, new in zip(self.zones, zones, strict=True)]

    def halves(self, k: int, missed: np.ndarray) -> list[Interval]:
        """Interval ``k``, which ``missed`` what is asked of its quantities by these factors (q,), in two."""
        interval = self.without_regularity(k)
        return replace(interval, asked=interval.asked.after(float(missed.max()))).halves

    def without_regularity(self, k: int) -> Interval:
        """Interval ``k``; as its nodes are not enough, what only seemed to end gently is no longer taken to."""
        return replace(self.intervals[k], smooth_low=False, smooth_high=False)

    def keep(self, index) -> None:
        """Go on with the intervals ``index`` alone."""
        self.intervals, self.zones = [self.intervals[i] for i in index], [self.zones[i] for i in index]
        self.values, self.errors = self.values[index], self.errors[index]


def _alternating(old, fresh):
    out = old + fresh
    out[0::2], out[1::2] = fresh, old
    return out
