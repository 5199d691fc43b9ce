"""The worst error of a function met so far, and what is compared with what."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import mpmath
import numpy as np

from ...certify import EPS, FLOOR, Certificate
from .scaled import Scaled


@dataclass
class Worst:
    """Collects errors of one function, in ulp of its natural scale."""

    name: str
    ulps: float = 0.0
    where: dict[str, float] = field(default_factory=dict)
    points: int = 0

    def see(self, computed: Any, truth: Scaled, where: dict[str, float]) -> None:
        """Compare one result of the emitted function, nested as it may be, with its exact value."""
        self.points += 1
        self.where = self.where or where
        for got, true, size in zip(numbers(computed), np.ravel(truth.value), np.ravel(truth.size), strict=True):
            ulps = float(abs(mpmath.mpf(got) - true) / (max(size, FLOOR) * EPS))
            if not ulps <= self.ulps:
                self.ulps, self.where = ulps, where

    def certificate(self) -> Certificate:
        return Certificate(self.name, self.ulps, self.points, self.where)


def numbers(result: Any) -> list[float]:
    """All numbers of a nested result, in order."""
    if isinstance(result, (tuple, list)):
        return [number for part in result for number in numbers(part)]
    return [float(value) for value in np.ravel(np.asarray(result, dtype=float))]
