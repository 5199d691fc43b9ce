"""From nominal pressure to penetration along a branch of loading, and how far up the curve has to be known for that."""

from __future__ import annotations

import numpy as np

from .curve import first_contact
from .means import level_means
from .strips import Columns

_COARSE = 1e-2


def cut_penetration(columns: Columns, p_max: np.ndarray, full: np.ndarray) -> np.ndarray:
    """A penetration above the one that carries ``p_max`` (Pa, (n,)) on the unloading path, at most ``full`` (m, (n,)).

    Doubles the distance from first contact until the level carries clearly more than ``p_max`` there and at the next two
    doublings, so that a local minimum of the curve is not taken for its rise.
    """
    bottom = first_contact(columns)
    scale = 1e-3 * columns.scales[0]
    step = np.full(columns.size, max(columns.level.h, -bottom))
    top, lead = full.copy(), np.zeros(columns.size, int)
    candidate = full.copy()
    active = np.flatnonzero(bottom + step < full)
    while active.size:
        D = bottom + step[active]
        p = level_means(columns.at(active, D), np.full(active.size, _COARSE)).values[:, 0]
        enough = p > p_max[active] + 2 * _COARSE * (np.abs(p) + scale)
        lead[active] = np.where(enough, lead[active] + 1, 0)
        candidate[active] = np.where(enough & (lead[active] == 1), D, candidate[active])
        done = lead[active] == 3
        top[active[done]] = candidate[active[done]]
        step[active] *= 2
        active = active[~done & (bottom + step[active] < full[active])]
    return top
