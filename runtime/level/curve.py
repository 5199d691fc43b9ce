"""A level's means as a function of penetration, from the first contact to saturation, one curve per velocity.

Between its breaks (``breaks.py``) a curve is interpolated (``interpolation.py``). All velocities advance together. Unloading
jumps to re-entrant branches: parts of the curve under a pressure below all that came before, as below the fold of the crest,
where strips near the edge of the cell still adhere. Only what a rough sample of the curve leaves open is interpolated.
"""

from dataclasses import replace

import numpy as np

from ..numerics.quadrature import Stage, interior_nodes, sampled
from ..numerics.rounding import EPS
from .branches import Piece
from .breaks import between_breaks, first_contact, scan
from .error_budget import ErrorBudget
from .interpolation import Intervals, interpolate, means_in, weighed
from .look import BENDS, DOUBT, between_nodes
from .regime_map import OPENS, straight
from .strips import LevelBatch

#: accuracy of the look for re-entrant branches, its first nodes; share of ``h`` below which intervals are tried before, and where
_ROUGH, _NODES, _NARROW, _APART = 5e-3, 4, 0.1, (0.1, 0.9)
#: how close to where gaps that adhere throughout open the crest lets go with short memory, in heights; share of an interval, from
#: its top, at which it is seen whether the pressure goes on falling
_SHORT, _TOP = 1e-2, 5e-3


def trace(
    columns: LevelBatch, rtol: np.ndarray, atol: np.ndarray, top: np.ndarray, budget: ErrorBudget | None = None
) -> tuple[list[list[Piece]], np.ndarray]:
    """Pieces of the curve of every column (its ``D`` is not used) up to penetration ``top`` (saturation, or a cut), to
    ``rtol |value| + atol``; and strips evaluated for each, (n,).

    Below the penetration at which the crest lets go, and where it falls between breaks that are close, they hold only what
    unloading at a falling pressure comes to. ``budget``: how much the pressures of every column's law count.
    """
    columns = replace(columns)  # what is spent on this curve alone is counted
    intervals, crest = smooth_intervals(columns, rtol, atol, top)
    intervals = without_hidden(columns, intervals, atol[:, 0])
    looked = intervals.high <= crest[intervals.column]
    if columns.branch == "unloading":
        # where strips let go one after another while the pressure rises it falls over penetration, which is no part of a law
        narrow = np.flatnonzero(~looked & (intervals.width < _NARROW * columns.level.h))
        if narrow.size:
            D, each = intervals.take(narrow).evenly(np.array(_APART)), intervals.take(np.repeat(narrow, 2))
            low, high = _rough_means(columns, each, D.ravel())[0][:, 0].reshape(-1, 2).T
            looked[narrow] = low > high
    pieces = interpolate(columns, intervals.take(~looked), budget)
    if looked.any():
        tops, parts = _below_known(columns, intervals.take(looked), pieces)
        rest = interpolate(columns, reentrant_parts(columns, parts, budget))
        pieces = [a + b + c for a, b, c in zip(pieces, interpolate(columns, tops, budget), rest, strict=True)]
    return pieces, columns.spent


def _below_known(columns: LevelBatch, parts: Intervals, pieces: list[list[Piece]]) -> tuple[Intervals, Intervals]:
    """The ``parts`` under the least pressure of the ``pieces`` above each, their ceiling; and first, taken from them, the tops of
    those in which the pressure goes on falling below the break, maybe for less than a look shows."""
    least = [[(piece.low, piece.values(piece.errors.at)[:, 0].min()) for piece in row] for row in pieces]
    above = [[(low, p) for low, p in least[i] if low >= high] for i, high in zip(parts.column, parts.high, strict=True)]
    parts = replace(parts, ceiling=np.array([min((p for _, p in row), default=np.inf) for row in above]))
    which = np.flatnonzero([high in (low for low, _ in row) for row, high in zip(above, parts.high, strict=True)])
    tops = parts.take(which)
    if which.size:
        values, errors, _ = _rough_means(columns, tops, tops.high - _TOP * tops.width)
        falls = (values + DOUBT * errors)[:, 0] < tops.ceiling
        rest, tops = tops.take(falls).split((tops.high - _APART[0] * tops.width)[falls], soft=True)
        parts.high[which[falls]], parts.inner_high[which[falls]] = rest.high, True
    return tops, parts


def smooth_intervals(columns: LevelBatch, rtol: np.ndarray, atol: np.ndarray, top: np.ndarray) -> tuple[Intervals, np.ndarray]:
    """The intervals between the breaks of the curve of every column, ascending; where its crest lets go, inf if never, (n,).

    Pressure, ``K mean(w)``, rises by ``K`` times the penetration at most: w rises as the profile does, less where more touches.
    So where two breaks all but coincide, as where memory is short and all strips let go at one height of the valley, the curve
    falls, which is no part of a law, or it rises by less than pressure may err. What is that narrow is left out.
    """
    K, h = columns.material.K, columns.level.h
    # closer to a threshold rounding may decide it the other way
    inside = 64 * EPS * (h + np.abs(top) + 2 * columns.stretch + columns.adhesion.delta_0)
    column, low, high, crest = between_breaks(columns, np.arange(columns.size), scan(columns, top))
    # down to there strips cling by adhesion all along when unloading
    start = np.where(np.isfinite(crest), np.fmin(crest, h + straight(columns)[1][OPENS]), first_contact(columns))
    wide = high - low > np.maximum(2 * inside, atol[:, 0] / K)[column]
    intervals = Intervals.of(column, low, high, rtol, atol).take(wide & (low >= start[column]))
    # at the top a curve is but cut, or saturates
    intervals.inner_high[:] = intervals.high > (top - 2 * inside)[intervals.column]
    return intervals, crest


def without_hidden(columns: LevelBatch, intervals: Intervals, atol: np.ndarray) -> Intervals:
    """The intervals, but for what loading has met before where gaps that adhere throughout open, if they end little above: with
    short memory all strips let go there at once and the pressure falls. It is known to ``atol``, Pa (n,), for each column."""
    K, h = columns.material.K, columns.level.h
    # nearer to a threshold than that rounding decides strip by strip
    opens, nearest = h + columns.opens, 64 * EPS * (h - columns.opens)
    above, inside = intervals.high - opens, (intervals.low < opens) & (columns.branch == "loading") & (columns.adhesion.p_0 > 0)
    # where all may err by more than it falls there nothing is looked for
    inside &= (np.maximum(above, intervals.atol[:, 0] / K) < _SHORT * h) & (above > 0)
    narrow = inside & (above <= np.maximum(nearest / _APART[0], atol[intervals.column] / K))
    intervals = replace(intervals, high=np.where(narrow, opens, intervals.high), inner_high=intervals.inner_high & ~narrow)
    inside &= ~narrow
    lower, upper = intervals.take(inside).split(np.full(np.count_nonzero(inside), opens), soft=False)
    if upper.size:
        beside = np.minimum(np.maximum(atol[upper.column] / K, nearest), _APART[0] * upper.width)
        # the pressure falls like a logarithm of the distance before it rises
        steps = np.column_stack((-beside, np.geomspace(beside, _APART[1] * upper.width, 3 * _NODES, axis=1)))
        D, each = opens + steps, upper.take(np.repeat(np.arange(upper.size), steps.shape[1]))
        each.atol[:, 0] = atol[each.column]
        values, errors, _ = means_in(columns, each, D.ravel())
        low, high = (each[:, 0].reshape(D.shape) for each in (values - errors, values + errors))
        # it rises by K times the penetration at most; below zero, as the first strips cling, loading begins where it is least
        more = (high[:, 1:] + K * np.diff(steps[:, 1:], axis=1, append=upper.width[:, None]) > low[:, :1]) | (low[:, :1] <= 0)
        inside[inside] = cut = ~more[:, 0]
        upper.low, upper.inner_low = D[np.arange(upper.size), 1 + more.argmax(axis=1)], cut
        lower, upper = lower.take(cut), upper.take(cut & more.any(axis=1))
    parts = Intervals.joined([intervals.take(~inside), lower, upper])
    return parts.take(parts.width > nearest)


def reentrant_parts(columns: LevelBatch, intervals: Intervals, budget: ErrorBudget | None) -> Intervals:
    """The parts of the ``intervals`` that unloading may come to after the least pressure before each, its ceiling, as coarse as
    the ``budget`` allows."""

    def looked(stage: Stage) -> Stage:
        return sampled([stage], Intervals.evenly, lambda parts, D: _rough_means(columns, parts, D))[0]

    stage = looked(Stage(intervals, _NODES))
    doubtful = np.isin(np.arange(intervals.size), [k for _, k, *_ in _parts([stage], BENDS[0])])
    stages = [stage.take(~doubtful)] + ([looked(stage.take(doubtful))] if doubtful.any() else [])
    found = _parts(stages, BENDS[1])
    parts = [replace(stages[s].parts.take([k]), **{name: np.array([v]) for name, v in ends.items()}) for s, k, ends, _ in found]
    out = Intervals.joined(parts) if parts else intervals.take([])
    return out if budget is None else weighed(columns, budget, out, [values for *_, values in found])


def _rough_means(columns: LevelBatch, intervals: Intervals, D: np.ndarray) -> tuple:
    """``means_in`` the intervals, as rough as a look may be."""
    rough = _ROUGH / intervals.rtol
    return means_in(columns, replace(intervals, rtol=rough * intervals.rtol, atol=rough[:, None] * intervals.atol), D)


def _parts(stages: list[Stage], bends: float) -> list[tuple[int, int, dict, np.ndarray]]:
    """Parts of intervals that unloading may come to: stage, number of the interval in it, new ends, means there (nodes, q)."""
    met: dict[int, float] = {}
    out, looks = [], []
    for s, stage in enumerate(stages):
        D = np.column_stack((stage.parts.low, stage.parts.evenly(interior_nodes(stage.n)), stage.parts.high))
        p, slack = between_nodes(stage, D, bends)
        looks += [(s, k, D[k], p[k], slack[k], *(v[k] for v in stage.known[:2])) for k in range(stage.parts.size)]
    for s, k, D, p, slack, values, errors in sorted(looks, key=lambda look: -look[2][-1]):
        look, known, error = stages[s].parts, values[:, 0], errors[:, 0]
        least = min(met.get(look.column[k], np.inf), look.ceiling[k])
        floor = np.minimum(p[:-1], p[1:]) - slack
        # the least that was before, above the upper end of each part
        before = np.minimum.accumulate((known + error)[::-1])[::-1]
        above = np.minimum(np.concatenate((before, [np.inf])), least)
        comes = np.flatnonzero(floor < above)
        for run in np.split(comes, np.flatnonzero(np.diff(comes) > 1) + 1) if comes.size else ():
            first, last = run[0], run[-1] + 1
            if last == p.size - 1 and (p - DOUBT * np.pad(error, 1, "edge"))[first:last].min() > least:
                # the curve goes on from what was met, and rises
                continue
            ends = {"low": D[first], "inner_low": True} if first > 0 else {}
            ends |= {"high": D[last], "inner_high": True} if last < p.size - 1 else {}
            out.append((s, k, ends, values[max(first - 1, 0) : max(last, 2)]))
        met[look.column[k]] = min(least, (known + error).min())
    return out
