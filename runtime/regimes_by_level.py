"""Regimes of the strips of every level at one point of a result: a look at even strips, not an average to rtol."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from .level.breaks import reach
from .level.saturated import saturated_level
from .level.strips import LevelBatch
from .orbit.regimes import REGIMES, SEQUENCES

PULLED_OFF = "below pull-off: no contact"

#: strips across half a cell of level 1; penetrations at which a lower level is looked at first, and strips at each; points along
#: the contact of a strip
_STRIPS, _DEPTHS, _FEWER, _PHASES = 200, (40, 20, 12), 40, 32
#: share of the local pressures that may be carried between two of those penetrations, how often these are halved; and how many
#: penetrations in the end stand for even shares. Of 266 levels of random surfaces shares are known to 1 % of the whole but for 4
_BETWEEN, _ROUNDS, _EVEN = 0.01, 10, 64


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
            D, off = _carrying(result, i, V, pressure, share / share.sum())
            strips, weight = _Strips(result, i, V, D, _FEWER), np.full(D.size, (1 - off) / max(D.size, 1))
        each = strips.in_contact(weight)
        parts = dict(zip(REGIMES.values(), (weight @ strips.regimes()).tolist(), strict=True)) | {PULLED_OFF: off}
        shares = {name: part for name, part in sorted(parts.items(), key=lambda item: -item[1]) if part > 0}
        found.append(LevelRegimes(area, area * float(each.sum()), shares))
        area = float(np.ravel(result.contact_by_level[i])[at])
        if not each.any():
            break
        if i + 1 < len(result.levels):
            pressure, share = strips.pressures(each)
    return found


class _Strips:
    """Even strips of a level at penetrations D (n,), one after another."""

    def __init__(self, result: Any, i: int, V: float, D: np.ndarray, count: int):
        level = result.levels[i]
        of = result.material.at_wavelength(level.l), result.adhesion, level, result.edge, result.branch
        column, theta = np.repeat(np.arange(D.size), count), np.tile((np.arange(count) + 0.5) * np.pi / count, D.size)
        self.strips, self._count = LevelBatch(*of, np.full(D.size, V), D).solve(column, theta), count
        self.p_mean = self.strips.p_mean.reshape(-1, count).mean(axis=1)

    def regimes(self) -> np.ndarray:
        """Share of each of ``SEQUENCES`` at every depth, (n, 8)."""
        codes = self.strips.solved.code.reshape(-1, self._count, 1)
        return (codes == np.arange(len(SEQUENCES))).mean(axis=1)

    def in_contact(self, weight: np.ndarray) -> np.ndarray:
        """Share of the area that is in contact of each strip, (m,)."""
        return np.repeat(weight / self._count, self._count) * self.strips.solved.contact_fraction

    def pressures(self, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Local pressures in contact, Pa, and their shares of the area, both (k,); ``share`` (m,): of each strip's contact."""
        index, contact = self.strips.touching
        some = np.flatnonzero(share[index] > 0)
        along = (np.arange(_PHASES)[:, None] + 0.5) / _PHASES
        p = contact.pressure(some, contact.b[some] + along * (contact.a - contact.b)[some])
        return p.ravel(), np.tile(share[index[some]] / _PHASES, _PHASES)


def _carrying(result: Any, i: int, V: float, pressure: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, float]:
    """Penetrations of level ``i`` that carry even shares of what it carries of the local pressures (m,) on the branch, (n,); and
    the ``share`` (m,) of these that is below pull-off. Few are carried between two penetrations that were looked at."""
    order = np.argsort(pressure)
    pressure, share = pressure[order], share[order]
    D, unloading = _depths(result, i, V, pressure[-1]), result.branch == "unloading"
    p_mean = _Strips(result, i, V, D, _FEWER).p_mean
    for halvings in range(_ROUNDS + 1):
        cell, start = _cells(p_mean, pressure, unloading)
        off, step = pressure < p_mean[start], np.abs(np.diff(p_mean))
        between = np.bincount(cell[~off], share[~off], step.size)
        # the least pressure that is carried may be less beside where it was seen, by as much as there is between
        for k in range(max(start - 1, 0), min(start + 1, step.size)):
            between[k] += share[off & (pressure > p_mean[start] - step[k])].sum()
        wide = np.flatnonzero(between > _BETWEEN)
        if not wide.size or halvings == _ROUNDS:
            break
        D = np.insert(D, wide + 1, 0.5 * (D[wide] + D[wide + 1]))
        p_mean = np.insert(p_mean, wide + 1, _Strips(result, i, V, D[wide + 1 + np.arange(wide.size)], _FEWER).p_mean)
    carried = np.cumsum(share[~off])
    if not carried.size:
        return np.empty(0), 1.0
    some = np.searchsorted(carried, carried[-1] * (np.arange(_EVEN) + 0.5) / _EVEN)
    low, above = cell[~off][some], pressure[~off][some]
    rise = p_mean[low + 1] - p_mean[low]
    along = np.divide(above - p_mean[low], rise, out=np.zeros(_EVEN), where=rise > 0)
    return D[low] + np.clip(along, 0.0, 1.0) * (D[low + 1] - D[low]), float(share[off].sum())


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


def _cells(p_mean: np.ndarray, pressure: np.ndarray, unloading: bool) -> tuple[np.ndarray, int]:
    """After which penetration each pressure is carried on the branch, and the penetration that carries the least.

    Where the curve turns back the branch jumps over it, and meets the pressure where it comes from beyond."""
    if unloading:
        start = int(p_mean.argmin())
        after = np.searchsorted(np.minimum.accumulate(p_mean[::-1])[::-1], pressure, side="right") - 1
    else:
        # as the first strips cling the pressure falls below zero: loading follows what comes after its minimum there
        back = np.flatnonzero(np.maximum.accumulate(p_mean < 0) & (p_mean >= 0))
        start = int(np.argmin(p_mean[: back[0] if back.size else None]))
        reached = np.maximum.accumulate(np.where(np.arange(p_mean.size) < start, -np.inf, p_mean))
        after = np.searchsorted(reached, pressure) - 1
    return np.clip(after, start, p_mean.size - 2), start
