"""Chebyshev series of several quantities at once: through values at nested nodes, with the error that is left.

A function that is flat in t at both ends (``gauss``) is had from the interior nodes: what it is at an end, a breakpoint of the
caller's, need not be known. Compare chapter 4 of Mason & Handscomb, "Chebyshev Polynomials" (2003); sums over many series are by
the recurrence of Clenshaw, "A note on the summation of Chebyshev series" (Math. Tables Aids Comput. 9, 1955, 118).
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebvander

from .roots import falling_root
from .rounding import EPS

#: all quantities share their singularities: power of the roughest one's coefficients, relative to its own, in those of the others
_COMMON = 0.2
#: ratio of the last coefficients to those in the middle below which they surely fall geometrically
_GEOMETRIC = 0.01
#: how much of the last coefficient a sum of the rest is at least and at most, and how much more than that sum is feared: a sum
#: that falls by a power is up to three times one that falls geometrically at first
_FASTEST, _SLOWEST, _SAFE = 0.5, 32.0, 3.0
#: sums at a time: what is known of them stays in the cache
_CHUNK = 4096


@lru_cache
def lobatto(n: int) -> np.ndarray:
    """Chebyshev-Lobatto nodes on [0, 1], ascending, n + 1 of them; those of n/2 are every other one."""
    return np.sin(0.5 * np.pi * np.arange(n + 1) / n) ** 2


def coefficients(values: np.ndarray) -> np.ndarray:
    """Chebyshev coefficients (..., n + 1, q) of the interpolants through ``values`` (..., n + 1, q) at ``lobatto(n)``."""
    return _transform(values.shape[-2] - 1) @ values


@lru_cache
def _transform(n: int) -> np.ndarray:
    j = np.arange(n + 1)
    weight = np.where((j == 0) | (j == n), 0.5, 1.0)
    # ascending nodes are cos(pi (n - j)/n)
    matrix = np.cos(np.pi * np.outer(j, n - j) / n) * weight * (2 / n)
    matrix[[0, -1]] *= 0.5
    return matrix


@lru_cache
def flat_ended(n: int) -> np.ndarray:
    """Matrix (n + 1, n - 1) from values at the interior ``lobatto(n)`` to coefficients of the interpolant flat at both ends."""
    every, degree = _transform(n), np.arange(n + 1)
    # slopes of the Chebyshev polynomials are k^2 at one end and (-1)^(k + 1) k^2 at the other
    slopes = np.stack((degree**2, (-1.0) ** degree * degree**2)) @ every
    ends = np.linalg.solve(slopes[:, [0, -1]], -slopes[:, 1:-1])
    return every[:, 1:-1] + every[:, [0, -1]] @ ends


def interpolation_errors(
    c: np.ndarray, noise: np.ndarray, blur: np.ndarray | float = 0.0, rounding: np.ndarray | float = 0.0
) -> np.ndarray:
    """Error of interpolants with the coefficients ``c`` (p, n + 1, q), n >= 8, (p, q), a guess if 6; (p, q) each: ``noise``,
    changes that don't matter; ``blur``, how uncertain coefficients are themselves; ``rounding`` of each, not counted.

    What is left is extrapolated from the end of the series, at the pace that coefficients fell at since the middle: those of a
    quantity itself, as far as they don't fall faster than those of the roughest one, for all share their singularities.
    """
    n = c.shape[1] - 1
    c = np.abs(c)
    # what is rounding says nothing of the singularities
    c = np.maximum(c - (16 * EPS * c.max(axis=1) + rounding)[:, None], 0.0)
    amplitude = (c[:, 1:].max(axis=1) + noise + np.finfo(float).tiny)[:, None]
    blur = np.broadcast_to(blur, noise.shape)[:, None]
    roughest = (np.maximum(c - blur, 0.0) / amplitude).max(axis=2, keepdims=True)
    c = shared_size(c, roughest, amplitude)
    # a run long enough that a kink's coefficients, which come and go, are not all small in it
    few = max(3, n // 5)
    last, middle = c[:, n - few :].max(axis=1), c[:, n // 2 - 2 : n // 2 + 1].max(axis=1)
    ratio = fall_ratio(last, middle)
    pace = ratio ** (1 / (n / 2 + 1 - few / 2))
    onward = (c[:, n - few :] * pace[:, None] ** np.arange(few, -1, -1)[:, None]).max(axis=1)
    end = np.where(ratio < _GEOMETRIC, onward, last)
    return _SAFE * end * np.clip(2 * pace / np.maximum(1 - pace, 1e-3), _FASTEST, _SLOWEST)


def fall_ratio(last: np.ndarray, first: np.ndarray) -> np.ndarray:
    """``last`` over ``first``, neither negative; 1 where that is more."""
    return np.divide(last, first, out=np.ones_like(last), where=first > last)


def shared_size(own: np.ndarray, roughest: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
    """Size of coefficients of each quantity, given that of the ``roughest`` one relative to its ``amplitude``."""
    return own ** (1 - _COMMON) * (roughest * amplitude) ** _COMMON


def evaluate_each(table: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Chebyshev sums of a ``table`` (m, n + 1, q), each at its own ``x`` (m, nodes) in [-1, 1], (m, nodes, q)."""
    out, rows = np.empty((*x.shape, table.shape[2])), max(1, _CHUNK // x.shape[1])
    for some in (slice(start, start + rows) for start in range(0, len(x), rows)):
        out[some] = chebvander(x[some], table.shape[1] - 1) @ table[some]
    return out


@lru_cache
def _differentiation(n: int) -> np.ndarray:
    """Matrix from n Chebyshev coefficients to those of the derivative over [-1, 1], the last one zero."""
    return np.concatenate((chebder(np.eye(n)), np.zeros((1, n))))[:n]


def derivatives(table: np.ndarray) -> np.ndarray:
    """Coefficients (..., n, q) of the derivatives over [-1, 1] of the series ``table`` (..., n, q)."""
    return _differentiation(table.shape[-2]) @ table


def resampled(x: np.ndarray, goal: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Coefficients (m, n + 1, q) of the interpolants through quantities at the places ``goal`` (m, n + 1), of which there are
    ``values`` (m, n + 1, q) at ``x`` (m, n + 1): at ``lobatto(n)`` of something that x rises with. Both end at the same."""
    (m, size), nodes, of = x.shape, 2 * lobatto(x.shape[1] - 1) - 1, coefficients(x[:, :, None])
    rise = np.concatenate((of, derivatives(of)), axis=2).transpose(1, 2, 0)
    known = np.maximum.accumulate(x, axis=1)
    guess = np.array([np.interp(g, row, nodes) for g, row in zip(goal, known, strict=True)])
    row, wanted, t = np.repeat(np.arange(m), size - 2), goal[:, 1:-1].ravel(), np.tile(nodes, (m, 1))

    def missing(t, index):
        place, slope = clenshaw(rise, row[index], t)
        return wanted[index] - place, -slope

    inside = falling_root(missing, np.full(row.size, -1.0), np.ones(row.size), guess[:, 1:-1].ravel())
    t[:, 1:-1] = inside.reshape(m, size - 2)
    return coefficients(evaluate_each(coefficients(values), t))


def clenshaw(table: np.ndarray, which: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Chebyshev sums (q, ...) at ``x`` (...): those of the members ``which`` (...) of a ``table`` (degree + 1, q, n)."""
    twice, shape = 2 * x, (table.shape[1], *x.shape)
    one, two, product, here = np.zeros(shape), np.zeros(shape), np.empty(shape), np.empty(shape)
    for c in table[:0:-1]:
        # the older one becomes the next, in place: all time goes here
        np.subtract(np.multiply(twice, one, out=product), two, out=two)
        two += np.take(c, which, axis=1, out=here, mode="clip")
        one, two = two, one
    np.subtract(np.multiply(x, one, out=product), two, out=two)
    two += np.take(table[0], which, axis=1, out=here, mode="clip")
    return two


class Series:
    """Chebyshev series over t in [0, 1], coefficients (n_i + 1, q) each: those with as many are summed together."""

    def __init__(self, coefficients: Sequence[np.ndarray]):
        self._size, self._q = np.array([len(c) for c in coefficients]), coefficients[0].shape[1]
        self._rank, self._tables = np.empty(self._size.size, int), {}
        for size in np.unique(self._size).tolist():
            members = np.flatnonzero(self._size == size)
            self._rank[members] = np.arange(members.size)
            self._tables[size] = np.stack([coefficients[i] for i in members], axis=2)

    def __call__(self, which: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Sums (q, m) of the members ``which`` (m,) at ``t`` (m,)."""
        out = np.empty((self._q, which.size))
        sizes = self._size[which]
        for size, table in self._tables.items():
            rows = np.flatnonzero(sizes == size)
            out[:, rows] = clenshaw(table, self._rank[which[rows]], 2 * t[rows] - 1)
        return out
