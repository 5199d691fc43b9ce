"""Second term of Eq. 13 for levels without adhesion: the law of the level below averaged over the contact pressures of
all strips of a level."""

from __future__ import annotations

import numpy as np

from hystrip.errors import SolverError
from hystrip.solver import Foundation

from .law import BareLaws
from .means import Changes, Level, cells, gauss
from .orbit import Wave
from .pressure import ContactPressure

#: nodes over the strips and over each contact, tried in turn
RULES = ((6, 5), (9, 7), (14, 9), (21, 12), (32, 16), (48, 22), (72, 30), (108, 40), (162, 54))
#: share of what is allowed that these sums may miss, and how much more than their changes is feared: kinks that no
#: part ends at come and go
_QUADRATURE, _SURE = 0.7, 1.5
#: looks at a contact's pressure for where it passes the breaks of the law, and steps towards each
_LOOKS, _STEPS = 17, 5
#: nodes of all parts together, about, that are summed at a time
_CHUNK = 60_000
_EPS = np.finfo(float).eps


class Carrier:
    """A level that carries the ``laws`` of the next one: its contact pressures."""

    def __init__(self, foundation: Foundation, level: Level, rate: np.ndarray, pressure: float, laws: BareLaws):
        self.foundation, self.level, self.rate, self.pressure, self.laws = foundation, level, rate, pressure, laws
        self.strips = 0

    def carried(self, group: np.ndarray, d: np.ndarray, goal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """What columns at ``d = D/h`` carry (m, q), to ``goal`` (m, q), and the errors of the sums (m, q)."""
        out, errors = np.zeros((d.size, self.laws.full.shape[1])), np.zeros((d.size, self.laws.full.shape[1]))
        left, changes = np.flatnonzero(d > 0), Changes(_SURE, at_once=True)
        for rule in RULES:
            new = self._sums(group[left], d[left], *rule)
            miss = changes.after(new)
            done = (miss <= _QUADRATURE * goal[left]).all(axis=1) | (rule == RULES[-1])
            out[left[done]], errors[left[done]] = new[done], miss[done]
            left = left[~done]
            if not left.size:
                break
            changes.keep(~done)
        return out, errors

    def _sums(self, group, d, strips: int, nodes: int):
        out = np.zeros((d.size, self.laws.full.shape[1]))
        # so many columns at a time that memory stays bounded
        many = max(1, _CHUNK // (strips * nodes))
        for start in range(0, d.size, many):
            some = slice(start, start + many)
            out[some] = self._chunk(group[some], d[some], strips, nodes)
        return out

    def _chunk(self, group, d, strips, nodes):
        f = self.level.family
        out = np.zeros((d.size, self.laws.full.shape[1]))
        some = np.flatnonzero(d < 0.5 * f.s_sat[group])
        if some.size:
            out[some] = self._partial(group[some], d[some], strips, nodes)
        some = np.flatnonzero(d > 1)
        if some.size:
            out[some] += self._complete(group[some], d[some], strips, nodes)
        return out

    def _partial(self, group, d, strips, nodes):
        """Strips in partial contact."""
        f = self.level.family
        at = cells(d, f.s_sat[group], strips)
        known = f.values(group, at.s, slopes=True)
        wave = Wave(self.foundation, np.repeat(self.rate[group], strips))
        width = _inside(known[:, :, 2].ravel())
        # families know pressures, not widths, as well as friction needs it: a step of Newton's towards the strip that
        # is meant
        miss = at.s.ravel() - wave.orbits(width, means=False).D
        width = _inside(width / (2 * np.pi) + known[:, :, 5].ravel() * miss)
        orbits = wave.orbits(width, means=False)
        if not orbits.certified.all():
            raise SolverError("a strip without adhesion was not certified")
        self.strips += width.size
        unit = 0.5 * self.pressure * at.u.ravel()
        column = np.repeat(np.arange(d.size), strips)
        breaks = self.laws.breaks[group[column]] / unit[:, None]
        contact = ContactPressure(wave, orbits)
        edges, top = _passages(contact, breaks)
        weight = at.weight.ravel() * width / (2 * np.pi)
        parts = _Parts.between(edges, top & np.isfinite(self.laws.p_full[group[column]]))
        t, w = parts.nodes(nodes)
        p = contact.at(_mapped(t), parts.row) * unit[parts.row, None]
        total = self.laws.averages(
            group, np.repeat(column[parts.row], nodes), p.ravel(), (weight[parts.row, None] * w * _mapped_slope(t)).ravel()
        )
        # where the pressure saturates all below there is nothing to sum
        sure = np.bincount(column, weight * parts.saturated(_mapped), minlength=d.size)
        return total + sure[:, None] * self.laws.full[group]

    def _complete(self, group, d, strips, nodes):
        """Strips in complete contact: one harmonic of the phase about the mean."""
        f = self.level.family
        first = 2 * np.arccos(np.sqrt(_starts(d, f.s_sat[group])))
        y, v = gauss(strips)
        # the strip that just becomes so is at the start of the interval
        theta = first[:, None] + (np.pi - first)[:, None] * y * y
        u = np.cos(0.5 * theta).ravel() ** 2
        column = np.repeat(np.arange(d.size), strips)
        mean, swing = d[column] - 1 + 0.5 * u, 0.5 * u * (f.s_sat[group[column]] - 1)
        breaks = self.laws.breaks[group[column]] / self.pressure
        with np.errstate(invalid="ignore"):
            cosine = np.divide(
                breaks - mean[:, None], swing[:, None], out=np.sign(breaks - mean[:, None]), where=swing[:, None] > 0
            )
        passed = np.arccos(np.clip(cosine, -1.0, 1.0)) / np.pi
        # from the peak down: above the highest break first
        edges = np.concatenate((np.zeros((u.size, 1)), passed[:, ::-1], np.ones((u.size, 1))), axis=1)
        weight = ((np.pi - first) / np.pi)[column] * np.tile(v * 2 * y, d.size)
        parts = _Parts.between(edges, np.isfinite(self.laws.p_full[group[column]]), 0)
        t, w = parts.nodes(nodes)
        p = np.maximum(mean[parts.row, None] + swing[parts.row, None] * np.cos(np.pi * t), 0.0)
        total = self.laws.averages(
            group, np.repeat(column[parts.row], nodes), self.pressure * p.ravel(), (weight[parts.row, None] * w).ravel()
        )
        sure = np.bincount(column, weight * parts.saturated(lambda x: x), minlength=d.size)
        return total + sure[:, None] * self.laws.full[group]


class _Parts:
    """Parts of contacts between the breaks of the law: ``row`` (k,) of the contact and ends ``low``, ``high``;
    ``above`` (N, 2): the part of each contact in which everything below is saturated, not among the others."""

    def __init__(self, row, low, high, above):
        self.row, self.low, self.high, self.above = row, low, high, above

    @classmethod
    def between(cls, edges, saturates, which=None) -> _Parts:
        """``edges`` (N, e), ascending; part ``which`` (the middle one) is saturated where ``saturates`` (N,)."""
        which = (edges.shape[1] - 1) // 2 if which is None else which
        wide = np.diff(edges, axis=1) > 4 * _EPS
        above = np.where(saturates[:, None], edges[:, which : which + 2], 0.0)
        wide[:, which] &= ~saturates
        row, part = np.nonzero(wide)
        return cls(row, edges[row, part], edges[row, part + 1], above)

    def nodes(self, n):
        """Nodes and weights, (k, n), of a rule that takes roots at either end."""
        t, w = gauss(n)
        width = (self.high - self.low)[:, None]
        return self.low[:, None] + width * _mapped(t), width * w * _mapped_slope(t)

    def saturated(self, place):
        """Share of each contact in which all below is saturated, (N,)."""
        return place(self.above[:, 1]) - place(self.above[:, 0])


def _inside(share):
    """Widths of contacts that are these shares of the period, neither none nor all."""
    return 2 * np.pi * np.clip(share, 1e-9, 1 - 1e-9)


def _mapped(t):
    return t * t * (3 - 2 * t)


def _mapped_slope(t):
    return 6 * t * (1 - t)


def _passages(contact: ContactPressure, breaks) -> tuple[np.ndarray, np.ndarray]:
    """Parameters of contacts, ``_mapped`` to shares, between which the pressure exceeds each of ``breaks`` (N, B), and
    the ends 0 and 1, (N, 2 B + 2); and where it exceeds the last one. A pressure rises to its peak and falls from
    there; what it does between the looks is not needed to the last digit: the passages only part smooth pieces from
    one another."""
    N, B = breaks.shape
    t = np.linspace(0, 1, _LOOKS)
    looks = contact.at(np.broadcast_to(_mapped(t), (N, _LOOKS)))
    looks[:, -1] = 0.0
    peak = looks[:, :-1].argmax(axis=1)
    edges = np.empty((N, 2 * B + 2))
    edges[:, 0], edges[:, -1] = 0.0, 1.0
    every = np.arange(N)
    index = np.arange(_LOOKS)
    contact_of, order = np.repeat(every, B), np.tile(np.arange(B), N)
    p, crest, all_looks = breaks.ravel(), peak[contact_of], looks[contact_of]
    over = all_looks[np.arange(p.size), crest] > p
    below = all_looks <= p[:, None]
    # the last look below on the way up, and the first one on the way down
    before = np.where(below & (index < crest[:, None]), index, -1).max(axis=1)
    after = np.where(below & (index > crest[:, None]), index, _LOOKS).min(axis=1)
    up, down = t[crest], t[crest]
    up[over] = 0.0
    rising, falling = np.flatnonzero(over & (before >= 0)), np.flatnonzero(over & (after < _LOOKS))
    both = np.concatenate((rising, falling))
    lower, upper = np.concatenate((before[rising], after[falling])), np.concatenate((before[rising] + 1, after[falling] - 1))
    found = _passage(contact, contact_of[both], p[both], all_looks[both, lower], all_looks[both, upper], t[lower], t[upper])
    up[rising], down[falling] = found[: rising.size], found[rising.size :]
    edges[contact_of, 1 + order], edges[contact_of, 2 * B - order] = up, down
    return np.maximum.accumulate(edges, axis=1), edges[:, B + 1] > edges[:, B]


def _passage(contact, rows, p, low_pressure, high_pressure, low, high):
    """Where the pressures of the contacts ``rows`` pass ``p`` between parameters ``low`` and ``high`` of these
    pressures: false position with halving of stale ends."""
    f_low, f_high = low_pressure - p, high_pressure - p
    middle = low
    for _ in range(_STEPS if rows.size else 0):
        middle = (low * f_high - high * f_low) / np.where(f_high > f_low, f_high - f_low, 1.0)
        f = contact.at(_mapped(middle)[:, None], rows)[:, 0] - p
        less = f <= 0
        f_high, f_low = np.where(less, 0.5 * f_high, f), np.where(less, f, 0.5 * f_low)
        low, high = np.where(less, middle, low), np.where(less, high, middle)
    return middle


def _starts(d, s_sat):
    return np.minimum(np.divide(2 * (d - 1), s_sat - 2, out=np.ones_like(d), where=s_sat > 2), 1.0)
