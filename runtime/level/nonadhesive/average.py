"""Means of a level without adhesion: over its strips, and over the contact of each where the level below has a law (Eq. 13).

What is carried is not smooth where a pressure passes a break of the law, along a strip or as the strips' greatest: cut there.

With ``u = cos^2(theta/2)`` a strip has the amplitude ``h u/2`` and ``s = 2 - 2 (1 - D/h)/u``. Where the crests of the
cell's edge are out of reach, D < h, contact ends at u = 1 - D/h; else the strips of small u are in complete contact,
from ``s = s_sat`` on. Hyperbolic functions of ``eta`` for ``u/|1 - D/h|`` make all scales alike however near D is to h; the
crest of the level is where eta is greatest, and the root of the distance from it takes the root out of the integrand there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...numerics.gauss import graded_gauss
from ...numerics.quadrature import by_rules, gauss, mapped, mapped_slope
from ...numerics.roots import falling_root
from ...numerics.rounding import EPS
from ...orbit.contact import passages
from .family import CONTACT, CUT, MEANS, Family

if TYPE_CHECKING:
    from ..strips import LevelBatch

#: nodes over a panel of strips and over each part of a contact, tried in turn; and over all strips where nothing is carried
_RULES = ((2, 3), (4, 6), (7, 9), (11, 14), (16, 20), (24, 30), (36, 44), (54, 66), (81, 98))
_ALONE = (10, 15, 22, 33, 50, 75, 112)
#: how much more than by the next terms of a series its values are feared to err; strips for means of what series leave out; means
#: of Chebyshev polynomials in pressure, friction, contact times their degree, where that is not low: medians of 40 surfaces
_SURE, _NODES, _FEW, _PACE = 3.0, 30, 32, (1.25, 0.6, 2.5)
#: share of what is allowed that these sums may miss, and the fastest that they are believed to converge, alone and over contacts:
#: of 1,014 random points of two and three levels four erred by more than they said, by a third at most
_QUADRATURE, _FASTEST = 0.7, (0.01, 0.03)
#: how closely it is known where a contact's pressure, and the greatest ones of strips, pass the breaks of the law
_CLOSE, _CLOSER = 1e-4, 1e-5
#: least penetration in heights: squares of what is smaller underflow
_LEAST = 1e-60
#: nodes of all parts together, about, that are summed at a time: what is known of them stays in the cache
_CHUNK = 30_000


def family_means(columns: LevelBatch, rtol: np.ndarray, atol: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Means of ``columns`` that have a family to ``rtol |value| + atol``, ``rtol`` (n,), ``atol`` (n, q); and their errors."""
    values, errors = np.zeros((2, columns.size, columns.scales.size))
    index = np.flatnonzero(columns.D > 0)
    sums, own = _Sums(columns.at(index, columns.D[index])), slice(0, 3)
    rtol, atol = _QUADRATURE * rtol[index, None], _QUADRATURE * atol[index]
    values[index, own], errors[index, own] = by_rules(sums.own, _ALONE, atol[:, own], rtol, _FASTEST[0])
    errors[index, own] += sums.of_series()
    if columns.carry is not None:
        q = columns.carry.scales.size
        values[index, -q:], errors[index, -q:] = by_rules(sums.carried, _RULES, atol[:, -q:], rtol, _FASTEST[1], at_once=True)
    return values, errors


class Span:
    """Strips in partial contact at ``d = D/h`` (m,), 0 < d < s_sat/2: eta between ``low`` and ``high``, ``length`` apart."""

    def __init__(self, d: np.ndarray, s_sat: np.ndarray):
        d = np.maximum(d, _LEAST)
        self.under, self.even = d < 1, d == 1
        self.off = np.where(self.even, 1.0, np.abs(d - 1))
        part = partly(d, s_sat)
        high, low = (np.sqrt(v / self.off) for v in (np.where(self.under, d, 1.0), 1 - part))
        # next to saturation both are the same but for rounding
        apart = np.where(self.under, d, part) / self.off
        self.length = np.arcsinh(np.maximum(apart / (high * np.hypot(1, low) + low * np.hypot(1, high)), _LEAST))
        self.high = np.arcsinh(high)
        self.low = self.high - self.length

    def strips(self, column: np.ndarray, eta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """u and s of the strips at ``eta`` (k, n) of the columns (k,)."""
        under = self.under[column, None]
        sinh, cosh = np.sinh(eta), np.cosh(eta)
        u = self.off[column, None] * np.where(under, cosh, sinh) ** 2
        with np.errstate(divide="ignore"):
            s = np.where(under, 2 * (sinh / cosh) ** 2, 2 + 2 / sinh**2)
        # at d = 1 all strips are alike
        s[self.even[column]] = 2.0
        return u, s

    def at(self, column: np.ndarray, root: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """u, s and weights in the mean over the cell of the strips of the columns (k,) at ``root`` (k, n), that of the distance
        of eta from the crest, of which each stands for the ``share`` (k, n)."""
        crest, rest = self.high[column, None], root * root
        eta = np.maximum(crest - rest, self.low[column, None])
        slope = np.where(self.under[column, None], np.sinh(eta), np.cosh(eta))
        return *self.strips(column, eta), share * 4 / np.pi * root * slope / np.sqrt(np.sinh(rest) * np.sinh(crest + eta))

    def nodes(self, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """n strips of every column as in ``at``, (m, n) each: towards complete contact the integrand ends like a root again."""
        t, w = gauss(n)
        length, rest = self.length[:, None], 1 - mapped(t)
        root = np.sqrt(length * rest)
        return self.at(np.arange(self.high.size), root, 0.5 * length * w * mapped_slope(t) / root)

    def panels(self, ends: np.ndarray, n: int) -> tuple[np.ndarray, ...]:
        """Panels with n strips each between the ``ends`` (m, e), ascending roots of the distance of eta from the crest, of each
        column: that (k,), and the strips as in ``at``."""
        column, k = np.nonzero(np.diff(ends, axis=1) > 1e-9 * ends[:, -1:])
        low, width = ends[column, k, None], np.diff(ends, axis=1)[column, k, None]
        share, weight, _ = graded_gauss(n)
        return column, *self.at(column, low + width * share, width * weight)

    def parted(self, family: Family, group: np.ndarray, breaks: np.ndarray) -> np.ndarray:
        """Ends (m, e) of panels, between which the greatest pressure of strips passes none of ``breaks`` (m, B), K h/2."""
        column, wanted = np.repeat(np.arange(group.size), breaks.shape[1]), breaks.ravel()

        def over(eta, index):
            at = column[index]
            u, s = self.strips(at, eta[:, None])
            share, greatest, *_ = family.at(group[at], s, CONTACT)
            return (u * share * np.maximum(greatest, 0.0))[:, 0] - wanted[index]

        # what is not met is next to one end: both ends are that
        passed, every = self.high[column], np.arange(column.size)
        under = over(self.low[column], every) < 0
        passed[~under], met = self.low[column[~under]], np.flatnonzero(under & (over(passed, every) > 0))
        low, high = self.low[column[met]], self.high[column[met]]
        passed[met] = falling_root(lambda eta, index: -over(eta, met[index]), low, high, tolerance=_CLOSER)
        rest = np.maximum(self.high[:, None] - passed.reshape(breaks.shape), 0.0)
        return np.sqrt(np.sort(np.column_stack((np.zeros_like(self.low), rest, self.length)), axis=1))


class _Sums:
    """Columns of a level at ``d = D/h`` > 0 (m,), of the ``group`` (m,) of their family."""

    def __init__(self, columns: LevelBatch):
        self.family, self.carry, self.law, self.work = columns.family, columns.carry, columns.group, columns.work
        self.d, self.group = columns.D / columns.level.h, columns.family.of(columns)
        self.pressure, slope = columns.material.K * columns.level.h, columns.level.k * columns.level.h
        self.units = self.pressure * np.array([1.0, slope, 1 / self.pressure])
        self.s_sat = self.family.s_sat[self.group]
        self.partly = self.d < 0.5 * self.s_sat
        if self.carry is not None:
            part = np.flatnonzero(self.partly)
            breaks = self.carry.breaks[self.law[part]] / (0.5 * self.pressure)
            # ends (m, e) of the panels of strips in partial contact
            self.ends = np.zeros((self.d.size, 2 + breaks.shape[1]))
            self.ends[part] = Span(self.d[part], self.s_sat[part]).parted(self.family, self.group[part], breaks)

    def own(self, some: np.ndarray, strips: int, of: tuple = MEANS) -> np.ndarray:
        """Mean pressure, friction (Pa) and contact fraction of the columns ``some`` (m,), by so many strips, (m, 3); or what is
        cut ``of`` the series of these."""
        values = np.zeros((some.size, 3))
        if of == MEANS:
            # strips in complete contact: p = D_j - A
            rest, pressure = completely(self.d[some], self.s_sat[some])
            u_square = (1.5 * rest - 2 * np.sin(rest) + 0.25 * np.sin(2 * rest)) / (4 * np.pi)
            friction = 0.25 * self.family.full[self.group[some]] * u_square
            values = self.units * np.stack((pressure, friction, rest / np.pi), axis=1)
        part = np.flatnonzero(self.partly[some])
        index = some[part]
        u, s, weight = Span(self.d[index], self.s_sat[index]).nodes(strips)
        p, tau, share = self.family.at(self.group[index], s, of)
        A = 0.5 * u
        values[part] += self.units * (np.stack((A * p, A * A * tau, share), axis=2) * weight[:, :, None]).sum(axis=1)
        return values

    def of_series(self) -> np.ndarray:
        """What errors of the series make of the own means, (m, 3).

        What the next terms would add is the error, as with the lower rule of an embedded pair (Hairer, Norsett & Wanner, "Solving
        Ordinary Differential Equations I", 1993, section II.4). The others, and those that the nodes take for terms that are
        kept, begin with the degree that was interpolated (Trefethen, "Approximation Theory and Approximation Practice", 2013,
        theorem 4.2); means of Chebyshev polynomials fall at least like its inverse."""
        f, at = self.family, self.group
        others = self.units * f.errors[at] * _PACE / np.maximum(f.degree[at, None], _FEW)
        return _SURE * np.abs(self.own(np.arange(at.size), _NODES, CUT)) + np.where(self.partly[:, None], others, 0.0)

    def carried(self, some: np.ndarray, rule: tuple[int, int]) -> np.ndarray:
        """What the columns ``some`` (m,) carry, (m, q), by a ``rule`` of strips and nodes."""
        (strips, nodes), out = rule, np.zeros((some.size, self.carry.scales.size))
        # so many columns at a time that memory stays bounded
        many = max(1, _CHUNK // (4 * strips * nodes))
        for start in range(0, some.size, many):
            for chosen, sums in ((self.partly, self._carried_partly), (self.d > 1, self._carried_completely)):
                here = start + np.flatnonzero(chosen[some[start : start + many]])
                if here.size:
                    out[here] += sums(some[here], strips, nodes)
        return out

    def _carried_partly(self, some, strips, nodes):
        """Strips in partial contact."""
        panel, u, s, weight = Span(self.d[some], self.s_sat[some]).panels(self.ends[some], strips)
        column, u, weight = np.repeat(panel, strips), u.ravel(), weight.ravel()
        waves, orbits, crest = self.family.orbits(self.group[some[panel]], s)
        self.work.solved += s.size
        pressure, unit = waves.pressure(orbits), 0.5 * self.pressure * u[:, None]
        law = self.law[some]
        edges, top = _passages(pressure, crest, self.carry.breaks[law[column]] / unit)
        parts = _parts(edges, top & np.isfinite(self.carry.p_full[law[column]]), edges.shape[1] // 2 - 1)
        weight *= (orbits.a - orbits.b) / (2 * np.pi)
        return self._over(parts, law, column, weight, lambda x, row: unit[row] * pressure(x, row), nodes)

    def _carried_completely(self, some, strips, nodes):
        """What strips in complete contact carry: their pressure is one harmonic of the phase about the mean."""
        d, s_sat, law = self.d[some], self.s_sat[some], self.law[some]
        part = partly(d, s_sat)[:, None]
        breaks = self.carry.breaks[law] / self.pressure
        # u at which the greatest or the least pressure of a strip is a break
        over = breaks - (d - 1)[:, None]
        u = np.where(over > 0, 2 * over / s_sat[:, None], -2 * over / np.maximum(s_sat - 2, EPS)[:, None])
        theta = np.sort(2 * np.arcsin(np.sqrt(np.clip(np.column_stack((np.ones_like(d), 1 - u, part)), part, 1.0))), axis=1)
        panel, k = np.nonzero(np.diff(theta, axis=1) > 1e-9)
        low, high = theta[panel, k, None], theta[panel, k + 1, None]
        y, v, _ = graded_gauss(strips)
        column = np.repeat(panel, strips)
        u = np.cos(0.5 * (low + (high - low) * y)).ravel() ** 2
        weight = ((high - low) / np.pi * v).ravel()
        mean, swing = d[column] - 1 + 0.5 * u, 0.5 * u * (s_sat[column] - 1)
        passed = passages(breaks[column], mean[:, None], swing[:, None], 0.0)[1] / np.pi
        # from the peak down: above the highest break first
        edges = np.concatenate((np.zeros((u.size, 1)), passed[:, ::-1], np.ones((u.size, 1))), axis=1)
        parts = _parts(edges, np.isfinite(self.carry.p_full[law[column]]), 0)

        def pressure(x, row):
            return self.pressure * np.maximum(mean[row, None] + swing[row, None] * np.cos(np.pi * x), 0.0)

        return self._over(parts, law, column, weight, pressure, nodes)

    def _over(self, parts, law, column, weight, pressure, nodes):
        """Sums (m, q) of the laws ``law`` (m,) over ``parts`` of contacts that count by ``weight`` (N,) for the ``column`` (N,)
        each; ``pressure``: at shares (k, n) of the contacts (k,), Pa."""
        row, low, high, saturated = parts
        share, w, _ = graded_gauss(nodes)
        width = (high - low)[:, None]
        p, weights = pressure(low[:, None] + width * share, row), weight[row, None] * width * w
        total = self.carry.averages(law, np.repeat(column[row], nodes), p.ravel(), weights.ravel())
        # where the pressure saturates all below there is nothing to sum
        return total + np.bincount(column, weight * saturated, minlength=law.size)[:, None] * self.carry.full[law]


def partly(d: np.ndarray, s_sat: np.ndarray) -> np.ndarray:
    """The distance ``1 - u`` from the crest, up to 1 in the valley, within which strips at ``d`` > 0 are in partial contact."""
    return np.clip(np.divide(s_sat - 2 * d, s_sat - 2, out=(2 * d < s_sat).astype(float), where=s_sat > 2), 0.0, 1.0)


def completely(d: np.ndarray, s_sat: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Angle theta, from the valley, over which strips at ``d`` > 0 are in complete contact; and the pressure they add, K h."""
    rest = np.pi - 2 * np.arcsin(np.sqrt(partly(d, s_sat)))
    return rest, (d - 1) * rest / np.pi + (rest - np.sin(rest)) / (4 * np.pi)


def _parts(edges, saturates, which):
    """Parts of contacts between ``edges`` (N, e), ascending: of each the contact (k,) and its ends; and how much of each contact
    is saturated with everything below, (N,), not among the others: part ``which`` where it ``saturates`` (N,)."""
    widths = np.diff(edges, axis=1)
    saturated, wide = np.where(saturates, widths[:, which], 0.0), widths > 4 * EPS
    wide[:, which] &= ~saturates
    row, part = np.nonzero(wide)
    return row, edges[row, part], edges[row, part + 1], saturated


def _passages(pressure, crest, breaks) -> tuple[np.ndarray, np.ndarray]:
    """Shares of contacts between which the pressure exceeds each of ``breaks`` (N, B), and the ends 0 and 1, (N, 2 B + 2); and
    where it exceeds the last one. A pressure rises to its ``crest`` (N,) and falls from there. The passages only part smooth
    pieces from one another: they are not needed to the last digit."""
    B, top = breaks.shape[1], pressure(crest[:, None])[:, 0]
    edges = np.tile(crest[:, None], 2 * B + 2)
    edges[:, 0], edges[:, -1] = 0.0, 1.0
    row, which = (np.tile(v, 2) for v in np.nonzero(breaks < top[:, None]))
    far = np.repeat((0.0, 1.0), row.size // 2)
    # the root of what is missing to the top is nearly linear in the distance from the crest
    short = lambda p, rows: np.sqrt(np.maximum(1 - p / top[rows], 0.0))  # noqa: E731
    goal, run = short(breaks[row, which], row), far - crest[row]

    def beyond(share, index):
        at = row[index]
        return goal[index] - short(pressure((crest[at] + run[index] * share)[:, None], at)[:, 0], at)

    share = falling_root(beyond, np.zeros(row.size), np.ones(row.size), goal, _CLOSE)
    edges[row, np.where(far > 0, 2 * B - which, 1 + which)] = crest[row] + run * share
    return np.maximum.accumulate(edges, axis=1), breaks[:, -1] < top
