"""Strips of a level in panels between which what they carry is not smooth.

As in ``means``, hyperbolic functions of ``eta`` stand for ``u/|1 - D/h|``; the crest of the level is where eta is greatest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...numerics.quadrature import gauss, mapped, mapped_slope
from .family import Family
from .peaks import Peaks

#: looks at where the greatest pressures of strips pass a break, and steps towards it
_LOOKS, _STEPS = 24, 2
#: eta from the crest at which a panel that is longer by half ends, and beyond which strips are too few to matter
_SPLITS, _FARTHEST = (2.0, 5.0), 16.0
#: nearest penetration to the height
_NEAREST = 1e-14
#: a pressure that no strip has, K h/2
_BEYOND = 1e200
_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class Panels:
    """Nodes (k, n) of panels: the ``column`` (k,) of each, share ``u`` and penetration ``s`` of its strips, and their ``weight``
    in the mean over the cell."""

    column: np.ndarray
    u: np.ndarray
    s: np.ndarray
    weight: np.ndarray


class Span:
    """Strips in partial contact at ``d`` (m,), 0 < d < s_sat/2: eta between ``low`` and ``high``."""

    def __init__(self, d: np.ndarray, s_sat: np.ndarray):
        beyond = np.where(d < 1, np.minimum(d - 1, -_NEAREST), np.maximum(d - 1, _NEAREST))
        self.under, self.off = d < 1, np.abs(beyond)
        start = np.divide(2 * self.off, s_sat - 2, out=np.ones_like(d), where=s_sat > 2)
        ratio = np.where(self.under, np.minimum(d, 1 - _NEAREST), 1.0) / self.off
        self.high = np.arcsinh(np.sqrt(ratio))
        low = np.where(self.under, 0.0, np.arcsinh(np.sqrt(np.minimum(start, 1.0) / self.off)))
        # at saturation nothing but rounding is left of them
        low = np.minimum(low, self.high * (1 - 4 * _EPS))
        self.low = np.maximum(low, self.high - _FARTHEST)

    def strips(self, column: np.ndarray, eta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """u and s of the strips at ``eta`` (k, n) of the columns (k,)."""
        under = self.under[column, None]
        sinh, cosh = np.sinh(eta), np.cosh(eta)
        u = self.off[column, None] * np.where(under, cosh, sinh) ** 2
        with np.errstate(divide="ignore"):
            s = np.where(under, 2 * (sinh / cosh) ** 2, 2 + 2 / sinh**2)
        return u, s

    def panels(self, ends: np.ndarray, n: int) -> Panels:
        """Panels with n strips each between the ``ends`` (m, e), ascending roots of the distance from the crest, of each
        column."""
        column, k = np.nonzero(np.diff(ends, axis=1) > 1e-9 * ends[:, -1:])
        low, high = ends[column, k, None], ends[column, k + 1, None]
        t, w = gauss(n)
        root = low + (high - low) * mapped(t)
        crest, rest = self.high[column, None], root * root
        eta = np.maximum(crest - rest, self.low[column, None])
        u, s = self.strips(column, eta)
        slope = np.where(self.under[column, None], np.sinh(eta), np.cosh(eta))
        weight = w * mapped_slope(t) * (high - low) * 4 / np.pi * root * slope / np.sqrt(np.sinh(rest) * np.sinh(crest + eta))
        return Panels(column, u, s, weight)

    def ends(self, family: Family, peaks: Peaks, group: np.ndarray, breaks: np.ndarray) -> np.ndarray:
        """Ends (m, e) of panels, between which the greatest pressure of strips passes none of ``breaks`` (m, B), K h/2."""
        length = self.high - self.low
        far = [np.where(length > 1.5 * split, split, 0.0) for split in _SPLITS]
        passed = np.maximum(self.high[:, None] - self._passed(family, peaks, group, breaks), 0.0)
        return np.sqrt(np.sort(np.column_stack((np.zeros_like(length), *far, passed, length)), axis=1))

    def _passed(self, family, peaks, group, breaks):
        """eta (m, B) at which the greatest pressure of strips is each of the ``breaks``, or the end that is nearest to it."""
        every = np.arange(self.low.size)

        def greatest(eta):
            u, s = self.strips(every, eta)
            return u * peaks.at(group, family.values(group, s)[:, :, 2])[0]

        eta = self.low[:, None] + (self.high - self.low)[:, None] * np.linspace(0, 1, _LOOKS)
        looks = greatest(eta)
        over = np.clip((looks[:, :, None] < breaks[:, None]).sum(axis=1), 1, _LOOKS - 1)
        (low, high), (f_low, f_high) = ([np.take_along_axis(v, over - side, axis=1) for side in (1, 0)] for v in (eta, looks))
        # what is never saturated is never passed
        breaks = np.minimum(breaks, _BEYOND)
        f_low, f_high = f_low - breaks, f_high - breaks
        middle = np.where(f_low >= 0, low, high)
        met = (f_low < 0) & (f_high > 0)
        for _ in range(_STEPS):
            middle = np.where(met, (low * f_high - high * f_low) / np.where(met, f_high - f_low, 1.0), middle)
            f = greatest(middle) - breaks
            less = f <= 0
            low, high = np.where(less, middle, low), np.where(less, high, middle)
            f_low, f_high = np.where(less, f, 0.5 * f_low), np.where(less, 0.5 * f_high, f)
        return middle
