"""Chebyshev interpolation of several quantities at once on a piece ``low <= D <= high``.

``D = low + width share(t)`` (``grading.py``): whatever a quantity does next to an end, it is smooth and flat in t there, which
says what it is at the end: the ends are no nodes. They are breaks, and next to one rounding decides which side of it a strip is
on.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from .grading import Grading

_EPS = np.finfo(float).eps
#: power of the roughest quantity's coefficients, relative to its own, in those of every other one
_COMMON = 0.2
#: ratio of the last coefficients to those in the middle below which they surely fall geometrically
_GEOMETRIC = 0.01
#: how much of the last coefficient a sum of the rest is at least and at most, and how much more than that sum is feared: a sum
#: that falls by a power is up to three times one that falls geometrically at first
_FASTEST, _SLOWEST, _SAFE = 0.5, 32.0, 3.0


@lru_cache
def lobatto(n: int) -> np.ndarray:
    """Chebyshev-Lobatto nodes on [0, 1], ascending, n + 1 of them; those of n/2 are every other one."""
    return np.sin(0.5 * np.pi * np.arange(n + 1) / n) ** 2


def coefficients(values: np.ndarray) -> np.ndarray:
    """Chebyshev coefficients (n + 1, q) of the interpolant through ``values`` (n + 1, q) at ``lobatto(n)``."""
    n = values.shape[0] - 1
    return _transform(n) @ values


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
    """Matrix (n + 1, n - 1) from values at the interior nodes of ``lobatto(n)`` to coefficients of the interpolant whose slope
    vanishes at both ends."""
    every, degree = _transform(n), np.arange(n + 1)
    # slopes of the Chebyshev polynomials are k^2 at one end and (-1)^(k + 1) k^2 at the other
    slopes = np.stack((degree**2, (-1.0) ** degree * degree**2)) @ every
    ends = np.linalg.solve(slopes[:, [0, -1]], -slopes[:, 1:-1])
    return every[:, 1:-1] + every[:, [0, -1]] @ ends


def interpolation_errors(
    c: np.ndarray, noise: np.ndarray, blur: np.ndarray | float = 0.0, rounding: np.ndarray | float = 0.0
) -> np.ndarray:
    """Error of interpolants with the coefficients ``c`` (p, n + 1, q), n >= 8, (p, q); ``noise`` (p, q): changes that don't
    matter; ``blur`` (p, q): how uncertain the coefficients are themselves; ``rounding`` (p, q): what of each is rounding and not
    counted.

    What is left is extrapolated from the end of the series, at the pace that coefficients fell at since the middle: those of a
    quantity itself, as far as they don't fall faster than those of the roughest one, for all share their singularities.
    """
    n = c.shape[1] - 1
    c = np.abs(c)
    # what is rounding says nothing of the singularities
    c = np.maximum(c - (16 * _EPS * c.max(axis=1) + rounding)[:, None], 0.0)
    amplitude = (c[:, 1:].max(axis=1) + noise + np.finfo(float).tiny)[:, None]
    blur = np.broadcast_to(blur, noise.shape)[:, None]
    roughest = (np.maximum(c - blur, 0.0) / amplitude).max(axis=2, keepdims=True)
    c = c ** (1 - _COMMON) * (roughest * amplitude) ** _COMMON
    # a run long enough that a kink's coefficients, which come and go, are not all small in it
    few = max(3, n // 5)
    last, middle = c[:, n - few :].max(axis=1), c[:, n // 2 - 2 : n // 2 + 1].max(axis=1)
    ratio = np.minimum(np.divide(last, middle, out=np.ones_like(last), where=middle > last), 1.0)
    pace = ratio ** (1 / (n / 2 + 1 - few / 2))
    onward = (c[:, n - few :] * pace[:, None] ** np.arange(few, -1, -1)[:, None]).max(axis=1)
    end = np.where(ratio < _GEOMETRIC, onward, last)
    return _SAFE * end * np.clip(2 * pace / np.maximum(1 - pace, 1e-3), _FASTEST, _SLOWEST)


def graded(t):
    """Share of a range of pressure that lies below parameter t: both in [0, 1], flat like t^4 at both ends."""
    return np.sin(0.5 * np.pi * np.sin(0.5 * np.pi * t) ** 2) ** 2


def parameter(share):
    """t at which ``graded`` is ``share``."""
    inner = 2 / np.pi * np.arcsin(np.sqrt(share))
    return 2 / np.pi * np.arcsin(np.sqrt(inner))


@dataclass(frozen=True)
class Piece:
    """Quantities over one interval of D: ``coefficients`` of shape (n + 1, q) in t; ``error`` bounds each of them, (q,).

    ``soft_low``, ``soft_high``: the curve goes on smoothly beyond that end, in another piece. ``grading``: what t is.
    """

    low: float
    high: float
    coefficients: np.ndarray
    error: np.ndarray
    soft_low: bool = False
    soft_high: bool = False
    grading: Grading = Grading()

    def penetration(self, t):
        """D at t."""
        return self.low + (self.high - self.low) * self.grading.share(t)

    def values(self, t) -> np.ndarray:
        """Quantities at t (m,), shape (m, q)."""
        return evaluate(self.coefficients, t)

    def first(self, t) -> tuple[np.ndarray, np.ndarray]:
        """The first quantity (pressure) and its derivative with respect to t."""
        both = evaluate(self.first_coefficients, t)
        return both[:, 0], both[:, 1]

    @cached_property
    def first_coefficients(self) -> np.ndarray:
        """Coefficients of the first quantity and of its derivative with respect to t, (n + 1, 2)."""
        c = self.coefficients[:, 0]
        return np.stack((c, np.append(2 * np.polynomial.chebyshev.chebder(c), 0.0)), axis=1)


def evaluate(coefficients: np.ndarray, t) -> np.ndarray:
    """Chebyshev sums of ``coefficients`` (n + 1, q) at ``t`` in [0, 1] (m,), shape (m, q)."""
    angle = np.arccos(np.clip(2 * np.asarray(t, float) - 1, -1.0, 1.0))
    return np.cos(angle[:, None] * np.arange(coefficients.shape[0])) @ coefficients
