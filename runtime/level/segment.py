"""Segments of friction laws: branches of curves over pressure, so that they need not be inverted again; those of all laws at
once. Quantities are polynomials of low degree, each on a cell as large as it may be: made once, cheap wherever asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from ..numerics.chebyshev import Series, clenshaw, coefficients, lobatto
from .branches import Branch, Errors, ParameterAt, graded

#: degree of the polynomials
_DEGREE = 8
#: the smallest cells are one over this
SLOTS = 1024
#: the last coefficients have to fall below this share of what the function may err
_NEGLIGIBLE = 0.1


@dataclass(frozen=True)
class Cells:
    """Chebyshev ``coefficients`` (degree + 1, q, cells) on cells that begin at slot ``start`` (cells,) of their function and are
    ``size`` (cells,) slots wide; ``of``: the cell that a slot belongs to, SLOTS of them for each function. ``error`` (q,): what
    the smallest cells of a function still miss, on average over pressure."""

    coefficients: np.ndarray
    start: np.ndarray
    size: np.ndarray
    of: np.ndarray
    error: np.ndarray

    def __call__(self, x: np.ndarray, which: np.ndarray | int = 0) -> np.ndarray:
        """Values (q, ...) of the functions ``which`` at ``x`` (...) in [0, 1]."""
        cell = self.of[slot(x, which)]
        return clenshaw(self.coefficients, cell, 2 * (x * SLOTS - self.start[cell]) / self.size[cell] - 1)

    @property
    def greatest(self) -> np.ndarray:
        """The largest magnitude of each quantity at the nodes of the cells, (q,)."""
        return np.abs(np.tensordot(chebvander(2 * lobatto(_DEGREE) - 1, _DEGREE), self.coefficients, 1)).max(axis=(0, 2))

    @classmethod
    def joined(cls, every: Sequence[Cells], quantities: slice) -> Cells:
        """Some ``quantities`` of the functions of ``every`` one, at least one, as one."""
        first = np.cumsum([0, *(each.start.size for each in every)])[:-1]
        return cls(
            np.concatenate([each.coefficients[:, quantities] for each in every], axis=2),
            *(np.concatenate([getattr(each, name) for each in every]) for name in ("start", "size")),
            np.concatenate([each.of + at for each, at in zip(every, first, strict=True)]),
            np.max([each.error[quantities] for each in every], axis=0),
        )


def cells_of(function: Callable[[np.ndarray, np.ndarray], np.ndarray], tolerance: np.ndarray, smallest: int = 1) -> list[Cells]:
    """Several functions of [0, 1], each to its ``tolerance`` (functions, q).

    ``function``: (which (m,), x (m,)) -> (m, q). ``smallest``: slots of the smallest cells."""
    transform, nodes, count = coefficients(np.eye(_DEGREE + 1)), lobatto(_DEGREE), tolerance.shape[0]
    which, start = np.repeat(np.arange(count), 2), np.tile([0, SLOTS // 2], count)
    size, error = SLOTS // 2, np.zeros(tolerance.shape)
    found: list[tuple] = []
    while start.size:
        x = (start[:, None] + size * nodes) / SLOTS
        c = transform @ function(np.repeat(which, nodes.size), x.ravel()).reshape(*x.shape, -1)
        last = np.abs(c[:, -2:]).max(axis=1)
        done = (last <= _NEGLIGIBLE * tolerance[which]).all(axis=1)
        if size == smallest:
            share = graded((start + size) / SLOTS) - graded(start / SLOTS)
            np.add.at(error, which[~done], share[~done, None] * last[~done] / _NEGLIGIBLE)
            done[:] = True
        found.append((which[done], c[done], start[done], np.full(np.count_nonzero(done), size)))
        size //= 2
        which, start = np.repeat(which[~done], 2), (start[~done, None] + size * np.arange(2)).ravel()
    which, c, start, sizes = (np.concatenate(v) for v in zip(*found, strict=True))
    order = np.lexsort((start, which))
    parts = np.split(order, np.searchsorted(which[order], np.arange(1, count)))
    c = np.moveaxis(c, 0, 2)
    return [Cells(c[:, :, i], start[i], sizes[i], np.repeat(np.arange(i.size), sizes[i]), error[k]) for k, i in enumerate(parts)]


def slot(x: np.ndarray, which: np.ndarray | int) -> np.ndarray:
    """The slot that each ``x`` in [0, 1] lies in, of the functions ``which``."""
    return which * SLOTS + np.minimum((x * SLOTS).astype(int), SLOTS - 1)


@dataclass(frozen=True)
class Segment:
    """A law between the pressures ``p_low`` and ``p_high``, Pa, where it is smooth: ``cells`` of its quantities over u,
    ``p = p_low + (p_high - p_low) graded(u)``, and their ``errors`` over pressure.

    ``inner_low``, ``inner_high``: the law goes on smoothly beyond that end, in another segment.
    """

    p_low: float
    p_high: float
    cells: Cells
    errors: Errors
    inner_low: bool = False
    inner_high: bool = False


def segments_of(branches: Sequence[Branch], tolerance: np.ndarray) -> list[Segment]:
    """A segment for each branch, to its ``tolerance`` (branches, q)."""
    if not branches:
        return []
    t_at, quantities = ParameterAt(branches), Series([b.piece.coefficients for b in branches])
    low, span = np.array([b.p_low for b in branches]), np.array([b.p_high - b.p_low for b in branches])
    cells = cells_of(lambda which, u: quantities(which, t_at(which, low[which] + span[which] * graded(u))).T, tolerance)
    return [
        Segment(b.p_low, b.p_high, c, b.errors_by_pressure().plus(c.error), b.inner_low, b.inner_high)
        for b, c in zip(branches, cells, strict=True)
    ]
