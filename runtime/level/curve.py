"""A level's means as a function of penetration, from the first contact to saturation, one curve per velocity.

Between its breaks (``breaks.py``) a curve is interpolated (``interpolation.py``). All velocities advance together.
"""

from dataclasses import dataclass

import numpy as np

from .breaks import breakpoints, threshold_width
from .error_budget import ErrorBudget
from .interpolation import interpolate
from .interval import Interval
from .piece import Piece
from .reentrant import falling, reentrant_parts
from .strips import LevelBatch


@dataclass(frozen=True)
class Curve:
    """Pieces in order of falling D; above ``D_top`` (saturation, or the cut) nothing is stored. ``strips``: strips evaluated."""

    pieces: list[Piece]
    D_top: float
    strips: int


def trace(columns: LevelBatch, rtol: np.ndarray, top: np.ndarray, budget: ErrorBudget | None = None) -> list[Curve]:
    """Curves of every column (its ``D`` is not used) up to penetration ``top``, to ``rtol``; of ``frictional`` columns pressure
    only as well as it takes for friction over pressure to be known to that.

    Below the penetration at which the crest lets go, and where pressure falls between breaks that are close, they hold only what
    unloading at a falling pressure comes to. ``budget``: what is asked of every column's law; what hardly counts there is made
    coarser.
    """
    n = columns.size
    strips = np.zeros(n, int)
    rows, crest = smooth_intervals(columns, rtol, top)
    intervals = [i for row in rows for i in row]
    looked = [i for i in intervals if i.high <= crest[i.column]]
    if columns.branch == "unloading":
        looked += falling(columns, [i for i in intervals if i.high > crest[i.column]], strips)
    others = set(intervals).difference(looked)
    pieces = interpolate(columns, rtol, [i for i in intervals if i in others], strips, budget=budget)
    if looked:
        least = [[(piece.low, piece.values(piece.errors.at)[:, 0].min()) for piece in row] for row in pieces]

        def before(i: Interval) -> float:
            return min((p for low, p in least[i.column] if low >= i.high), default=np.inf)

        parts = reentrant_parts(columns, looked, before, strips, budget)
        for row, more in zip(pieces, interpolate(columns, rtol, parts, strips, budget=budget, ceiling=before), strict=True):
            row += more
    return [Curve(sorted(pieces[i], key=lambda piece: -piece.low), float(top[i]), int(strips[i])) for i in range(n)]


def smooth_intervals(columns: LevelBatch, rtol: np.ndarray, top: np.ndarray) -> tuple[list[list[Interval]], np.ndarray]:
    """For every column the intervals between the breaks of its curve, ascending; and where the crest lets go (inf: never seen),
    (n,).

    Pressure, ``K mean(w)``, rises by ``K`` times the penetration at most: w rises as the profile does, less where more touches.
    So where two breaks all but coincide, as where memory is short and all strips let go at one height of the valley, the curve
    falls, which is no part of a law, or it rises by less than pressure may err. What is that narrow is left out.
    """
    inside = threshold_width(columns, top)
    narrowest = np.maximum(2 * inside, rtol * columns.floors[:, 0] / columns.material.K)
    breaks, crest = breakpoints(columns, top)
    # at the top a curve is but cut, or saturates
    rows = [
        [
            Interval(i, low, high, inner_high=high > top[i] - 2 * inside[i])
            for low, high in zip(points[:-1], points[1:], strict=True)
            if high - low > narrowest[i]
        ]
        for i, points in enumerate(breaks)
    ]
    return rows, crest
