"""Re-entrant branches: parts of the curve under a pressure below all that came before, so that unloading jumps to them, as below
the fold of the crest, where the rims of the cells still hold. Where breaks are close most of a curve is none.

A rough sample of the curve tells where they are to a few digits; what it leaves open is kept, and only what is kept is
interpolated.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ..numerics.nested import Stage, sampled
from ..numerics.quadrature import interior_nodes
from .error_budget import ErrorBudget
from .interval import Interval, array_of, means_in, weighed
from .strips import LevelBatch

#: accuracy of the look, and its nodes at first; intervals narrower than this share of ``h`` have fewer; and two places in these
_ROUGH, _MANY, _FEW, _NARROW, _APART = 5e-3, 6, 4, 0.1, (0.1, 0.9)
#: how much more than its error a pressure keeps above what was before, and than what it bends between two nodes, which are the
#: first ones or twice as many: a parabola keeps within an eighth of that from its chord
_DOUBT, _BENDS = 2.0, (1.0, 0.25)


def falling(columns: LevelBatch, intervals: Sequence[Interval], strips: np.ndarray) -> list[Interval]:
    """Those of the ``intervals`` that are narrow and in which the pressure falls over penetration, as far as two places tell:
    strips let go there one after another while the pressure rises, which is no part of a law. ``strips`` counts the work."""
    narrow = array_of([i for i in intervals if i.width < _NARROW * columns.level.h])
    if not narrow.size:
        return []
    alone, D = replace(columns, carry=None), _evenly(narrow, np.array(_APART))
    low, high = means_in(alone, _rough(columns), narrow.repeat(2), D.ravel(), strips)[0][:, 0].reshape(-1, 2).T
    return [*narrow[low > high]]


def reentrant_parts(
    columns: LevelBatch,
    intervals: list[Interval],
    before: Callable[[Interval], float],
    strips: np.ndarray,
    budget: ErrorBudget | None,
) -> list[Interval]:
    """The parts of the ``intervals`` that unloading may come to after the least pressure ``before`` each, Pa, as coarse as the
    ``budget`` allows; ``strips`` (per column) counts the work."""
    every = array_of(intervals)
    narrow = np.array([i.width < _NARROW * columns.level.h for i in intervals])
    rough = _rough(columns)

    def means(parts, D):
        return means_in(columns, rough, np.concatenate(parts), D, strips)

    stages = sampled([Stage(every[which], n) for n, which in ((_FEW, narrow), (_MANY, ~narrow)) if which.any()], _evenly, means)
    doubtful = {look for look, *_ in _parts(stages, before, _BENDS[0])}
    apart = [(stage, np.array([i in doubtful for i in stage.parts])) for stage in stages]
    stages, again = [stage.take(~which) for stage, which in apart], [stage.take(which) for stage, which in apart if which.any()]
    found = _parts([*stages, *(sampled(again, _evenly, means) if again else [])], before, _BENDS[1])
    parts = [part for _, part, _ in found]
    return parts if budget is None else weighed(columns, budget, parts, [values for *_, values in found], before)


def _rough(columns: LevelBatch) -> np.ndarray:
    return np.full(columns.size, _ROUGH)


def _parts(stages: list[Stage], before: Callable[[Interval], float], bends: float) -> list[tuple[Interval, Interval, np.ndarray]]:
    """Intervals that were looked at, their parts that unloading may come to, and the means there, (nodes, q)."""
    met: dict[int, float] = {}
    out, looks = [], []
    for stage in stages:
        values, errors, _ = stage.known
        looks += zip(stage.parts, _evenly(stage.parts, interior_nodes(stage.n)), values, errors[:, :, 0], strict=True)
    for look, D, values, error in sorted(looks, key=lambda look: -look[0].high):
        column, p = look.column, values[:, 0]
        least = min(met.get(column, np.inf), before(look))
        bend = np.pad(np.abs(p[:-2] - 2 * p[1:-1] + p[2:]), 1)
        slack = _DOUBT * np.maximum(error[:-1], error[1:]) + bends * np.maximum(bend[:-1], bend[1:])
        floor = np.minimum(p[:-1], p[1:]) - slack
        # the least that was before, above the upper end of each part
        above = np.minimum(np.minimum.accumulate((p + error)[:0:-1])[::-1], least)
        comes = np.flatnonzero(floor < above)
        for run in np.split(comes, np.flatnonzero(np.diff(comes) > 1) + 1) if comes.size else ():
            first, last = run[0], run[-1] + 1
            if last == p.size - 1 and (p - _DOUBT * error)[first:last].min() > least:
                # the curve goes on from what was met, and rises
                continue
            soft = look.inner_low or first > 0, look.inner_high or last < p.size - 1
            low, high = D[first] if first > 0 else look.low, D[last] if last < p.size - 1 else look.high
            part = replace(look, low=float(low), high=float(high), inner_low=soft[0], inner_high=soft[1])
            out.append((look, part, values[first : last + 1]))
        met[column] = min(least, (p + error).min())
    return out


def _evenly(intervals: Sequence[Interval], t: np.ndarray) -> np.ndarray:
    """Penetrations (intervals, nodes) at the shares ``t`` (nodes,) of each: a look need not be graded towards ends."""
    return np.array([i.low + i.width * t for i in intervals]).reshape(-1, t.size)
