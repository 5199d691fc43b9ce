"""Intervals of penetration on which curves are interpolated or looked at, and a level's means in them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..orbit.batch import Batch
from .error_budget import ErrorBudget
from .means import level_means
from .piece import share_of
from .strips import LevelBatch

#: share of the error allowed that each mean may have
MEAN = 0.4
#: pressures in an interval are known at least this well, of their range, unless all in it may err by more
_COARSEST = 1e-3


@dataclass
class Intervals(Batch):
    """Intervals of D of columns; ``inner_low``, ``inner_high``: the curve goes on smoothly beyond that end; all (m,).

    Quantities in them may err by ``rtol`` (m,) times the least that they are in an interval, and ``atol`` (m, q). Pressures above
    the ``ceiling`` (m,), Pa, count for nothing.
    """

    column: np.ndarray
    low: np.ndarray
    high: np.ndarray
    inner_low: np.ndarray
    inner_high: np.ndarray
    rtol: np.ndarray
    atol: np.ndarray
    ceiling: np.ndarray

    @classmethod
    def of(cls, column, low, high, rtol, atol) -> Intervals:
        """Intervals between breaks of the columns ``column`` (m,), as accurate as these, ``rtol`` (n,) and ``atol`` (n, q)."""
        inner = np.zeros((2, column.size), bool)
        return cls(column, low, high, *inner, rtol[column], atol[column], np.full(column.size, np.inf))

    @property
    def width(self) -> np.ndarray:
        return self.high - self.low

    def split(self, D: np.ndarray, soft: bool) -> tuple[Intervals, Intervals]:
        """The parts below and above D of each; the curve goes on smoothly there, or not."""
        smooth = np.full(self.size, soft)
        return replace(self, high=D, inner_high=smooth), replace(self, low=D, inner_low=smooth)

    @property
    def halves(self) -> Intervals:
        """Halves by parameter, so that the one next to an end that is like a root is the smaller by far; the curve goes on
        smoothly between them."""
        return Intervals.joined(self.split(self.at(np.array([0.5]))[:, 0], soft=True))

    def at(self, t: np.ndarray) -> np.ndarray:
        """Penetrations at the parameters ``t`` (nodes,) of each, (m, nodes)."""
        shares = np.array([share_of(t, low, high) for low in (False, True) for high in (False, True)])
        return self.low[:, None] + self.width[:, None] * shares[2 * self.inner_low + self.inner_high]

    def evenly(self, t: np.ndarray) -> np.ndarray:
        """Penetrations at the shares ``t`` (nodes,) of the width of each, (m, nodes)."""
        return self.low[:, None] + self.width[:, None] * t


def means_in(columns: LevelBatch, intervals: Intervals, D: np.ndarray, strips: np.ndarray) -> tuple:
    """Means (m, q), their errors (m, q) and the zones met (m,) at penetrations ``D`` (m,) in the ``intervals`` (m,), to a share
    of what these may err; ``strips`` (per column) counts the work."""
    means = level_means(columns.at(intervals.column, D), MEAN * intervals.rtol, MEAN * intervals.atol)
    np.add.at(strips, intervals.column, means.strips)
    return means.values, means.errors, np.array([*means.zones, None], object)[:-1]


def weighed(columns: LevelBatch, budget: ErrorBudget, intervals: Intervals, values: Sequence[np.ndarray]) -> Intervals:
    """The intervals as coarse as the ``budget`` allows where means are as in ``values`` (nodes, q) of each."""
    atol, floors = intervals.atol.copy(), 1e-3 * columns.scales
    for k, v in enumerate(values):
        rtol, p, least = intervals.rtol[k], v[:, 0], np.abs(v).min(axis=0)
        met, friction = budget.met(intervals.column[k], p.min(), min(p.max(), intervals.ceiling[k]))
        # all that is carried may err by as much of itself as all frictions may; where an interval ends is as well known as
        # pressures are relative to themselves, less of it the narrower it is
        size, rise = (least + floors)[columns.frictions].sum(), np.ptp(v[:, columns.frictions], axis=0).sum()
        coarse = rtol * friction / size * min(np.ptp(p) / max(np.abs(p).max(), np.finfo(float).tiny), 1.0)
        allowed = coarse * (least + floors)
        # an error of pressure moves frictions that rise steadily with it by as much of their rise
        even = coarse * size / rise if coarse * size < _COARSEST * rise else _COARSEST
        allowed[0] = max(coarse, even) * np.ptp(p)
        allowed[columns.fractions] += rtol / met
        atol[k] = np.maximum(atol[k], allowed)
    return replace(intervals, atol=atol)
