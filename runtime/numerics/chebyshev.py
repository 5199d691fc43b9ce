"""Chebyshev series on [0, 1] through values at interior nodes, for many functions at once.

One family of nodes serves interpolation and quadrature: the zeros of the Chebyshev polynomial of the second kind U_n. They are
nested (n to 2 n + 1) and leave out the ends, which are breakpoints of the caller's function: on which side of one a point lies
is decided by rounding. Series are sums of ``c_j T_j(2 t - 1)``.

Sums are by the recurrence of Clenshaw, "A note on the summation of Chebyshev series" (Math. Tables Aids Comput. 9, 1955, 118);
the rest is numpy.polynomial.chebyshev and chapter 4 of Mason & Handscomb, "Chebyshev Polynomials" (2003).
"""

from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev

#: points summed up at a time: their intermediate results stay in the processor's cache
_CHUNK = 4096


@lru_cache
def nodes(n: int) -> np.ndarray:
    """The n nodes in (0, 1), ascending; every other one of ``nodes(2 n + 1)``, from the second on."""
    return np.sin(0.5 * np.pi * np.arange(1, n + 1) / (n + 1)) ** 2


@lru_cache
def second_kind(n: int) -> np.ndarray:
    """Matrix (n, n) from values at ``nodes(n)`` to coefficients of U_0 to U_(n-1): a discrete sine transform.

    A matrix, not a fast transform: below some 200 nodes its product with a stack of values takes less time, and each function's
    coefficients do not depend on those beside it.
    """
    angle = np.pi * np.arange(n, 0, -1) / (n + 1)  # ascending nodes have falling angles
    return (2 / (n + 1)) * np.sin(np.outer(np.arange(1, n + 1), angle)) * np.sin(angle)


@lru_cache
def interpolation(n: int, flat_low: bool = False, flat_high: bool = False) -> np.ndarray:
    """Matrix (n + 2, n) from values at ``nodes(n)`` to coefficients of T_0 to T_(n+1).

    Towards an end that is ``flat`` the derivative vanishes; the polynomial's degree is n - 1 and one more for each such end.
    Without that it errs n times as much at an end as in between.
    """
    degree = np.arange(n + 2)
    conditions = np.zeros((2, n + 2))
    conditions[0] = degree**2 / n**2 if flat_high else degree == n + 1
    conditions[1] = (-1.0) ** degree * degree**2 / n**2 if flat_low else degree == (n if not flat_high else n + 1)
    return np.linalg.inv(np.vstack((chebyshev.chebvander(2 * nodes(n) - 1, n + 1), conditions)))[:, :n]


@lru_cache
def vandermonde(n: int, t: tuple[float, ...]) -> np.ndarray:
    """Matrix (len(t), n) from coefficients to values at the fixed parameters ``t`` in [0, 1]."""
    return chebyshev.chebvander(2 * np.array(t) - 1, n - 1)


@lru_cache
def _differentiation(n: int) -> np.ndarray:
    return np.pad(2 * chebyshev.chebder(np.eye(n)), ((0, 1), (0, 0))) if n > 1 else np.zeros((1, 1))


def derivative(c: np.ndarray) -> np.ndarray:
    """Coefficients (..., n, q) of the derivatives by t of the series ``c`` (..., n, q); the last one is zero."""
    return _differentiation(c.shape[-2]) @ c


def clenshaw(table: np.ndarray, which: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Sums (q, m) of the series ``which`` (m,) of a ``table`` (n, q, series) at ``t`` (m,) in [0, 1]."""
    out = np.empty((table.shape[1], which.size))
    for start in range(0, which.size, _CHUNK):
        some = slice(start, start + _CHUNK)
        out[:, some] = _sums(table, which[some], t[some])
    return out


def _sums(table, which, t):
    x = 2 * t - 1
    twice, shape = 2 * x, (table.shape[1], which.size)
    newer, older, product, term = np.zeros(shape), np.zeros(shape), np.empty(shape), np.empty(shape)
    for k in range(table.shape[0] - 1, -1, -1):
        # in place, the older one becoming the newer: all the time is spent here
        np.multiply(twice if k else x, newer, out=product)
        np.subtract(product, older, out=older)
        older += np.take(table[k], which, axis=1, out=term, mode="clip")
        newer, older = older, newer
    return newer
