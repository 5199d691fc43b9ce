"""All levels of a surface without adhesion: laws from the smallest level upwards, each from one family of strips at
every velocity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...numerics.chebyshev import lobatto
from ...numerics.quadrature import interleaved
from ...numerics.rounding import EPS
from ...orbit.foundation import foundation_of
from .columns import Columns
from .family import family
from .law import Laws, Piece, fit, greatest_slope

if TYPE_CHECKING:
    from ...multilevel import Surface

#: of what is allowed: what the values of a law may err
_VALUES = 0.6
#: and what a strip's means may by the series of its family, on level 1, where they only lead to penetrations, and below
_SERIES = 2.0, 0.5
#: nodes of a piece of a law, tried in turn
NODES = (16, 32, 64, 128)
#: slope of friction over pressure, relative to their ratio, that is not exceeded
_STEEPEST = 2.0
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


class FamilyStack:
    """Levels of a ``surface`` at velocities ``V`` (G,), ``p_full`` (levels, G) as in ``NonadhesiveSurface``, each with its family
    as far as pressures up to ``p_max`` (Pa, (G,)) on level 1 need it. ``d_max`` (G,), where that is what is known of level 1:
    penetrations in its height. ``rough``: level 1 is had by series alone, too."""

    def __init__(
        self, surface: Surface, V: np.ndarray, p_full: Sequence[np.ndarray], p_max: np.ndarray, d_max, wanted: Wanted, rough: bool
    ):
        self.rough = rough
        self.waves, self.V, self.p_full, self.wanted = surface.levels, V, p_full, wanted
        self.units = [surface.at_level(i).K * level.h for i, level in enumerate(surface.levels)]
        self.levels = self._levels(surface, p_max, d_max)
        # penetrations that levels reach, where there are others below, and below
        self.tops, every = [d_max], np.arange(V.size)
        for i in range(1, len(self.waves)):
            if self.tops[0] is None:
                self.tops[0] = self.levels[0].penetrations(every, p_max)
            self.tops.append(self.levels[i].penetrations(every, self._greatest(i - 1, self.tops[i - 1])))

    def _levels(self, surface, p_max, d_max) -> list[Columns]:
        """The families of all levels at once, each as far as pressures can reach at most."""
        # foundations of different levels differ in scale alone
        foundation, G, s_top, pressure = foundation_of(surface.at_level(0)), self.V.size, [], p_max
        rates = np.concatenate([wave.k * self.V for wave in self.waves])
        s_sat = 1 + np.broadcast_to(foundation.modulus_ratio(rates), rates.shape)
        for i, unit in enumerate(self.units):
            crest = d_max if i == 0 and d_max is not None else pressure / unit + 0.75
            # slopes by penetration are looked at a little beyond
            s_top.append(np.where(crest < 0.98, 2.04 * np.maximum(crest, EPS), np.inf))
            pressure = unit * np.maximum(crest - 1 + 0.5 * s_sat[i * G : (i + 1) * G], 0.0)
        accuracy = np.concatenate(
            [_SERIES[i > 0] * self.wanted.of(i) / (self.units[i] * w.k * w.h) for i, w in enumerate(self.waves)]
        )
        # the last level carries nothing
        carries = np.arange(rates.size) < rates.size - G
        known, strips = family(foundation, rates, np.concatenate(s_top), np.minimum(accuracy, 1e-2), carries)
        surface.work.solved += strips
        parts = [known.part(slice(i * G, (i + 1) * G)) for i in range(len(self.waves))]
        return [Columns(f, unit, w.k * w.h, surface.work) for f, unit, w in zip(parts, self.units, self.waves, strict=True)]

    def _greatest(self, i, d):
        """Greatest local pressure that level i passes on at ``d`` (G,), Pa."""
        family = self.levels[i].family
        out = np.maximum(d - 1 + 0.5 * family.s_sat, 0.0)
        part = np.flatnonzero((d > 0) & (d < 0.5 * family.s_sat))
        if part.size:
            share, over = family.values(part, 2 * d[part, None])[:, 0, 2:4].T
            out[part] = np.minimum(out[part], 0.5 * _BETWEEN * share * over)
        return self.units[i] * out

    def laws(self) -> Laws | None:
        """Of level 2 with all that it carries; None where there is none."""
        laws = None
        for i in range(len(self.waves) - 1, 0, -1):
            laws = self._law(i, laws)
        return laws

    def at(self, i, group, load, laws: Laws | None, by_pressure: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Level i over the ``laws`` of the next one at penetrations ``load`` (m,) in its height, or at pressures, Pa: these
        penetrations, and (m, 1 + q) pressure, friction (Pa) and contact of the level and of each below, and the error of all
        friction, Pa."""
        level, count = self.levels[i], 0 if laws is None else laws.full.shape[1]
        allowed = _VALUES * self.wanted.of(i)[group]
        goal = np.stack((allowed / level.slope, allowed, np.full(load.size, self.wanted.rtol)), axis=1)
        d = level.penetrations(group, load) if by_pressure else load
        # of level 1 there are few columns
        own, errors = level.means(group, d, goal, by_series=i > 0 or self.rough)
        carried, error = np.zeros((d.size, max(count, 1))), errors[:, 1]
        if laws is not None:
            # contact counts on as much of the surface as friction does
            share = max(self.wanted.rtol, _SHARES) * (self.wanted.of(i) / self.wanted.friction)[group]
            share = np.where(laws.most[group] > allowed, np.minimum(share, _COARSE), np.inf)
            goal = np.broadcast_to(share[:, None], (d.size, count)).copy()
            goal[:, :-1:2], goal[:, -1] = allowed[:, None], np.inf
            level = replace(level, laws=laws)
            carried, missed = level.carried(group, d, goal, at_once=i > 0)
            error += missed[:, :-1:2].sum(axis=1)
        # of an error of pressure friction has no more than its slope
        friction = own[:, 1] + carried[:, :-1:2].sum(axis=1)
        slope = np.divide(friction, own[:, 0], out=np.full(d.size, level.slope), where=own[:, 0] > 0)
        missed = errors[:, 0] + (np.abs(load - own[:, 0]) if by_pressure else 0.0)
        carried[:, -1] += error + _STEEPEST * slope * missed
        return d, np.concatenate((own, carried), axis=1)

    def _sharp(self, i):
        """Where the friction of level i with all that it carries counts enough for its lesser breaks to matter, (G,)."""
        return self.wanted.of(i) < _BLUNT * self._saturated(i)[:, :-1:2].sum(axis=1)

    def _law(self, i, below: Laws | None) -> Laws:
        unit, s_sat = self.units[i], self.levels[i].family.s_sat
        full = self.p_full[i] / unit + 0.75
        top = np.minimum(self.tops[i], full)
        own = np.minimum(np.stack((np.ones_like(full), 0.5 * s_sat, full), axis=1), top[:, None])
        ends = np.concatenate((np.zeros_like(own[:, :1]), own), axis=1)
        sharp = self._sharp(i)
        if below is not None and sharp.any():
            # where the pressure at the edges of the cells, all one, passes a break of the law below
            met = 1 + np.where(sharp[:, None], below.breaks, np.inf) / unit
            ends = np.concatenate((ends, np.minimum(met, top[:, None])), axis=1)
        order = np.argsort(ends, axis=1, kind="stable")
        ends = np.take_along_axis(ends, order, axis=1)
        # ends that are next to one another are one
        near = np.diff(ends, axis=1) <= 1e-6 * np.minimum(ends[:, 1:], 1.0)
        for j in np.flatnonzero(near.any(axis=0)):
            ends[near[:, j], j + 1] = ends[near[:, j], j]
        pieces, p, steepest, most = self._pieces(i, ends, below)
        breaks = np.take_along_axis(p, np.argsort(order, axis=1)[:, 1:4], axis=1)
        reached = top >= full
        breaks[(own >= top[:, None]) & ~reached[:, None]] = np.inf
        return Laws(pieces, breaks, np.where(reached, breaks[:, 2], np.inf), self._saturated(i), p[:, -1], steepest, most)

    def _saturated(self, i):
        columns = []
        for level in self.levels[i:]:
            columns += [0.09375 * level.family.full * level.unit * level.slope, np.ones(self.V.size)]
        return np.stack((*columns, np.zeros(self.V.size)), axis=1)

    def _pieces(self, i, ends, below):
        """Pieces between the penetrations ``ends`` (G, pieces + 1) of each law, all together; the pressures there; and of each
        law the greatest slope of friction, and a bound of its size, (G,)."""
        G, J, q = self.V.size, ends.shape[1] - 1, 2 * (len(self.waves) - i) + 1
        group, piece = np.nonzero(np.diff(ends, axis=1) > 0)
        low, high = ends[group, piece, None], ends[group, piece + 1, None]
        table, p_ends = np.zeros((G, J, NODES[-1] + 1, q)), np.zeros((G, J + 1))
        steep, most, longest = np.zeros(G), self._saturated(i)[:, :-1:2].sum(axis=1), 1
        left, known = np.arange(group.size), None
        for n in NODES:
            t = lobatto(n) if known is None else lobatto(n)[1::2]
            d = low[left] + (high - low)[left] * np.sin(0.5 * np.pi * t) ** 2
            _, new = self.at(i, np.repeat(group[left], t.size), d.ravel(), below)
            new = new.reshape(left.size, t.size, q + 1)
            known = new if known is None else interleaved(known, new)
            p, values = known[:, :, 0], known[:, :, 1:]
            p_ends[group[left], piece[left]], p_ends[group[left], piece[left] + 1] = p[:, 0], p[:, -1]
            fitted, size, done = fit(p, values, piece[left] == 0, self.wanted.of(i)[group[left]])
            done |= n == NODES[-1]
            table[group[left[done]], piece[left[done]], : n + 1] = fitted[done]
            longest = n + 1 if done.any() else longest
            np.maximum.at(most, group[left[done]], size[done])
            np.maximum.at(steep, group[left[done]], greatest_slope(p[done], values[done, :, :-1:2].sum(axis=2)))
            left, known = left[~done], known[~done]
            if not left.size:
                break
        p_ends = np.maximum.accumulate(p_ends, axis=1)
        return [Piece(p_ends[:, j], p_ends[:, j + 1], table[:, j, :longest], j == 0) for j in range(J)], p_ends, steep, most
