"""Means of a level without adhesion: sums over its strips, and over the contact of each where the levels below have a law, the
second term of Eq. 13.

What a strip carries is not smooth where its pressure passes a break of the law, nor is it over the strips where their greatest
pressure does: both are cut there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...numerics.gauss import graded_gauss, left_out
from ...numerics.roots import false_position, rising_root
from ...numerics.rounding import EPS
from ...numerics.rules import by_rules
from ...orbit.contact import passages
from ..effort import WorkCounters
from .family import Family
from .law import Laws
from .span import Span, ends_of, panels

#: nodes over a panel of strips and over each part of a contact, tried in turn; and over all strips where nothing is carried
_RULES = ((2, 3), (4, 6), (7, 9), (11, 14), (16, 20), (24, 30), (36, 44), (54, 66), (81, 98))
_ALONE = (9, 15, 24, 38, 60, 96, 154)
#: share of what is allowed that these sums may miss, and the fastest that they are believed to converge: of 350 random surfaces
#: of two levels one erred by more than it said (by a quarter), with half of that two
_QUADRATURE, _FASTEST = 0.7, 0.02
#: steps towards where a contact's pressure passes the breaks of the law
_STEPS = 4
#: strips for penetrations, to what accuracy, relative, in turn, and how far beside slopes are from
_SEARCH, _ASIDE = ((16, 1e-2), (64, 1e-12)), 1e-5
#: what is left in a mean of the greatest error of strips: along a series errors change sign
_CANCELLED = 0.3
#: nodes of all parts together, about, that are summed at a time: what is known of them stays in the cache
_CHUNK = 30_000


@dataclass(frozen=True)
class Columns:
    """A level of one ``family``, with pressures in ``unit`` (K h, Pa) and frictions in that times ``slope`` (k h), which carries
    ``laws``."""

    family: Family
    unit: float
    slope: float
    work: WorkCounters
    laws: Laws | None = None

    def means(self, group: np.ndarray, d: np.ndarray, goal: np.ndarray, by_series: bool) -> tuple[np.ndarray, np.ndarray]:
        """Pressure and friction (Pa) and contact fraction of columns at ``d = D/h``, (m, 3), to ``goal`` (m, 3); and their errors
        (m, 3). ``by_series``: strips are what the family's series say."""
        out, errors, left = np.zeros((d.size, 3)), np.zeros((d.size, 3)), np.arange(d.size)
        for n in _ALONE:
            out[left], errors[left] = self._own(group[left], d[left], n, by_series)
            left = left[(errors[left] > _QUADRATURE * goal[left]).any(axis=1)]
            if not left.size:
                break
        if by_series:
            errors += _CANCELLED * self.family.errors[group] * (self.unit, self.unit * self.slope, 1.0)
        return out, errors

    def _part(self, group, d):
        """Which columns have strips in partial contact."""
        return np.flatnonzero((d > 0) & (d < 0.5 * self.family.s_sat[group]))

    def _own(self, group, d, n, by_series):
        """``means`` by n strips in partial contact, and what these miss."""
        f, part, touching = self.family, self._part(group, d), np.flatnonzero(d > 0)
        out, missed, units = np.zeros((d.size, 3)), np.zeros((d.size, 3)), np.array([self.unit, self.unit * self.slope, 1.0])
        out[touching] = units * _complete(d[touching], f.s_sat[group[touching]], f.full[group[touching]])
        if part.size:
            span = Span(d[part], f.s_sat[group[part]])
            _, u, s, weight = panels(span, np.sqrt(np.column_stack((np.zeros(part.size), span.high - span.low))), n)
            values = f.values(group[part], s)
            if not by_series:
                waves, orbits = self._orbits(np.repeat(group[part], n), s, values)
                exact = (*waves.means(orbits.b, orbits.a, orbits.D), (orbits.a - orbits.b) / (2 * np.pi))
                values = np.stack(exact, axis=1).reshape(*s.shape, 3)
            A = 0.5 * u
            _, shares, projection = graded_gauss(n)
            each = units * values[:, :, :3] * np.stack((A, A * A, np.ones_like(A)), axis=2) * weight[:, :, None]
            out[part] += each.sum(axis=1)
            missed[part] = left_out(projection, np.moveaxis(each / shares[:, None], 1, 0))
        return out, missed

    def _orbits(self, group, s, values):
        self.work.solved += s.size
        return self.family.orbits(group, s.ravel(), *values.reshape(-1, 6)[:, [2, 5]].T)

    def carried(self, group: np.ndarray, d: np.ndarray, goal: np.ndarray, at_once: bool) -> tuple[np.ndarray, np.ndarray]:
        """What columns at ``d = D/h`` carry (m, q), to ``goal`` (m, q), and the errors of the sums (m, q): the first
        change from rule to rule may be small by chance, and is believed only if ``at_once``."""
        out, errors = np.zeros(goal.shape), np.zeros(goal.shape)
        some = np.flatnonzero(d > 0)
        group, d = group[some], d[some]
        ends = self._ends(group, d)
        sums = lambda left, rule: self._sums(group[left], d[left], ends[left], *rule)  # noqa: E731
        out[some], errors[some] = by_rules(sums, _RULES, _QUADRATURE * goal[some], np.full(some.size, _FASTEST), at_once)
        return out, errors

    def _ends(self, group, d):
        """Ends (m, e) of the panels of strips in partial contact."""
        part = self._part(group, d)
        if not part.size:
            return np.zeros((d.size, 0))
        breaks = self.laws.breaks[group[part]] / (0.5 * self.unit)
        known = ends_of(Span(d[part], self.family.s_sat[group[part]]), self.family, group[part], breaks)
        ends = np.zeros((d.size, known.shape[1]))
        ends[part] = known
        return ends

    def _sums(self, group, d, ends, strips: int, nodes: int):
        out = np.zeros((d.size, self.laws.full.shape[1]))
        # so many columns at a time that memory stays bounded
        many = max(1, _CHUNK // (4 * strips * nodes))
        part, over = d < 0.5 * self.family.s_sat[group], d > 1
        for start in range(0, d.size, many):
            for chosen, sums in ((part, self._partly), (over, self._completely)):
                some = start + np.flatnonzero(chosen[start : start + many])
                if some.size:
                    out[some] += sums(group[some], d[some], ends[some], strips, nodes)
        return out

    def _partly(self, group, d, ends, strips, nodes):
        """Strips in partial contact."""
        panel, u, s, weight = panels(Span(d, self.family.s_sat[group]), ends, strips)
        values, column = self.family.values(group[panel], s), np.repeat(panel, strips)
        waves, orbits = self._orbits(group[column], s, values)
        pressure, unit = waves.pressure(orbits), 0.5 * self.unit * u.reshape(-1, 1)
        edges, top = _passages(pressure, np.clip(values[..., 4].ravel(), 0.0, 1.0), self.laws.breaks[group[column]] / unit)
        parts = _Parts.between(edges, top & np.isfinite(self.laws.p_full[group[column]]))
        weight = weight.ravel() * (orbits.a - orbits.b) / (2 * np.pi)
        total = self._over(parts, group, column, weight, lambda x, row: unit[row] * pressure(x, row), nodes)
        missed = np.bincount(column, weight * unit[:, 0] * np.abs(s.ravel() - orbits.D), minlength=group.size)
        total[:, -1] += missed * self.laws.steepest[group]
        return total

    def _completely(self, group, d, _, strips, nodes):
        """What strips in complete contact carry: their pressure is one harmonic of the phase about the mean."""
        f = self.family
        swings = f.s_sat[group] - 2
        least = np.minimum(np.divide(2 * (d - 1), swings, out=np.ones_like(d), where=swings > 0), 1.0)
        breaks = self.laws.breaks[group] / self.unit
        # u at which the greatest or the least pressure of a strip is a break
        over = breaks - (d - 1)[:, None]
        u = np.where(over > 0, 2 * over / f.s_sat[group, None], -2 * over / np.maximum(swings, EPS)[:, None])
        theta = 2 * np.arccos(np.sqrt(np.clip(np.column_stack((np.zeros_like(d), u, least)), 0.0, least[:, None])))
        theta = np.sort(theta, axis=1)
        panel, k = np.nonzero(np.diff(theta, axis=1) > 1e-9)
        low, high = theta[panel, k, None], theta[panel, k + 1, None]
        y, v, _ = graded_gauss(strips)
        column = np.repeat(panel, strips)
        u = np.cos(0.5 * (low + (high - low) * y)).ravel() ** 2
        weight = ((high - low) / np.pi * v).ravel()
        mean, swing = d[column] - 1 + 0.5 * u, 0.5 * u * (f.s_sat[group[column]] - 1)
        passed = passages(breaks[column], mean[:, None], swing[:, None], 0.0)[1] / np.pi
        # from the peak down: above the highest break first
        edges = np.concatenate((np.zeros((u.size, 1)), passed[:, ::-1], np.ones((u.size, 1))), axis=1)
        parts = _Parts.between(edges, np.isfinite(self.laws.p_full[group[column]]), 0)

        def pressure(x, row):
            return self.unit * np.maximum(mean[row, None] + swing[row, None] * np.cos(np.pi * x), 0.0)

        return self._over(parts, group, column, weight, pressure, nodes)

    def _over(self, parts, group, column, weight, pressure, nodes):
        """Sums (m, q) of the laws ``group`` (m,) over ``parts`` of contacts that count by ``weight`` (N,) for the ``column`` (N,)
        each; ``pressure``: at shares (k, n) of the contacts (k,), Pa."""
        x, w = parts.nodes(nodes)
        p, weights = pressure(x, parts.row), weight[parts.row, None] * w
        total = self.laws.averages(group, np.repeat(column[parts.row], nodes), p.ravel(), weights.ravel())
        # where the pressure saturates all below there is nothing to sum
        return total + np.bincount(column, weight * parts.saturated, minlength=group.size)[:, None] * self.laws.full[group]

    def penetrations(self, group: np.ndarray, p: np.ndarray) -> np.ndarray:
        """d at which the mean pressure is ``p`` (m,), Pa, nowhere below none, by series."""
        at = p / self.unit
        d = np.where(at > 0, at + 0.75, 0.0)
        part = self._part(group, d)
        if not part.size:
            return d
        at, group, high = at[part], group[part], np.log(np.minimum(d[part], 0.5 * self.family.s_sat[group[part]]))

        def over(log_d, index, n):
            two, x = np.tile(group[index], 2), np.exp(np.concatenate((log_d, log_d + _ASIDE)))
            pressure = self._own(two, x, n, True)[0][:, 0] / self.unit
            f, beside = np.log(np.maximum(pressure, np.finfo(float).tiny)).reshape(2, -1)
            return f - np.log(at[index]), (beside - f) / _ASIDE

        # crests are paraboloids next to the plane: at rest they carry d^2/(2 pi)
        found = 0.5 * np.log(2 * np.pi * at)
        for n, close in _SEARCH:
            found, _ = rising_root(lambda x, index, n=n: over(x, index, n), np.log(at), high, found, close)
        d[part] = np.exp(found)
        return d


def _complete(d, s_sat, friction):
    """What strips in complete contact add to the means of columns at ``d`` > 0, (m, 3): ``p = D_j - A``."""
    start = np.minimum(np.divide(2 * (d - 1), s_sat - 2, out=np.ones_like(d), where=s_sat > 2), 1.0)
    rest = np.where((d > 1) | (d >= 0.5 * s_sat), np.pi - 2 * np.arccos(np.sqrt(np.clip(start, 0.0, 1.0))), 0.0)
    u = (rest - np.sin(rest)) / (2 * np.pi)
    u_square = (1.5 * rest - 2 * np.sin(rest) + 0.25 * np.sin(2 * rest)) / (4 * np.pi)
    return np.stack(((d - 1) * rest / np.pi + 0.5 * u, 0.25 * friction * u_square, rest / np.pi), axis=1)


class _Parts:
    """Parts of contacts between the breaks of the law: ``row`` (k,) of the contact and ends ``low``, ``high``;
    ``saturated`` (N,): the part of each contact in which everything below is saturated, not among the others."""

    def __init__(self, row, low, high, saturated):
        self.row, self.low, self.high, self.saturated = row, low, high, saturated

    @classmethod
    def between(cls, edges, saturates, which=None) -> _Parts:
        """``edges`` (N, e), ascending; part ``which`` (the middle one) is saturated where ``saturates`` (N,)."""
        which = (edges.shape[1] - 1) // 2 if which is None else which
        widths = np.diff(edges, axis=1)
        saturated = np.where(saturates, widths[:, which], 0.0)
        wide = widths > 4 * EPS
        wide[:, which] &= ~saturates
        row, part = np.nonzero(wide)
        return cls(row, edges[row, part], edges[row, part + 1], saturated)

    def nodes(self, n):
        """Nodes and weights, (k, n), of a rule that takes roots at either end."""
        share, weight, _ = graded_gauss(n)
        width = (self.high - self.low)[:, None]
        return self.low[:, None] + width * share, width * weight


def _passages(pressure, crest, breaks) -> tuple[np.ndarray, np.ndarray]:
    """Shares of contacts between which the pressure exceeds each of ``breaks`` (N, B), and the ends 0 and 1, (N, 2 B + 2); and
    where it exceeds the last one. A pressure rises to its ``crest`` (N,) and falls from there. The passages only part smooth
    pieces from one another: they are not needed to the last digit."""
    N, B = breaks.shape
    entry, top = pressure(np.column_stack((np.zeros(N), crest))).T
    edges = np.repeat(crest[:, None], 2 * B + 2, axis=1)
    edges[:, 0], edges[:, -1] = 0.0, 1.0
    row, which = np.nonzero(breaks < top[:, None])
    late = entry[row] < breaks[row, which]
    edges[row[~late], 1 + which[~late]] = 0.0
    rows, order = np.concatenate((row[late], row)), np.concatenate((which[late], which))
    far = np.concatenate((np.zeros(np.count_nonzero(late)), np.ones(row.size)))
    outer = np.concatenate((entry[row[late]], np.zeros(row.size)))
    # the root of what is missing to the top is nearly linear in the distance from the crest
    short = lambda p: np.sqrt(np.maximum(1 - p / top[rows], 0.0))  # noqa: E731
    target = short(breaks[rows, order])

    def missing(share):
        return short(pressure((crest[rows] + (far - crest[rows]) * share)[:, None], rows)[:, 0]) - target

    ends = np.zeros(rows.size), np.ones(rows.size), -target, short(outer) - target
    middle = false_position(missing, *ends, _STEPS) if rows.size else target
    edges[rows, np.where(far > 0, 2 * B - order, 1 + order)] = crest[rows] + (far - crest[rows]) * middle
    rising = np.maximum.accumulate(edges, axis=1)
    return rising, breaks[:, -1] < top
