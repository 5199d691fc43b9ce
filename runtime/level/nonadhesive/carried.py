"""Second term of Eq. 13 for levels without adhesion: the law of the level below averaged over the contact pressures of
all strips of a level.

What a strip carries is not smooth where its pressure passes a break of the law, nor is it over the strips where their greatest
pressure does: both are cut there.
"""

from __future__ import annotations

import numpy as np

from ...numerics.gauss import graded_gauss
from ...numerics.roots import false_position
from ...numerics.rounding import EPS
from ...numerics.rules import by_rules
from ...orbit.contact import passages
from ...orbit.foundation import Foundation
from .family import CONTACT
from .law import Laws
from .means import Level
from .span import Span, ends_of, panels

#: nodes over a panel of strips and over each part of a contact, tried in turn
RULES = ((2, 3), (4, 6), (7, 9), (11, 14), (16, 20), (24, 30), (36, 44), (54, 66), (81, 98))
#: share of what is allowed that these sums may miss, and the fastest that they are believed to converge: of 350 random surfaces
#: of two levels one erred by more than it said (by a quarter), with half of that two
_QUADRATURE, _FASTEST = 0.7, 0.02
#: steps towards where a contact's pressure passes the breaks of the law
_STEPS = 4
#: nodes of all parts together, about, that are summed at a time: what is known of them stays in the cache
_CHUNK = 30_000


class Carrier:
    """A level that carries the ``laws`` of the next one: its contact pressures."""

    def __init__(self, foundation: Foundation, level: Level, rate: np.ndarray, pressure: float, laws: Laws):
        self.foundation, self.level, self.rate = foundation, level, rate
        self.pressure, self.laws = pressure, laws
        self.strips = 0

    def carried(self, group: np.ndarray, d: np.ndarray, goal: np.ndarray, at_once: bool) -> tuple[np.ndarray, np.ndarray]:
        """What columns at ``d = D/h`` carry (m, q), to ``goal`` (m, q), and the errors of the sums (m, q): the first
        change from rule to rule may be small by chance, and is believed only if ``at_once``."""
        out, errors = np.zeros(goal.shape), np.zeros(goal.shape)
        some = np.flatnonzero(d > 0)
        group, d = group[some], d[some]
        ends = self._ends(group, d)
        sums = lambda left, rule: self._sums(group[left], d[left], ends[left], *rule)  # noqa: E731
        out[some], errors[some] = by_rules(sums, RULES, _QUADRATURE * goal[some], np.full(some.size, _FASTEST), at_once)
        return out, errors

    def _ends(self, group, d):
        """Ends (m, e) of the panels of strips in partial contact."""
        f = self.level.family
        part = np.flatnonzero(d < 0.5 * f.s_sat[group])
        if not part.size:
            return np.zeros((d.size, 0))
        breaks = self.laws.breaks[group[part]] / (0.5 * self.pressure)
        known = ends_of(Span(d[part], f.s_sat[group[part]]), f, group[part], breaks)
        ends = np.zeros((d.size, known.shape[1]))
        ends[part] = known
        return ends

    def _sums(self, group, d, ends, strips: int, nodes: int):
        out = np.zeros((d.size, self.laws.full.shape[1]))
        # so many columns at a time that memory stays bounded
        many = max(1, _CHUNK // (4 * strips * nodes))
        part, over = d < 0.5 * self.level.family.s_sat[group], d > 1
        for start in range(0, d.size, many):
            for chosen, sums in ((part, self._partial), (over, self._complete)):
                some = start + np.flatnonzero(chosen[start : start + many])
                if some.size:
                    out[some] += sums(group[some], d[some], ends[some], strips, nodes)
        return out

    def _partial(self, group, d, ends, strips, nodes):
        """Strips in partial contact."""
        f = self.level.family
        panel, u, s, weight = panels(Span(d, f.s_sat[group]), ends, strips)
        column, u, weight = np.repeat(panel, strips), u.ravel(), weight.ravel()
        waves = self.foundation.waves(self.rate[group[column]])
        share, _, crest, slope, *_ = f.values(group[panel], s, slopes=True, of=CONTACT).reshape(-1, 6).T
        width = _inside(share)
        orbits = waves.orbits(width, means=False)
        # families know pressures, not widths, as well as friction may need it: a step of Newton's towards the strip that
        # is meant
        width = _inside(width / (2 * np.pi) + slope * (s.ravel() - orbits.D))
        orbits = waves.orbits(width, means=False)
        missed = np.abs(s.ravel() - orbits.D)
        self.strips += width.size
        pressure = waves.pressure(orbits.sure())
        breaks = self.laws.breaks[group[column]] / (0.5 * self.pressure * u[:, None])
        edges, top = _passages(pressure, np.clip(crest, 0.0, 1.0), breaks)
        weight *= width / (2 * np.pi)
        parts = _Parts.between(edges, top & np.isfinite(self.laws.p_full[group[column]]))
        unit = 0.5 * self.pressure * u[:, None]
        total = self._over(parts, group, column, weight, lambda x, row: unit[row] * pressure(x, row), nodes)
        steepest = 0.5 * self.pressure * self.laws.steepest[group]
        total[:, -1] += np.bincount(column, weight * u * missed, minlength=group.size) * steepest
        return total

    def _complete(self, group, d, _, strips, nodes):
        """Strips in complete contact: one harmonic of the phase about the mean."""
        f = self.level.family
        swings = f.s_sat[group] - 2
        least = np.minimum(np.divide(2 * (d - 1), swings, out=np.ones_like(d), where=swings > 0), 1.0)
        breaks = self.laws.breaks[group] / self.pressure
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
            return self.pressure * np.maximum(mean[row, None] + swing[row, None] * np.cos(np.pi * x), 0.0)

        return self._over(parts, group, column, weight, pressure, nodes)

    def _over(self, parts, group, column, weight, pressure, nodes):
        """Sums (m, q) of the laws ``group`` (m,) over ``parts`` of contacts that count by ``weight`` (N,) for the ``column`` (N,)
        each; ``pressure``: at shares (k, n) of the contacts (k,), Pa."""
        x, w = parts.nodes(nodes)
        p, weights = pressure(x, parts.row), weight[parts.row, None] * w
        total = self.laws.averages(group, np.repeat(column[parts.row], nodes), p.ravel(), weights.ravel())
        # where the pressure saturates all below there is nothing to sum
        return total + np.bincount(column, weight * parts.saturated, minlength=group.size)[:, None] * self.laws.full[group]


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


def _inside(share):
    """Widths of contacts that are these shares of the period, neither none nor all."""
    return 2 * np.pi * np.clip(share, 1e-9, 1 - 1e-9)


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
