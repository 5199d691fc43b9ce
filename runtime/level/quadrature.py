"""Clenshaw-Curtis sums on nested nodes of an interval whose ends may be like square roots, with an error from the decay of
coefficients.

``x = low + width (3 t^2 - 2 t^3)``: what starts or ends like a square root in x is smooth in t, and a polynomial in x stays one
in t. The ends are no nodes: the weight vanishes there, so that nothing need be known of what happens on them.
"""

from functools import lru_cache

import numpy as np

_EPS = np.finfo(float).eps
#: share of the roughest quantity's relative error that every other one is taken to have at least
_COMMON = 0.3
#: slowest decay that a sum of the rest may be extrapolated with
_SLOWEST = 6.0
#: number of nodes from which on coefficients are many; up to it and from it on: the fastest decay believed, and the ratio of the
#: last coefficients to the middle ones below which they surely fall geometrically
_MANY, _FASTEST, _GEOMETRIC = 16, (0.43, 0.35), (0.15, 0.05)
#: so many coefficients in a row are not small by chance where a pair of singularities makes them come and go
_RUN = 5
#: how much more than what the run leaves at its end is feared
_SAFE = 2.0


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


@lru_cache
def _missed(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Orders ``j = n + 1, n + 3 ... 2 n - 1`` of the polynomials ``sin(j phi)/sin(phi)`` that the sum does not integrate exactly,
    and how far it is off.

    Their integrals are ``m(j) = -3/(j (j^2 - 4))``, zero for even j, and at the nodes order ``2 n - j`` looks like j.
    """
    j = np.arange(n + 1, 2 * n, 2)
    integral = lambda j: 3 / np.abs(j * (j**2.0 - 4))  # noqa: E731
    return j, integral(j) + integral(2 * n - j)


def sum_errors(values: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """Error of the sum over nodes of each interval, per width, (p, q); ``values`` (p, n - 1, q), ``noise`` (p, q): changes that
    don't matter.

    The last coefficients say how much is left, and what they have lost against those in the middle how fast it falls. All
    quantities share their singularities: the slowest decay is taken for all, and none is taken to be much smoother than the
    roughest.
    """
    n = values.shape[1] + 1
    c = np.abs(_second_kind(n) @ values)
    # what is rounding says nothing of the singularities
    c = np.maximum(c - 16 * _EPS * np.abs(values).max(axis=1)[:, None], 0.0)
    amplitude = c[:, 1:].max(axis=1) + noise + np.finfo(float).tiny
    shape = (c / amplitude[:, None]).max(axis=2)
    # a run long enough that coefficients which change their sign in it are not all small
    few = max(_RUN, n // 5) if n > 8 else 3
    last, middle = shape[:, -few:].max(axis=1), shape[:, n // 2 - 3 : n // 2].max(axis=1)
    ratio = np.minimum(np.divide(last, middle, out=np.ones_like(last), where=middle > last), 1.0)
    decay = ratio ** (1 / (0.5 * (n + 1 - few)))
    many = int(n >= _MANY)
    # what the rule makes of a tail that goes on geometrically, from the last coefficient on
    believed = np.maximum(decay, _FASTEST[many])
    orders, off = _missed(n)
    beyond = believed[:, None] ** (orders - (n - 1)) @ off + believed ** (n + 1) / (1 - np.minimum(believed, 0.999) ** 2)
    # where coefficients may fall by a power only: as if nothing cancelled
    slow = np.minimum(1 / np.maximum(1 - decay, 1e-3), _SLOWEST) * decay ** (1 + n / 4)
    rest = np.where(ratio < _GEOMETRIC[many], beyond, np.maximum(beyond, slow))[:, None]
    if n == 8:
        return np.maximum(c[:, -few:].max(axis=1), _COMMON * last[:, None] * amplitude) * rest
    # what earlier coefficients of the run leave at its end, at that pace
    fading = believed[:, None] ** np.arange(few - 1, -1, -1)
    left, common = (c[:, -few:] * fading[:, :, None]).max(axis=1), (shape[:, -few:] * fading).max(axis=1)
    return _SAFE * np.maximum(left, _COMMON * common[:, None] * amplitude) * rest
