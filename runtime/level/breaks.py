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


def breakpoints(columns: LevelBatch, top: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
    """Penetrations between first contact and ``top`` (n,) where the curve may not be smooth, ascending, ends included, of every
    column; and the lowest at which its crest changes regime (inf: none), (n,)."""
    inside, touched = breaks_on(columns, np.arange(columns.size), _scan(columns, top))
    # down to there strips cling by adhesion all along when unloading
    last = columns.level.h + straight(columns)[1][OPENS]
    out = []
    for r, points in enumerate(inside):
        start = np.fmin(touched[r], last[r]) if np.isfinite(touched[r]) else first_contact(columns)
        points = np.unique([*points, top[r]])
        out.append(points[(points >= start) & (points <= top[r])])
    return out, touched


def breaks_on(columns: LevelBatch, column: np.ndarray, D: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
    """Breaks between the first and the last of the penetrations ``D`` (m, points) of each ``column`` (m,), by the changes they
    show.

    Returns them, ascending, for every row, and the lowest that is one of the crest (inf: none), (m,).
    """
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
    # the flat strip of the valley has no amplitude
    valley = h + straight(columns)[1].T[column]
    out, touched = [], np.full(m, np.inf)
    for r in range(m):
        own = changes.high[changes.line == r]
        touched[r] = own.min(initial=np.inf)
        points = np.unique([*own, *valley[r][(D[r, 0] < valley[r]) & (valley[r] < D[r, -1])]])
        out.append(points[np.concatenate(([True], np.diff(points) > 1e-12 * h))] if points.size else points)
    return out, touched


def _scan(columns: LevelBatch, top):
    """Penetrations at which to look, (n, m): dense where regimes follow one another, geometric above, for saturation may be far
    up."""
    a = columns.adhesion
    bottom = first_contact(columns)
    reach = 2 * columns.level.h + a.delta_0 + 2 * a.p_0 / columns.material.K
    near = bottom + np.minimum(reach, top - bottom)[:, None] * np.linspace(0, 1, _SCAN)
    ratio = np.maximum((top - bottom) / np.maximum(near[:, -1] - bottom, 1e-300), 1.0)
    far = bottom + (near[:, -1] - bottom)[:, None] * ratio[:, None] ** np.linspace(0, 1, _SCAN // 4 + 1)
    return np.concatenate((near, far[:, 1:]), axis=1)
