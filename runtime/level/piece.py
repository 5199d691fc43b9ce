"""A Chebyshev series on a piece ``low <= D <= high`` of a curve over penetration.

``D = low + width share(t)`` (``numerics/endpoints.py``): whatever a quantity does next to an end, it is smooth and flat in t
there, which says what it is at the end: the ends are no nodes. They are breaks, and next to one rounding decides which side of it
a strip is on.
"""

from dataclasses import dataclass
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
    """

    low: float
    high: float
    coefficients: np.ndarray
    error: np.ndarray
    inner_low: bool = False
    inner_high: bool = False
    endpoint_map: EndpointMap = EndpointMap()

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
