"""Penetrations at which a level's means over penetration are not smooth.

The crest strip (y = 0) has everywhere the highest profile: the means lose smoothness at the penetrations where it changes regime,
and where the flat edge does. Unloading with adhesion it need not be the last to let go: what is pressed in less is drawn out of
reach later.
"""

from __future__ import annotations

import numpy as np

from .strips import Columns, saturation_depth
from .transitions import Looks, Probe, locate

_SCAN = 48
#: how far from a penetration that is known to look, as shares of the width of a bracket
_ASIDE = np.array((-0.45, -0.06, 0.06, 0.45))
_EPS = np.finfo(float).eps


def first_contact(columns: Columns) -> float:
    """A penetration at and below which every strip of the level is free."""
    a = columns.adhesion
    reach = a.delta_0 if a.p_0 > 0 else 0.0
    if columns.branch == "loading":
        return -reach
    # w is never above -p_0/K where it adheres, and after a step it recovers by J_0 p_0 <= p_0/K at most
    return -(2 * a.p_0 / columns.material.K + reach) * (1 + 1e-9)


def let_go(columns: Columns) -> float:
    """Penetration down to which strips cling by adhesion all along when unloading, +inf if none ever does.

    A strip at rest at ``w = -p_0/K`` reaches over its valley while ``D_j - 2 A >= -p_0/K - delta_0``; ``D_j - 2 A = D - h`` on
    all of them.
    """
    a = columns.adhesion
    if columns.branch == "loading" or a.p_0 == 0:
        return np.inf
    return columns.level.h - a.p_0 / columns.material.K - a.delta_0


def threshold_width(columns: Columns, top):
    """Distance in D from a threshold below which rounding may decide it the other way."""
    a = columns.adhesion
    return 64 * _EPS * (columns.level.h + np.abs(top) + 2 * a.p_0 / columns.material.K + a.delta_0)


def breakpoints(columns: Columns, top: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
    """Penetrations between first contact and ``top`` (n,) where the curve may not be smooth, ascending, ends included, of every
    column; and the lowest at which its crest changes regime (inf: none), (n,)."""
    inside, touched = breaks_on(columns, np.arange(columns.size), _scan(columns, top))
    last = let_go(columns)
    out = []
    for r, points in enumerate(inside):
        start = min(touched[r], last) if np.isfinite(touched[r]) else first_contact(columns)
        points = np.unique([*points, top[r]])
        out.append(points[(points >= start) & (points <= top[r])])
    return out, touched


def breaks_on(columns: Columns, column: np.ndarray, D: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
    """Breaks between the first and the last of the penetrations ``D`` (m, points) of each ``column`` (m,), by the changes they
    show.

    Returns them, ascending, for every row, and the lowest that is one of the crest (inf: none), (m,).
    """
    a, h, K = columns.adhesion, columns.level.h, columns.material.K
    m = column.size
    # what levels below carry may change at the flat edge too
    places = np.array((0.0, np.pi) if columns.carry else (0.0,))

    def crest_or_edge(line, x):
        return columns.at(column[line % m], x), np.arange(x.size), places[line // m]

    def codes_at(line, x):
        at, *where = crest_or_edge(line, x)
        return at.codes(*where)

    def probe(line, x):
        at, *where = crest_or_edge(line, x)
        return at.probe(*where)

    D = np.tile(D, (places.size, 1))
    codes = codes_at(np.repeat(np.arange(m * places.size), D.shape[1]), D.ravel()).reshape(D.shape)
    line, node = np.nonzero(codes[:, 1:] != codes[:, :-1])
    low, high = D[line, node], D[line, node + 1]
    width = 16 * _EPS * np.maximum(np.maximum(np.abs(low), np.abs(high)), max(h, a.p_0 / K))
    ends = codes[line, node], codes[line, node + 1]
    known = np.stack((columns.clinging.crest(columns), saturation_depth(columns)))[:, column]
    looks = _beside_known(known, probe, line, low, high, ends, width)
    changes = locate(probe, columns.guide, line, low, high, *ends, width, looks)
    if columns.branch == "unloading" and a.p_0 > 0:
        edge = [h - a.p_0 / K, h - a.p_0 / K - a.delta_0]
    else:
        edge = [h - a.p_0 / K, h - (a.delta_0 if a.p_0 > 0 else 0.0)]
    out, touched = [], np.full(m, np.inf)
    for r in range(m):
        touched[r] = changes.high[changes.line == r].min(initial=np.inf)
        points = np.unique([*changes.high[changes.line % m == r], *(e for e in edge if D[r, 0] < e < D[r, -1])])
        out.append(points[np.concatenate(([True], np.diff(points) > 1e-12 * h))] if points.size else points)
    return out, touched


def _beside_known(known, probe: Probe, line, low, high, ends, width) -> Looks:
    """Looks at the ``ends`` (codes at ``low`` and ``high``) of brackets, and next to where crests are ``known`` to change,
    (kinds, crests)."""
    crest = np.flatnonzero(line < known.shape[1])
    x = known[:, line[crest]] + np.multiply.outer(_ASIDE, width[crest])[:, None]
    *_, at = inside = np.nonzero((x > low[crest]) & (x < high[crest]))
    rows, x = crest[at], x[inside]
    codes, margins = probe(line[rows], x)
    every, unknown = np.arange(line.size), np.full((2 * line.size, margins.shape[1]), np.nan)
    return Looks(
        np.concatenate((every, every, rows)),
        np.concatenate((low, high, x)),
        np.concatenate((*ends, codes)),
        np.concatenate((unknown, margins)),
    )


def _scan(columns: Columns, top):
    """Penetrations at which to look, (n, m): dense where regimes follow one another, geometric above, for saturation may be far
    up."""
    a = columns.adhesion
    bottom = first_contact(columns)
    reach = 2 * columns.level.h + a.delta_0 + 2 * a.p_0 / columns.material.K
    near = bottom + np.minimum(reach, top - bottom)[:, None] * np.linspace(0, 1, _SCAN)
    ratio = np.maximum((top - bottom) / np.maximum(near[:, -1] - bottom, 1e-300), 1.0)
    far = bottom + (near[:, -1] - bottom)[:, None] * ratio[:, None] ** np.linspace(0, 1, _SCAN // 4 + 1)
    return np.concatenate((near, far[:, 1:]), axis=1)
