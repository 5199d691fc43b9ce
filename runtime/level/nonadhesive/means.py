"""Means of a level without adhesion at any load, as integrals over its strips of functions that are known."""

from dataclasses import dataclass

import numpy as np

from ...numerics.roots import rising_root
from ...numerics.rounding import EPS
from ...numerics.rules import by_rules
from .family import CUT, MEANS, Family
from .span import Span

#: nodes of the rules tried in turn; the second is what penetrations are looked for with, the third what laws are parted with
_RULES = (8, 12, 18, 27, 40, 60, 90)
#: share of what is allowed that a sum over nodes may miss, and how much more than by the next terms of a series its values are
#: feared to err
_QUADRATURE, _SURE = 0.5, 3.0
#: terms of a series from which on it has layers that a few nodes see by chance, and the fastest that sums are believed to
#: converge then (0.01 told a sixth of an error at 1e-9) and otherwise (of 500 random levels none erred by more than it said)
_LAYERED, _FASTEST = 120, (0.25, 0.01)
#: penetrations are looked for to this, relative, what is left being taken up by slopes
_CLOSE = 1e-7
#: slope of friction over pressure, k h, that is never reached
_STEEPEST = 2.0
#: what is left in a mean of the greatest error of strips' pressures, or of a law's friction: along its pieces errors change sign
CANCELLED = 0.3
#: strips for means of what series leave out; and means of Chebyshev polynomials in pressure, friction and contact times their
#: degree, where that is not low: medians of 40 random surfaces
_NODES, _FEW, _PACE = 30, 32, (1.25, 0.6, 2.5)


@dataclass(frozen=True)
class Level:
    """A level as all columns share it: ``K`` times height, and ``k h``; pressures in K h, friction in K h k h."""

    family: Family

    def means(self, group: np.ndarray, d: np.ndarray, n: int = _RULES[2], slopes: bool = False, of: slice = MEANS) -> np.ndarray:
        """Mean pressure (K h), friction (K h kh), contact fraction of the columns at ``d`` (m,), and with ``slopes``
        theirs by d; or what is cut off the series of these."""
        f = self.family
        span = Span(d, f.s_sat[group])
        u, s, weight = span.nodes(n)
        values = f.values(group, s, slopes, of)
        A = 0.5 * u
        powers = (A, A * A, 1.0, 1.0, A, 1 / A) if slopes else (A, A * A, 1.0)
        out = np.empty((d.size, len(powers)))
        for j, power in enumerate(powers):
            out[:, j] = (weight * power * values[:, :, j]).sum(axis=1)
        return out if of == CUT else out + self._complete(span.complete, d, f.full[group], slopes)

    def _complete(self, theta, d, friction, slopes):
        """The share of the strips in complete contact, beyond ``theta``: ``p = D_j - A``."""
        rest = np.pi - theta
        u = (rest - np.sin(rest)) / (2 * np.pi)
        u_square = (1.5 * rest - 2 * np.sin(rest) + 0.25 * np.sin(2 * rest)) / (4 * np.pi)
        out = [(d - 1) * rest / np.pi + 0.5 * u, 0.25 * friction * u_square, rest / np.pi]
        if slopes:
            out += [rest / np.pi, np.zeros_like(rest), np.zeros_like(rest)]
        return np.stack(out, axis=1)

    def sure_means(
        self, group: np.ndarray, d: np.ndarray, goal: np.ndarray, p: np.ndarray | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Means with as many nodes as it takes for ``goal`` (m, 3), and their errors (m, 3). With ``p`` (m,) friction and
        contact are those at these pressures next to those at ``d``, and the slopes follow: of pressure by d, of the others by
        pressure."""

        def sums(left, n):
            out = self.means(group[left], d[left], n, p is not None)
            if p is not None:
                # mean pressure is K times mean displacement, which rises with d wherever there is contact
                out[:, 3] = np.maximum(out[:, 3], np.maximum(out[:, 2], np.finfo(float).tiny))
                # friction is pressure times slope: where means of next to nothing vary by chance they say nothing else
                out[:, 4] = np.clip(out[:, 4] / out[:, 3], -_STEEPEST, _STEEPEST)
                out[:, 5] = np.maximum(out[:, 5], 0.0) / out[:, 3]
                out[:, 1:3] += out[:, 4:] * (p[left] - out[:, 0])[:, None]
                out[:, 2] = np.clip(out[:, 2], 0.0, 1.0)
            return out

        size = np.array([self.family.series[g].shape[0] for g in group])
        fastest = np.where(size > _LAYERED, *_FASTEST)
        out, errors = by_rules(sums, _RULES, _QUADRATURE * goal, fastest)
        slopes = out[:, 4:] if p is not None else np.zeros((d.size, 2))
        return out, errors + self.errors(group, d, slopes) + EPS * (1 + 16 * np.abs(out[:, :3]))

    def errors(self, group: np.ndarray, d: np.ndarray, slopes: np.ndarray) -> np.ndarray:
        """What the errors of the strips' means make of the level's, (m, 3); those of friction and contact are at a given
        pressure, where the pressure's error counts by their ``slopes`` (m, 2).

        What the next terms of the series would add is the error, as with the lower rule of an embedded pair (Hairer, Norsett &
        Wanner, "Solving Ordinary Differential Equations I", 1993, section II.4). The others, and those that the nodes take for
        terms that are kept, begin with the degree that was interpolated (Trefethen, "Approximation Theory and Approximation
        Practice", 2013, theorem 4.2); means of Chebyshev polynomials fall at least like its inverse."""
        f = self.family
        known, others = self.means(group, d, _NODES, of=CUT), f.errors[group] * _PACE / np.maximum(f.degree[group, None], _FEW)
        known[:, 1:] -= slopes * known[:, :1]
        others[:, 1:] += np.abs(slopes) * others[:, :1]
        return _SURE * np.abs(known) + others

    def at(
        self, group: np.ndarray, load: np.ndarray, by_pressure: bool, goal: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Penetrations, means and errors (m, 3), to ``goal`` (m, 3), at any load: d, or the pressure, which is then met."""
        d = self.penetrations(group, load) if by_pressure else load.copy()
        values, errors = (
            np.stack((d - 0.75, 0.09375 * self.family.full[group], np.ones(d.size)), axis=1),
            np.zeros((d.size, 3)),
        )
        values[d <= 0] = 0.0
        part = np.flatnonzero((d > 0) & (d < 0.5 * self.family.s_sat[group]))
        if part.size:
            p = load[part] if by_pressure else None
            means, errors[part] = self.sure_means(group[part], d[part], goal[part], p)
            if p is not None:
                d[part] = np.maximum(d[part] + (p - means[:, 0]) / means[:, 3], p)
                means[:, 0] = p
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
        """``penetrations`` between none and that of saturation: pressures are nearly powers."""
        low, high = p, np.minimum(p + 0.75, 0.5 * self.family.s_sat[group])

        def over(log_d, index):
            at = self.means(group[index], np.exp(log_d), _RULES[1], True)
            pressure = np.maximum(at[:, 0], np.finfo(float).tiny)
            return np.log(pressure / p[index]), at[:, 3] * (np.exp(log_d) / pressure)

        # crests are paraboloids next to the plane: at rest they carry d^2/(2 pi)
        return np.exp(rising_root(over, np.log(low), np.log(high), 0.5 * np.log(2 * np.pi * p), _CLOSE))
