"""Points of a surface of which some levels are flat, in truth or to the last digit: these pass on what presses them.

A flat level is in contact where ``p >= -p_0``, at ``D = p/K``. Where it is loaded it touches later: it clings from
``D = -delta_0`` on, and carries ``-K delta_0`` at least.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from .multilevel import Surface
from .points import Points


def solve_points(surface: Surface, V, load, by_pressure: bool, progress: Callable[[int, int], None] | None = None) -> Points:
    """Solve points of a surface; ``V`` (m/s) and ``load`` (Pa or m) of shape (n,).

    Flat levels are left out, but with adhesion for a first one at given penetrations, and for lower ones that are loaded, which
    may not touch where the level above does."""
    K, p_0, delta_0 = surface.at_level(0).K, surface.adhesion.p_0, surface.adhesion.delta_0
    loading = p_0 > 0 and surface.branch == "loading"
    kept = np.array([not level.is_flat for level in surface.levels])
    kept |= loading & (np.cumsum(kept) > 0)
    # there is at least one to solve
    kept[0] |= not kept.any() or (p_0 > 0 and not by_pressure)
    rest = replace(surface, levels=[level for level, keep in zip(surface.levels, kept, strict=True) if keep])
    if kept[0]:
        points, touching = rest.solve(V, load, by_pressure, progress), np.ones(load.size, bool)
    else:
        p = load if by_pressure else K * np.maximum(load, 0.0)
        points = replace(rest, strips=None).solve(V, p, True, progress)
        points.pulled_off = p < -(min(p_0, K * delta_0) if loading else p_0)
        points.D = np.where(points.pulled_off, np.nan, p / K) if by_pressure else load
        touching = ~points.pulled_off & (by_pressure | (load >= 0))
    # where the level above is in contact, if there is one
    above = np.cumsum(kept) - 1
    points.contact = np.concatenate((points.contact, np.ones((1, load.size))))[above] * touching
    points.tau, points.adhesion = (np.where(kept[:, None], v[above], 0.0) * touching for v in (points.tau, points.adhesion))
    return points
