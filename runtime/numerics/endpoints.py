"""Changes of variable that make functions smooth and flat which end like roots.

A share of ``t^2`` next to an end makes what ends like a square root of a cube there, or goes on beyond, smooth and flat in t;
``t^4`` does so to what ends like a square root itself, and nearly so to ``D log D`` (a level does where its crest lets go while
its neighbours still hold). Being polynomials they leave what is smooth in D as smooth as they can.
"""

from math import comb

import numpy as np

GENTLE, STEEP = 2, 4


def graded_share(t: np.ndarray, low: int = STEEP, high: int = STEEP) -> np.ndarray:
    """Share of an interval below ``t``, both in [0, 1]: like ``t^low`` next to 0 and ``1 - (1 - t)^high`` next to 1; to the
    digits of the distance from either end."""
    t = np.asarray(t, float)
    return np.where(t <= 0.5, _beta(t, low, high), 1 - _beta(1 - t, high, low))


def _beta(t, a: int, b: int):
    """Regularised incomplete beta function: sums of positive terms, so that no digits are lost."""
    n = a + b - 1
    return sum(comb(n, j) * t**j * (1 - t) ** (n - j) for j in range(a, n + 1))
