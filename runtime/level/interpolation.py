"""A level's means interpolated over penetration, on nested nodes; what does not converge is halved, or split at new regimes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..numerics.chebyshev import flat_ended, interpolation_errors, lobatto
from ..numerics.quadrature import Stage, interior_nodes, sampled
from ..numerics.rounding import EPS
from ..orbit.batch import Ranges
from .averages import level_means
from .branches import Errors, Piece, share_of
from .breaks import Islands, islands, locate_vanishing
from .error_budget import ErrorBudget
from .look import BENDS, unloading_meets
from .strips import CURVE_LIMIT, NO_CURVE, LevelBatch

#: share of the error allowed that each mean may have
MEAN = 0.4
#: pressures in an interval are known at least this well, of their range, unless all in it may err by more
_COARSEST = 1e-3
#: nodes of an interval, and one more: those that tell what pressures it comes to, the first, and the last before it is divided;
#: accuracy of a look at a rough one
_LOOK, _FIRST, _LAST, _ROUGH = 6, 12, 96, 5e-3
#: coefficients below this share of what the means may err say nothing of how smooth they are
_BLUR = 0.1
#: a piece narrower than this, relative to D, is taken as it is; breaks in an interval are this far apart, relative to it
_NARROWEST, _APART = 1e-11, 1e-9
#: error of a piece by what rounding may make of each of its coefficients, and the share of the largest error of a mean that an
#: interpolant has far from it: means mostly err by a tenth of their bounds
_ROUNDED, _SPREAD = 8.0, 0.05


@dataclass
class Intervals(Ranges):
    """Intervals of D of columns; ``inner_low``, ``inner_high``: the curve goes on smoothly beyond that end; all (m,).

    Quantities in them may err by ``rtol`` (m,) times the least that they are in an interval, and ``atol`` (m, q). Pressures above
    the ``ceiling`` (m,), Pa, count for nothing. ``rough``: unloading may come to some of it, or to nothing; a look tells.
    """

    column: np.ndarray
    inner_low: np.ndarray
    inner_high: np.ndarray
    rtol: np.ndarray
    atol: np.ndarray
    ceiling: np.ndarray
    rough: np.ndarray

    @classmethod
    def of(cls, column, low, high, rtol, atol) -> Intervals:
        """Intervals between breaks of the columns ``column`` (m,), as accurate as these, ``rtol`` (n,) and ``atol`` (n, q)."""
        inner_low, inner_high, rough = np.zeros((3, column.size), bool)
        return cls(low, high, column, inner_low, inner_high, rtol[column], atol[column], np.full(column.size, np.inf), rough)

    def split(self, D: np.ndarray, smooth: bool) -> tuple[Intervals, Intervals]:
        """The parts below and above D of each; the curve goes on smoothly there, or not."""
        inner = np.full(self.size, smooth)
        return replace(self, high=D, inner_high=inner), replace(self, low=D, inner_low=inner)

    def at(self, t: np.ndarray) -> np.ndarray:
        """Penetrations at the parameters ``t`` (nodes,) of each, (m, nodes)."""
        shares = np.array([share_of(t, low, high) for low in (False, True) for high in (False, True)])
        kind = np.where(self.rough, 3, 2 * self.inner_low + self.inner_high)
        return self.low[:, None] + self.width[:, None] * shares[kind]


def means_in(columns: LevelBatch, intervals: Intervals, D: np.ndarray) -> tuple:
    """Means (m, q), their errors (m, q) and the zones met (m,) at penetrations ``D`` (m,) in the ``intervals`` (m,), to a share
    of what these may err."""
    share = MEAN * np.divide(_ROUGH, intervals.rtol, out=np.ones(D.size), where=intervals.rough)
    means = level_means(columns.at(intervals.column, D), share * intervals.rtol, share[:, None] * intervals.atol)
    np.add.at(columns.spent, intervals.column, means.strips)
    return means.values, means.errors, np.array([*means.zones, None], object)[:-1]


def weighed(columns: LevelBatch, budget: ErrorBudget, intervals: Intervals, values: Sequence[np.ndarray]) -> Intervals:
    """The intervals as coarse as the ``budget`` allows where means are as in ``values`` (nodes, q) of each."""
    atol, floors = intervals.atol.copy(), 1e-3 * columns.scales
    for k, v in enumerate(values):
        rtol, p, least = intervals.rtol[k], v[:, 0], np.abs(v).min(axis=0)
        share, friction = budget.share_between(intervals.column[k], p.min(), min(p.max(), intervals.ceiling[k]))
        # all that is carried may err by as much of itself as all frictions may; where an interval ends is as well known as
        # pressures are relative to themselves, less of it the narrower it is
        size, rise = (least + floors)[columns.frictions].sum(), np.ptp(v[:, columns.frictions], axis=0).sum()
        coarse = rtol * friction / size * min(np.ptp(p) / max(np.abs(p).max(), np.finfo(float).tiny), 1.0)
        allowed = coarse * (least + floors)
        # an error of pressure moves frictions that rise steadily with it by as much of their rise
        even = coarse * size / rise if coarse * size < _COARSEST * rise else _COARSEST
        allowed[0] = max(coarse, even) * np.ptp(p)
        allowed[columns.fractions] += rtol / share
        atol[k] = np.maximum(atol[k], allowed)
    return replace(intervals, atol=atol)


def interpolate(
    columns: LevelBatch, intervals: Intervals, budget: ErrorBudget | None = None, first: int = 0
) -> list[list[Piece]]:
    """Pieces of each column that interpolate the means over the intervals, on at least ``first`` nodes; or, without, of all that
    its branch comes to there. ``budget``: how much the pressures of an interval count."""
    work = _Work(columns, budget, first or _FIRST, [[] for _ in range(columns.size)])
    stages = [Stage(intervals, first or _LOOK)] if intervals.size else []
    while stages:
        stages = work.refine(stages)
    return work.pieces


@dataclass
class _Work:
    """See ``interpolate``. Of its stages the parts are intervals, and known are means, their errors and zones."""

    columns: LevelBatch
    budget: ErrorBudget | None
    first: int
    pieces: list[list[Piece]]

    def refine(self, stages: list[Stage]) -> list[Stage]:
        """Keep what converges under doubling; return what is left, divided where more nodes would not help."""
        going, fresh = [], []
        answers = sampled(stages, Intervals.at, lambda parts, D: means_in(self.columns, parts, D))
        for before, stage in zip(stages, answers, strict=True):
            if stage.n == _LOOK:
                going.append(self._after_first_look(stage))
                continue
            if before.n == _LOOK and self.columns.branch == "unloading":
                stage, parts = self._after_second_look(stage)
                fresh.append(parts)
            left, goal, hopeless = self._converged(stage)
            fresh += self._divided(left.take(hopeless), goal[hopeless])
            going.append(left.take(~hopeless))
        if fresh:
            going.append(Stage(Intervals.joined(fresh), self.first))
        return [stage for stage in going if stage.parts.size]

    def _after_first_look(self, stage: Stage) -> Stage:
        """What a branch may come to, of the first look; by now it is known what pressures an interval comes to, and so how well
        they have to be known."""
        if self.columns.branch == "unloading":
            stage = stage.take(unloading_meets(stage, _with_ends(stage), BENDS[0])[0].any(axis=1))
        known = np.flatnonzero(~stage.parts.rough)
        if self.budget is not None:
            stage.parts[known] = weighed(self.columns, self.budget, stage.parts.take(known), stage.known[0][known])
        return stage

    def _after_second_look(self, stage: Stage) -> tuple[Stage, Intervals]:
        """What unloading may come to, of the second look; and the parts of rough intervals, as coarse as the budget allows."""
        D, values = _with_ends(stage), stage.known[0]
        meets, ceiling = unloading_meets(stage, D, BENDS[1])
        # branches rise
        rises = (np.diff(values[:, :, 0], axis=1) > 0).any(axis=1)
        rest = stage.take(meets.any(axis=1) & rises & ~stage.parts.rough)
        change = np.diff((meets & stage.parts.rough[:, None]).astype(int), axis=1, prepend=0, append=0)
        (row, first), last = np.nonzero(change > 0), np.nonzero(change < 0)[1]
        parts = replace(stage.parts.take(row), low=D[row, first], high=D[row, last], ceiling=ceiling[row], rough=row < 0)
        parts.inner_low |= first > 0
        parts.inner_high |= last < D.shape[1] - 1
        if self.budget is not None:
            near = [values[k, max(i - 1, 0) : max(j, 2)] for k, i, j in zip(row, first, last, strict=True)]
            parts = weighed(self.columns, self.budget, parts, near)
        return rest, parts

    def _converged(self, stage: Stage) -> tuple[Stage, np.ndarray, np.ndarray]:
        """Append what has converged to the pieces; of columns with too many strips all as it is, with the spread of the values as
        error. Returns the rest, its goals (intervals, q), and which of it have to be divided."""
        columns, intervals, (values, errors, _) = self.columns, stage.parts, stage.known
        column, c = intervals.column, flat_ended(stage.n) @ values
        goal = allowed = intervals.rtol[:, None] * np.abs(values).min(axis=1) + intervals.atol
        blur, rounding, spread = _BLUR * errors.max(axis=1), _rounding(columns, stage, c), np.ptp(values, axis=1)
        # where next to nothing changes there is little to miss, whatever nobody marked there
        error = np.minimum(interpolation_errors(c, 0.1 * goal, blur, rounding), 2 * spread)
        # what the means leave of it, at least what they may not have
        goal = np.maximum(goal - errors.max(axis=1), (1 - MEAN) * goal)
        done = (error <= goal).all(axis=1)
        # pressure rises by K times the penetration at most: across what is so narrow it falls, which is no part of a branch
        jump = ~done & (intervals.width <= _NARROWEST * np.maximum(np.abs(intervals.high), columns.level.h))
        done |= jump
        ended = ~done & (columns.spent[column] > CURVE_LIMIT)
        columns.work.limit_reached(columns.V[column[ended]], columns.level.l, NO_CURVE)
        error[ended], done = np.maximum(error, spread)[ended], done | ended
        bounds = errors + (error + _ROUNDED * rounding + _SPREAD * errors.max(axis=1))[:, None]
        for k in np.flatnonzero(done & ~jump):
            low, high, *inner = (v[k].item() for v in (intervals.low, intervals.high, intervals.inner_low, intervals.inner_high))
            self.pieces[column[k]].append(Piece(low, high, c[k], Errors(interior_nodes(stage.n), bounds[k]), *inner))
        missed, before = error / goal, np.full_like(goal, np.inf)
        if stage.n >= _FIRST:
            half = flat_ended(stage.n // 2) @ values[:, 1::2]
            before = np.maximum(interpolation_errors(half, 0.1 * allowed, blur, rounding) / goal, 1.0)
        # coefficients fall geometrically: where missed (missed / before)^2 on twice the nodes is over the goal, halves are better
        hopeless = (missed > before ** (2 / 3)).any(axis=1) | (stage.n >= _LAST)
        return stage.take(~done), goal[~done], hopeless[~done]

    def _divided(self, stage: Stage, goal: np.ndarray) -> list[Intervals]:
        """The intervals divided where something appears or vanishes between two nodes, away from the crest, or in halves."""
        intervals, zones, nodes = stage.parts, stage.known[2], stage.parts.at(interior_nodes(stage.n))
        seen = [(k, each) for k, D in enumerate(nodes) for each in islands(int(intervals.column[k]), D, zones[k], goal[k])]
        found = locate_vanishing(self.columns, Islands.joined([each for _, each in seen])) if seen else np.empty(0)
        crest = self.columns.at(np.repeat(intervals.column, nodes.shape[1]), nodes.ravel())
        parts, kinks = [], crest.kinks(np.zeros(nodes.size), nodes)
        for k in range(intervals.size):
            rest, breaks = intervals.take([k]), [D for (i, _), D in zip(seen, found, strict=True) if i == k] + [kinks[k]]
            apart, before = _APART * rest.width[0], len(parts)
            for D in np.sort(breaks):
                if rest.low[0] + apart < D < rest.high[0] - apart:
                    lower, rest = rest.split(np.full(1, D), smooth=False)
                    parts.append(lower)
            # halves by parameter: next to an end that is like a root far less than half
            halves = rest.split(rest.at(np.array([0.5]))[:, 0], smooth=True)
            parts += [rest] if len(parts) > before else halves
        return parts


def _with_ends(stage: Stage) -> np.ndarray:
    """Penetrations at the nodes and both ends of the intervals of a stage, (m, n + 1)."""
    return np.column_stack((stage.parts.low, stage.parts.at(interior_nodes(stage.n)), stage.parts.high))


def _rounding(columns: LevelBatch, stage: Stage, c: np.ndarray) -> np.ndarray:
    """What rounding of D makes of coefficients ``c``, (intervals, q): seen next to breaks where means are like square roots."""
    n = stage.n
    ends = np.stack(((-1.0) ** np.arange(n + 1) @ c, c.sum(axis=1)), axis=1)
    values, D = np.concatenate((ends[:, :1], stage.known[0], ends[:, 1:]), axis=1), stage.parts.at(lobatto(n))
    apart, digit = np.diff(D), EPS * np.maximum(np.abs(D).max(axis=1), columns.level.h)
    share = np.minimum(np.divide(digit[:, None], apart, out=np.ones_like(apart), where=apart > 0), 1.0)
    steps = np.abs(np.diff(values, axis=1)) * share[:, :, None]
    return (np.abs(flat_ended(n)) @ np.maximum(steps[:, 1:], steps[:, :-1])).max(axis=1)
