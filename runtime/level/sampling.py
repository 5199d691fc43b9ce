"""Means of a level over intervals of penetration, on nested nodes that are doubled."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..numerics.chebyshev import flat_ended, lobatto
from ..numerics.quadrature import interleaved
from .averages import Averages
from .error_budget import ErrorBudget
from .interval import Interval
from .means import level_means
from .strips import LevelBatch
from .zones import Zones

#: share of the error allowed that each mean may have
MEAN = 0.4
#: nodes of an interval at least, less one
FEWEST = 6


def means_in(columns: LevelBatch, intervals: list[Interval], D: list[np.ndarray], rtol, strips) -> list[Averages]:
    """Means at penetrations ``D`` in each of the intervals, to the ``rtol`` (intervals,) of each; ``strips`` (per column) counts
    the work."""
    sizes, column = [d.size for d in D], np.array([i.column for i in intervals], int)
    number = np.repeat(np.arange(len(D)), sizes)
    means = level_means(_within(columns, intervals, number, np.concatenate(D)), np.asarray(rtol)[number])
    np.add.at(strips, column[number], means.strips)
    ends = np.cumsum([0, *sizes])
    return [
        Averages(means.values[low:high], means.errors[low:high], means.strips[low:high], means.zones[low:high])
        for low, high in zip(ends[:-1], ends[1:], strict=True)
    ]


def _within(columns: LevelBatch, intervals: list[Interval], number: np.ndarray, D: np.ndarray) -> LevelBatch:
    """The columns of the intervals ``number`` (m,) at the penetrations ``D`` (m,), as accurate as is asked of these."""
    columns = columns.at(np.array([i.column for i in intervals], int)[number], D)
    return replace(columns, asked=columns.asked.within([i.asked for i in intervals], number))


@dataclass
class Batch:
    """Intervals on the same interior nodes of ``lobatto(n)``: means and errors there, (intervals, nodes, q), and the zones met at
    each; ``missed`` (intervals, q): error over goal of every quantity, on these nodes or on half as many."""

    columns: LevelBatch
    rtol: np.ndarray
    intervals: list[Interval]
    n: int = 0
    values: np.ndarray | None = None
    errors: np.ndarray | None = None
    zones: list[list[Zones]] | None = None
    missed: np.ndarray | float = np.inf

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
        return _within(self.columns, self.intervals, np.arange(len(self.intervals)), self.column).floors

    @property
    def coefficients(self) -> np.ndarray:
        """Of the interpolants through the values, (intervals, nodes, q)."""
        return flat_ended(self.n) @ self.values

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

    def halves(self, k: int) -> list[Interval]:
        """Interval ``k`` in two."""
        return replace(self.intervals[k], asked=self.intervals[k].asked.after(float(self.missed[k].max()))).halves

    def take(self, index: np.ndarray, missed: np.ndarray) -> Batch:
        """The intervals ``index``, which ``missed`` their goals by these factors (k, q)."""
        some, zones = [self.intervals[i] for i in index], [self.zones[i] for i in index]
        return replace(self, intervals=some, values=self.values[index], errors=self.errors[index], zones=zones, missed=missed)


def sample(batches: list[Batch], first: int, strips: np.ndarray) -> None:
    """Go on with every batch to twice its nodes, of which every other one is known, or to the ``first``, all at once."""
    nodes = [lobatto(2 * batch.n)[1:-1:2] if batch.n else lobatto(first)[1:-1] for batch in batches]
    intervals = [i for batch in batches for i in batch.intervals]
    D = [i.penetrations(t) for batch, t in zip(batches, nodes, strict=True) for i in batch.intervals]
    rtol = np.concatenate([batch.accuracy * [i.asked.means for i in batch.intervals] for batch in batches])
    found = iter(means_in(batches[0].columns, intervals, D, MEAN * rtol, strips))
    for batch in batches:
        new = [next(found) for _ in batch.intervals]
        values, errors = (np.array([getattr(means, name) for means in new]) for name in ("values", "errors"))
        zones = [means.zones for means in new]
        if batch.n:
            values, errors = interleaved(values, batch.values), interleaved(errors, batch.errors)
            zones = [_alternating(*pair) for pair in zip(zones, batch.zones, strict=True)]
        batch.n, batch.values, batch.errors, batch.zones = 2 * batch.n or first, values, errors, zones


def _alternating(outer: list[Zones], inner: list[Zones]) -> list[Zones]:
    out = outer + inner
    out[0::2], out[1::2] = outer, inner
    return out
