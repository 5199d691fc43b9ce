"""A Chebyshev series on a piece ``low <= D <= high`` of a curve over penetration.

``D = low + width share(t)`` (``numerics/endpoints.py``): whatever a quantity does next to an end, it is smooth and flat in t
there, which says what it is at the end: the ends are no nodes. They are breaks, and next to one rounding decides which side of it
a strip is on.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..numerics.chebyshev import evaluate
from ..numerics.endpoints import EndpointMap


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

    ``inner_low``, ``inner_high``: the curve goes on smoothly beyond that end, in another piece. ``endpoint_map``: what t is.
    ``least_error`` (as ``error`` if None), ``relative``: no quantity errs by more than that and a share of its own size, (q,).
    """

    low: float
    high: float
    coefficients: np.ndarray
    error: np.ndarray
    inner_low: bool = False
    inner_high: bool = False
    endpoint_map: EndpointMap = EndpointMap()
    least_error: np.ndarray | None = None
    relative: np.ndarray | float = 0.0

    @property
    def least_errors(self) -> np.ndarray:
        """``least_error``, (q,)."""
        return self.error if self.least_error is None else self.least_error

    def erring(self, more: np.ndarray) -> Piece:
        """The same with errors larger by ``more`` (q,)."""
        least = None if self.least_error is None else self.least_error + more
        return replace(self, error=self.error + more, least_error=least)

    def with_errors_of(self, other: Piece) -> Piece:
        """The same with errors that cover those of the ``other`` too."""
        least, share = np.maximum(self.least_errors, other.least_errors), np.maximum(self.relative, other.relative)
        return replace(self, error=np.maximum(self.error, other.error), least_error=least, relative=share)

    def penetration(self, t):
        """D at t."""
        return self.low + (self.high - self.low) * self.endpoint_map.share(t)

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
