"""Exact values that carry their natural scale |f| + sum |x df/dx| through sums, products and linear systems."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np


@dataclass(frozen=True, eq=False)
class Scaled:
    """An array of exact values and one of their scales, both of mpmath numbers."""

    value: np.ndarray
    size: np.ndarray

    @classmethod
    def of(cls, value: Any) -> Scaled:
        """Values that are inputs themselves, each as large as its scale."""
        value = np.array(value, dtype=object)
        return cls(value, abs(value))

    @classmethod
    def joined(cls, parts: Sequence[Scaled]) -> Scaled:
        """All numbers of the parts in one row."""
        return cls(*(np.concatenate([np.ravel(getattr(part, name)) for part in parts]) for name in ("value", "size")))

    @classmethod
    def stacked(cls, parts: Sequence[Scaled], axis: int = 0) -> Scaled:
        return cls(np.stack([part.value for part in parts], axis), np.stack([part.size for part in parts], axis))

    def __getitem__(self, index: Any) -> Scaled:
        return Scaled(np.asarray(self.value[index], object), np.asarray(self.size[index], object))

    @property
    def transposed(self) -> Scaled:
        return Scaled(self.value.T, self.size.T)

    def reshape(self, shape: tuple[int, ...]) -> Scaled:
        return Scaled(np.reshape(self.value, shape), np.reshape(self.size, shape))

    def sum(self) -> Scaled:
        """Over the first axis."""
        return Scaled(np.asarray(self.value.sum(axis=0), object), np.asarray(self.size.sum(axis=0), object))

    def __neg__(self) -> Scaled:
        return Scaled(-self.value, self.size)

    def __add__(self, other: Scaled) -> Scaled:
        return Scaled(self.value + other.value, self.size + other.size)

    def __sub__(self, other: Scaled) -> Scaled:
        return self + -other

    def __mul__(self, other: Scaled) -> Scaled:
        one, two = abs(self.value), abs(other.value)
        return Scaled(self.value * other.value, one * other.size + self.size * two - one * two)

    def __matmul__(self, other: Scaled) -> Scaled:
        one, two = abs(self.value), abs(other.value)
        return Scaled(self.value @ other.value, one @ other.size + self.size @ two - one @ two)

    def __truediv__(self, other: Scaled) -> Scaled:
        one, two = abs(self.value), abs(other.value)
        return Scaled(self.value / other.value, self.size / two + one * other.size / two**2 - one / two)

    def solved(self, right: Scaled) -> Scaled:
        """x of ``self x = right``, one column or several."""
        inverse = inverted(self.value)
        x = inverse @ right.value
        return Scaled(x, abs(inverse) @ (right.size + self.size @ abs(x)))


def inverted(matrix: np.ndarray) -> np.ndarray:
    """Inverse; rows and columns are scaled, since mpmath takes a small pivot for none."""
    rows = abs(matrix).max(axis=1, keepdims=True)
    columns = (abs(matrix) / rows).max(axis=0, keepdims=True)
    return np.array((mpmath.matrix((matrix / rows / columns).tolist()) ** -1).tolist(), dtype=object) / rows.T / columns.T
