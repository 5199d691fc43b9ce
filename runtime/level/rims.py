"""Where the curve below the end of the crest falls under all it was before: there the rims of the cells hold on, and unloading jumps to them.

Equal strips tell, to a few digits; what they leave open is taken for coming. Only that has to be interpolated.
"""

from __future__ import annotations

import numpy as np

from .chebyshev import lobatto
from .demand import Demand
from .interval import Interval
from .means import equal_strips
from .strips import Columns

#: strips across the cell, and penetrations over all intervals of a column and in each at least
_STRIPS, _LOOKS, _LEAST = 32, 24, 2
#: how much more than its error and than what it bends between two looks a pressure has to stay above what was before
_DOUBT, _BEND = 2.0, 0.5


def where_rims_hold(columns: Columns, rtol, intervals: list[Interval], least: np.ndarray, strips, demand: Demand | None) -> list[Interval]:
    """The parts of the ``intervals`` (in order of D in every column) that unloading may come to after the pressures ``least`` (Pa, per column), as far as
    they count for the ``demand``."""
    whole = np.zeros(columns.size)
    for i in intervals:
        whole[i.column] += i.high - i.low
    looks = [lobatto(int(np.clip(np.ceil(_LOOKS * (i.high - i.low) / whole[i.column]), _LEAST, _LOOKS))) for i in intervals]
    D = [i.low + (i.high - i.low) * t for i, t in zip(intervals, looks, strict=True)]
    rows = np.repeat([i.column for i in intervals], [t.size for t in looks])
    means = equal_strips(columns.at(rows, np.concatenate(D)), _STRIPS)
    np.add.at(strips, rows, means.strips)
    cuts = np.cumsum([t.size for t in looks])[:-1]
    seen = zip(intervals, D, np.split(means.values[:, :2], cuts), np.split(means.errors[:, 0], cuts), strict=True)
    met, out = least.copy(), []
    for interval, depth, values, error in sorted(seen, key=lambda look: -look[0].high):
        column, p = interval.column, values[:, 0]
        bend = np.zeros(p.size)
        bend[1:-1] = np.abs(p[:-2] - 2 * p[1:-1] + p[2:])
        floor = np.minimum(p[:-1], p[1:]) - _DOUBT * np.maximum(error[:-1], error[1:]) - _BEND * np.maximum(bend[:-1], bend[1:])
        ceiling = np.minimum(np.minimum.accumulate((p + error)[::-1])[::-1][1:], met[column])
        comes = np.flatnonzero(floor < ceiling)
        met[column] = min(met[column], (p + error).min())
        for run in np.split(comes, np.flatnonzero(np.diff(comes) > 1) + 1) if comes.size else ():
            low, high = run[0], run[-1] + 1
            ease = 1.0
            if demand is not None:
                ease = demand.ease(column, floor[run].min(), min(p[low : high + 1].max(), ceiling[run].max()), np.abs(values[low : high + 1, 1]).max())
            if ease * rtol[column] < 1.0:
                soft = interval.soft_low or low > 0, interval.soft_high or high < p.size - 1
                out.append(Interval(column, float(depth[low]), float(depth[high]), *soft))
    return out
