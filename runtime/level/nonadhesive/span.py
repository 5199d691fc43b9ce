"""The strips of a level in partial contact as nodes of an average.

With ``u = cos^2(theta/2)`` a strip has the amplitude ``h u/2`` and ``s = 2 - 2 (1 - D/h)/u``. Where the crests of the
cell's edge are out of reach, D < h, contact ends at u = 1 - D/h; else the strips of small u are in complete contact,
from ``s = s_sat`` on. Hyperbolic functions of ``eta`` for ``u/|1 - D/h|`` make all scales alike however near D is to h; the
crest of the level is where eta is greatest, and the root of the distance from it takes the root out of the integrand there.
"""

import numpy as np

from ...numerics.quadrature import gauss
from ...numerics.rounding import EPS

#: least penetration in heights: squares of what is smaller underflow; and the nearest to the height
_LEAST, _NEAREST = 1e-60, 1e-17


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
