"""A Chebyshev series on a piece ``low <= D <= high`` of a curve over penetration.

``D = low + width share(t)`` (``numerics/gauss.py``): whatever a quantity does next to an end, it is smooth and flat in t
there, which says what it is at the end: the ends are no nodes. They are breaks, and next to one rounding decides which side of it
a strip is on.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..numerics.chebyshev import evaluate
from ..numerics.gauss import GENTLE, STEEP, graded_share


def graded(t):
    """Share of a range of pressure that lies below parameter t: both in [0, 1], flat like t^4 at both ends."""
    return np.sin(0.5 * np.pi * np.sin(0.5 * np.pi * t) ** 2) ** 2


def parameter(share):
    """t at which ``graded`` is ``share``."""
    inner = 2 / np.pi * np.arcsin(np.sqrt(share))
    return 2 / np.pi * np.arcsin(np.sqrt(inner))


def share_of(t, inner_low: bool, inner_high: bool):
    """Share of an interval of D that lies below parameter t, where the curve goes on smoothly beyond either end, or not."""
    return graded_share(t, *(GENTLE if inner else STEEP for inner in (inner_low, inner_high)))


@dataclass(frozen=True)
class Errors:
    """Bounds of the errors of quantities, ``bounds`` (k, q), at places ``at`` (k,), ascending; interpolated between.

    Means next to a break are often known a thousand times less well than all others: one bound for a whole piece would be
    theirs.
    """

    at: np.ndarray
    bounds: np.ndarray

    @classmethod
    def constant(cls, error: np.ndarray) -> Errors:
        """The same everywhere, (q,)."""
        return cls(np.zeros(1), error[None])

    @property
    def most(self) -> np.ndarray:
        """The largest of each quantity, (q,)."""
        return self.bounds.max(axis=0)

    def along(self, x: np.ndarray, columns: np.ndarray | int) -> np.ndarray:
        """Of the sum of some quantities at the places ``x`` (m,), (m,)."""
        return np.interp(x, self.at, self.bounds[:, np.atleast_1d(columns)].sum(axis=1))

    def plus(self, more: np.ndarray) -> Errors:
        """Larger by ``more`` (q,)."""
        return Errors(self.at, self.bounds + more)

    def then(self, other: Errors) -> Errors:
        """These, then those of what follows."""
        return Errors(np.concatenate((self.at, other.at)), np.concatenate((self.bounds, other.bounds)))


@dataclass(frozen=True)
class Piece:
    """Quantities over one interval of D: ``coefficients`` of shape (n + 1, q) in t, and their ``errors`` over t.

    ``inner_low``, ``inner_high``: the curve goes on smoothly beyond that end, in another piece.
    """

    low: float
    high: float
    coefficients: np.ndarray
    errors: Errors
    inner_low: bool = False
    inner_high: bool = False

    def penetration(self, t):
        """D at t."""
        return self.low + (self.high - self.low) * share_of(t, self.inner_low, self.inner_high)

    def values(self, t) -> np.ndarray:
        """Quantities at t (m,), shape (m, q)."""
        return evaluate(self.coefficients, t)
