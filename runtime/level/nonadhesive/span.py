"""The strips of a level in partial contact as nodes of an average, in panels between which what they carry is not smooth.

With ``u = cos^2(theta/2)`` a strip has the amplitude ``h u/2`` and ``s = 2 - 2 (1 - D/h)/u``. Where the crests of the
cell's edge are out of reach, D < h, contact ends at u = 1 - D/h; else the strips of small u are in complete contact,
from ``s = s_sat`` on. Hyperbolic functions of ``eta`` for ``u/|1 - D/h|`` make all scales alike however near D is to h; the
crest of the level is where eta is greatest, and the root of the distance from it takes the root out of the integrand there.
"""

from __future__ import annotations

import numpy as np

from ...numerics.gauss import graded_gauss
from ...numerics.quadrature import gauss, mapped, mapped_slope
from ...numerics.roots import falling_root
from ...numerics.rounding import EPS
from .family import CONTACT, Family

#: least penetration in heights: squares of what is smaller underflow
_LEAST = 1e-60
#: how closely it is known where the greatest pressures of strips pass a break
_CLOSE = 1e-5


class Span:
    """Strips in partial contact at ``d = D/h`` (m,), 0 < d < s_sat/2: eta between ``low`` and ``high``."""

    def __init__(self, d: np.ndarray, s_sat: np.ndarray):
        d = np.maximum(d, _LEAST)
        self.under, self.even = d < 1, d == 1
        self.off = np.where(self.even, 1.0, np.abs(d - 1))
        start = np.minimum(np.divide(2 * self.off, s_sat - 2, out=np.ones_like(d), where=s_sat > 2), 1.0)
        self.high = np.arcsinh(np.sqrt(np.where(self.under, d, 1.0) / self.off))
        low = np.where(self.under | self.even, 0.0, np.arcsinh(np.sqrt(start / self.off)))
        # at saturation nothing but rounding is left of them
        self.low = np.minimum(low, self.high * (1 - 4 * EPS))

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
        length, rest = (self.high - self.low)[:, None], 1 - mapped(t)
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
        passed[met] = falling_root(lambda eta, index: -over(eta, met[index]), low, high, tolerance=_CLOSE)
        rest = np.maximum(self.high[:, None] - passed.reshape(breaks.shape), 0.0)
        return np.sqrt(np.sort(np.column_stack((np.zeros_like(self.low), rest, self.high - self.low)), axis=1))
