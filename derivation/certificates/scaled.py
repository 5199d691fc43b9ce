"""Exact numbers that carry their natural scale |f| + sum |x df/dx| through sums, products and linear systems.

They stand in NumPy arrays of objects, which add, multiply and contract them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np

STEP = mpmath.mpf(10) ** -60  # change of an input, relative or of a phase; a central difference errs by its square


@dataclass(eq=False, slots=True)
class Scaled:
    value: mpmath.mpf
    size: mpmath.mpf

    def __neg__(self) -> Scaled:
        return Scaled(-self.value, self.size)

    def __add__(self, other: Scaled) -> Scaled:
        return Scaled(self.value + other.value, self.size + other.size)

    def __sub__(self, other: Scaled) -> Scaled:
        return Scaled(self.value - other.value, self.size + other.size)

    def __mul__(self, other: Scaled) -> Scaled:
        one, two = abs(self.value), abs(other.value)
        return Scaled(self.value * other.value, one * other.size + self.size * two - one * two)

    def __truediv__(self, other: Scaled) -> Scaled:
        one, two = abs(self.value), abs(other.value)
        return Scaled(self.value / other.value, self.size / two + one * other.size / two**2 - one / two)


scaled = np.frompyfunc(Scaled, 2, 1)  # of arrays of values and of their scales
values = np.frompyfunc(lambda number: number.value, 1, 1)
sizes = np.frompyfunc(lambda number: number.size, 1, 1)


def naturally(function: Callable[[Any], np.ndarray], inputs: Any, moves: Iterable[tuple[Any, Any]]) -> np.ndarray:
    """A function of ``inputs`` with its natural scale; ``moves``: (weight, inputs of which one is moved by STEP)."""
    exact = function(inputs)
    size = abs(exact)
    for weight, moved in moves:
        size = size + weight * abs(function(moved) - exact) / STEP
    return scaled(exact, size)


def given(value: Any) -> Any:
    """Values that are inputs themselves, each as large as its scale."""
    return scaled(value, np.abs(value))


def solved(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """x of ``matrix x = right``, one column or several."""
    inverse = inverted(values(matrix))
    x = inverse @ values(right)
    return scaled(x, abs(inverse) @ (sizes(right) + sizes(matrix) @ abs(x)))


def inverted(matrix: np.ndarray) -> np.ndarray:
    """Inverse; rows and columns are scaled, since mpmath takes a small pivot for none."""
    rows = abs(matrix).max(axis=1, keepdims=True)
    columns = (abs(matrix) / rows).max(axis=0, keepdims=True)
    return np.array((mpmath.matrix((matrix / rows / columns).tolist()) ** -1).tolist(), dtype=object) / rows.T / columns.T
