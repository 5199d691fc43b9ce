"""Means of a level without adhesion at any load, as integrals over its strips of functions that are known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...numerics.rules import Changes, by_rules
from .family import Family
from .span import Span

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
#: slope of friction over pressure, k h, that is never reached
_STEEPEST = 2.0
#: what is left in a level's mean of the greatest error of its strips, and of errors that change sign from one strip
#: sampled to the next
CANCELLED, _WAVES = 0.2, 3.4
_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class Level:
    """A level as all columns share it: ``K`` times height, and ``k h``; pressures in K h, friction in K h k h."""

    family: Family

    def means(self, group: np.ndarray, d: np.ndarray, n: int, slopes: bool = False) -> np.ndarray:
        """Mean pressure (K h), friction (K h kh), contact fraction of the columns at ``d`` (m,), and with ``slopes``
        those of the first two by d."""
        f = self.family
        span = Span(d, f.s_sat[group])
        u, s, weight = span.nodes(n)
        values = f.values(group, s, slopes)
        A = 0.5 * u
        out = np.empty((d.size, 5 if slopes else 3))
        for j, power in enumerate((A, A * A, 1.0, 1.0, A)[: out.shape[1]]):
            out[:, j] = (weight * power * values[:, :, j]).sum(axis=1)
        return out + self._complete(span.complete, d, f.full[group, 1], slopes)

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

    def at(
        self, group: np.ndarray, load: np.ndarray, by_pressure: bool, goal: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Penetrations, means and errors (m, 3), to ``goal`` (m, 3), at any load: d, or the pressure, which is then met."""
        d = self.penetrations(group, load) if by_pressure else load.copy()
        values, errors = (
            np.stack((d - 0.75, 0.09375 * self.family.full[group, 1], np.ones(d.size)), axis=1),
            np.zeros((d.size, 3)),
        )
        values[d <= 0] = 0.0
        part = np.flatnonzero((d > 0) & (d < 0.5 * self.family.s_sat[group]))
        if part.size:
            means, errors[part] = self.sure_means(group[part], d[part], goal[part], by_pressure)
            if by_pressure:
                rise = np.where(means[:, 3] > 0, means[:, 3], np.inf)
                # friction is pressure times slope: where means of next to nothing vary by chance they say nothing else
                slope = np.clip(means[:, 4] / rise, -_STEEPEST, _STEEPEST)
                lift = load[part] - means[:, 0]
                d[part] += lift / rise
                means[:, 0], means[:, 1] = load[part], means[:, 1] + slope * lift
                errors[part, 1] += np.abs(slope) * (errors[part, 0] + _EPS)
            values[part] = means[:, :3]
        return d, values, errors

    def penetrations(self, group: np.ndarray, p: np.ndarray) -> np.ndarray:
        """d at which the mean pressure (K h) is ``p`` (m,), nowhere below none."""
        d = np.where(p > 0, p + 0.75, 0.0)
        part = np.flatnonzero((p > 0) & (d < 0.5 * self.family.s_sat[group]))
        if part.size:
            d[part] = self._partly(group[part], p[part])
        return d

    def _partly(self, group, p):
        """``penetrations`` between none and that of saturation: Newton on the root of the pressure, which is nearly linear."""
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
        """About what ``_partly`` finds, from a few of them."""
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
