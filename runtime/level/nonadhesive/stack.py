"""All levels of a surface without adhesion: laws from the smallest level upwards, each from one family of strips at
every velocity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...numerics.chebyshev import lobatto
from ...numerics.quadrature import interleaved
from ...numerics.rounding import EPS
from ...orbit.foundation import foundation_of
from .carried import Carrier
from .family import CONTACT, family
from .law import NODES, Laws, Piece, fit, greatest_slope, pressures
from .means import CANCELLED, Level

if TYPE_CHECKING:
    from ...multilevel import Surface

#: of what is allowed: what the values of a law may err, and what a strip's means may
_VALUES, _STRIPS = 0.6, 2.0
#: contact fractions are averaged no finer and, on however little of the surface, no coarser than this
_SHARES, _COARSE = 1e-4, 1e-2
#: an accuracy in parts of the greatest friction from which on a law is only parted where it is least smooth
_BLUNT = 1e-4
#: by how much more a greatest pressure is allowed for
_BETWEEN = 1.02


@dataclass(frozen=True)
class Wanted:
    """Accuracy of friction at each velocity, Pa, of level 1 with what it carries and of the laws ``below``, (G,), and of
    everything else, relative."""

    friction: np.ndarray
    below: np.ndarray
    rtol: float

    def of(self, i: int) -> np.ndarray:
        """Accuracy of friction on level i, (G,)."""
        return self.friction if i == 0 else self.below


@dataclass(frozen=True)
class Found:
    """Columns (m,) of a level: penetration in its height, pressure (Pa), ``values`` (m, q): friction (Pa) and
    contact of the level and of each below, and the error of all friction, Pa."""

    d: np.ndarray
    p: np.ndarray
    values: np.ndarray


class FamilyStack:
    """Levels of a ``surface`` at velocities ``V`` (G,), ``p_full`` (levels, G) as in ``NonadhesiveSurface``, each with its family
    as far as pressures up to ``p_max`` (Pa, (G,)) on level 1 need it. ``d_max`` (G,), where that is what is known of level 1:
    penetrations in its height."""

    def __init__(self, surface: Surface, V: np.ndarray, p_full: Sequence[np.ndarray], p_max: np.ndarray, d_max, wanted: Wanted):
        # foundations of different levels differ in scale alone
        self.foundation, self.waves, self.V, self.p_full = foundation_of(surface.at_level(0)), surface.levels, V, p_full
        self.wanted, self.work = wanted, surface.work
        self.units = [surface.at_level(i).K * level.h for i, level in enumerate(surface.levels)]
        self.reach: list[np.ndarray] = []
        self.levels = self._levels(p_max, d_max)
        self.ceilings, every = [p_max], np.arange(self.V.size)
        for i in range(len(self.waves) - 1):
            known = i == 0 and d_max is not None
            d = d_max if known else self.levels[i].penetrations(every, self.ceilings[i] / self.units[i])
            self.ceilings.append(self._greatest(i, d))

    def _friction_unit(self, i):
        return self.units[i] * self.waves[i].k * self.waves[i].h

    def _levels(self, p_max, d_max) -> list[Level]:
        """The families of all levels at once, each as far as pressures can reach at most."""
        rates, s_top, shares, G = np.concatenate([wave.k * self.V for wave in self.waves]), [], [], self.V.size
        s_sat = 1 + np.broadcast_to(self.foundation.modulus_ratio(rates), rates.shape)
        pressure = p_max
        for i, unit in enumerate(self.units):
            crest = d_max if i == 0 and d_max is not None else pressure / unit + 0.75
            self.reach.append(crest)
            s_top.append(np.where(crest < 1, 2 * np.maximum(crest, EPS), np.inf))
            pressure = unit * np.maximum(crest - 1 + 0.5 * s_sat[i * G : (i + 1) * G], 0.0)
            # what is not known of pressures counts by the slope of the friction, hardly above k h
            shares.append(np.minimum(_STRIPS * self.wanted.of(i) / self._friction_unit(i), 1e-2))
        # the last level carries nothing
        carries = np.arange(rates.size) < rates.size - G
        known, strips = family(self.foundation, rates, np.concatenate(s_top), np.concatenate(shares), carries)
        self.work.solved += strips
        return [Level(known.part(slice(i * G, (i + 1) * G))) for i in range(len(self.waves))]

    def _greatest(self, i, d):
        """Greatest local pressure that level i passes on at ``d`` (G,), Pa."""
        family = self.levels[i].family
        out = np.maximum(d - 1 + 0.5 * family.s_sat, 0.0)
        part = np.flatnonzero((d > 0) & (d < 0.5 * family.s_sat))
        if part.size:
            share, over, _ = family.values(part, 2 * d[part, None], of=CONTACT)[:, 0].T
            out[part] = np.minimum(out[part], 0.5 * _BETWEEN * share * over)
        return self.units[i] * out

    def laws(self) -> Laws | None:
        """Of level 2 with all that it carries; None where there is none."""
        laws = None
        for i in range(len(self.waves) - 1, 0, -1):
            laws = self._law(i, laws)
        return laws

    def carrier(self, i, laws: Laws) -> Carrier:
        """Level i over the ``laws`` of the next one."""
        return Carrier(self.foundation, self.levels[i], self.waves[i].k * self.V, self.units[i], laws)

    def at(self, i, group, load, laws: Laws | None, by_pressure: bool = True) -> Found:
        """Level i over the ``laws`` of the next one at pressures ``load`` (m,), Pa, or at penetrations (m,) in its height."""
        level, unit, friction = self.levels[i], self.units[i], self._friction_unit(i)
        allowed = _VALUES * self.wanted.of(i)[group]
        goal = np.stack((*(2 * [allowed / friction]), np.full(load.size, self.wanted.rtol)), axis=1)
        d, means, errors = level.at(group, load / unit if by_pressure else load, by_pressure, goal)
        pressure = np.where(d > 0, load if by_pressure else unit * means[:, 0], 0.0)
        own = np.stack((friction * means[:, 1], means[:, 2]), axis=1)
        error, missed = friction * errors[:, 1], errors[:, 0] if by_pressure else 0.0
        if laws is None:
            return Found(d, pressure, np.column_stack((own, error)))
        carrier = self.carrier(i, laws)
        # contact counts on as much of the surface as friction does
        share = max(self.wanted.rtol, _SHARES) * (self.wanted.of(i) / self.wanted.friction)[group]
        share = np.where(laws.most[group] > allowed, np.minimum(share, _COARSE), np.inf)
        goal = np.broadcast_to(share[:, None], (d.size, laws.full.shape[1])).copy()
        goal[:, :-1:2], goal[:, -1] = allowed[:, None], np.inf
        carried, errors = carrier.carried(group, d, goal, at_once=i > 0)
        self.work.solved += carrier.strips
        error += errors[:, :-1:2].sum(axis=1) + carried[:, -1]
        # local pressures are as uncertain as a strip's means, and change friction by the law's slope
        error += own[:, 1] * (CANCELLED * level.family.greatest_errors[group, 0] + missed) * unit * laws.steepest[group]
        return Found(d, pressure, np.column_stack((own, carried[:, :-1], error)))

    def _sharp(self, i):
        """Where the friction of level i with all that it carries counts enough for its lesser breaks to matter, (G,)."""
        return self.wanted.of(i) < _BLUNT * self._saturated(i)[:, :-1:2].sum(axis=1)

    def _law(self, i, below: Laws | None) -> Laws:
        top, p_sat = self.ceilings[i], self.units[i] * (0.5 * self.levels[i].family.s_sat - 0.75)
        own = np.minimum([np.minimum(self._at(i, np.ones((self.V.size, 1)))[:, 0], p_sat), p_sat, self.p_full[i]], top).T
        ends, sharp = own, self._sharp(i)
        if below is not None and sharp.any():
            # where the pressure at the edges of the cells, all one, passes a break of the law below
            met = self._at(i, 1 + np.where(sharp[:, None], below.breaks, np.inf) / self.units[i])
            met = np.minimum(met, own[:, 2:])
            ends = np.concatenate((own, met), axis=1)
        ends = np.sort(np.concatenate((np.zeros((self.V.size, 1)), ends), axis=1), axis=1)
        # ends that are next to one another are one
        near = np.diff(ends, axis=1) <= 1e-6 * np.minimum(ends[:, 1:], self.units[i])
        for j in np.flatnonzero(near.any(axis=0)):
            ends[near[:, j], j + 1] = ends[near[:, j], j]
        pieces, steepest, most = self._pieces(i, ends, below)
        p_full = np.where(top >= self.p_full[i], self.p_full[i], np.inf)
        breaks = np.where(own < np.where(np.isinf(p_full), top, np.inf)[:, None], own, np.inf)
        return Laws(pieces, breaks, p_full, self._saturated(i), top, steepest, most)

    def _at(self, i, d):
        """Pressures of level i at penetrations ``d`` (G, k) in its height, Pa, inf where its families do not reach."""
        row, column = np.nonzero(d <= self.reach[i][:, None])
        x, out = d[row, column], np.full(d.shape, np.inf)
        pressure, part = x - 0.75, x < 0.5 * self.levels[i].family.s_sat[row]
        if part.any():
            pressure[part] = self.levels[i].means(row[part], x[part])[:, 0]
        out[row, column] = pressure * self.units[i]
        return out

    def _saturated(self, i):
        columns = []
        for j in range(i, len(self.waves)):
            columns += [0.09375 * self.levels[j].family.full * self._friction_unit(j), np.ones(self.V.size)]
        return np.stack((*columns, np.zeros(self.V.size)), axis=1)

    def _pieces(self, i, ends, below):
        """Pieces between the ``ends`` (G, pieces + 1) of each law, all together; and of each law the
        greatest slope of friction, and a bound of its size, (G,)."""
        G, J, q = self.V.size, ends.shape[1] - 1, 2 * (len(self.waves) - i) + 1
        group, piece = np.nonzero(np.diff(ends, axis=1) > 0)
        low, high = ends[group, piece], ends[group, piece + 1]
        series: list[np.ndarray] = [np.zeros((1, q))] * group.size
        steep, most = np.zeros(G), self._saturated(i)[:, :-1:2].sum(axis=1)
        left, known = np.arange(group.size), None
        for n in NODES:
            omega = lobatto(n) if known is None else lobatto(n)[1::2]
            p = pressures(low[left], high[left], omega, piece[left] == 0)
            found = self.at(i, np.repeat(group[left], omega.size), p.ravel(), below)
            new = np.concatenate((found.values.reshape(left.size, omega.size, q), p[:, :, None]), axis=2)
            known = new if known is None else interleaved(known, new)
            values, p = known[:, :, :-1], known[:, :, -1]
            fitted, size, done = fit(values, self.wanted.of(i)[group[left]])
            done |= n == NODES[-1]
            for k in np.flatnonzero(done):
                series[left[k]] = fitted[k]
            np.maximum.at(most, group[left[done]], size[done])
            np.maximum.at(steep, group[left[done]], greatest_slope(p[done], values[done, :, :-1:2].sum(axis=2)))
            left, known = left[~done], known[~done]
            if not left.size:
                break
        table = np.zeros((G, J, max((s.shape[0] for s in series), default=1), q))
        for g, j, s in zip(group, piece, series, strict=True):
            table[g, j, : s.shape[0]] = s
        return [Piece(ends[:, j], ends[:, j + 1], table[:, j], j == 0) for j in range(J)], steep, most
