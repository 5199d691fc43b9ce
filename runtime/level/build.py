"""Friction laws of one level at several velocities, each as far up as it will be asked for."""

from __future__ import annotations

import numpy as np

from .curve import trace
from .error_budget import ErrorBudget
from .inverse import cut_penetration
from .law import Law, laws_of
from .strips import LevelBatch


def build_laws(
    columns: LevelBatch,
    rtol: np.ndarray,
    p_full: np.ndarray,
    D_full: np.ndarray,
    saturated: np.ndarray,
    p_max: np.ndarray | None,
    budget: ErrorBudget | None = None,
) -> list[Law]:
    """One law per column (its ``D`` is not used).

    ``p_full``, ``D_full`` (n,): where the level, and all it carries, is saturated; ``saturated`` (n, q): means there. ``p_max``
    (n,): greatest pressure that will be asked for, or None for the whole law. ``budget``: how much its pressures count.
    """
    p_max = np.full(columns.size, np.inf) if p_max is None else np.maximum(p_max, -columns.adhesion.p_0)
    top = cut_penetration(columns, p_max, D_full)
    curves = trace(columns, rtol, top, follow=True, budget=budget)
    return laws_of(curves, columns.branch == "unloading", p_full, saturated, np.where(top < D_full, p_max, np.inf))
