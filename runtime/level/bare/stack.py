"""All levels of a surface without adhesion: laws from the smallest level upwards, each from one family of strips at every velocity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hystrip.inputs.surface import Level as Wavy
from hystrip.solver import Foundation

from ..chebyshev import interpolation_errors, lobatto
from ..strips import Tally
from .carried import Carrier
from .family import coefficients_over, family
from .law import BareLaws, Piece, pressures
from .means import Level
from .orbit import Wave
from .pressure import ContactPressure

#: nodes of a piece of a law, tried in turn
_NODES = (8, 16, 32, 64, 128)
#: of what is allowed: what interpolating a law may err, what its values may, and what a strip's means may
_INTERPOLATION, _VALUES, _STRIPS = 0.3, 0.1, 2.0
#: contact fractions are interpolated no finer than this
_CONTACT = 1e-5
#: greatest pressure in a contact by samples of it, with what may be between them
_SAMPLES, _BETWEEN = 48, 1.02
_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class Wanted:
    """Accuracy of friction at each velocity, Pa (G,), and of everything else, relative."""

    friction: np.ndarray
    rtol: float


@dataclass(frozen=True)
class Found:
    """Columns (m,) of a level: penetration in its height, pressure (Pa), ``values`` (m, q): friction (Pa), contact, adhesion of the level and of each below,
    and the error of all friction, Pa."""

    d: np.ndarray
    p: np.ndarray
    values: np.ndarray
    error: np.ndarray


class BareStack:
    """The levels at velocities ``V`` (G,), each with its family as far as pressures up to ``p_max`` (Pa, (G,)) on level 1 need it.

    ``p_sat``, ``p_full`` (levels, G): saturation of each level by itself, and with all below it. ``d_max`` (G,), where that is what is known of level 1:
    penetrations in its height.
    """

    def __init__(self, foundation: Foundation, levels: Sequence[Wavy], V, p_max, d_max, p_sat, p_full, wanted: Wanted, tally: Tally):
        self.foundation, self.waves, self.V, self.p_full, self.wanted, self.tally = foundation, levels, V, p_full, wanted, tally
        self.p_sat = p_sat
        self.groups = np.arange(V.size)
        self.units = [foundation.K * level.h for level in levels]
        self.levels, self.ceilings = [], [p_max]
        for i in range(len(levels)):
            crest = d_max if i == 0 and d_max is not None else self.ceilings[i] / self.units[i] + 0.75
            self.levels.append(self._level(i, crest))
            if i + 1 < len(levels):
                d = d_max if i == 0 and d_max is not None else self._penetrations(i, self.groups, self.ceilings[i])
                self.ceilings.append(self._greatest(i, d))

    def _friction_unit(self, i):
        return self.units[i] * self.waves[i].k * self.waves[i].h

    def _level(self, i, crest) -> Level:
        rate = self.waves[i].k * self.V
        s_top = np.where(crest < 1, 2 * np.maximum(crest, _EPS), np.inf)
        # what is not known of pressures counts by the slope of the friction, hardly above k h
        share = _STRIPS * self.wanted.friction / self._friction_unit(i)
        fam = family(self.foundation, rate, s_top, np.zeros(rate.size), np.array((1.0, 1.0, 1e30)), np.minimum(share, 1e-2))
        self.tally.solved += int(fam.strips.sum())
        return Level(fam)

    def _greatest(self, i, d):
        """Greatest local pressure that level i passes on at ``d`` (G,), Pa."""
        at, unit = self.levels[i], self.units[i]
        s_sat = at.family.s_sat
        bound = np.where(d > 0, d - 1 + 0.5 * s_sat, 0.0)
        part = np.flatnonzero((d > 0) & (d < 0.5 * s_sat))
        if part.size:
            width = 2 * np.pi * np.clip(at.family.values(part, 2 * d[part, None])[:, 0, 2], 1e-9, 1 - 1e-9)
            wave = Wave(self.foundation, self.waves[i].k * self.V[part])
            t = np.linspace(0, 1, _SAMPLES + 2)[1:-1]
            share = np.broadcast_to(t * t * (3 - 2 * t), (part.size, _SAMPLES))
            peak = ContactPressure(wave, wave.orbits(width)).at(share).max(axis=1)
            self.tally.solved += part.size
            bound[part] = np.minimum(bound[part], 0.5 * _BETWEEN * peak)
        return unit * bound

    def _penetrations(self, i, group, p):
        """d of level i at pressures ``p`` (m,), Pa."""
        at, unit = self.levels[i], self.units[i]
        d = np.where(p > 0, p / unit + 0.75, 0.0)
        part = np.flatnonzero((p > 0) & (p < self.p_sat[i][group]))
        if part.size:
            d[part] = at.penetrations(group[part], p[part] / unit)
        return d

    def laws(self) -> BareLaws | None:
        """Of level 2 with all that it carries; None where there is none."""
        laws = None
        for i in range(len(self.waves) - 1, 0, -1):
            laws = self._law(i, laws)
        return laws

    def carrier(self, i, laws: BareLaws) -> Carrier:
        """Level i over the ``laws`` of the next one."""
        return Carrier(self.foundation, self.levels[i], self.waves[i].k * self.V, self.units[i], laws)

    def at(self, i, group, p, laws: BareLaws | None, d=None) -> Found:
        """Level i over the ``laws`` of the next one at pressures ``p`` (m,), Pa, or (None) at penetrations ``d`` (m,) in its height."""
        level, unit, friction = self.levels[i], self.units[i], self._friction_unit(i)
        d = self._penetrations(i, group, p) if d is None else d
        own, pressure = np.zeros((d.size, 3)), unit * (d - 0.75) if p is None else p
        s_sat, full = level.family.s_sat[group], level.family.full[group, 1]
        error = np.zeros(d.size)
        own[:, 0] = 0.09375 * full * friction
        own[:, 1] = 1.0
        part = np.flatnonzero((d < 0.5 * s_sat) & (d > 0))
        own[d <= 0] = 0.0
        pressure = np.where(d > 0, pressure, 0.0)
        allowed = self.wanted.friction[group]
        if part.size:
            g = group[part]
            goal = np.stack((_VALUES * allowed[part] / friction, _VALUES * allowed[part] / friction, np.full(part.size, self.wanted.rtol)), axis=1)
            means, errors = level.sure_means(g, d[part], goal, True)
            own[part, 0], own[part, 1] = means[:, 1] * friction, means[:, 2]
            error[part] = friction * errors[:, 1]
            by_pressure = np.divide(means[:, 4], means[:, 3], out=np.zeros(part.size), where=means[:, 3] > 0) * friction
            if p is None:
                pressure[part] = unit * means[:, 0]
            else:
                lift = p[part] / unit - means[:, 0]
                own[part, 0] += by_pressure * lift
                error[part] += np.abs(by_pressure) * (errors[:, 0] + _EPS)
        if laws is None:
            return Found(d, pressure, own, error)
        carrier = self.carrier(i, laws)
        goal = np.full((d.size, laws.full.shape[1]), self.wanted.rtol)
        goal[:, ::3] = _VALUES * allowed[:, None]
        carried, errors = carrier.carried(group, d, goal)
        self.tally.solved += carrier.strips
        error += errors[:, ::3].sum(axis=1) + laws.error[group]
        # local pressures are as uncertain as a strip's means, and change friction by the law's slope
        error += level.family.errors[group, 0] * unit * laws.steepest[group]
        return Found(d, pressure, np.concatenate((own, carried), axis=1), error)

    def _law(self, i, below: BareLaws | None) -> BareLaws:
        unit, top = self.units[i], self.ceilings[i]
        edge = np.minimum(self._at_height(i), self.p_sat[i])
        ends = [np.zeros(self.V.size), edge, self.p_sat[i], self.p_full[i]]
        ends = [np.minimum(end, top) for end in ends]
        full = self._saturated(i)
        pieces, error, steepest = [], np.zeros(self.V.size), np.zeros(self.V.size)
        for j, (low, high) in enumerate(zip(ends[:-1], ends[1:], strict=True)):
            wide = np.flatnonzero(high - low > 1e-12 * unit)
            high = np.where(high - low > 1e-12 * unit, high, low)
            table, wrong, steep = self._piece(i, wide, low, high, j == 0, below)
            pieces.append(Piece(low, high, table, j == 0))
            error, steepest = np.maximum(error, wrong), np.maximum(steepest, steep)
        p_full = np.where(top >= self.p_full[i], self.p_full[i], np.inf)
        return BareLaws(pieces, p_full, full, error, steepest)

    def _at_height(self, i):
        """Pressure at D = h."""
        level = self.levels[i]
        reached = self.ceilings[i] / self.units[i] + 0.75 >= 1
        out = np.full(self.V.size, np.inf)
        g = np.flatnonzero(reached)
        if g.size:
            flat = level.family.s_sat[g] <= 2
            means = level.means(g, np.ones(g.size), 12)
            out[g] = np.where(flat, self.p_sat[i][g], means[:, 0] * self.units[i])
        return out

    def _saturated(self, i):
        one, none = np.ones(self.V.size), np.zeros(self.V.size)
        columns = []
        for j in range(i, len(self.waves)):
            columns += [0.09375 * self.levels[j].family.full[:, 1] * self._friction_unit(j), one, none]
        return np.stack(columns, axis=1)

    def _piece(self, i, groups, low, high, quartic, below):
        q = 3 * (len(self.waves) - i)
        G = self.V.size
        tables: list[tuple[int, np.ndarray]] = []
        wrong, steep = np.zeros(G), np.zeros(G)
        values = np.zeros((0, 0, q))
        left = groups
        for n in _NODES:
            if not left.size:
                break
            omega = lobatto(n)
            fresh = omega if not values.size else omega[1::2]
            p = pressures(low[left], high[left], fresh, quartic)
            found = self.at(i, np.repeat(left, fresh.size), p.ravel(), below)
            new, errors = found.values.reshape(left.size, fresh.size, q), found.error.reshape(left.size, -1)
            values = new if not values.size else _merged(values, new)
            worst = errors.max(axis=1) if n == _NODES[0] else np.maximum(worst, errors.max(axis=1))
            total = np.concatenate((values[:, :, ::3].sum(axis=2, keepdims=True), values), axis=2)
            goal = np.empty((left.size, 1 + q))
            goal[:] = max(self.wanted.rtol, _CONTACT)
            goal[:, 0] = goal[:, 1] = _INTERPOLATION * self.wanted.friction[left]
            goal[:, 1::3] = goal[:, :1]
            c = coefficients_over(total)
            alone = np.swapaxes(c, 1, 2).reshape(-1, n + 1, 1)
            miss = interpolation_errors(alone, 0.1 * goal.reshape(-1, 1)).reshape(left.size, -1)
            done = (miss <= goal).all(axis=1) | (n == _NODES[-1])
            for k in np.flatnonzero(done):
                tables.append((left[k], c[k, :, 1:]))
                wrong[left[k]] = miss[k, 0] + worst[k]
                nodes = pressures(low[left[k : k + 1]], high[left[k : k + 1]], omega, quartic)[0]
                steep[left[k]] = np.abs(np.diff(total[k, :, 0])[1:] / np.diff(nodes)[1:]).max()
            keep = ~done
            left, values, worst = left[keep], values[keep], worst[keep]
        size = max((c.shape[0] for _, c in tables), default=1)
        table = np.zeros((G, size, q))
        for g, c in tables:
            table[g, : c.shape[0]] = c
        return table, wrong, steep


def _merged(old, fresh):
    out = np.empty((old.shape[0], old.shape[1] + fresh.shape[1], old.shape[2]))
    out[:, 0::2], out[:, 1::2] = old, fresh
    return out
