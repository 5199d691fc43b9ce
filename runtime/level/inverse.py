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
    doublings (or up to saturation), so that a local minimum of the curve is not taken for its rise.
    """
    # the curve turns where the crest touches, about -delta_0; from there doubling steps
    base = max(first_contact(columns), -columns.adhesion.delta_0 - 0.5 * columns.level.h)
    scale = 1e-3 * columns.scales[0]
    n = columns.size
    step, lead = np.full(n, columns.level.h), np.zeros(n, int)
    candidate = full.copy()
    active = np.flatnonzero(base + step < full)
    while active.size:
        D = base + step[active]
        p = level_means(columns.at(active, D), np.full(active.size, _COARSE)).values[:, 0]
        enough = p > p_max[active] + 2 * _COARSE * (np.abs(p) + scale)
        lead[active] = np.where(enough, lead[active] + 1, 0)
        candidate[active] = np.where(enough, np.where(lead[active] == 1, D, candidate[active]), full[active])
        step[active] *= 2
        active = active[(lead[active] < 3) & (base + step[active] < full[active])]
    return candidate
