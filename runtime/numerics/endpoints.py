"""Changes of variable that make functions smooth and flat which end like roots.

A share of ``t^2`` next to an end makes what ends like a square root of a cube there, or goes on beyond, smooth and flat in t;
``t^4`` does so to what ends like a square root itself, and nearly so to ``D log D`` (a level does where its crest lets go while
its neighbours still hold). Being polynomials they leave what is smooth in D as smooth as they can.
"""

from dataclasses import dataclass
from math import comb

import numpy as np

GENTLE, STEEP = 2, 4
_NEWTON = 8


@dataclass(frozen=True)
class EndpointMap:
    """Shares of an interval over t, both in [0, 1]: like ``t^low`` next to 0 and ``1 - (1 - t)^high`` next to 1."""

    low: int = STEEP
    high: int = STEEP

    def share(self, t: np.ndarray) -> np.ndarray:
        """Share of the interval below ``t``; next to either end to the digits of the distance from it."""
        t = np.asarray(t, float)
        return np.where(t <= 0.5, _beta(t, self.low, self.high), 1 - _beta(1 - t, self.high, self.low))

    def parameter(self, share: np.ndarray) -> np.ndarray:
        """t at which ``share`` lies below."""
        share = np.asarray(share, float)
        above = share > self.share(0.5)
        return np.where(above, 1 - _root(1 - share, self.high, self.low), _root(share, self.low, self.high))


def _beta(t, a: int, b: int):
    """Regularised incomplete beta function: sums of positive terms, so that no digits are lost."""
    n = a + b - 1
    return sum(comb(n, j) * t**j * (1 - t) ** (n - j) for j in range(a, n + 1))


def _root(share, a: int, b: int):
    """Where ``_beta`` is ``share``, up to its value at 1/2: Newton on its a-th root, which is all but linear there."""
    goal = np.minimum(share, _beta(0.5, a, b)) ** (1 / a)
    first = comb(a + b - 1, a)
    t = np.minimum(goal / first ** (1 / a), 0.5)
    for _ in range(_NEWTON):
        value = np.maximum(_beta(t, a, b), np.finfo(float).tiny)
        rise = first * t ** (a - 1) * (1 - t) ** (b - 1)
        root = value ** (1 / a)
        slope = root * rise / value
        t = np.clip(t + np.divide(goal - root, slope, out=np.zeros_like(t), where=slope > 0), 0.0, 1.0)
    return t
