"""Changes of variable that make functions smooth and flat which begin and end like roots, and Gaussian sums of such functions.

A share of ``t^2`` next to an end makes what ends like a square root of a cube there, or goes on beyond, smooth and flat in t;
``t^4`` does so to what ends like a square root itself, and nearly so to ``D log D`` (a level does where its crest lets go while
its neighbours still hold). Being polynomials they leave what is smooth in D as smooth as they can.

With ``x = low + width share(t)``, where ``share`` rises like t^4 from either end, such a function is smooth in t, and the slope
of ``share`` is the weight ``(t (1 - t))^3`` of Gegenbauer polynomials. Nodes and weights are eigenvalues and first components of
eigenvectors of their recurrence (Golub & Welsch, Math. Comp. 23, 1969, 221). Their other components are the polynomials at the
nodes: they give the coefficients of the function, and how fast those fall tells what the sum misses.
"""

from functools import lru_cache
from math import comb

import numpy as np

from .chebyshev import fall_ratio
from .rounding import EPS

GENTLE, STEEP = 2, 4
#: share of the last coefficients that sums miss at least: once they are those of a layer next to an end they fall no faster
_TAIL = 0.03


def graded_share(t: np.ndarray, low: int, high: int) -> np.ndarray:
    """Share of an interval below ``t``, both in [0, 1]: like ``t^low`` next to 0 and ``1 - (1 - t)^high`` next to 1; to the
    digits of the distance from either end."""
    t, n = np.asarray(t, float), low + high - 1
    # the regularised incomplete beta function: sums of positive terms, so that no digits are lost
    terms = [comb(n, j) * t**j * (1 - t) ** (n - j) for j in range(n + 1)]
    return np.where(t <= 0.5, sum(terms[low:]), 1 - sum(terms[:low]))


@lru_cache
def graded_gauss(n: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Shares of the interval at which n nodes lie, ascending, their weights, and the matrix (n, n) from values there to
    coefficients of orthonormal polynomials."""
    j = np.arange(1, n)
    beside = np.sqrt(j * (j + 6) / ((2 * j + 6) ** 2 - 1.0))
    x, vectors = np.linalg.eigh(np.diag(beside, 1) + np.diag(beside, -1))
    t = 0.5 * (x + 1)
    return t**4 * (35 - t * (84 - t * (70 - 20 * t))), vectors[0] ** 2, vectors * vectors[0]


def left_out(projection: np.ndarray, values: np.ndarray) -> np.ndarray:
    """What means by n nodes miss of functions with ``values`` (n, ...) there, from the ``projection`` of ``graded_gauss``: they
    are exact up to order 2 n - 1, and coefficients fall further from n to there than from the middle of those known to n."""
    n = len(values)
    # next to a layer they come and go: of two at the end both may be small by chance
    known = projection[[n // 2 - 1, n // 2, n // 2, n - 3, n - 2, n - 1]]
    c = np.abs(summed(known, values)) - 16 * EPS * np.abs(values).max(axis=0)
    middle, last = np.maximum(c, 0.0).reshape(2, 3, *values.shape[1:]).max(axis=1)
    return last * np.maximum(fall_ratio(last, middle) ** 1.5, _TAIL)


def summed(weights: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Sums of ``values`` (n, ...) by ``weights`` (..., n), one after the other: no function's sum depends on those beside it."""
    one = (..., *(None for _ in values.shape[1:]))
    out = weights[..., 0][one] * values[0]
    for k in range(1, len(values)):
        out += weights[..., k][one] * values[k]
    return out
