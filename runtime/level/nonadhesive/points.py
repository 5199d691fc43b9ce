"""One level without adhesion at points of pressure, or penetration, and velocity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...errors import SolverError
from ...orbit.foundation import foundation_of
from ..strips import LevelBatch
from .family import are_families, family
from .means import Level

#: shares of what is allowed that the strips' means may err, pressure, friction and contact, and how much finer each
#: further attempt is
_SHARES, _FINER, _ATTEMPTS = np.array((0.3, 0.3, 0.5)), 0.01, 3


@dataclass(frozen=True)
class FamilyMeans:
    """Of columns (m,): penetration ``D``, ``values`` and ``errors`` (m, 4) of ``strips.QUANTITIES``, SI, and which are
    ``certain`` to be as accurate as was asked for."""

    D: np.ndarray
    values: np.ndarray
    errors: np.ndarray
    certain: np.ndarray


def family_means(columns: LevelBatch, rtol: np.ndarray, p: np.ndarray | None = None) -> FamilyMeans:
    """Means of the level alone at the columns' penetrations, or at the pressures ``p`` (Pa) where they are between zero and that
    of saturation, to ``rtol (|value| + floor)``."""
    level, K, n = columns.level, columns.material.K, columns.size
    D, values, errors, certain = columns.D.copy(), np.zeros((n, 3)), np.zeros((n, 3)), np.zeros(n, bool)
    foundation = foundation_of(columns.material)
    if columns.strips is not None or not are_families(foundation, columns.adhesion.p_0, (level,), columns.V):
        return FamilyMeans(D, np.zeros((n, 4)), np.zeros((n, 4)), certain)
    unit = np.array((K * level.h, K * level.h * level.k * level.h, 1.0))
    V, group = np.unique(columns.V, return_inverse=True)
    load = columns.D / level.h if p is None else p / unit[0]
    s_sat = 1 + np.broadcast_to(foundation.modulus_ratio(level.k * columns.V), n)
    mine = np.full(n, True) if p is None else (load > 0) & (load < 0.5 * s_sat - 0.75)
    floors = columns.floors[0, :3]
    D, finer = load.copy(), np.ones(n)
    for _ in range(_ATTEMPTS):
        left = np.flatnonzero(mine & ~certain)
        if not left.size:
            break
        which, row = np.unique(group[left], return_inverse=True)
        tight = np.full(which.size, np.inf)
        np.minimum.at(tight, row, rtol[left] * finer[left])
        try:
            known, strips = _family(columns, foundation, V[which], load[left], row, p is None, floors / unit, tight)
        except SolverError:
            # the general path solves them, or names the strip that it can't
            break
        at = Level(known)
        columns.work.solved += strips
        goal = rtol[left, None] * (floors / unit)
        D[left], means, missed = at.at(row, load[left], p is not None, goal)
        values[left], errors[left] = means * unit, missed * unit
        allowed = rtol[left, None] * (np.abs(values[left]) + floors)
        certain[left] = (errors[left] <= allowed).all(axis=1)
        finer[left] *= _FINER
    # there is no adhesion
    return FamilyMeans(D * level.h, np.column_stack((values, np.zeros(n))), np.column_stack((errors, np.zeros(n))), certain)


def _family(columns, foundation, V, load, row, by_penetration, floors, rtol):
    """As far and as fine as the loads (in h, or K h) need."""
    crest = np.full(V.size, -np.inf)
    np.maximum.at(crest, row, load if by_penetration else load + 0.75)
    least = np.full(V.size, np.inf)
    np.minimum.at(least, row, load)
    size = np.zeros(V.size) if by_penetration else 0.5 * np.minimum(least, 1.0)
    s_top = np.where(crest < 1, 2 * np.maximum(crest, 0.0), np.inf)
    return family(foundation, columns.level.k * V, s_top, size, _SHARES * floors / _SHARES[0], _SHARES[0] * rtol)
