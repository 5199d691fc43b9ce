"""Panels of y between breakpoints of the integrand."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..numerics.quadrature import mapped, mapped_weights
from ..orbit.batch import Batch

#: nodes of a panel at first and at most, and one more
FIRST, LAST = 8, 64


@dataclass
class Panels(Batch):
    """Panels of ``state`` between thetas; ``first`` and ``last``: the strip known next to each end, -1: none."""

    state: np.ndarray
    low: np.ndarray
    high: np.ndarray
    first: np.ndarray
    last: np.ndarray

    @property
    def width(self) -> np.ndarray:
        return self.high - self.low

    def halves(self) -> list[Panels]:
        """Both halves of each."""
        middle, none = 0.5 * (self.low + self.high), np.full(self.size, -1)
        return [replace(self, high=middle, last=none), replace(self, low=middle, first=none)]

    def at(self, t: np.ndarray) -> np.ndarray:
        """Thetas at the parameters ``t`` of every panel, (panels, t)."""
        return self.low[:, None] + self.width[:, None] * mapped(t)

    def sums(self, values: np.ndarray) -> np.ndarray:
        """Integrals (panels, q) of what has the ``values`` (panels, n - 1, q) at the interior ones of n nodes."""
        return self.width[:, None] * (mapped_weights(values.shape[1] + 1) @ values)
