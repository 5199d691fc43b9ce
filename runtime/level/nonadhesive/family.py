"""All strips of a level at one velocity: their means as functions of the penetration over the amplitude.

Without adhesion alpha and beta are all that a strip has but for ``s = D/A``, and they are the same on the whole level.
Contact begins like a root of s and becomes complete like a root of ``s_sat - s``, ``s_sat = 1 + R``: over ``xi``, ``s
= s_sat sin^2 xi``, everything is smooth. The orbits are sampled over the width of their contact, where they are in
closed form and smooth as well, and resampled over xi.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from ...errors import SolverError
from ...inputs.surface import Level
from ...numerics.chebyshev import clenshaw, coefficients, derivatives, evaluate_each, interpolation_errors, lobatto
from ...numerics.quadrature import interleaved, mapped
from ...numerics.roots import rising_root
from ...numerics.rounding import EPS, LARGEST
from ...orbit.foundation import Foundation

#: nodes of the first attempt and of the last
_FIRST, _LAST = 8, 512
#: so many coefficients that are cut off a series are known to whoever asks what they would add
_NEXT = 4
#: beyond its end by this, relative, nothing is asked of a series
_ROUNDING = 1e-12
#: nothing is sampled finer than this many roundings; and the share of what is allowed that is cut off a series
_FINEST, _TRIMMED = 256, 0.03
#: beyond this k V times the longest retardation time the general path says what is wrong
_FASTEST = 1e100
#: quantities of a strip that are averaged, mean pressure, mean friction and share of the period in contact; of its contact that,
#: the greatest pressure over it, and where that is, a share of the contact from the entry; then what is cut off the series of
#: the means; and how well the share has to be known beside the others: as well as it comes
MEANS, CONTACT, CUT, _ANY = slice(0, 3), slice(2, 5), slice(5, 8), 1e30
#: looks at a contact for its greatest pressure
_LOOKS = 33
#: the least share of the period that a contact is looked at
_LEAST = 1e-6


def are_families(foundation: Foundation, p_0: float, levels: Sequence[Level], V: np.ndarray) -> bool:
    """Whether the strips of all ``levels`` are families at the velocities ``V``: without adhesion (``p_0``), and wavy."""
    fastest = max(level.k for level in levels) * V.max(initial=0.0) * foundation.longest_time
    return p_0 == 0 and all(level.k * level.h**2 > 1 / LARGEST for level in levels) and bool(fastest < _FASTEST)


@dataclass(frozen=True)
class Family:
    """Strips at velocities (G,): ``s_sat`` (G,), and ``series``, coefficients (n, 8) for each, of mean pressure (K
    A), mean friction (K A kA), contact fraction, greatest pressure (K A) over that, and its place, over ``xi/top``; and of what
    the next terms would add to the means. ``degree`` (G,): up to that terms are known; ``errors`` (G, 3): bounds of what all
    others would add, but rough ones of contact; ``greatest_errors`` (G, 3): with the next terms. ``full`` (G,): friction in
    complete contact, at s_sat."""

    s_sat: np.ndarray
    top: np.ndarray
    series: list[np.ndarray]
    degree: np.ndarray
    errors: np.ndarray
    greatest_errors: np.ndarray
    full: np.ndarray

    def part(self, which: slice) -> Family:
        """The velocities ``which`` alone."""
        return Family(*(getattr(self, field.name)[which] for field in fields(self)))

    def values(self, group: np.ndarray, s: np.ndarray, slopes: bool = False, of: slice = MEANS) -> np.ndarray:
        """Quantities ``of`` the strips ``s`` (m, nodes), all of row i at the velocity ``group[i]``: (m, nodes, q), or with
        their ``slopes`` by s (m, nodes, 2 q). Raises ``SolverError`` for strips beyond those that the series was made for."""
        xi, q = _xi(s, self.s_sat[group, None]), of.stop - of.start
        if (xi > (1 + _ROUNDING) * self.top[group, None]).any():
            raise SolverError("a strip without adhesion lies beyond its family")
        out = np.empty((*s.shape, 2 * q if slopes else q))
        sizes = np.array([self.series[g].shape[0] for g in group])
        kept = None if of == CUT else -_NEXT
        for n in np.unique(sizes):
            rows = np.flatnonzero(sizes == n)
            some = slice(None) if rows.size == group.size else rows
            which, place = np.unique(group[some], return_inverse=True)
            table = np.array([self.series[g][:kept, of] for g in which])
            if slopes:
                table = np.concatenate((table, derivatives(table)), axis=2)
            x = 2 * xi[some] / self.top[group[some], None] - 1
            out[some] = evaluate_each(table[place], np.clip(x, -1.0, 1.0))
        if slopes:
            # by s: twice the derivative over [0, 1] that was a derivative over [-1, 1]
            by_s = self.s_sat[group, None] * np.sin(2 * xi) * 0.5 * self.top[group, None]
            out[..., q:] /= np.maximum(by_s, np.finfo(float).tiny)[..., None]
        return out


def family(
    foundation: Foundation, rate: np.ndarray, s_top: np.ndarray, accuracy: np.ndarray, carries: np.ndarray | bool = True
) -> tuple[Family, int]:
    """Families at the rates ``k V`` (G,), up to the penetrations ``s_top`` (G,), to the ``accuracy`` (G,) of pressure and
    friction in their units; and how many strips that took. Where it ``carries`` (G,), contacts are looked at for peaks.

    Where that is not reached, the error says so. Raises ``SolverError`` for a strip that is not certified.
    """
    G = rate.size
    R = np.broadcast_to(foundation.modulus_ratio(rate), (G,))
    s_sat = 1 + R
    full = _full_friction(foundation, rate)
    complete = np.stack((s_sat, R, full, np.ones(G), 2 * R, np.full(G, 0.5)), axis=1)
    phi, strips = _reaching(foundation, rate, s_top)
    carries = np.broadcast_to(carries, (G,))
    series: list[np.ndarray] = [np.empty(0)] * G
    out = Family(s_sat, np.zeros(G), series, np.zeros(G, int), np.zeros((G, 3)), np.zeros((G, 3)), full)
    left, n, samples = np.arange(G), _FIRST, None
    while left.size:
        share = phi[left, None] * (lobatto(n) if samples is None else lobatto(n)[1::2])
        fresh = _samples(foundation, rate[left], complete[left], share, carries[left])
        strips += int(np.count_nonzero((share > 0) & (share < 1)))
        samples = fresh if samples is None else interleaved(samples, fresh)
        s, values = samples[:, :, 0], samples[:, :, 1:4]
        over = _resampled(samples, s_sat[left])
        greatest = np.abs(values).max(axis=1)
        goal = np.maximum(accuracy[left, None] * (1.0, 1.0, _ANY), _FINEST * EPS * greatest)
        # what is not known of a strip's penetration moves all along their slopes
        step = np.diff(s, axis=1)[:, :, None]
        slopes = np.abs(np.divide(np.diff(values, axis=1), step, out=np.zeros((*step.shape[:2], 3)), where=step > 0)).max(axis=1)
        sampled = errors_alone(coefficients(samples[:, :, :4]), np.concatenate((goal.min(axis=1, keepdims=True), goal), axis=1))
        error = errors_alone(over[:, :, MEANS], goal) + sampled[:, 1:] + slopes * sampled[:, :1] + 16 * EPS * greatest
        error += 4 * EPS * (s_sat[left] * s[:, -1])[:, None]
        done = (error <= goal).all(axis=1) | (n == _LAST)
        for k in np.flatnonzero(done):
            g = left[k]
            size = _needed(over[k], _TRIMMED * goal[k])
            out.series[g] = np.zeros((size + _NEXT, 8))
            out.series[g][:size, :5] = over[k, :size]
            cut = over[k, size : size + _NEXT, MEANS]
            out.series[g][size : size + len(cut), CUT] = cut
            out.degree[g] = n
            out.errors[g] = error[k] + np.abs(over[k, size + _NEXT :, MEANS]).sum(axis=0)
            out.greatest_errors[g] = error[k] + np.abs(over[k, size:, MEANS]).sum(axis=0)
            out.top[g] = _xi(s[k, -1], s_sat[g])
        left, samples, n = left[~done], samples[~done], 2 * n
    return out, strips


def errors_alone(c: np.ndarray, goal: np.ndarray) -> np.ndarray:
    """Errors of interpolants with coefficients ``c`` (m, n + 1, q), each quantity by itself, (m, q); a tenth of the ``goal``
    (m, q) doesn't matter."""
    m, n, q = c.shape
    alone = np.swapaxes(c, 1, 2).reshape(m * q, n, 1)
    return interpolation_errors(alone, 0.1 * goal.reshape(-1, 1)).reshape(m, q)


def _xi(s, s_sat):
    return np.arcsin(np.sqrt(np.clip(s / s_sat, 0.0, 1.0)))


def _needed(c, goal):
    """How many coefficients there are before a tail that doesn't matter; in steps, so that series of one size are evaluated
    together."""
    tail = np.cumsum(np.abs(c[::-1, MEANS]), axis=0)[::-1]
    n = int(np.count_nonzero((tail > goal).any(axis=1)))
    return min(4 * -(-max(n, 1) // 4), len(c))


def _full_friction(foundation, rate):
    """In complete contact, K A kA: half the loss modulus."""
    # a level of height h averages K A kA loss/2 over its strips, and the mean of A^2 is 3 h^2/32
    l = 2 * np.pi  # noqa: E741
    return foundation.saturation_friction(l, 1.0, rate) * 32 / (3 * foundation.K)


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


def _resampled(samples, s_sat):
    """Coefficients over xi/xi_top of quantities of which, and of s before them, there are ``samples`` (m, n + 1, 6) at
    ``lobatto(n)`` of the width of contact."""
    (m, size, _), s = samples.shape, samples[:, :, 0]
    both, nodes = coefficients(samples), lobatto(size - 1)
    goal = s_sat[:, None] * np.sin(_xi(s[:, -1], s_sat)[:, None] * nodes) ** 2
    # x in [-1, 1] at which s is the goal; the root of s is nearly linear in it
    known = np.sqrt(np.maximum.accumulate(s, axis=1))
    guess = np.array([np.interp(g, row, 2 * nodes - 1) for g, row in zip(np.sqrt(goal), known, strict=True)])
    rise = np.concatenate((both[:, :, :1], derivatives(both[:, :, :1])), axis=2).transpose(1, 2, 0)
    row, wanted, inside = np.repeat(np.arange(m), size - 2), goal[:, 1:-1].ravel(), guess[:, 1:-1].ravel()

    def over(x, index):
        place, slope = clenshaw(rise, row[index], x)
        return place - wanted[index], slope

    x = np.tile(2 * nodes - 1, (m, 1))
    x[:, 1:-1] = rising_root(over, np.full(row.size, -1.0), np.ones(row.size), inside).reshape(m, size - 2)
    return coefficients(evaluate_each(both[:, :, 1:], x))
