"""Friction laws of levels without adhesion over nominal pressure, as Chebyshev series between their breaks.

A law is not smooth at p = 0, where the crests touch (its powers are those of ``p^(1/4)``); at D = h, where the strips at the edge
of the cell come into contact; where the level is in complete contact; and where all below it is. Towards these pressures it has
roots of the distance. It is sampled over penetration, where these are known, and resampled over pressure.
Penetrations at which a level carries given pressures are roots of its mean pressure.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...numerics.chebyshev import lobatto, resampled
from ...numerics.quadrature import interleaved
from ...numerics.roots import falling_root
from ...numerics.rounding import EPS, LARGEST
from ...orbit.foundation import foundation_of
from ..averages import level_means
from ..saturated import Saturation
from ..strips import LevelBatch, cut_penetration
from .average import Span, completely
from .family import CONTACT, SEARCH, Family, errors_alone

#: nodes of a piece, tried in turn
_NODES = (16, 32, 64, 128)
#: of what is allowed, what the values of a law may err, and what a strip's means may; they are known this well at least
_VALUES, _STRIPS, _COARSE = 0.6, 2.0, 1e-2
#: what is left in a mean of a law's error: along its pieces errors change sign, but so much of a piece errs alike. With 0.08 and
#: 0.02, which do for the bounds of ``lower_levels``, one of 448 points erred by more than it said
_CANCELLED, _ALIKE = 0.3, 0.05
#: how much steeper a law is feared to be beyond its end
_FEARED = 2.0
#: slopes of a law are looked at over steps of at least this share of the pressure
_STEP = 1e-3
#: an accuracy in parts of the greatest friction from which on a law is only parted where it is least smooth
_BLUNT = 1e-4
#: by how much more a greatest pressure is allowed for, and a penetration; and ends of pieces that are one, relative
_BETWEEN, _FURTHER, _SAME = 1.02, 1e-3, 1e-6
#: strips that penetrations are looked for with, and how well, relative
_SEARCH, _NEAR = 18, 1e-7


@dataclass(frozen=True)
class FamilyLaws:
    """Laws of a level at velocities (G,), in J pieces: ``ends`` (2, G, J), the pressures between which each lies, inf for none,
    and ``series`` (G, J, n, q) over ``omega``. ``breaks`` (G, 3): the pressures that part the sharpest of them, ascending, inf
    for none; from ``p_full`` (G,) on everything below is saturated, with the means ``full`` (G, q). ``top`` (G,): as far as the
    law goes, beyond it stays what it is there; ``steepest`` (G,): the greatest slope of friction, own and carried, over pressure.
    Quantities: those of the level but for pressure, then the error of its friction, Pa; ``scales`` (q,): their natural scales."""

    ends: np.ndarray
    series: np.ndarray
    breaks: np.ndarray
    p_full: np.ndarray
    full: np.ndarray
    top: np.ndarray
    steepest: np.ndarray
    scales: np.ndarray

    def averages(self, group: np.ndarray, owner: np.ndarray, p: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """Sums (m, q) over the nodes of each column, ``group`` (m,) its law, of the law at ``p`` by ``weight``
        (nodes,); ``owner`` (nodes,), ascending: the column of each node."""
        g = group[owner]
        saturated = p >= self.p_full[g]
        out = np.bincount(owner[saturated], weight[saturated], minlength=group.size)[:, None] * self.full[group]
        beyond = np.where(saturated, 0.0, np.maximum(p - self.top[g], 0.0))
        if beyond.any():
            out[:, -1] += _FEARED * np.bincount(owner, weight * beyond, minlength=group.size) * self.steepest[group]
        todo = ~saturated & (p > 0)
        for j in reversed(range(self.series.shape[1])):
            index = np.flatnonzero(todo & (p >= self.ends[0, g, j]))
            todo[index] = False
            if index.size:
                which, start = np.unique(owner[index], return_index=True)
                low, high = self.ends[:, g[index], j]
                share = np.minimum((p[index] - low) / (high - low), 1.0)
                x = 4 / np.pi * np.arcsin(np.sqrt(np.sqrt(share) if j == 0 else share)) - 1
                moments = _moments(x, weight[index], start, self.series.shape[2])
                found = np.einsum("km,mkq->mq", moments, self.series[group[which], j])
                span = 0.5 * (np.maximum.reduceat(x, start) - np.minimum.reduceat(x, start))
                found[:, -1] *= np.maximum(_ALIKE / np.maximum(span, _ALIKE), _CANCELLED)
                out[which] += found
        return out


def _moments(x, weight, start, count):
    """Weighted sums of Chebyshev polynomials over runs of nodes that begin at ``start``, (count, runs)."""
    out = np.empty((count, start.size))
    out[0] = np.add.reduceat(weight, start)
    before, now, twice = weight, weight * x, 2 * x
    for k in range(1, count):
        out[k] = np.add.reduceat(now, start)
        before, now = now, twice * now - before
    return out


def with_family(columns: LevelBatch, D: np.ndarray, friction: np.ndarray, carries: bool) -> LevelBatch:
    """The ``columns`` with their family up to ``D`` (n,), m, known to ``friction`` (n,), Pa; whether it ``carries`` a level."""
    h, k = columns.level.h, columns.level.k
    rate, row = np.unique(k * columns.V, return_inverse=True)
    d, accuracy = np.full(rate.size, EPS), np.full(rate.size, _COARSE)
    np.maximum.at(d, row, D / h)
    # what is not known of pressures counts by the slope of the friction, hardly above k h
    np.minimum.at(accuracy, row, _STRIPS * friction / (columns.material.K * h * k * h))
    family = Family(foundation_of(columns.material), rate, np.where(d < 1, 2 * d, np.inf), accuracy, carries)
    columns.work.solved += family.strips
    return replace(columns, family=family)


def penetrations(columns: LevelBatch, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """About the penetrations (m) at which ``columns`` that have a family carry ``p`` > 0 (Pa, (n,)), below saturation, and the
    slopes of the logarithm of pressure over that of penetration."""
    group, family, h = columns.family.of(columns), columns.family, columns.level.h
    p = p / (columns.material.K * h)
    s_sat, slope = family.s_sat[group], np.ones(p.size)

    def missing(log_d, index):
        d, at = np.exp(log_d), group[index]
        u, s, weight = Span(d, s_sat[index]).nodes(_SEARCH)
        mean, mean_slope = family.at(at, s, SEARCH)
        rest, complete = completely(d, s_sat[index])
        pressure = np.maximum((0.5 * u * weight * mean).sum(axis=1) + complete, np.finfo(float).tiny)
        # s rises by 2/u with d
        rise = (weight * mean_slope).sum(axis=1) + rest / np.pi
        slope[index] = rise * d / pressure
        return -np.log(pressure / p[index]), -slope[index]

    low, high = np.log(p), np.log(np.minimum(p + 0.75, 0.5 * s_sat))
    # crests are paraboloids next to the plane: at rest they carry d^2/(2 pi)
    return h * np.exp(falling_root(missing, low, high, 0.5 * np.log(2 * np.pi * p), _NEAR)), slope


def crest_pressure(columns: LevelBatch) -> np.ndarray:
    """Greatest local pressure of ``columns`` with a family, Pa, (n,)."""
    family, level = columns.family, columns.level
    group, d = family.of(columns), columns.D / level.h
    out = np.maximum(d - 1 + 0.5 * family.s_sat[group], 0.0)
    part = np.flatnonzero((d > 0) & (d < 0.5 * family.s_sat[group]))
    share, over, *_ = family.at(group[part], 2 * d[part, None], CONTACT)[:, :, 0]
    out[part] = np.minimum(out[part], 0.5 * _BETWEEN * share * over)
    return columns.material.K * level.h * out


def tolerances(columns: LevelBatch, friction: np.ndarray, fraction: np.ndarray) -> np.ndarray:
    """Absolute tolerances (n, q) of ``columns`` by those of ``friction``, Pa, and of a ``fraction`` of the surface, (n,) each;
    errors that are carried ask for nothing.

    Frictions of all levels add up, whatever their scales; and friction rises with pressure hardly faster than k h."""
    atol = np.full((columns.size, columns.scales.size), LARGEST)
    atol[:, columns.frictions], atol[:, columns.fractions] = friction[:, None], fraction[:, None]
    atol[:, 0] = friction / (columns.level.k * columns.level.h)
    return atol


def lower_laws(
    levels: Sequence[LevelBatch], saturated: Sequence[Saturation], p_max: np.ndarray, rtol: float, friction, fraction
) -> FamilyLaws:
    """The laws of level 2 with all that it carries, from the smallest upwards: ``levels`` 2 and below at velocities (G,), up
    to the pressures ``p_max`` (G,), Pa, to ``rtol``, ``friction``, Pa, and a ``fraction`` of the surface, (G,)."""
    reached = []
    for columns, full in zip(levels, saturated, strict=True):
        carries, K, h = columns.level is not levels[-1].level, columns.material.K, columns.level.h
        columns = with_family(columns, cut_penetration(columns, p_max, full.D), friction, carries)
        D = p_max / K + columns.level.mean_plane
        part = np.flatnonzero((p_max > 0) & (D < 0.5 * h * columns.family.s_sat))
        D[part] = (1 + _FURTHER) * penetrations(columns.at(part, D[part]), p_max[part])[0]
        reached.append(replace(columns, D=np.minimum(D, full.D)))
        p_max = crest_pressure(reached[-1]) if carries else p_max
    laws = None
    for columns, full in zip(reached[::-1], saturated[::-1], strict=True):
        laws = _law(replace(columns, carry=laws, group=np.arange(columns.size)), full, rtol, friction, fraction)
    return laws


def _law(columns: LevelBatch, saturated: Saturation, rtol, friction, fraction) -> FamilyLaws:
    """The law of ``columns`` up to their penetrations."""
    K, h, top, zero = columns.material.K, columns.level.h, columns.D, np.zeros((columns.size, 1))
    D_sat = 0.5 * columns.family.s_sat * h
    cuts = [zero, zero + h, D_sat[:, None], top[:, None]]
    if columns.carry is not None:
        # where the pressure at the edges of the cells, all one, passes a break of the law below
        sharp = friction < _BLUNT * saturated.means[:, columns.frictions].sum(axis=1)
        cuts.append(h + np.where(sharp[:, None], columns.carry.breaks, np.inf) / K)
    cuts = np.sort(np.minimum(np.concatenate(cuts, axis=1), top[:, None]), axis=1)
    near = np.diff(cuts, axis=1) <= _SAME * np.minimum(cuts[:, 1:], h)
    for j, same in enumerate(near.T):
        cuts[same, j + 1] = cuts[same, j]
    ends, series, steepest = _pieces(columns, cuts, rtol, friction, fraction)
    p_top = np.where(np.isfinite(ends[1]), ends[1], 0.0).max(axis=1)
    edge = np.where(cuts[:, 1:] == h, ends[1], np.inf).min(axis=1)
    p_full = np.where(top >= saturated.D, saturated.p, np.inf)
    breaks = np.stack((edge, K * (D_sat - columns.level.mean_plane), p_full), axis=1)
    breaks = np.sort(np.where(breaks < np.where(np.isinf(p_full), p_top, np.inf)[:, None], breaks, np.inf), axis=1)
    scales = np.concatenate((columns.scales[1:], [LARGEST]))
    return FamilyLaws(ends, series, breaks, p_full, np.column_stack((saturated.means[:, 1:], zero)), p_top, steepest, scales)


def _pieces(columns: LevelBatch, cuts: np.ndarray, rtol: float, friction, fraction) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pieces between the penetrations ``cuts`` (G, J + 1) of each law, all together: their ends in pressure (2, G, J) and series
    (G, J, n, q); and of each law the greatest slope of friction."""
    (G, J), q = (columns.size, cuts.shape[1] - 1), columns.scales.size
    group, piece = np.nonzero(np.diff(cuts, axis=1) > 0)
    low, width = cuts[group, piece], np.diff(cuts, axis=1)[group, piece]
    ends, steepest, series = np.full((2, G, J), np.inf), np.zeros(G), np.zeros((G, J, 0, q))
    left, known = np.arange(group.size), None
    for n in _NODES:
        if not left.size:
            break
        t = lobatto(n) if known is None else lobatto(n)[1::2]
        D = low[left, None] + width[left, None] * np.sin(0.5 * np.pi * t) ** 2
        every = np.repeat(group[left], t.size)
        at = columns.at(every, D.ravel())
        tolerance = _VALUES * tolerances(at, friction[every], fraction[every])
        means = level_means(at, np.full(D.size, _VALUES * rtol), tolerance)
        errors = means.errors[:, columns.frictions].sum(axis=1), means.errors[:, 0]
        fresh = np.column_stack((means.values, *errors)).reshape(*D.shape, q + 2)
        known = fresh if known is None else interleaved(known, fresh)
        total, step = known[:, :, columns.frictions].sum(axis=2), np.diff(known[:, :, 0], axis=1)
        # differences of pressures that rounding or quadrature would make slopes of are none
        resolved = step > _STEP * known[:, -1:, 0]
        slope = np.divide(np.abs(np.diff(total, axis=1)), step, out=np.zeros_like(step), where=resolved).max(axis=1)
        goal = (rtol * total.min(axis=1) + friction[group[left]])[:, None]
        fitted, miss = _fit(known[:, :, :q], piece[left] == 0, columns.frictions, goal)
        done = (miss <= goal).all(axis=1) | (n == _NODES[-1])
        error = (known[:, :, -2] + slope[:, None] * known[:, :, -1]).max(axis=1)
        fitted[:, 0, -1] = miss[:, 0] + error
        which = group[left[done]], piece[left[done]]
        series = np.concatenate((series, np.zeros((G, J, n + 1 - series.shape[2], q))), axis=2)
        series[which], ends[:, *which] = fitted[done], known[done][:, [0, -1], 0].T
        np.maximum.at(steepest, which[0], slope[done])
        left, known = left[~done], known[~done]
    return ends, series, steepest


def _fit(values: np.ndarray, quartic: np.ndarray, frictions: np.ndarray, goal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Series (m, n + 1, q) over ``omega`` of all but the pressure, the last one for an error, through the ``values``
    (m, n + 1, q) of pieces at ``lobatto(n)`` of penetration; and what they miss of all friction, and of that of each level,
    (m, 1 + levels), of which a tenth of the ``goal`` (m, 1) doesn't matter."""
    p, omega = np.maximum.accumulate(values[:, :, 0], axis=1), lobatto(values.shape[1] - 1)
    share = np.sin(0.5 * np.pi * omega) ** np.where(quartic, 4, 2)[:, None]
    rest = np.concatenate((values[:, :, 1:], 0 * values[:, :, :1]), axis=2)
    fitted = resampled(p, p[:, :1] + (p[:, -1:] - p[:, :1]) * share, rest)
    of = fitted[:, :, frictions - 1]
    return fitted, errors_alone(np.concatenate((of.sum(axis=2, keepdims=True), of), axis=2), goal)
