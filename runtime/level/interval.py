"""Intervals of penetration on which curves are interpolated or looked at, and a level's means in them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..numerics.endpoints import GENTLE, STEEP, EndpointMap
from .accuracy import Accuracy
from .error_budget import ErrorBudget
from .means import level_means
from .strips import LevelBatch

#: share of the error allowed that each mean may have
MEAN = 0.4


@dataclass(frozen=True)
class Interval:
    """An interval of D of one column; ``inner_low``, ``inner_high``: the curve goes on smoothly beyond that end. ``asked``: how
    accurate it has to be beside what is asked of the column."""

    column: int
    low: float
    high: float
    inner_low: bool = False
    inner_high: bool = False
    asked: Accuracy = Accuracy()

    @property
    def width(self) -> float:
        return self.high - self.low

    def split(self, D: float, soft: bool) -> list[Interval]:
        """The two parts below and above D."""
        return [replace(self, high=D, inner_high=soft), replace(self, low=D, inner_low=soft)]

    @property
    def halves(self) -> list[Interval]:
        """Halves by parameter, so that the one next to an end that is like a root is the smaller by far; the curve goes on
        smoothly between them."""
        return self.split(float(self.penetrations(0.5)), soft=True)

    @property
    def endpoint_map(self) -> EndpointMap:
        """Of its nodes."""
        return EndpointMap(*(GENTLE if inner else STEEP for inner in (self.inner_low, self.inner_high)))

    def penetrations(self, t):
        """D at the parameters ``t`` of a piece."""
        return self.low + self.width * self.endpoint_map.share(t)


def places(intervals: Sequence[Interval], t: np.ndarray) -> np.ndarray:
    """Penetrations at the parameters ``t`` (nodes,) of each of the ``intervals``, (intervals, nodes)."""
    return np.array([i.penetrations(t) for i in intervals])


def array_of(intervals: Sequence[Interval]) -> np.ndarray:
    """The intervals as an array of objects."""
    return np.array([*intervals, None], object)[:-1]


def columns_of(intervals: Sequence[Interval]) -> np.ndarray:
    """The column of each, (intervals,)."""
    return np.array([i.column for i in intervals], int)


def within(columns: LevelBatch, intervals: Sequence[Interval], D: np.ndarray) -> LevelBatch:
    """The columns of the ``intervals`` (m,) at the penetrations ``D`` (m,), as accurate as is asked of these."""
    columns = columns.at(columns_of(intervals), D)
    return replace(columns, asked=columns.asked.within([i.asked for i in intervals], np.arange(len(intervals))))


def means_in(columns: LevelBatch, rtol: np.ndarray, intervals: Sequence[Interval], D: np.ndarray, strips: np.ndarray) -> tuple:
    """Means (m, q), their errors (m, q) and the zones met (m,) at penetrations ``D`` (m,) in the ``intervals`` (m,), to the
    ``rtol`` of each column and what is asked of each interval; ``strips`` (per column) counts the work."""
    column = columns_of(intervals)
    means = level_means(within(columns, intervals, D), MEAN * rtol[column] * [i.asked.coarser * i.asked.means for i in intervals])
    np.add.at(strips, column, means.strips)
    return means.values, means.errors, np.array([*means.zones, None], object)[:-1]


def weighed(
    columns: LevelBatch,
    budget: ErrorBudget,
    intervals: Sequence[Interval],
    values: Sequence[np.ndarray],
    ceiling: Callable[[Interval], float] | None,
) -> np.ndarray:
    """The intervals as coarse as the ``budget`` allows where pressures, those above the ``ceiling`` (Pa) apart, and
    frictions are as in ``values`` (nodes, q) of each."""
    out, frictions = [], columns.frictions
    # what an accuracy is relative to, of its own friction and all that it carries
    floors = replace(columns, asked=replace(columns.asked, friction=0.0)).floors[:, frictions]
    for i, v in zip(intervals, values, strict=True):
        size = np.abs(v[:, frictions]) + floors[i.column]
        friction = size.min(axis=0).sum()
        low, high = v[:, 0].min(), v[:, 0].max() if ceiling is None else min(v[:, 0].max(), ceiling(i))
        asked = i.asked.relaxed(budget.tolerance_factor(i.column, low, high, friction), budget.fractions(i.column, low, high))
        # means err relative to themselves: where the interval may be coarser, nowhere by more than it may where they are least
        means = max(friction / (MEAN * size.sum(axis=1).max()), 1 / asked.coarser)
        out.append(replace(i, asked=replace(asked, means=min(asked.means, means))))
    return array_of(out)
