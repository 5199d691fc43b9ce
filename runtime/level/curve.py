"""A level's means as a function of penetration, from the first contact to saturation, one curve per velocity.

Between its breaks (``breaks.py``) a curve is interpolated (``interpolation.py``). All velocities advance together.
"""

from dataclasses import dataclass, replace

import numpy as np

from .breaks import between_breaks, clinging_ends, first_contact, scan, threshold_width
from .error_budget import ErrorBudget
from .interpolation import interpolate
from .interval import Intervals
from .piece import Piece
from .reentrant import falling, reentrant_parts
from .strips import LevelBatch


@dataclass(frozen=True)
class Curve:
    """Pieces in order of falling D; above ``D_top`` (saturation, or the cut) nothing is stored. ``strips``: strips evaluated."""

    pieces: list[Piece]
    D_top: float
    strips: int


def trace(
    columns: LevelBatch, rtol: np.ndarray, atol: np.ndarray, top: np.ndarray, budget: ErrorBudget | None = None
) -> list[Curve]:
    """Curves of every column (its ``D`` is not used) up to penetration ``top``, to ``rtol |value| + atol``.

    Below the penetration at which the crest lets go, and where pressure falls between breaks that are close, they hold only what
    unloading at a falling pressure comes to. ``budget``: how much the pressures of every column's law count.
    """
    n = columns.size
    strips = np.zeros(n, int)
    intervals, crest = smooth_intervals(columns, rtol, atol, top)
    looked = intervals.high <= crest[intervals.column]
    if columns.branch == "unloading":
        looked[~looked] = falling(columns, intervals.take(~looked), strips)
    pieces = interpolate(columns, intervals.take(~looked), strips, budget)
    if looked.any():
        least = [[(piece.low, piece.values(piece.errors.at)[:, 0].min()) for piece in row] for row in pieces]
        parts = intervals.take(looked)
        before = [
            min((p for low, p in least[i] if low >= high), default=np.inf)
            for i, high in zip(parts.column, parts.high, strict=True)
        ]
        parts = reentrant_parts(columns, replace(parts, ceiling=np.array(before)), strips, budget)
        for row, more in zip(pieces, interpolate(columns, parts, strips), strict=True):
            row += more
    return [Curve(sorted(pieces[i], key=lambda piece: -piece.low), float(top[i]), int(strips[i])) for i in range(n)]


def smooth_intervals(columns: LevelBatch, rtol: np.ndarray, atol: np.ndarray, top: np.ndarray) -> tuple[Intervals, np.ndarray]:
    """The intervals between the breaks of the curve of every column, ascending; and where its crest lets go (inf: never seen),
    (n,).

    Pressure, ``K mean(w)``, rises by ``K`` times the penetration at most: w rises as the profile does, less where more touches.
    So where two breaks all but coincide, as where memory is short and all strips let go at one height of the valley, the curve
    falls, which is no part of a law, or it rises by less than pressure may err. What is that narrow is left out.
    """
    inside = threshold_width(columns, top)
    column, low, high, crest = between_breaks(columns, np.arange(columns.size), scan(columns, top))
    # down to there strips cling by adhesion all along when unloading
    start = np.where(np.isfinite(crest), np.fmin(crest, clinging_ends(columns)), first_contact(columns))
    wide = high - low > np.maximum(2 * inside, atol[:, 0] / columns.material.K)[column]
    intervals = Intervals.of(column, low, high, rtol, atol).take(wide & (low >= start[column]))
    # at the top a curve is but cut, or saturates
    intervals.inner_high[:] = intervals.high > (top - 2 * inside)[intervals.column]
    return intervals, crest
