"""Weights on the nested interior nodes of ``chebyshev``, and what a sum with them misses.

A strength above 1 (``endpoints``) makes the integrand vanish at that end, which is then as good as a node. With both ends that
gives the rule of Clenshaw & Curtis ("A method for numerical integration on an automatic computer", Numer. Math. 2, 1960, 197),
all but as good as Gauss's (Trefethen, "Is Gauss quadrature better than Clenshaw-Curtis?", SIAM Review 50, 2008, 67), with
neither Fejér's second rule: Waldvogel, "Fast construction of the Fejér and Clenshaw-Curtis quadrature rules" (BIT 46, 2006,
195).
"""

from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev as series

from . import endpoints
from .chebyshev import nodes, second_kind

#: terms of the sums over what is missed; rates that these are tabulated at
_TERMS = 1024
_RATES = np.linspace(0.0, 0.985, 128)


def _integrals(j):
    """Integrals of U_j over [0, 1], by ``U_-j = -U_(j - 2)`` also for negative j."""
    return np.where(j % 2 == 0, 1 / (j + 1.0 + (j == -1)), 0.0)


@lru_cache
def weights(n: int, low: int = 1, high: int = 1) -> np.ndarray:
    """Weights (n,) on [0, 1] of values at ``nodes(n)``, the derivative of the map of strengths ``low`` and ``high`` included."""
    moments = _integrals(np.arange(n + 2))
    plain = moments[:n] @ second_kind(n)
    # the one polynomial of degree n that vanishes at the nodes is U_n, that of degree n + 1 with the other parity x U_n: so
    # much of them is added that the integrand's polynomial vanishes at the ends
    at_high = np.arange(1, n + 1) @ second_kind(n)
    at_low = (np.arange(1, n + 1) * (-1.0) ** np.arange(n)) @ second_kind(n)
    even, odd = moments[n], 0.5 * (moments[n + 1] + _integrals(np.array(n - 1)))
    size, sign = n + 1.0, (-1.0) ** n
    if low > 1 and high > 1:
        plain = plain - even * 0.5 * (at_high + sign * at_low) / size - odd * 0.5 * (at_high - sign * at_low) / size
    elif high > 1:
        plain = plain - even * at_high / size
    elif low > 1:
        plain = plain - even * sign * at_low / size
    return plain * endpoints.slope(nodes(n), low, high)


def rule(n: int, low: int = 1, high: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Points and weights (n,) on (0, 1) for functions that end like roots: ``low``, ``high`` as in ``endpoints``."""
    return endpoints.share(nodes(n), low, high), weights(n, low, high)


@lru_cache
def _missed(n: int, low: int, high: int) -> np.ndarray:
    """At each of ``_RATES``: the sum of what the rule misses of U_n and all higher ones with coefficients 1, rate, rate^2, ..."""
    degree = np.arange(n, n + _TERMS)
    rise = series.chebfit(2 * nodes(63) - 1, endpoints.slope(nodes(63), low, high), 62)
    k = np.arange(rise.size)
    # U_j T_k = (U_(j + k) + U_(j - k))/2
    exact = 0.5 * (_integrals(degree[:, None] + k) + _integrals(degree[:, None] - k)) @ rise
    angle = np.pi * np.arange(n, 0, -1) / (n + 1)
    sums = (np.sin(np.outer(degree + 1, angle)) / np.sin(angle)) @ weights(n, low, high)
    return _RATES[:, None] ** np.arange(_TERMS) @ np.abs(sums - exact)


def missed(n: int, low: int, high: int, rate: np.ndarray) -> np.ndarray:
    """Largest error (...) on [0, 1] of the rule with n nodes where the coefficients of U_n and onwards are 1, rate, rate^2,
    ..."""
    return np.interp(rate, _RATES, _missed(n, low, high))
