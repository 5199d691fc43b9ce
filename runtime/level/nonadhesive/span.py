"""The strips of a level in partial contact as nodes of an average, in panels between which what they carry is not smooth.

With ``u = cos^2(theta/2)`` a strip has the amplitude ``h u/2`` and ``s = 2 - 2 (1 - D/h)/u``. Where the crests of the
cell's edge are out of reach, D < h, contact ends at u = 1 - D/h; else the strips of small u are in complete contact,
from ``s = s_sat`` on. Hyperbolic functions of ``eta`` for ``u/|1 - D/h|`` make all scales alike however near D is to h; the
crest of the level is where eta is greatest, and the root of the distance from it takes the root out of the integrand there.
"""

from __future__ import annotations

import numpy as np

from ...numerics.gauss import graded_gauss
from ...numerics.quadrature import gauss
from ...numerics.roots import false_position
from ...numerics.rounding import EPS, LARGEST
from .family import CONTACT, Family

#: least penetration in heights: squares of what is smaller underflow; and the nearest to the height
_LEAST, _NEAREST = 1e-60, 1e-17
#: looks at where the greatest pressures of strips pass a break, and steps towards it
_LOOKS, _STEPS = 24, 2


class Span:
    """Strips in partial contact at ``d = D/h`` (m,), 0 < d < s_sat/2: eta between ``low`` and ``high``; and ``complete`` (m,),
    the angle theta from which on contact is complete."""

    def __init__(self, d: np.ndarray, s_sat: np.ndarray):
        d = np.maximum(d, _LEAST)
        self.under, self.even, self.off = d < 1, d == 1, np.maximum(np.abs(d - 1), _NEAREST)
        start = np.minimum(np.divide(2 * self.off, s_sat - 2, out=np.ones_like(d), where=s_sat > 2), 1.0)
        self.high = np.arcsinh(np.sqrt(np.where(self.under, d, 1.0) / self.off))
        low = np.where(self.under, 0.0, np.arcsinh(np.sqrt(start / self.off)))
        # at saturation nothing but rounding is left of them
        self.low = np.minimum(low, self.high * (1 - 4 * EPS))
        self.complete = np.where(self.under | self.even, np.pi, 2 * np.arccos(np.sqrt(start)))

    def strips(self, column: np.ndarray, eta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """u and s of the strips at ``eta`` (k, n) of the columns (k,)."""
        under = self.under[column, None]
        sinh, cosh = np.sinh(eta), np.cosh(eta)
        u = self.off[column, None] * np.where(under, cosh, sinh) ** 2
        with np.errstate(divide="ignore"):
            s = np.where(under, 2 * (sinh / cosh) ** 2, 2 + 2 / sinh**2)
        return u, s

    def at(self, column: np.ndarray, root: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """u, s and weights in the mean over the cell of the strips of the columns (k,) at ``root`` (k, n), that of the distance
        of eta from the crest, of which each stands for the ``share`` (k, n)."""
        crest, rest = self.high[column, None], root * root
        eta = np.maximum(crest - rest, self.low[column, None])
        slope = np.where(self.under[column, None], np.sinh(eta), np.cosh(eta))
        return *self.strips(column, eta), share * 4 / np.pi * root * slope / np.sqrt(np.sinh(rest) * np.sinh(crest + eta))

    def nodes(self, n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """n strips of every column as in ``at``, (m, n) each."""
        t, w = gauss(n)
        # towards complete contact the integrand ends like a root again
        flat = ~self.under[:, None]
        end = np.sqrt(self.high - self.low)[:, None]
        shape = np.where(flat, np.sqrt(1 + 2 * t), 1.0)
        root = end * (1 - t) * shape
        share = end * w * np.where(flat, 3 * t / shape, 1.0)
        out = self.at(np.arange(self.high.size), root, share)
        # at d = 1 all strips are alike
        for values, of in zip(out, (np.cos(0.5 * np.pi * t) ** 2, 2.0, w), strict=True):
            values[self.even] = of
        return out


def panels(span: Span, ends: np.ndarray, n: int) -> tuple[np.ndarray, ...]:
    """Panels with n strips each between the ``ends`` (m, e), ascending roots of the distance from the crest, of each column: that
    (k,), the strips' shares u and penetrations s, and their weights in the mean over the cell, (k, n)."""
    column, k = np.nonzero(np.diff(ends, axis=1) > 1e-9 * ends[:, -1:])
    low, high = ends[column, k, None], ends[column, k + 1, None]
    share, weight, _ = graded_gauss(n)
    return column, *span.at(column, low + (high - low) * share, (high - low) * weight)


def ends_of(span: Span, family: Family, group: np.ndarray, breaks: np.ndarray) -> np.ndarray:
    """Ends (m, e) of panels, between which the greatest pressure of strips passes none of ``breaks`` (m, B), K h/2."""
    length = span.high - span.low
    passed = np.maximum(span.high[:, None] - _passed(span, length, family, group, breaks), 0.0)
    return np.sqrt(np.sort(np.column_stack((np.zeros_like(length), passed, length)), axis=1))


def _passed(span, length, family, group, breaks):
    """eta (m, B) at which the greatest pressure of strips is each of the ``breaks``, or the end that is nearest to it."""
    every = np.arange(span.low.size)

    def greatest(eta):
        u, s = span.strips(every, eta)
        share, over, _ = np.moveaxis(family.values(group, s, of=CONTACT), 2, 0)
        return u * share * np.maximum(over, 0.0)

    eta = span.high[:, None] - length[:, None] * np.linspace(1, 0, _LOOKS)
    looks = greatest(eta)
    over = np.clip((looks[:, :, None] < breaks[:, None]).sum(axis=1), 1, _LOOKS - 1)
    (low, high), (f_low, f_high) = ([np.take_along_axis(v, over - side, axis=1) for side in (1, 0)] for v in (eta, looks))
    # what is never saturated is never passed
    breaks = np.minimum(breaks, LARGEST)
    f_low, f_high = f_low - breaks, f_high - breaks
    met = (f_low < 0) & (f_high > 0)
    # what is not met is next to one end: both ends are that
    low, high = np.where(met | (f_low >= 0), low, high), np.where(met | (f_low < 0), high, low)
    return false_position(lambda eta: greatest(eta) - breaks, low, high, f_low, f_high, _STEPS)
