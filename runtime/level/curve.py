"""A level's means as a function of penetration, from the first contact to saturation, one curve per velocity.

Between its breaks (``breaks.py``) a curve is interpolated (``interpolation.py``). All velocities advance together. Unloading
jumps to re-entrant branches: parts of the curve under a pressure below all that came before, as below the fold of the crest,
where strips near the edge of the cell still adhere. Of all below that fold only what two rough looks leave open is interpolated.
"""

from dataclasses import replace

import numpy as np

from ..numerics.rounding import EPS
from .branches import Piece
from .breaks import ONE_BREAK, between_breaks, first_contact, scan
from .error_budget import ErrorBudget
from .interpolation import Intervals, interpolate, means_in
from .regime_map import OPENS, straight
from .strips import LevelBatch

#: how close to where gaps that adhere throughout open the crest lets go with short memory, in heights; penetrations looked at
#: there next to where they open, and shares of the interval between which all others are
_SHORT, _NODES, _APART = 1e-2, 12, (0.1, 0.9)


def trace(
    columns: LevelBatch, rtol: np.ndarray, atol: np.ndarray, top: np.ndarray, budget: ErrorBudget | None = None
) -> tuple[list[list[Piece]], np.ndarray]:
    """Pieces of the curve of every column (its ``D`` is not used) up to penetration ``top`` (saturation, or a cut), to
    ``rtol |value| + atol``; and strips evaluated for each, (n,).

    Intervals between breaks which its branch passes by are left out; below the penetration at which the crest lets go they hold
    only what unloading at a falling pressure comes to. ``budget``: how much the pressures of every column's law count.
    """
    columns = replace(columns)  # what is spent on this curve alone is counted
    intervals, crest = smooth_intervals(columns, rtol, atol, top)
    intervals = without_hidden(columns, intervals, atol[:, 0])
    # parts below that at which the crest lets go may lie under the pressures of all above them
    intervals.rough[:] = (columns.branch == "unloading") & (intervals.high <= crest[intervals.column])
    return interpolate(columns, intervals, budget), columns.spent


def smooth_intervals(columns: LevelBatch, rtol: np.ndarray, atol: np.ndarray, top: np.ndarray) -> tuple[Intervals, np.ndarray]:
    """The intervals between the breaks of the curve of every column, ascending; where its crest lets go, inf if never, (n,)."""
    h = columns.level.h
    column, low, high, crest = between_breaks(columns, np.arange(columns.size), scan(columns, top))
    # down to there strips cling by adhesion all along when unloading
    start = np.where(np.isfinite(crest), np.fmin(crest, h + straight(columns)[1][OPENS]), first_contact(columns))
    intervals = Intervals.of(column, low, high, rtol, atol).take(low >= start[column])
    # at the top a curve is but cut, or saturates; closer to a threshold rounding may decide it the other way
    rounding = 128 * EPS * (h + np.abs(top) + 2 * columns.stretch + columns.adhesion.delta_0)
    intervals.inner_high[:] = intervals.high > (top - rounding)[intervals.column]
    return intervals, crest


def without_hidden(columns: LevelBatch, intervals: Intervals, atol: np.ndarray) -> Intervals:
    """The intervals, but for what loading has met before where gaps that adhere throughout open, if they end little above: with
    short memory all strips let go there at once and the pressure falls. It is known to ``atol``, Pa (n,), for each column.

    Pressure, ``K mean(w)``, rises by ``K`` times the penetration at most: w rises as the profile does, less where more touches.
    So where two breaks all but coincide, as where memory is short and all strips let go at one height of the valley, the curve
    falls, which is no part of a law, or it rises by less than pressure may err. What is that narrow is left out, unless it ends
    where the curve is but cut, and may rise just to the pressure."""
    K, h = columns.material.K, columns.level.h
    # nearer to a threshold than that rounding decides strip by strip
    opens, nearest, known = h + columns.opens, 64 * EPS * (h - columns.opens), atol[intervals.column] / K
    inside = (np.abs(intervals.low - opens) <= nearest + ONE_BREAK * h) & (columns.branch == "loading") & (columns.stretch > 0)
    # where all may err by more than it falls there nothing is looked for
    inside &= np.maximum(intervals.width, intervals.atol[:, 0] / K) < _SHORT * h
    inside &= intervals.width > np.maximum(nearest / _APART[0], known)
    parts, upper = intervals.take(~inside), intervals.take(inside)
    if upper.size:
        beside = np.minimum(np.maximum(known[inside], nearest), _APART[0] * upper.width)
        # the pressure falls like a logarithm of the distance before it rises
        steps = np.column_stack((-beside, np.geomspace(beside, _APART[1] * upper.width, _NODES, axis=1)))
        D, each = opens + steps, upper.take(np.repeat(np.arange(upper.size), steps.shape[1]))
        each.atol[:, 0] = atol[each.column]
        values, errors, _ = means_in(columns, each, D.ravel())
        low, high = (each[:, 0].reshape(D.shape) for each in (values - errors, values + errors))
        # it rises by K times the penetration at most; below zero, as the first strips cling, loading begins where it is least
        rises = K * np.diff(steps[:, 1:], axis=1, append=upper.width[:, None])
        after = np.pad(low[:, 2:], ((0, 0), (0, 1)), constant_values=-np.inf)
        more = high[:, 1:] + rises > low[:, :1]
        more |= (low[:, :1] <= 0) & (after - rises <= high.min(axis=1, keepdims=True))
        first = more.argmax(axis=1)
        upper.low, upper.inner_low = np.where(first > 0, D[np.arange(upper.size), 1 + first], upper.low), first > 0
        parts = Intervals.joined([parts, upper.take(more.any(axis=1))])
    narrow = np.where(parts.inner_high, 0.0, atol[parts.column] / K)
    return parts.take(parts.width > np.maximum(nearest + 64 * EPS * np.abs(parts.high), narrow))
