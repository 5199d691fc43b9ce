"""All strips of a level at one velocity: the width of their contact as a function of the penetration over the amplitude.

Without adhesion alpha and beta are all that a strip has but for ``s = D/A``, and they are the same on the whole level.
Contact begins like a root of s and becomes complete like a root of ``s_sat - s``, ``s_sat = 1 + R``: over ``xi``, ``s
= s_sat sin^2 xi``, everything is smooth. The orbits are sampled over the width of their contact, where they are in
closed form and smooth as well, and resampled over xi. Newton's method goes on from there to the strip that is meant.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from ...errors import SolverError
from ...inputs.surface import Level
from ...numerics.chebyshev import derivatives, errors_alone, evaluate_each, lobatto, resampled
from ...numerics.quadrature import interleaved, mapped
from ...numerics.rounding import EPS, LARGEST
from ...orbit.foundation import Foundation
from ...orbit.nonadhesive import Orbits, Waves

#: nodes of the first attempt and of the last, and errors, relative to the largest, from which on Newton's method goes on; nothing
#: is sampled finer than this many roundings; and the share of what is allowed that is cut off a series
_FIRST, _LAST, _CLOSE, _FINEST, _TRIMMED = 16, 512, 1e-2, 256, 0.1
#: beyond its end by this, relative, nothing is asked of a series
_ROUNDING = 1e-12
#: beyond this k V times the longest retardation time the general path says what is wrong
_FASTEST = 1e100
#: looks at a contact for its greatest pressure
_LOOKS = 33
#: the least share of the period that a contact is looked at, and that a strip has of it or of what is left
_LEAST, _NONE = 1e-6, 1e-9
#: relative step of Newton's method after which there is another one, and how many there are
_STEP, _STEPS = 1e-5, 4


def are_families(foundation: Foundation, p_0: float, levels: Sequence[Level], V: np.ndarray) -> bool:
    """Whether the strips of all ``levels`` are families at the velocities ``V``: without adhesion (``p_0``), and wavy."""
    fastest = max(level.k for level in levels) * V.max(initial=0.0) * foundation.longest_time
    return p_0 == 0 and all(level.k * level.h**2 > 1 / LARGEST for level in levels) and bool(fastest < _FASTEST)


@dataclass(frozen=True)
class Family:
    """Strips at the rates ``k V`` (G,): ``s_sat`` (G,), and ``series``, coefficients (G, n, 6) over ``xi/top``: mean pressure
    (K A) and friction (K A kA), the share of the period in contact, the greatest pressure over that, its place, a share of the
    contact from the entry; and the slope of the share. ``errors`` (G, 3): of the first three. ``full`` (G,): friction in complete
    contact."""

    foundation: Foundation
    rate: np.ndarray
    s_sat: np.ndarray
    top: np.ndarray
    series: np.ndarray
    errors: np.ndarray
    full: np.ndarray

    def part(self, which: slice) -> Family:
        """The velocities ``which`` alone."""
        some = Family(self.foundation, *(getattr(self, field.name)[which] for field in fields(self)[1:]))
        return replace(some, series=some.series[:, : np.flatnonzero(some.series.any(axis=(0, 2))).max(initial=0) + 1])

    def values(self, group: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Of the strips ``s`` (m, nodes), all of row i at the velocity ``group[i]``, what there are series of, and the slope of
        the share by s, (m, nodes, 6). Raises ``SolverError`` for strips beyond those that the series was made for."""
        xi, top = _xi(s, self.s_sat[group, None]), self.top[group, None]
        if (xi > (1 + _ROUNDING) * top).any():
            raise SolverError("a strip without adhesion lies beyond its family")
        out = evaluate_each(self.series[group], np.clip(2 * xi / top - 1, -1.0, 1.0))
        # twice the derivative over [0, 1] that was a derivative over [-1, 1]
        out[..., 5] *= 2 / np.maximum(top * self.s_sat[group, None] * np.sin(2 * xi), 1 / LARGEST)
        return out

    def orbits(self, group: np.ndarray, s: np.ndarray, share: np.ndarray, slope: np.ndarray) -> tuple[Waves, Orbits]:
        """The strips ``s`` (N,) at the velocities ``group`` (N,), from the ``share`` of the period in contact that a series has,
        and its ``slope``, (N,). Raises ``SolverError`` for one that is not certified."""
        waves = self.foundation.waves(self.rate[group])
        share, rows, some = _inside(share), np.arange(s.size), waves
        for _ in range(_STEPS):
            before = share[rows]
            after = _inside(before + slope[rows] * (s[rows] - some.orbits(2 * np.pi * before, means=False).D))
            share[rows] = after
            rows = rows[np.abs(after - before) > _STEP * np.minimum(after, 1 - after)]
            if not rows.size:
                break
            some = waves.take(rows)
        return waves, waves.orbits(2 * np.pi * share, means=False).sure()


def family(
    foundation: Foundation, rate: np.ndarray, s_top: np.ndarray, accuracy: np.ndarray, carries: np.ndarray | bool = True
) -> tuple[Family, int]:
    """Families at the rates ``k V`` (G,), up to the penetrations ``s_top`` (G,), pressure and friction to the ``accuracy`` (G,)
    in their units; and how many strips that took. Where it ``carries`` (G,), contacts are looked at for peaks. Where the accuracy
    is not reached, the error says so. Raises ``SolverError`` for a strip that is not certified."""
    R = np.broadcast_to(foundation.modulus_ratio(rate), rate.shape)
    # a level of height h averages K A kA loss/2 over its strips, and the mean of A^2 is 3 h^2/32
    full = foundation.saturation_friction(2 * np.pi, 1.0, rate) * 32 / (3 * foundation.K)
    phi, strips = _reaching(foundation, rate, s_top)
    complete = np.stack((1 + R, R, full, np.ones_like(R), 2 * R, np.full_like(R, 0.5)), axis=1)
    series, G = np.zeros((rate.size, _LAST + 1, 6)), rate.size
    out = Family(foundation, rate, 1 + R, np.zeros(G), series, np.zeros((G, 3)), full)
    left, n, samples, carries = np.arange(G), _FIRST, None, np.broadcast_to(carries, (G,))
    while left.size:
        share = phi[left, None] * (lobatto(n) if samples is None else lobatto(n)[1::2])
        fresh = _samples(foundation, rate[left], complete[left], share, carries[left])
        strips += int(np.count_nonzero((share > 0) & (share < 1)))
        samples = fresh if samples is None else interleaved(samples, fresh)
        xi = _xi(samples[:, :, 0], out.s_sat[left, None])
        top = np.maximum(xi[:, -1:], np.finfo(float).tiny)
        c = resampled(np.maximum.accumulate(xi / top, axis=1), samples[:, :, 1:])
        greatest = np.abs(samples[:, :, 1:4]).max(axis=1)
        goal = np.minimum(accuracy[left, None] * (1.0, 1.0, np.inf), _CLOSE * greatest)
        goal = np.maximum(goal, _FINEST * EPS * greatest)
        error = errors_alone(c[:, :, :3], goal)
        done = (error <= goal).all(axis=1) | (n == _LAST)
        tail = np.cumsum(np.abs(c[:, ::-1, :3]), axis=1)[:, ::-1]
        c[(tail <= _TRIMMED * goal[:, None]).all(axis=2)] = 0.0
        out.top[left], out.errors[left] = xi[:, -1], error + _TRIMMED * goal
        series[left, : n + 1] = np.concatenate((c, derivatives(c[:, :, 2:3])), axis=2)
        left, samples, n = left[~done], samples[~done], 2 * n
    return out, strips


def _xi(s, s_sat):
    return np.arcsin(np.sqrt(np.clip(s / s_sat, 0.0, 1.0)))


def _inside(share):
    """Shares of the period of contacts, neither none nor all."""
    return np.clip(share, _NONE, 1 - _NONE)


def _reaching(foundation, rate, s_top):
    """Shares of the period in contact that strips up to ``s_top`` (G,) have at most, half of one being too little; and how many
    strips that took."""
    # w is nowhere negative, so contact lies where the profile is below the plane
    phi = np.where(s_top < 2, 2 / np.pi * np.arcsin(np.sqrt(0.5 * np.minimum(s_top, 2.0))), 1.0)
    left, strips = np.flatnonzero(phi > 0), 0
    while left.size:
        strips += left.size
        far = foundation.waves(rate[left]).orbits(np.pi * phi[left], means=False).D >= s_top[left]
        left = left[far]
        phi[left] *= 0.5
    return phi, strips


def _samples(foundation, rate, complete, phi, carries):
    """Samples (m, nodes, 6) at shares of the period in contact ``phi`` (m, nodes): s, then the quantities; those at 1 are
    ``complete`` (m, 6), at 0 there are but the limits of the last two, which only rows with ``carries`` (m,) have."""
    out = np.repeat(complete[:, None], phi.shape[1], axis=1)
    row, node = np.nonzero(phi < 1)
    if row.size:
        share, waves = np.maximum(phi[row, node], _LEAST), foundation.waves(rate[row])
        orbits = waves.orbits(2 * np.pi * share).sure()
        out[row, node, :4] = np.stack((orbits.D, orbits.p_mean, orbits.tau_mean, share), axis=1)
        some = np.flatnonzero(carries[row])
        greatest, place = _peaks(waves.pressure(orbits), some)
        out[row[some], node[some], 4:] = np.stack((greatest / share[some], place), axis=1)
    out[phi == 0, :4] = 0.0
    return out


def _peaks(pressure, rows):
    """Greatest ``pressure`` in the contacts ``rows``, and its place: from looks at them that are closest at either end."""
    t = np.linspace(0, 1, _LOOKS)
    looks = pressure(np.broadcast_to(mapped(t), (rows.size, _LOOKS)), rows)
    # the vertex of the parabola through the highest look and those next to it
    every, highest = np.arange(rows.size), np.clip(looks.argmax(axis=1), 1, _LOOKS - 2)
    before, at, after = (looks[every, highest + k] for k in (-1, 0, 1))
    bend = before + after - 2 * at
    offset = np.divide(0.5 * (before - after), bend, out=np.zeros_like(bend), where=bend < 0)
    vertex = mapped(np.clip(t[highest] + offset * t[1], 0.0, 1.0))
    return np.maximum(pressure(vertex[:, None], rows)[:, 0], looks.max(axis=1)), vertex
