"""Clenshaw-Curtis sums on nested nodes of an interval whose ends may be like square roots, with an error from the decay of coefficients.

``x = low + width (3 t^2 - 2 t^3)``: what starts or ends like a square root in x is smooth in t, and a polynomial in x stays one in t. The ends
are no nodes: the weight vanishes there, so that nothing need be known of what happens on them.
"""

from functools import lru_cache

import numpy as np

_EPS = np.finfo(float).eps
#: share of the roughest quantity's relative error that every other one is taken to have at least
_COMMON = 0.1
#: slowest decay that a sum of the rest may be extrapolated with
_SLOWEST = 6.0
#: from so many nodes on the pace of coefficients is plain, and below this ratio of the last to the middle ones it is geometric
_PLAIN, _GEOMETRIC = 16, 0.05


def mapped(t):
    """Where parameter t in [0, 1] lies in its interval, as a share of it."""
    return t * t * (3 - 2 * t)


@lru_cache
def interior_nodes(n: int) -> np.ndarray:
    """Interior Clenshaw-Curtis nodes on (0, 1)."""
    j = np.arange(1, n)
    return np.sin(0.5 * np.pi * j / n) ** 2


@lru_cache
def mapped_weights(n: int) -> np.ndarray:
    """Clenshaw-Curtis weights at the interior nodes, times the derivative of ``mapped`` (zero at both ends)."""
    j = np.arange(1, n)
    m = np.arange(1, n // 2 + 1)
    b = np.where(m == n / 2, 1.0, 2.0)
    angle = 2 * np.outer(j, m) * np.pi / n
    weights = (2 / n) * (1 - (b * np.cos(angle) / (4 * m**2 - 1)).sum(axis=1)) / 2
    t = interior_nodes(n)
    return weights * 6 * t * (1 - t)


@lru_cache
def _second_kind(n: int) -> np.ndarray:
    """Matrix from values at ``interior_nodes(n)`` to coefficients of Chebyshev polynomials of the second kind, (n - 1, n - 1)."""
    angle = np.arange(1, n) * np.pi / n
    return (2 / n) * np.sin(np.outer(np.arange(1, n), angle)) * np.sin(angle)


def sum_errors(values: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """Error of the sum over nodes of each interval, per width, (p, q); ``values`` (p, n - 1, q), ``noise`` (p, q): changes that don't matter.

    The last coefficients say how much is left, and what they have lost against those in the middle how fast it falls. All quantities share their
    singularities: the slowest decay is taken for all, and none is taken to be much smoother than the roughest.
    """
    n = values.shape[1] + 1
    c = np.abs(np.einsum("kj,pjq->pkq", _second_kind(n), values))
    # what is rounding says nothing of the singularities
    c = np.maximum(c - 16 * _EPS * np.abs(values).max(axis=1)[:, None], 0.0)
    amplitude = c[:, 1:].max(axis=1) + noise + np.finfo(float).tiny
    shape = (c / amplitude[:, None]).max(axis=2)
    last, middle = shape[:, n - 4 :].max(axis=1), shape[:, n // 2 - 3 : n // 2].max(axis=1)
    decay = (np.minimum(np.divide(last, middle, out=np.ones_like(last), where=middle > last), 1.0)) ** (1 / (n // 2 - 1))
    # the rule integrates polynomials of degree n exactly, and nearly so for half of that beyond
    beyond = decay ** (1 + n / 4)
    if n >= _PLAIN:
        # coefficients that fall geometrically without doubt: those up to 3 n/2 count with weights like 1/n^2, the later ones are that much smaller
        ratio = decay ** (n // 2 - 1)
        beyond = np.where(ratio < _GEOMETRIC, np.minimum(beyond, np.maximum(ratio, 2 * decay / n**2)), beyond)
    rest = (np.minimum(1 / np.maximum(1 - decay, 1e-3), _SLOWEST) * beyond)[:, None]
    return np.maximum(c[:, n - 4 :].max(axis=1), _COMMON * last[:, None] * amplitude) * rest
