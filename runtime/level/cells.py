"""A function on [0, 1] as polynomials of low degree, each on a cell as large as it may be: made once, cheap wherever it is asked
for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .chebyshev import coefficients, lobatto

_DEGREE = 8
#: the smallest cells are one over this
SLOTS = 1024
#: the last coefficients have to fall below this share of what the function may err
_NEGLIGIBLE = 0.1


@dataclass(frozen=True)
class Cells:
    """Chebyshev ``coefficients`` (cells, degree + 1, q) on cells that begin at slot ``start`` (cells,) and are ``size`` (cells,)
    slots wide; ``of`` (SLOTS,): the cell that a slot belongs to. ``error`` (q,): what the smallest cells still miss, on
    average."""

    coefficients: np.ndarray
    start: np.ndarray
    size: np.ndarray
    of: np.ndarray
    error: np.ndarray

    def __call__(self, x: np.ndarray) -> np.ndarray:
        """Values (m, q) at ``x`` (m,) in [0, 1]."""
        cell = self.of[slot(x)]
        return clenshaw(self.coefficients[cell], within(x, self.start[cell], self.size[cell]))


def cells_of(
    function: Callable[[np.ndarray], np.ndarray], tolerance: np.ndarray, measure: Callable[[np.ndarray], np.ndarray]
) -> Cells:
    """``function``, [0, 1] (m,) -> (m, q), to ``tolerance`` (q,). ``measure``: how much of what is averaged over lies below an x,
    0 to 1."""
    transform, nodes = coefficients(np.eye(_DEGREE + 1)), lobatto(_DEGREE)
    start, size, error = np.array([0, SLOTS // 2]), SLOTS // 2, np.zeros(tolerance.size)
    found: list[tuple] = []
    while start.size:
        x = (start[:, None] + size * nodes) / SLOTS
        c = transform @ function(x.ravel()).reshape(*x.shape, -1)
        last = np.abs(c[:, -2:]).max(axis=1)
        done = (last <= _NEGLIGIBLE * tolerance).all(axis=1)
        if size == 1:
            share = measure((start + 1) / SLOTS) - measure(start / SLOTS)
            error = share[~done] @ last[~done] / _NEGLIGIBLE
            done[:] = True
        found.append((c[done], start[done], np.full(np.count_nonzero(done), size)))
        size //= 2
        start = (start[~done, None] + size * np.arange(2)).ravel()
    c, start, sizes = (np.concatenate(v) for v in zip(*found, strict=True))
    of = np.empty(SLOTS, int)
    for k, (first, wide) in enumerate(zip(start, sizes, strict=True)):
        of[first : first + wide] = k
    return Cells(c, start, sizes, of, error)


def slot(x: np.ndarray) -> np.ndarray:
    """The slot that each ``x`` in [0, 1] lies in."""
    return np.minimum((x * SLOTS).astype(int), SLOTS - 1)


def within(x: np.ndarray, start: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Where in its cell each ``x`` lies, in [-1, 1]."""
    return 2 * (x * SLOTS - start) / size - 1


def clenshaw(c: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Chebyshev sums (m, q) with coefficients ``c`` (m, degree + 1, q) of their own at every ``x`` (m,)."""
    twice = 2 * x[:, None]
    one = two = 0.0
    for k in range(c.shape[1] - 1, 0, -1):
        one, two = c[:, k] + twice * one - two, one
    return c[:, 0] + x[:, None] * one - two
