"""All strips of a level at one velocity: where they are in contact, as functions of the penetration over the amplitude.

Without adhesion alpha and beta are all that a strip has but for ``s = D/A``, and they are the same on the whole level.
Contact begins like a root of s and becomes complete like a root of ``s_sat - s``, ``s_sat = 1 + R``: over ``xi``, ``s
= s_sat sin^2 xi``, the width of contact is smooth. Orbits are in closed form from that width: series of it are what a strip is
found from, and their errors leave with one step of Newton's method.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...errors import SolverError
from ...inputs.surface import Level
from ...numerics.chebyshev import coefficients, derivatives, evaluate_each, interpolation_errors, lobatto, resampled
from ...numerics.quadrature import interleaved, mapped
from ...numerics.rounding import EPS
from ...orbit.foundation import Foundation
from ...orbit.nonadhesive import Orbits, Waves

if TYPE_CHECKING:
    from ..strips import LevelBatch

#: quantities of a strip: mean pressure and friction, share of the period in contact, greatest pressure over that, its place in
#: contact; slopes of the first and the third by s; what is cut off the series of the first three
MEANS, SEARCH, CONTACT, CUT = (0, 1, 2), (0, 5), (2, 3, 4, 6), (7, 8, 9)
#: so many coefficients that are cut off a series are known to whoever asks what they would add
_NEXT = 4
#: nodes of the first series and of the last; nothing is sampled finer than so many roundings; and how well contact has to be
#: known beside pressure and friction: as well as it comes; share of what is allowed that is cut off a series
_FIRST, _LAST, _FINEST, _ANY, _TRIMMED = 8, 512, 256, 1e30, 0.03
#: beyond its end by this, relative, nothing is asked of a series, nor is a strip known any better
_ROUNDING = 1e-12
#: beyond this k V times the longest retardation time the general path says what is wrong
_FASTEST = 1e100
#: looks at a contact for its greatest pressure
_LOOKS = 33
#: the least share of the period that contact has, and the least slope of a penetration
_LEAST, _TINY = 1e-9, 1e-150
#: steps towards a strip at most, and by what part of the accuracy its penetration may be missed
_STEPS, _FOUND = 4, 1e-3


def are_families(foundation: Foundation, p_0: float, levels: Sequence[Level], V: np.ndarray) -> bool:
    """Whether the strips of all ``levels`` are families at the velocities ``V``: without adhesion (``p_0``), and wavy."""
    fastest = max(level.k for level in levels) * V.max(initial=0.0) * foundation.longest_time
    return p_0 == 0 and not any(level.is_flat for level in levels) and bool(fastest < _FASTEST)


class Family:
    """Strips at the rates ``k V`` (G,), ascending, up to the penetrations ``s_top`` (G,) over their amplitudes.

    ``s_sat`` (G,): where contact becomes complete. ``full`` (G,): friction then, K A kA. ``strips``: strips it took. Series are
    known to ``accuracy`` (G,), of pressure (K A) and friction, where that can be reached, and where contacts are pressed most if
    it ``carries`` a level; ``errors`` (G, 3): how well these are known, and contact."""

    def __init__(self, foundation: Foundation, rate: np.ndarray, s_top: np.ndarray, accuracy: np.ndarray, carries: bool):
        self.foundation, self.rate, self.carries, self.found = foundation, rate, carries, _FOUND * accuracy
        self.s_sat = 1 + foundation.modulus_ratio(rate)
        # a level of height h averages K A kA loss/2 over its strips, half the loss modulus, and the mean of A^2 is 3 h^2/32
        self.full = foundation.saturation_friction(2 * np.pi, 1.0, rate) * 32 / (3 * foundation.K)
        self.strips, self.top = 0, np.zeros(rate.size)
        self.errors, self.degree = np.zeros((rate.size, 3)), np.zeros(rate.size, int)
        series: list[np.ndarray] = [np.empty((0, 10))] * rate.size
        most = self._reaching(s_top)
        left, n, known = np.arange(rate.size), _FIRST, None
        while left.size:
            fresh = self._samples(left, most[left, None] * (lobatto(n) if known is None else lobatto(n)[1::2]))
            known = fresh if known is None else interleaved(known, fresh)
            goal = np.maximum(accuracy[left, None] * (1.0, 1.0, _ANY), _FINEST * EPS * np.abs(known[:, :, 1:4]).max(axis=1))
            over, self.errors[left] = self._resampled(left, known, goal)
            done = (self.errors[left] <= goal).all(axis=1) | (n == _LAST)
            for k in np.flatnonzero(done):
                series[left[k]] = _with_slopes_and_cut(over[k], _TRIMMED * goal[k])
            self.degree[left[done]] = n
            left, known, n = left[~done], known[~done], 2 * n
        self._size, self._series = np.array([len(c) for c in series]), series

    def _resampled(self, group, samples, goal) -> tuple[np.ndarray, np.ndarray]:
        """Series (m, n + 1, 5) over ``xi/top`` through ``samples`` (m, n + 1, 6) of the rates ``group`` (m,), and the errors of
        pressure, friction and contact, (m, 3), of which a tenth of the ``goal`` doesn't matter."""
        s, values, s_sat = samples[:, :, 0], samples[:, :, 1:], self.s_sat[group, None]
        self.top[group] = _xi(s[:, -1], s_sat[:, 0])
        out = resampled(s, s_sat * np.sin(self.top[group, None] * lobatto(s.shape[1] - 1)) ** 2, values)
        # what is not known of a strip's penetration moves all along their slopes
        values, step = values[:, :, :3], np.diff(s)[:, :, None]
        slope = np.abs(np.divide(np.diff(values, axis=1), step, out=np.zeros((*step.shape[:2], 3)), where=step > 0)).max(axis=1)
        over, sampled = (errors_alone(v, goal) for v in (out[:, :, :3], coefficients(values)))
        place = errors_alone(coefficients(s[:, :, None]), goal.min(axis=1, keepdims=True))
        return out, over + sampled + slope * place + 16 * EPS * np.abs(values).max(axis=1)

    def _reaching(self, s_top) -> np.ndarray:
        """Shares of the period in contact that strips up to ``s_top`` (G,) have at most, half of one being too little."""
        # w is nowhere negative, so contact lies where the profile is below the plane
        share = np.where(s_top < 2, 2 / np.pi * _xi(s_top, 2.0), 1.0)
        left = np.arange(share.size)
        while left.size:
            self.strips += left.size
            left = left[self.foundation.waves(self.rate[left]).orbits(np.pi * share[left], means=False).D >= s_top[left]]
            share[left] *= 0.5
        return share

    def _samples(self, group, share):
        """Strips with the shares (m, nodes) of the period in contact: penetration, mean pressure (K A) and friction (K A kA),
        share, greatest pressure over the share, and where in contact that is, (m, nodes, 6)."""
        s_sat = np.broadcast_to(self.s_sat[group, None], share.shape)
        full = np.broadcast_to(self.full[group, None], share.shape)
        out = np.stack((s_sat, s_sat - 1, full, share, 2 * s_sat - 2, np.full(share.shape, 0.5)), axis=2)
        row, node = np.nonzero(share < 1)
        self.strips += row.size
        waves, part = self.foundation.waves(self.rate[group[row]]), np.maximum(share[row, node], _LEAST)
        orbits = waves.orbits(2 * np.pi * part).sure()
        greatest, place = _peaks(waves.pressure(orbits)) if self.carries else (part, part)
        values = (orbits.D, orbits.p_mean, orbits.tau_mean, share[row, node], greatest / part, place)
        out[row, node] = np.stack(values, axis=1)
        out[share == 0, :3] = 0.0
        return out

    def of(self, columns: LevelBatch) -> np.ndarray:
        """Which of its rates the ``columns`` have, (n,)."""
        return np.searchsorted(self.rate, columns.level.k * columns.V)

    def at(self, group: np.ndarray, s: np.ndarray, of: tuple) -> np.ndarray:
        """Quantities ``of`` the strips ``s`` (k, n) at the rates ``group`` (k,): (q, k, n). Raises ``SolverError`` for strips
        beyond those that the series was made for."""
        s_sat, top = self.s_sat[group, None], self.top[group, None]
        xi = _xi(s, s_sat)
        if (xi > (1 + _ROUNDING) * top).any():
            raise SolverError("a strip without adhesion lies beyond its family")
        out, x = np.empty((len(of), *s.shape)), np.minimum(2 * xi / top - 1, 1.0)
        for size in np.unique(self._size[group]):
            rows = np.flatnonzero(self._size[group] == size)
            which, place = np.unique(group[rows], return_inverse=True)
            # beyond their tails series have the next terms of means alone
            table = np.array([self._series[g][: None if of == CUT else -_NEXT, of] for g in which])
            out[:, rows] = np.moveaxis(evaluate_each(table[place], x[rows]), 2, 0)
        out[np.isin(of, (5, 6))] /= np.maximum(top * s_sat * np.sin(2 * xi), _TINY)
        return out

    def orbits(self, group: np.ndarray, s: np.ndarray) -> tuple[Waves, Orbits, np.ndarray]:
        """The strips ``s`` (k, n) at the rates ``group`` (k,), in a row: waves, orbits, and about where they press most."""
        share, _, place, slope = self.at(group, s, CONTACT).reshape(4, -1)
        nodes, s, missed = s.shape[1], s.ravel(), 0.0
        waves, allowed = self.foundation.waves(np.repeat(self.rate[group], nodes)), np.repeat(self.found[group], nodes)
        for step in range(1 + _STEPS):
            # contact is neither none nor all
            share = np.clip(share + slope * missed, _LEAST, 1 - _LEAST)
            orbits = waves.orbits(2 * np.pi * share, means=False)
            missed = s - orbits.D
            if step and (np.abs(missed) <= np.maximum(allowed, _ROUNDING * s)).all():
                break
        return waves, orbits.sure(), np.clip(place, 0.0, 1.0)


def _with_slopes_and_cut(c, goal):
    """Coefficients (n, 5) without a tail that doesn't matter, in steps, so that series of one size are evaluated together; with
    slopes of the first and the third behind them, and then, in more rows, the next terms of the first three."""
    tail = np.cumsum(np.abs(c[::-1, :3]), axis=0)[::-1]
    n = min(4 * -(-max(int(np.count_nonzero((tail > goal).any(axis=1))), 1) // 4), len(c))
    out, kept, cut = np.zeros((n + _NEXT, 10)), c[:n], c[n : n + _NEXT, :3]
    out[:n, :5], out[:n, 5:7], out[n : n + len(cut), 7:] = kept, 2 * derivatives(kept[:, [0, 2]]), cut
    return out


def errors_alone(c: np.ndarray, goal: np.ndarray) -> np.ndarray:
    """Errors of interpolants with coefficients ``c`` (m, n + 1, q), each quantity by itself, (m, q); a tenth of the ``goal``
    (m, q) doesn't matter."""
    m, n, q = c.shape
    alone = np.swapaxes(c, 1, 2).reshape(m * q, n, 1)
    return interpolation_errors(alone, np.broadcast_to(0.1 * goal, (m, q)).reshape(-1, 1)).reshape(m, q)


def _xi(s, s_sat):
    return np.arcsin(np.sqrt(np.clip(s / s_sat, 0.0, 1.0)))


def _peaks(pressure):
    """Greatest ``pressure`` in every contact, and its place: from looks at them that are closest at either end."""
    t = np.linspace(0, 1, _LOOKS)
    looks = pressure(mapped(t)[None])
    # the vertex of the parabola through the highest look and those next to it
    every, highest = np.arange(len(looks)), np.clip(looks.argmax(axis=1), 1, _LOOKS - 2)
    before, at, after = (looks[every, highest + k] for k in (-1, 0, 1))
    bend = before + after - 2 * at
    offset = np.divide(0.5 * (before - after), bend, out=np.zeros_like(bend), where=bend < 0)
    vertex = mapped(np.clip(t[highest] + offset * t[1], 0.0, 1.0))
    return np.maximum(pressure(vertex[:, None])[:, 0], looks.max(axis=1)), vertex
