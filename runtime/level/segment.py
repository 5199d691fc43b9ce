"""Segments of friction laws: branches of curves over pressure, so that they need not be inverted again; those of all laws at
once."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..numerics.chebyshev import Series
from .branches import Branch, Inverse
from .cells import Cells, cells_of
from .piece import Errors, graded


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
    t_at, quantities = Inverse(branches), Series([b.piece.coefficients for b in branches])
    low, span = np.array([b.p_low for b in branches]), np.array([b.p_high - b.p_low for b in branches])
    cells = cells_of(lambda which, u: quantities(which, t_at(which, low[which] + span[which] * graded(u))).T, tolerance, graded)
    return [
        Segment(b.p_low, b.p_high, c, b.errors_by_pressure().plus(c.error), b.inner_low, b.inner_high)
        for b, c in zip(branches, cells, strict=True)
    ]
