"""All levels of a surface without adhesion: laws from the smallest level upwards, each from one family of strips at
every velocity."""

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
from .means import CANCELLED, Level
from .orbit import Wave
from .pressure import ContactPressure

#: nodes of a piece of a law, tried in turn
_NODES = (8, 16, 32, 64, 128)
#: of what is allowed: what interpolating a law may err, what its values may, and what a strip's means may
_INTERPOLATION, _VALUES, _STRIPS = 0.3, 0.3, 2.0
#: contact fractions are interpolated no finer than this, and on no more nodes
_CONTACT, _FOR_CONTACT = 1e-5, 16
#: how much more than the estimated error of a law is feared
_SURE = 2.0
#: slopes of a law are looked at over steps of at least this share of the pressure
_STEP = 1e-3
#: greatest pressure in a contact by samples of it, with what may be between them
_SAMPLES, _BETWEEN = 48, 1.02
#: looks, and how often they are narrowed, at where it passes a break of the law below
_LOOKS, _NARROWINGS = 17, 3
_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class Wanted:
    """Accuracy of friction at each velocity, Pa (G,), and of everything else, relative."""

    friction: np.ndarray
    rtol: float


@dataclass(frozen=True)
class Found:
    """Columns (m,) of a level: penetration in its height, pressure (Pa), ``values`` (m, q): friction (Pa), contact,
    adhesion of the level and of each below, and the error of all friction, Pa."""

    d: np.ndarray
    p: np.ndarray
    values: np.ndarray
    error: np.ndarray


class BareStack:
    """The levels at velocities ``V`` (G,), each with its family as far as pressures up to ``p_max`` (Pa, (G,)) on
    level 1 need it.

    ``p_sat``, ``p_full`` (levels, G): saturation of each level by itself, and with all below it. ``d_max`` (G,), where
    that is what is known of level 1: penetrations in its height.
    """

    def __init__(
        self, foundation: Foundation, levels: Sequence[Wavy], V, p_max, d_max, p_sat, p_full, wanted: Wanted, tally: Tally
    ):
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
        bound = d - 1 + 0.5 * self.levels[i].family.s_sat
        return self.units[i] * np.minimum(np.maximum(bound, 0.0), _BETWEEN * self._peak(i, self.groups, d))

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
        """Level i over the ``laws`` of the next one at pressures ``p`` (m,), Pa, or (None) at penetrations ``d`` (m,)
        in its height."""
        level, unit, friction = self.levels[i], self.units[i], self._friction_unit(i)
        d = self._penetrations(i, group, p) if d is None else d.copy()
        own, pressure = np.zeros((d.size, 3)), unit * (d - 0.75) if p is None else p
        s_sat, full = level.family.s_sat[group], level.family.full[group, 1]
        error, missed = np.zeros(d.size), np.zeros(d.size)
        own[:, 0] = 0.09375 * full * friction
        own[:, 1] = 1.0
        part = np.flatnonzero((d < 0.5 * s_sat) & (d > 0))
        own[d <= 0] = 0.0
        pressure = np.where(d > 0, pressure, 0.0)
        allowed = self.wanted.friction[group]
        if part.size:
            g = group[part]
            goal = np.stack(
                (_VALUES * allowed[part] / friction, _VALUES * allowed[part] / friction, np.full(part.size, self.wanted.rtol)),
                axis=1,
            )
            means, errors = level.sure_means(g, d[part], goal, True)
            rise = np.where(means[:, 3] > 0, means[:, 3], np.inf)
            by_pressure = means[:, 4] / rise
            lift = 0.0 if p is None else p[part] / unit - means[:, 0]
            d[part] += lift / rise
            own[part, 0], own[part, 1] = (means[:, 1] + by_pressure * lift) * friction, means[:, 2]
            pressure[part] = unit * (means[:, 0] + lift)
            error[part] = friction * (errors[:, 1] + (0.0 if p is None else np.abs(by_pressure) * (errors[:, 0] + _EPS)))
            missed[part] = 0.0 if p is None else errors[:, 0]
        if laws is None:
            return Found(d, pressure, own, error)
        carrier = self.carrier(i, laws)
        goal = np.full((d.size, laws.full.shape[1]), self.wanted.rtol)
        goal[:, ::3] = _VALUES * allowed[:, None]
        carried, errors = carrier.carried(group, d, goal)
        self.tally.solved += carrier.strips
        error += errors[:, ::3].sum(axis=1) + laws.error[group]
        # local pressures are as uncertain as a strip's means, and change friction by the law's slope
        error += (CANCELLED * level.family.errors[group, 0] + missed) * unit * laws.steepest[group]
        return Found(d, pressure, np.concatenate((own, carried), axis=1), error)

    def _law(self, i, below: BareLaws | None) -> BareLaws:
        unit, top = self.units[i], self.ceilings[i]
        edge = np.minimum(self._at_height(i), self.p_sat[i])
        own = np.minimum([edge, self.p_sat[i], self.p_full[i]], top).T
        ends = own if below is None else np.concatenate((own, np.minimum(self._met(i, below), own[:, 2:])), axis=1)
        ends = np.sort(np.concatenate((np.zeros((self.V.size, 1)), ends), axis=1), axis=1)
        # ends that are next to one another are one
        near = np.diff(ends, axis=1) <= 1e-6 * np.minimum(ends[:, 1:], unit)
        for j in np.flatnonzero(near.any(axis=0)):
            ends[near[:, j], j + 1] = ends[near[:, j], j]
        pieces, error, steepest = self._pieces(i, ends, below)
        p_full = np.where(top >= self.p_full[i], self.p_full[i], np.inf)
        breaks = np.where(own < np.where(np.isinf(p_full), top, np.inf)[:, None], own, np.inf)
        return BareLaws(pieces, breaks, p_full, self._saturated(i), error, steepest)

    def _met(self, i, below: BareLaws):
        """Pressures at which the greatest local pressure of level i, the least one of its crests, or that at the edges
        of its cells passes a break of the law below, (G, k)."""
        at, unit = self.levels[i], self.units[i]
        local = np.where(np.isfinite(below.breaks), below.breaks, np.nan) / unit
        s_sat = at.family.s_sat[:, None]
        d = [0.5 * s_sat + local, 1 + local, self._peaking(i, local)]
        out = np.concatenate(d, axis=1)
        row, column = np.nonzero(np.isfinite(out) & (out > 0))
        p = np.full(out.shape, np.inf)
        x, part = out[row, column], out[row, column] < 0.5 * at.family.s_sat[row]
        pressure = x - 0.75
        if part.any():
            pressure[part] = at.means(row[part], x[part], 18)[:, 0]
        p[row, column] = pressure * unit
        return p

    def _peaking(self, i, local):
        """d at which the greatest local pressure of level i is ``local`` (K h, (G, k)); nan for what is not met."""
        low = np.zeros(local.shape)
        high = np.broadcast_to(self._penetrations(i, self.groups, self.ceilings[i])[:, None], local.shape).copy()
        met = np.isfinite(local) & (local > 0)
        for _ in range(_NARROWINGS):
            share = np.linspace(0, 1, _LOOKS)
            d = low[..., None] + (high - low)[..., None] * share
            group = np.broadcast_to(self.groups[:, None, None], d.shape)
            peak = self._peak(i, group.ravel(), d.ravel()).reshape(d.shape)
            met &= local < peak[..., -1]
            reached = np.clip((peak < local[..., None]).sum(axis=-1), 1, _LOOKS - 1)[..., None]
            low, high = (np.take_along_axis(d, reached - side, axis=-1)[..., 0] for side in (1, 0))
        return np.where(met, 0.5 * (low + high), np.nan)

    def _peak(self, i, group, d):
        """Greatest local pressure of level i at ``d`` (m,), K h, from samples of its crest."""
        at = self.levels[i]
        s_sat = at.family.s_sat[group]
        out = np.where(d > 0, d - 1 + 0.5 * s_sat, 0.0)
        part = np.flatnonzero((d > 0) & (d < 0.5 * s_sat))
        if part.size:
            g = group[part]
            width = 2 * np.pi * np.clip(at.family.values(g, 2 * d[part, None])[:, 0, 2], 1e-9, 1 - 1e-9)
            wave = Wave(self.foundation, self.waves[i].k * self.V[g])
            t = np.linspace(0, 1, _SAMPLES + 2)[1:-1]
            share = np.broadcast_to(t * t * (3 - 2 * t), (part.size, _SAMPLES))
            out[part] = np.minimum(out[part], 0.5 * ContactPressure(wave, wave.orbits(width, means=False)).at(share).max(axis=1))
            self.tally.solved += part.size
        return out

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

    def _pieces(self, i, ends, below):
        """Pieces between the ``ends`` (G, pieces + 1) of each law, all together; and of each law the error of
        friction, Pa, and its greatest slope, (G,)."""
        G, J, q = self.V.size, ends.shape[1] - 1, 3 * (len(self.waves) - i)
        group, piece = np.nonzero(np.diff(ends, axis=1) > 0)
        low, high, wanted = ends[group, piece], ends[group, piece + 1], self.wanted.friction[group]
        series: list[np.ndarray] = [np.zeros((1, q))] * group.size
        wrong, steep = np.zeros(G), np.zeros(G)
        left, values, worst = np.arange(group.size), None, np.zeros(group.size)
        for n in _NODES:
            omega = lobatto(n) if values is None else lobatto(n)[1::2]
            p = np.where(
                (piece[left] == 0)[:, None],
                pressures(low[left], high[left], omega, True),
                pressures(low[left], high[left], omega, False),
            )
            found = self.at(i, np.repeat(group[left], omega.size), p.ravel(), below)
            new = found.values.reshape(left.size, omega.size, q)
            values = new if values is None else _merged(values, new)
            worst[left] = np.maximum(worst[left], found.error.reshape(left.size, -1).max(axis=1))
            total = np.concatenate((values[:, :, ::3].sum(axis=2, keepdims=True), values), axis=2)
            goal = np.full((left.size, 1 + q), max(self.wanted.rtol, _CONTACT))
            goal[:, 0] = _INTERPOLATION * wanted[left]
            goal[:, 1::3] = goal[:, :1]
            c = coefficients_over(total)
            alone = np.swapaxes(c, 1, 2).reshape(-1, n + 1, 1)
            miss = interpolation_errors(alone, 0.1 * goal.reshape(-1, 1)).reshape(left.size, -1)
            # between values that hardly differ there is little to miss
            miss = np.minimum(miss, 2 * np.ptp(total, axis=1))
            friction = (miss[:, :1] <= goal[:, :1]).all(axis=1) & (miss[:, 1::3] <= goal[:, 1::3]).all(axis=1)
            done = (miss <= goal).all(axis=1) | (n == _NODES[-1]) | (friction & (n >= _FOR_CONTACT))
            nodes = pressures(np.zeros(1), np.ones(1), lobatto(n), False)[0]
            for k in np.flatnonzero(done):
                j, g = left[k], group[left[k]]
                series[j] = c[k, :, 1:]
                wrong[g] = max(wrong[g], _SURE * miss[k, 0] + worst[j])
                share = nodes**2 if piece[j] == 0 else nodes
                rise, step = np.abs(np.diff(total[k, :, 0])), np.diff((high[j] - low[j]) * share)
                # differences of pressures that rounding or quadrature would make slopes of are none
                steep[g] = max(steep[g], (rise[step > _STEP * high[j]] / step[step > _STEP * high[j]]).max(initial=0.0))
            keep = ~done
            left, values = left[keep], values[keep]
            if not left.size:
                break
        table = np.zeros((G, J, max((s.shape[0] for s in series), default=1), q))
        for g, j, s in zip(group, piece, series, strict=True):
            table[g, j, : s.shape[0]] = s
        return [Piece(ends[:, j], ends[:, j + 1], table[:, j], j == 0) for j in range(J)], wrong, steep


def _merged(old, fresh):
    out = np.empty((old.shape[0], old.shape[1] + fresh.shape[1], old.shape[2]))
    out[:, 0::2], out[:, 1::2] = old, fresh
    return out
