"""A level's means as a function of penetration, from the first contact to saturation, one curve per velocity.

Between its breaks (``breaks.py``) a curve is interpolated; pieces that do not converge are halved, or split where strips enter a
new regime. All velocities advance together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..numerics.chebyshev import flat_ended, interpolation_errors, lobatto
from ..numerics.rounding import EPS
from .breaks import breakpoints, threshold_width
from .effort import CURVE_LIMIT
from .error_budget import ErrorBudget
from .interior_breaks import island, locate_vanishing
from .interval import Interval
from .piece import Errors, Piece
from .reentrant import reentrant_parts
from .sampling import FEWEST, MEAN, Batch, sample
from .strips import LevelBatch, saturation_depth

#: nodes of an interval at most, less one: what they do not tell is divided
_LAST = 96
#: share of the error allowed that interpolating may have at least: the means may have the rest
_INTERPOLATION = 1 - MEAN
#: coefficients below this share of what the means may err say nothing of how smooth they are
_BLUR = 0.1
#: an interval's pressure is known at least this well
_COARSEST = 1e-3
#: a piece narrower than this, relative to D, is taken as it is
_NARROWEST = 1e-11
#: parameters at which a piece is looked at
_GRID = np.linspace(0, 1, 65)
#: error of a piece by what rounding may make of each of its coefficients
_ROUNDED = 8.0


@dataclass(frozen=True)
class Curve:
    """Pieces in order of falling D; above ``D_top`` (saturation, or the cut) nothing is stored. ``strips``: strips evaluated."""

    pieces: list[Piece]
    D_top: float
    strips: int


def trace(
    columns: LevelBatch, rtol: np.ndarray, top: np.ndarray | None = None, follow: bool = False, budget: ErrorBudget | None = None
) -> list[Curve]:
    """Curves of every column (its ``D`` is not used) up to penetration ``top`` (saturation if not given), to ``rtol``; of
    ``frictional`` columns pressure only as well as it takes for friction over pressure to be known to that.

    ``follow``: below the penetration at which the crest lets go, only what unloading at a falling pressure comes to. ``budget``:
    what is asked of every column's law; what hardly counts there is made coarser.
    """
    n = columns.size
    top = saturation_depth(columns) if top is None else top
    strips = np.zeros(n, int)
    rows, crest = smooth_intervals(columns, top)
    intervals = [i for row in rows for i in row]
    hangs = lambda i: follow and i.high <= crest[i.column]  # noqa: E731
    below, above = [i for i in intervals if hangs(i)], [i for i in intervals if not hangs(i)]
    pieces = interpolate(columns, rtol, above, strips, budget=budget)
    if below:
        least = np.array([min((piece.values(_GRID)[:, 0].min() for piece in row), default=np.inf) for row in pieces])
        comes = reentrant_parts(columns, below, least, strips)
        for row, more in zip(pieces, interpolate(columns, rtol, comes, strips, budget=budget, ceiling=least), strict=True):
            row += more
    return [Curve(sorted(pieces[i], key=lambda piece: -piece.low), float(top[i]), int(strips[i])) for i in range(n)]


def smooth_intervals(columns: LevelBatch, top: np.ndarray) -> tuple[list[list[Interval]], np.ndarray]:
    """For every column the intervals between the breaks of its curve, ascending; and where the crest lets go (inf: never seen),
    (n,)."""
    inside = threshold_width(columns, top)
    breaks, crest = breakpoints(columns, top)
    # at the top a curve is but cut, or saturates
    rows = [
        [
            Interval(i, low, high, inner_high=high > top[i] - 2 * inside[i])
            for low, high in zip(points[:-1], points[1:], strict=True)
            if high - low > 2 * inside[i]
        ]
        for i, points in enumerate(breaks)
    ]
    return rows, crest


def interpolate(
    columns: LevelBatch,
    rtol: np.ndarray,
    intervals: list[Interval],
    strips: np.ndarray,
    pressure_goal: np.ndarray | None = None,
    budget: ErrorBudget | None = None,
    ceiling: np.ndarray | None = None,
) -> list[list[Piece]]:
    """Pieces that interpolate the means over the intervals, to ``rtol`` of each column; ``strips`` (per column) counts the work.

    ``pressure_goal`` (per column): nothing counts but the pressure, to that error, Pa. ``budget``: how much the pressures of an
    interval count, those above the ``ceiling`` (Pa, per column) not at all.
    """
    pieces: list[list[Piece]] = [[] for _ in range(columns.size)]
    batches = [Batch(columns, rtol, intervals)] if intervals else []
    # a budget has to know what pressures an interval comes to before it says how well they have to be known
    first = 2 * FEWEST if budget is None else FEWEST
    while batches:
        sample(batches, first, strips)
        going, left = [], []
        for batch in batches:
            if batch.n > FEWEST:
                left.append(_converged(batch, pieces, strips, pressure_goal))
                continue
            batch.weigh(budget, ceiling)
            going.append(batch)
        splits, parts = _isolated_regimes(columns, left, strips), []
        for batch, _, hopeless in left:
            keep = []
            for k, interval in enumerate(batch.intervals):
                if interval in splits:
                    parts += interval.split(splits[interval], soft=False)
                elif hopeless[k]:
                    parts += batch.halves(k)
                else:
                    keep.append(k)
            going += [batch.take(keep, batch.missed[keep])] if keep else []
        batches = going + ([Batch(columns, rtol, parts)] if parts else [])
    return pieces


def _converged(batch: Batch, pieces, strips, pressure_goal) -> tuple[Batch, np.ndarray, np.ndarray]:
    """Append what has converged of a batch to ``pieces``; columns with too many ``strips`` as they are, with the spread of their
    values as error. Returns the rest, its goals (intervals, q), and which of them have to be divided."""
    columns, c, floors = batch.columns, batch.coefficients, batch.floors
    goal = batch.accuracy[:, None] * (np.abs(batch.values).min(axis=1) + floors)
    rounding = _rounding(batch, c)
    error = interpolation_errors(c, 0.1 * goal, _BLUR * batch.errors.max(axis=1), rounding)
    # where next to nothing changes there is little to miss, whatever nobody marked there
    spread = np.ptp(batch.values, axis=1)
    error = np.minimum(error, 2 * spread)
    if pressure_goal is not None:
        goal = np.full_like(goal, np.inf)
        goal[:, 0] = pressure_goal[batch.column]
    elif columns.asked.frictional:
        goal[:, 0] = _pressure_goal(batch.values, goal)
    # what the means leave of it
    goal = np.maximum(goal - batch.errors.max(axis=1), _INTERPOLATION * goal)
    done = (error <= goal).all(axis=1)
    done |= [i.high - i.low <= _NARROWEST * max(abs(i.high), columns.level.h) for i in batch.intervals]
    ended = ~done & (strips[batch.column] > CURVE_LIMIT)
    if ended.any():
        V = columns.V[batch.column[ended]]
        columns.work.limit_reached(V, columns.level.l, "the curve over penetration did not converge")
        error[ended], done = np.maximum(error, spread)[ended], done | ended
    for k in np.flatnonzero(done):
        i, size = batch.intervals[k], np.abs(batch.values[k])
        relative = (batch.errors[k] / (size + floors[k])).max(axis=0)
        series, soft = error[k] + _ROUNDED * rounding[k], (i.inner_low, i.inner_high)
        errors = Errors(series + batch.errors[k].max(axis=0), series + relative * floors[k], relative)
        pieces[i.column].append(Piece(i.low, i.high, c[k], errors, *soft, i.endpoint_map))
    missed = error / goal
    # coefficients fall geometrically: where twice the nodes would miss the goal by missed (missed / before)^2, halves are better
    hopeless = (missed > np.maximum(batch.missed, 1.0) ** (2 / 3)).any(axis=1) | (batch.n >= _LAST)
    left = np.flatnonzero(~done)
    return batch.take(left, missed[left]), goal[left], hopeless[left]


def _rounding(batch: Batch, c: np.ndarray) -> np.ndarray:
    """What the rounding of D makes of the coefficients ``c``, (intervals, q): next to a break where the means are like square
    roots it tells."""
    n = batch.n
    ends = np.stack(((-1.0) ** np.arange(n + 1) @ c, c.sum(axis=1)), axis=1)
    values = np.concatenate((ends[:, :1], batch.values, ends[:, 1:]), axis=1)
    D = np.array([i.penetrations(lobatto(n)) for i in batch.intervals])
    digit = EPS * np.maximum(np.abs(D).max(axis=1), batch.columns.level.h)
    apart = np.diff(D)
    share = np.minimum(np.divide(digit[:, None], apart, out=np.ones_like(apart), where=apart > 0), 1.0)
    steps = np.abs(np.diff(values, axis=1)) * share[:, :, None]
    return (np.abs(flat_ended(n)) @ np.maximum(steps[:, 1:], steps[:, :-1])).max(axis=1)


def _pressure_goal(values, goal):
    """Error of pressure that moves friction by no more than is allowed for it, where friction rises steadily with pressure."""
    pressure, friction = np.ptp(values[:, :, 0], axis=1), np.ptp(values[:, :, 1], axis=1)
    share = np.divide(goal[:, 1], friction, out=np.full_like(friction, np.inf), where=friction > 0)
    return np.maximum(goal[:, 0], pressure * np.minimum(share, _COARSEST))


def _isolated_regimes(columns: LevelBatch, left, strips) -> dict[Interval, float]:
    """Breaks inside intervals of ``left`` that have to be divided (batches, their goals, and which have to be): penetrations at
    which something appears or vanishes between two nodes, away from the crest."""
    seen = {}
    for batch, goal, hopeless in left:
        for k in np.flatnonzero(hopeless):
            i = batch.intervals[k]
            found = island(i.column, i.penetrations(lobatto(batch.n)[1:-1]), batch.zones[k], goal[k])
            if found is not None:
                seen[i] = found
    if not seen:
        return {}
    breaks = zip(seen, locate_vanishing(columns, list(seen.values()), strips).tolist(), strict=True)
    return {i: D for i, D in breaks if i.low < D < i.high}
