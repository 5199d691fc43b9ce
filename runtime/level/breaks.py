"""Penetrations at which a level's means over penetration are not smooth.

The crest strip (y = 0) has everywhere the highest profile: the means lose smoothness at the penetrations where it changes regime,
and where the flat edge does. Unloading with adhesion it need not be the last to let go: what is pressed in less is drawn out of
reach later.
"""

import numpy as np

from ..numerics.rounding import EPS
from .changes import Changes, locate_changes
from .regime_map import OPENS, by_equation, hides_another, straight
from .strips import LevelBatch

_SCAN = 32


def first_contact(columns: LevelBatch) -> float:
    """A penetration at and below which every strip of the level is free."""
    a = columns.adhesion
    reach = a.delta_0 if a.p_0 > 0 else 0.0
    if columns.branch == "loading":
        return -reach
    # w is never above -p_0/K where it adheres, and after a step it recovers by J_0 p_0 <= p_0/K at most
    return -(2 * a.p_0 / columns.material.K + reach) * (1 + 1e-9)


def threshold_width(columns: LevelBatch, top):
    """Distance in D from a threshold below which rounding may decide it the other way."""
    a = columns.adhesion
    return 64 * EPS * (columns.level.h + np.abs(top) + 2 * a.p_0 / columns.material.K + a.delta_0)


def clinging_ends(columns: LevelBatch) -> np.ndarray:
    """Penetrations (n,) down to which strips cling by adhesion all along when unloading; NaN: they don't."""
    return columns.level.h + straight(columns)[1][OPENS]


def between_breaks(columns: LevelBatch, column: np.ndarray, D: np.ndarray) -> tuple[np.ndarray, ...]:
    """Intervals between the penetrations at which a curve may not be smooth, from the first to the last of the penetrations ``D``
    (m, points) of each ``column`` (m,), by the changes these show.

    Returns their rows, lower and upper ends, ascending, (k,); and the lowest penetration at which the crest of each row changes
    regime (inf: none), (m,)."""
    h, m = columns.level.h, column.size

    def probe(line, x):
        return columns.at(column[line], x).evaluate(np.arange(x.size), np.zeros(x.size))

    def equation(changes):
        E = np.stack((changes.low, changes.high), axis=1) - h
        parent, place = by_equation(columns.at(column[changes.line], changes.low), changes, np.full(E.shape, 0.5 * h), E, "E")
        return parent, place + h, hides_another(*changes.codes[parent].T)

    answers = [v.reshape(*D.shape, *v.shape[1:]) for v in probe(np.repeat(np.arange(m), D.shape[1]), D.ravel())]
    changes, *_ = Changes.between(np.arange(m), D, answers)
    width = 16 * EPS * np.maximum(np.maximum(np.abs(changes.low), np.abs(changes.high)), max(h, columns.stretch))
    changes, _ = locate_changes(probe, equation, changes, width)
    touched = np.full(m, np.inf)
    np.minimum.at(touched, changes.line, changes.high)
    # the flat strip of the valley has no amplitude
    valley = h + straight(columns)[1].T[column]
    row, which = np.nonzero((D[:, :1] < valley) & (valley < D[:, -1:]))
    row = np.concatenate((changes.line, row, np.repeat(np.arange(m), 2)))
    ends = np.concatenate((changes.high, valley[row[changes.size : -2 * m], which], D[:, [0, -1]].ravel()))
    order = np.lexsort((ends, row))
    row, ends = row[order], ends[order]
    apart = np.flatnonzero((np.diff(row) == 0) & (np.diff(ends) > 1e-12 * h))
    return row[apart], ends[apart], ends[apart + 1], touched


def scan(columns: LevelBatch, top: np.ndarray) -> np.ndarray:
    """Penetrations at which to look, (n, m): dense where regimes follow one another, geometric above, for saturation may be far
    up."""
    a = columns.adhesion
    bottom = first_contact(columns)
    reach = 2 * columns.level.h + a.delta_0 + 2 * a.p_0 / columns.material.K
    near = bottom + np.minimum(reach, top - bottom)[:, None] * np.linspace(0, 1, _SCAN)
    ratio = np.maximum((top - bottom) / np.maximum(near[:, -1] - bottom, 1e-300), 1.0)
    far = bottom + (near[:, -1] - bottom)[:, None] * ratio[:, None] ** np.linspace(0, 1, _SCAN // 4 + 1)
    return np.concatenate((near, far[:, 1:]), axis=1)
