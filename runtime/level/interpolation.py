"""Interpolation of a level's means over intervals of penetration, on nested nodes; what does not converge is halved, or split
where strips enter a new regime."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..numerics.chebyshev import flat_ended, interpolation_errors, lobatto
from ..numerics.nested import Stage, sampled
from ..numerics.quadrature import interior_nodes
from ..numerics.rounding import EPS
from .effort import CURVE_LIMIT, NO_CURVE
from .error_budget import ErrorBudget
from .interior_breaks import islands, locate_vanishing
from .interval import MEAN, Interval, array_of, columns_of, means_in, places, weighed, within
from .piece import Errors, Piece
from .strips import LevelBatch

#: nodes of an interval, and one more: those that tell what pressures it comes to; the first that an error can be told from, and
#: for more than a coarse pressure; and the last, for what they do not tell is divided
_LOOK, _COARSE, _FIRST, _LAST = 6, 8, 12, 96
#: coefficients below this share of what the means may err say nothing of how smooth they are
_BLUR = 0.1
#: an interval's pressure is known at least this well
_COARSEST = 1e-3
#: a piece narrower than this, relative to D, is taken as it is; breaks in an interval are this far apart, relative to it; and the
#: share of what its pressure may err by which it may rise in what is left out
_NARROWEST, _APART, _NOTHING = 1e-11, 1e-9, 0.1
#: error of a piece by what rounding may make of each of its coefficients
_ROUNDED = 8.0


def interpolate(
    columns: LevelBatch,
    rtol: np.ndarray,
    intervals: Sequence[Interval],
    strips: np.ndarray,
    pressure_goal: np.ndarray | None = None,
    budget: ErrorBudget | None = None,
    ceiling: Callable[[Interval], float] | None = None,
) -> list[list[Piece]]:
    """Pieces that interpolate the means over the intervals, to ``rtol`` of each column; ``strips`` (per column) counts the work.

    ``pressure_goal`` (per column): nothing counts but the pressure, to that error, Pa. ``budget``: how much the pressures of an
    interval count, those above the ``ceiling`` (Pa) not at all.
    """
    work = _Work(columns, rtol, strips, pressure_goal, budget, ceiling, [[] for _ in range(columns.size)])
    stages = work.start(intervals)
    while stages:
        stages = work.refine(stages)
    return work.pieces


@dataclass
class _Work:
    """See ``interpolate``. Of its stages the parts are intervals, and known are means, their errors and zones."""

    columns: LevelBatch
    rtol: np.ndarray
    strips: np.ndarray
    pressure_goal: np.ndarray | None
    budget: ErrorBudget | None
    ceiling: Callable[[Interval], float] | None
    pieces: list[list[Piece]]

    def start(self, intervals: Sequence[Interval]) -> list[Stage]:
        """Intervals on their first nodes."""
        # a budget has to know what pressures an interval comes to before it says how well they have to be known
        known = _COARSE if self.pressure_goal is not None else _FIRST
        first = np.array([known if self.budget is None or i.asked.frictional else _LOOK for i in intervals], int)
        return [Stage(array_of(intervals)[first == n], n) for n in np.unique(first).tolist()]

    def refine(self, stages: list[Stage]) -> list[Stage]:
        """Keep what converges under doubling; return what is left, divided where more nodes would not help."""

        def means(intervals, D):
            return means_in(self.columns, self.rtol, np.concatenate(intervals), D, self.strips)

        going, left = [], []
        for stage in sampled(stages, places, means):
            if stage.n > _LOOK:
                left.append(self._converged(stage))
                continue
            going.append(replace(stage, parts=weighed(self.columns, self.budget, stage.parts, stage.known[0], self.ceiling)))
        breaks, parts = self._isolated_regimes(left), []
        for stage, goal, missed, hopeless in left:
            blurred = (stage.known[1].max(axis=1) / goal).max(axis=1)
            for i, by, blur in zip(stage.parts[hopeless], missed[hopeless].max(axis=1), blurred[hopeless], strict=True):
                rest = i
                for D in breaks.get(i, []):
                    lower, rest = rest.split(D, soft=False)
                    parts.append(lower)
                parts += [rest] if i in breaks else replace(i, asked=i.asked.after(float(by), float(blur))).halves
            going.append(stage.take(~hopeless))
        return [stage for stage in (*going, *self.start(parts)) if stage.parts.size]

    def _converged(self, stage: Stage) -> tuple[Stage, np.ndarray, np.ndarray, np.ndarray]:
        """Append what has converged to the pieces; of columns with too many strips all as it is, with the spread of the values as
        error. Returns the rest, its goals (intervals, q), its errors over them, and which of it have to be divided."""
        columns, intervals, (values, errors, _) = self.columns, stage.parts, stage.known
        column, c = columns_of(intervals), flat_ended(stage.n) @ values
        floors = within(columns, intervals, columns.D[column]).floors
        goal = (self.rtol[column] * [i.asked.coarser for i in intervals])[:, None] * (np.abs(values).min(axis=1) + floors)
        blur, rounding, spread = _BLUR * errors.max(axis=1), _rounding(columns, stage, c), np.ptp(values, axis=1)
        # where next to nothing changes there is little to miss, whatever nobody marked there
        noise = 0.1 * goal
        error = np.minimum(interpolation_errors(c, noise, blur, rounding), 2 * spread)
        width, nothing = np.array([i.width for i in intervals]), np.zeros(column.size, bool)
        if self.pressure_goal is not None:
            goal = np.full_like(goal, np.inf)
            goal[:, 0] = self.pressure_goal[column]
        elif columns.asked.frictional:
            # pressure rises by K times the penetration at most (see ``curve``): too little for this to be part of a law
            nothing = columns.material.K * width <= _NOTHING * goal[:, 0]
            goal[:, 0] = _pressure_goal(values, goal)
        # what the means leave of it, at least what they may not have
        goal = np.maximum(goal - errors.max(axis=1), (1 - MEAN) * goal)
        done = (error <= goal).all(axis=1)
        done |= width <= _NARROWEST * np.maximum(np.abs([i.high for i in intervals]), columns.level.h)
        nothing &= ~done
        done |= nothing
        ended = ~done & (self.strips[column] > CURVE_LIMIT)
        if ended.any():
            columns.work.limit_reached(columns.V[column[ended]], columns.level.l, NO_CURVE)
            error[ended], done = np.maximum(error, spread)[ended], done | ended
        for k in np.flatnonzero(done & ~nothing):
            i = intervals[k]
            bounds = Errors(interior_nodes(stage.n), errors[k] + error[k] + _ROUNDED * rounding[k])
            self.pieces[i.column].append(Piece(i.low, i.high, c[k], bounds, i.inner_low, i.inner_high, i.endpoint_map))
        missed, before = error / goal, np.full_like(goal, np.inf)
        if stage.n >= _FIRST:
            half = flat_ended(stage.n // 2) @ values[:, 1::2]
            before = np.maximum(interpolation_errors(half, noise, blur, rounding) / goal, 1.0)
        # coefficients fall geometrically: where missed (missed / before)^2 on twice the nodes is over the goal, halves are better
        hopeless = (missed > before ** (2 / 3)).any(axis=1) | (stage.n >= _LAST)
        return stage.take(~done), *(v[~done] for v in (goal, missed, hopeless))

    def _isolated_regimes(self, left) -> dict[Interval, list[float]]:
        """Breaks inside intervals of ``left`` that have to be divided (see ``_converged``), ascending: penetrations at which
        something appears or vanishes between two nodes, away from the crest."""
        seen = []
        for stage, goal, _, hopeless in left:
            for k in np.flatnonzero(hopeless):
                i = stage.parts[k]
                found = islands(i.column, i.penetrations(interior_nodes(stage.n)), stage.known[2][k], goal[k])
                seen += [(i, island) for island in found]
        breaks: dict[Interval, list[float]] = {}
        if seen:
            at = locate_vanishing(self.columns, [island for _, island in seen], self.strips).tolist()
            for (i, _), D in sorted(zip(seen, at, strict=True), key=lambda each: each[1]):
                apart = _APART * i.width
                if breaks.get(i, [i.low])[-1] + apart < D < i.high - apart:
                    breaks.setdefault(i, []).append(D)
        return breaks


def _rounding(columns: LevelBatch, stage: Stage, c: np.ndarray) -> np.ndarray:
    """What the rounding of D makes of the coefficients ``c``, (intervals, q): next to a break where the means are like square
    roots it tells."""
    n = stage.n
    ends = np.stack(((-1.0) ** np.arange(n + 1) @ c, c.sum(axis=1)), axis=1)
    values, D = np.concatenate((ends[:, :1], stage.known[0], ends[:, 1:]), axis=1), places(stage.parts, lobatto(n))
    apart, digit = np.diff(D), EPS * np.maximum(np.abs(D).max(axis=1), columns.level.h)
    share = np.minimum(np.divide(digit[:, None], apart, out=np.ones_like(apart), where=apart > 0), 1.0)
    steps = np.abs(np.diff(values, axis=1)) * share[:, :, None]
    return (np.abs(flat_ended(n)) @ np.maximum(steps[:, 1:], steps[:, :-1])).max(axis=1)


def _pressure_goal(values, goal):
    """Error of pressure that moves friction by no more than is allowed for it, where friction rises steadily with pressure."""
    pressure, friction = np.ptp(values[:, :, 0], axis=1), np.ptp(values[:, :, 1], axis=1)
    share = np.divide(goal[:, 1], friction, out=np.full_like(friction, np.inf), where=friction > 0)
    return np.maximum(goal[:, 0], pressure * np.minimum(share, _COARSEST))
