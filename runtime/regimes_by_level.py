"""Regimes of the strips of every level at one point of a result: a look at even strips, not an average to rtol."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from .level.breaks import reach
from .level.saturated import saturated_level
from .strip_solution import solve_strip

PULLED_OFF = "below pull-off: no contact"

#: strips across half a cell of level 1; penetrations at which a lower level is looked at, and strips at each: shares are mostly
#: known to 1 % of the whole (of 351 levels of random surfaces, against four times as many of each, to 2.6 % at worst)
_STRIPS, _DEPTHS, _FEWER = 200, (40, 20, 12), 40
#: points along a strip
_PHASES = 128


@dataclass(frozen=True)
class LevelRegimes:
    """Regimes of one level.

    ``area``: fraction of the nominal area that this level meets: all of it for level 1, of a lower one the contact of
    the level above, as the result has it. ``contact``: fraction of the nominal area in contact on it, as these strips
    have it. ``shares``: name of a regime -> its share of that, largest first, adding up to 1.
    """

    area: float
    contact: float
    shares: dict[str, float]


def regimes_by_level(result: Any, at: int) -> list[LevelRegimes]:
    """Regimes of all levels at a point (flat index ``at``) of a :class:`hystrip.Result`; none where it is pulled off.

    Level 1: equal strips at its penetration. A lower level: at each local pressure in the contact of the level above,
    equal strips at the penetration that carries this pressure on the branch of the result, or :data:`PULLED_OFF`.
    """
    V, D = float(np.ravel(result.velocity)[at]), float(np.ravel(result.penetration)[at])
    if not np.isfinite(D):
        return []
    strips = _Strips(result, 0, V, np.array([D]), _STRIPS)
    weight, off, area, found = np.ones(1), 0.0, 1.0, []
    pressure = share = np.empty(0)
    for i in range(len(result.levels)):
        if i > 0:
            strips = _Strips(result, i, V, _depths(result, i, V, pressure.max()), _FEWER)
            row = _carrying(strips.p_mean, pressure, result.branch == "unloading")
            off = float(share[row < 0].sum() / share.sum())
            weight = np.bincount(row[row >= 0], share[row >= 0], minlength=strips.p_mean.size) / share.sum()
        pressure, share = strips.in_contact(weight)
        contact = area * float(share.sum())
        found.append(LevelRegimes(area, contact, _shares(strips.regimes, weight, off)))
        area = float(np.ravel(result.contact_by_level[i])[at])
        if not pressure.size:
            break
    return found


class _Strips:
    """Strips of a level at penetrations D (n,), all (n, strips)."""

    def __init__(self, result: Any, i: int, V: float, D: np.ndarray, count: int):
        level = result.levels[i]
        theta = (np.arange(count) + 0.5) * np.pi / count
        # a last axis for the points along the strip
        A, depth = level.amplitude(theta)[:, None], (D[:, None] - level.drop(theta))[..., None]
        how = {"edge": result.edge, "branch": result.branch}
        self._solved = solve_strip(result.material, result.adhesion, l=level.l, A=A, D=depth, V=V, **how)
        self._x = ((np.arange(_PHASES) + 0.5) / _PHASES - 0.5) * level.l
        self.regimes = self._solved.regime_name[..., 0].astype(str)
        self.p_mean = self._solved.p_mean[..., 0].mean(axis=1)

    def in_contact(self, weight: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Local pressures in contact, Pa, and their shares of the area, both (m,); ``weight`` (n,): of each depth."""
        touching = (self._solved.gap(self._x) <= 0) & (weight > 0)[:, None, None]
        share = np.broadcast_to(weight[:, None, None], touching.shape) / touching[0].size
        return self._solved.pressure(self._x)[touching], share[touching]


def _depths(result: Any, i: int, V: float, most: float) -> np.ndarray:
    """Penetrations from no contact to the one that carries ``most`` (Pa), in three even pieces."""
    a, level, K = result.adhesion, result.levels[i], result.material.at_wavelength(result.levels[i].l).K
    full = saturated_level(result.material, a, level, np.array([V]), result.branch).D_sat[0]
    # a free foundation touches first within reach of the adhesion alone
    low = -reach(a, K) if result.branch == "unloading" else -a.delta_0
    # at high speed saturation is far up, and what carries little lives near first contact
    near = low + min(2 * level.h + a.delta_0 + 2 * a.p_0 / K, full - low)
    ends = (low, near, full, max(full, most / K + level.mean_plane))
    pieces = [np.linspace(*ends[n : n + 2], count, endpoint=False) for n, count in enumerate(_DEPTHS)]
    return np.append(np.concatenate(pieces), ends[-1])


def _carrying(p_mean: np.ndarray, pressure: np.ndarray, unloading: bool) -> np.ndarray:
    """Index of the penetration that best carries each pressure on its branch; -1 below pull-off."""
    start = 0
    if unloading:
        reached = np.minimum.accumulate(p_mean[::-1])[::-1]
    else:
        # as the first strips cling the pressure falls below zero: loading follows what comes after its minimum there
        back = np.flatnonzero(np.maximum.accumulate(p_mean < 0) & (p_mean >= 0))
        start = int(np.argmin(p_mean[: back[0] if back.size else None]))
        reached = np.maximum.accumulate(np.where(np.arange(p_mean.size) < start, -np.inf, p_mean))
    above = np.clip(np.searchsorted(reached, pressure, side="right"), 1, p_mean.size - 1)
    low, high = reached[above - 1], reached[above]
    row = np.where(pressure - low <= high - pressure, above - 1, above)
    # where the curve turns back the branch jumps over it: only the side it jumps to carries this pressure
    row = np.where(p_mean[row] == reached[row], row, above - 1 if unloading else above)
    return np.where(pressure < reached[start], -1, row)


def _shares(regimes: np.ndarray, weight: np.ndarray, off: float) -> dict[str, float]:
    names, which = np.unique(regimes, return_inverse=True)
    share = np.bincount(which.ravel(), np.repeat(weight / regimes.shape[1], regimes.shape[1]))
    found = dict(zip(names.tolist(), share.tolist(), strict=True)) | {PULLED_OFF: off}
    return {name: float(each) for name, each in sorted(found.items(), key=lambda item: -item[1]) if each > 0}
