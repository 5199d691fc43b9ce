"""Chebyshev interpolation of several quantities at once on a piece ``low <= D <= high``.

``D = low + width graded(t)``: the grading is flat like t^4 at both ends. A quantity that ends like a square root in D is smooth
in t, and one that ends like ``D log D`` nearly so (a level does where its crest lets go while its neighbours still hold). Either
way it is flat in t at the end, which says what it is there: the ends are no nodes. They are breaks, and next to one rounding
decides which side of it a strip is on.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

_EPS = np.finfo(float).eps
#: share of the roughest quantity's relative error that every other one is taken to have at least
_COMMON = 0.3
#: slowest decay that a sum of the rest may be extrapolated with
_SLOWEST = 64.0


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

    What is left is extrapolated from the last coefficients, at the pace they fell at since the middle: that of the slowest
    quantity, and no quantity is taken to be much smoother than the roughest, for they share their singularities.
    """
    n = c.shape[1] - 1
    c = np.abs(c)
    # what is rounding says nothing of the singularities
    c = np.maximum(c - (16 * _EPS * c.max(axis=1) + rounding)[:, None], 0.0)
    amplitude = c[:, 1:].max(axis=1) + noise + np.finfo(float).tiny
    blur = np.broadcast_to(blur, amplitude.shape)[:, None]
    shape = (np.maximum(c - blur, 0.0) / amplitude[:, None]).max(axis=2)
    # a run long enough that a kink's coefficients, which come and go, are not all small in it
    few = max(3, n // 5)
    last, middle = shape[:, n - few :].max(axis=1), shape[:, n // 2 - 2 : n // 2 + 1].max(axis=1)
    pace = np.minimum(np.divide(last, middle, out=np.ones_like(last), where=middle > last), 1.0) ** (1 / (n / 2 + 1 - few / 2))
    rest = np.minimum(4 * pace / np.maximum(1 - pace, 1e-3), _SLOWEST)[:, None]
    return np.maximum(c[:, n - few :].max(axis=1), _COMMON * last[:, None] * amplitude) * rest


def graded(t):
    """Share of an interval that lies below parameter t: both in [0, 1], flat like t^4 at both ends."""
    return np.sin(0.5 * np.pi * np.sin(0.5 * np.pi * t) ** 2) ** 2


def parameter(share):
    """t at which ``graded`` is ``share``."""
    inner = 2 / np.pi * np.arcsin(np.sqrt(share))
    return 2 / np.pi * np.arcsin(np.sqrt(inner))


@dataclass(frozen=True)
class Piece:
    """Quantities over one interval of D: ``coefficients`` of shape (n + 1, q) in t; ``error`` bounds each of them, (q,).

    ``soft_low``, ``soft_high``: the curve goes on smoothly beyond that end, in another piece.
    """

    low: float
    high: float
    coefficients: np.ndarray
    error: np.ndarray
    soft_low: bool = False
    soft_high: bool = False

    def penetration(self, t):
        """D at t."""
        return self.low + (self.high - self.low) * graded(t)

    def parameter(self, D):
        """t at D."""
        return parameter(np.clip((D - self.low) / (self.high - self.low), 0.0, 1.0))

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
