"""Means of a level without adhesion at any penetration, as integrals over its strips of functions that are known.

With ``u = cos^2(theta/2)`` a strip has the amplitude ``h u/2`` and ``s = 2 - 2 (1 - D/h)/u``. Where the crests of the
cell's edge are out of reach, D < h, contact ends at u = 1 - D/h; else the strips of small u are in complete contact,
from ``s = s_sat`` on. Substituting hyperbolic functions for ``u/|1 - D/h|`` makes all scales alike however near D is
to h, and takes the root out of the integrand at the crest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...numerics.quadrature import gauss
from ...numerics.rules import Changes, by_rules
from .family import Family

#: nodes of the rules tried in turn; the second is what penetrations are looked for with
_RULES = (8, 12, 18, 27, 40, 60, 90)
#: share of what is allowed that a sum over nodes may miss, and how much more than a change is feared
_QUADRATURE, _SURE = 0.5, 2.0
#: a level's sum is not believed to gain more than this from rule to rule
_PACE = 0.3
#: penetrations are looked for to this, or pressures to that, or to this share of what is not known of them, what is left
#: being taken up by slopes; and steps
_CLOSE, _MET, _BLURRED, _STEPS = 1e-5, 1e-7, 1e-2, 60
#: penetrations that are looked at first
_LOOKS = 32
#: share of what is allowed below which no error is claimed to be
_TOLD = 5e-4
#: least penetration in heights
_LEAST = 1e-60
#: what is left in a level's mean of the greatest error of its strips, and of errors that change sign from one strip
#: sampled to the next
CANCELLED, _WAVES = 0.2, 3.4
_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class Cells:
    """The strips in partial contact of columns at d = D/h (m,), as nodes (m, n): share ``u`` and penetration ``s`` of
    each, and its ``weight`` in the mean over the cell; and ``complete`` (m,), the angle theta from which on contact is
    complete."""

    u: np.ndarray
    s: np.ndarray
    weight: np.ndarray
    complete: np.ndarray


def cells(d: np.ndarray, s_sat: np.ndarray, n: int) -> Cells:
    """Nodes for 0 < d < s_sat/2, (m,). At d = 1 all strips are alike, s = 2."""
    y, w = gauss(n)
    u, s, weight = (np.empty((d.size, n)) for _ in range(3))
    complete = np.full(d.size, np.pi)
    # squares of what is smaller underflow
    d = np.maximum(d, _LEAST)
    i = np.flatnonzero(d < 1)
    if i.size:
        end = np.arcsinh(np.sqrt(d[i] / (1 - d[i])))[:, None]
        rest = end * (1 - y) ** 2
        eta = end - rest
        u[i] = (1 - d[i])[:, None] * np.cosh(eta) ** 2
        s[i] = 2 * np.tanh(eta) ** 2
        weight[i] = w * 4 / np.pi * end * (1 - y) * np.sinh(eta) / np.sqrt(np.sinh(rest) * np.sinh(end + eta))
    i = np.flatnonzero(d == 1)
    if i.size:
        u[i], s[i], weight[i] = np.cos(0.5 * np.pi * y) ** 2, 2.0, w
    i = np.flatnonzero(d > 1)
    if i.size:
        excess = d[i, None] - 1
        start = np.minimum(2 * excess / (s_sat[i, None] - 2), 1.0)
        first, end = np.arcsinh(np.sqrt(start / excess)), np.arcsinh(np.sqrt(1 / excess))
        # at saturation nothing but rounding is left of them
        width = np.maximum(end - first, 4 * _EPS * end)
        rest = width * (1 - y) ** 2 * (1 + 2 * y)
        eta = end - rest
        square = np.sinh(eta) ** 2
        u[i], s[i] = excess * square, 2 + 2 / square
        weight[i] = w * 12 / np.pi * width * y * (1 - y) * np.cosh(eta) / np.sqrt(np.sinh(rest) * np.sinh(end + eta))
        complete[i] = 2 * np.arccos(np.sqrt(start[:, 0]))
    return Cells(u, s, weight, complete)


@dataclass(frozen=True)
class Level:
    """A level as all columns share it: ``K`` times height, and ``k h``; pressures in K h, friction in K h k h."""

    family: Family

    def means(self, group: np.ndarray, d: np.ndarray, n: int, slopes: bool = False) -> np.ndarray:
        """Mean pressure (K h), friction (K h kh), contact fraction of the columns at ``d`` (m,), and with ``slopes``
        those of the first two by d."""
        f = self.family
        at = cells(d, f.s_sat[group], n)
        values = f.values(group, at.s, slopes)
        A = 0.5 * at.u
        out = np.empty((d.size, 5 if slopes else 3))
        powers = (A, A * A, None, None, A)
        for j, (value, power) in enumerate(zip((0, 1, 2, 3, 4) if slopes else (0, 1, 2), powers, strict=False)):
            weight = at.weight if power is None else at.weight * power
            out[:, j] = (weight * values[:, :, value]).sum(axis=1)
        return out + self._complete(at.complete, d, f.full[group, 1], slopes)

    def _complete(self, theta, d, friction, slopes):
        """The share of the strips in complete contact, beyond ``theta``: ``p = D_j - A``."""
        rest = np.pi - theta
        u = (rest - np.sin(theta)) / (2 * np.pi)
        u_square = (1.5 * rest - 2 * np.sin(theta) - 0.25 * np.sin(2 * theta)) / (4 * np.pi)
        out = [(d - 1) * rest / np.pi + 0.5 * u, 0.25 * friction * u_square, rest / np.pi]
        if slopes:
            out += [rest / np.pi, np.zeros_like(rest)]
        return np.stack(out, axis=1)

    def sure_means(
        self, group: np.ndarray, d: np.ndarray, goal: np.ndarray, slopes: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """Means with as many nodes as it takes for ``goal`` (m, 3), and their errors (m, 3), all told."""
        out, errors = by_rules(
            lambda left, n: self.means(group[left], d[left], n, slopes), _RULES, _QUADRATURE * goal, Changes(_SURE, pace=_PACE)
        )
        return out, errors + self.errors(group) + _TOLD * goal + _EPS * (1 + 16 * np.abs(out[:, :3]))

    def errors(self, group) -> np.ndarray:
        """What the errors of the strips' means can make of the level's, (m, 3)."""
        # means of u/2 and of its square are at most 1/4 and 3/32; errors of either sign, one after the other, mostly
        # cancel, but for contact, whose greatest errors all are where it begins
        left = np.minimum(CANCELLED, _WAVES / np.maximum(self.family.strips[group], 1))[:, None]
        share = np.concatenate((0.25 * left, 0.09375 * left, np.full_like(left, 0.5)), axis=1)
        return self.family.errors[group] * share

    def penetrations(self, group: np.ndarray, p: np.ndarray) -> np.ndarray:
        """d at which the mean pressure (K h) is ``p`` (m,), between 0 and that of saturation: Newton on the root of
        the pressure, which is nearly linear."""
        low, high = p.copy(), np.minimum(p + 0.75, 0.5 * self.family.s_sat[group])
        d = np.clip(self._looked_up(group, p), low, high)
        left = np.arange(p.size)
        for _ in range(_STEPS):
            at = self.means(group[left], d[left], _RULES[1], True)
            miss = np.sqrt(np.maximum(at[:, 0], 0.0)) - np.sqrt(p[left])
            low[left], high[left] = np.where(miss <= 0, d[left], low[left]), np.where(miss > 0, d[left], high[left])
            slope = 0.5 * at[:, 3] / np.sqrt(np.maximum(at[:, 0], np.finfo(float).tiny))
            new = d[left] - np.divide(miss, slope, out=np.full_like(miss, np.inf), where=slope > 0)
            inside = (new >= low[left]) & (new <= high[left])
            new = np.where(inside, new, 0.5 * (low[left] + high[left]))
            known = _BLURRED * self.family.errors[group[left], 0]
            off = np.abs(at[:, 0] - p[left]) > np.maximum(_MET * p[left], known)
            left, new = left[off], new[off]
            moved = np.abs(new - d[left])
            d[left] = new
            left = left[moved > _CLOSE * new]
            if not left.size:
                break
        return d

    def _looked_up(self, group, p):
        """About what ``penetrations`` finds, from a few of them."""
        which, row = np.unique(group, return_inverse=True)
        most = np.zeros(which.size)
        np.maximum.at(most, row, p)
        # roots of the pressure are nearly linear
        d = np.minimum(most + 0.75, 0.5 * self.family.s_sat[which])[:, None] * np.linspace(0, 1, _LOOKS + 1)[1:] ** 2
        d = np.minimum(d, 0.5 * self.family.s_sat[which, None] * (1 - 4 * _EPS))
        known = self.means(np.repeat(which, _LOOKS), d.ravel(), _RULES[0])[:, 0].reshape(d.shape)
        known = np.sqrt(np.maximum.accumulate(np.maximum(known, 0.0), axis=1))
        out = np.empty_like(p)
        for k in range(which.size):
            mine = row == k
            out[mine] = np.interp(np.sqrt(p[mine]), np.append(0.0, known[k]), np.append(0.0, d[k]))
        return out
