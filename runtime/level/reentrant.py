"""Re-entrant branches: parts of the curve under a pressure below all that came before, so that unloading jumps to them, as below
the fold of the crest, where the rims of the cells still hold. Where breaks are close most of a curve is none.

A rough sample of the curve tells where they are to a few digits; what it leaves open is kept, and only what is kept is
interpolated.
"""

from dataclasses import replace

import numpy as np

from ..numerics.nested import Stage, sampled
from ..numerics.quadrature import interior_nodes
from .error_budget import ErrorBudget
from .interval import Intervals, means_in, weighed
from .strips import LevelBatch

#: accuracy of the look, and its nodes at first; intervals narrower than this share of ``h`` are looked at in two places before
_ROUGH, _NODES, _NARROW, _APART = 5e-3, 6, 0.1, (0.1, 0.9)
#: how much more than its error a pressure keeps above what was before, and than what it bends between two nodes, which are the
#: first ones or twice as many: a parabola keeps within an eighth of that from its chord
_DOUBT, _BENDS = 2.0, (1.0, 0.25)


def falling(columns: LevelBatch, intervals: Intervals, strips: np.ndarray) -> np.ndarray:
    """Which of the ``intervals`` are narrow and have pressure fall over penetration, as far as two places tell: strips let go
    there one after another while the pressure rises, which is no part of a law. ``strips`` counts the work."""
    out = intervals.width < _NARROW * columns.level.h
    if out.any():
        D, each = intervals.take(out).evenly(np.array(_APART)), np.repeat(np.flatnonzero(out), 2)
        low, high = _looked(columns, intervals.take(each), D.ravel(), strips)[0][:, 0].reshape(-1, 2).T
        out[out] = low > high
    return out


def reentrant_parts(columns: LevelBatch, intervals: Intervals, strips: np.ndarray, budget: ErrorBudget | None) -> Intervals:
    """The parts of the ``intervals`` that unloading may come to after the least pressure before each, its ceiling, as coarse as
    the ``budget`` allows; ``strips`` (per column) counts the work."""

    def looked(stage: Stage) -> Stage:
        return sampled([stage], Intervals.evenly, lambda parts, D: _looked(columns, parts, D, strips))[0]

    stage = looked(Stage(intervals, _NODES))
    doubtful = np.isin(np.arange(intervals.size), [k for _, k, *_ in _parts([stage], _BENDS[0])])
    stages = [stage.take(~doubtful)] + ([looked(stage.take(doubtful))] if doubtful.any() else [])
    found = _parts(stages, _BENDS[1])
    parts = [replace(stages[s].parts.take([k]), **{name: np.array([v]) for name, v in ends.items()}) for s, k, ends, _ in found]
    out = Intervals.joined(parts) if parts else intervals.take([])
    return out if budget is None else weighed(columns, budget, out, [values for *_, values in found])


def _looked(columns: LevelBatch, intervals: Intervals, D: np.ndarray, strips: np.ndarray) -> tuple:
    """``means_in`` the intervals, as rough as a look may be."""
    rough = _ROUGH / intervals.rtol
    return means_in(columns, replace(intervals, rtol=rough * intervals.rtol, atol=rough[:, None] * intervals.atol), D, strips)


def _parts(stages: list[Stage], bends: float) -> list[tuple[int, int, dict, np.ndarray]]:
    """Parts of intervals that unloading may come to: the stage and the number of the interval in it, what of it is other, and the
    means there, (nodes, q)."""
    met: dict[int, float] = {}
    out, looks = [], []
    for s, stage in enumerate(stages):
        D = stage.parts.evenly(interior_nodes(stage.n))
        looks += [(s, k, D[k], stage.known[0][k], stage.known[1][k, :, 0]) for k in range(stage.parts.size)]
    for s, k, D, values, error in sorted(looks, key=lambda look: -look[2][-1]):
        look, p = stages[s].parts, values[:, 0]
        least = min(met.get(look.column[k], np.inf), look.ceiling[k])
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
            ends = {"low": D[first], "inner_low": True} if first > 0 else {}
            ends |= {"high": D[last], "inner_high": True} if last < p.size - 1 else {}
            out.append((s, k, ends, values[first : last + 1]))
        met[look.column[k]] = min(least, (p + error).min())
    return out
