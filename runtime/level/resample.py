"""Branches of friction laws interpolated over pressure, so that they need not be inverted again; those of all laws at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..numerics.chebyshev import clenshaw
from .cells import cells_of
from .piece import graded, parameter

if TYPE_CHECKING:
    from .branches import Branch

_GRID = np.linspace(0, 1, 65)
_EPS = np.finfo(float).eps
_CHUNK = 4096


def resampled(branches: Sequence[Branch], tolerance: np.ndarray) -> list[Branch]:
    """The same branches with cells, each to its ``tolerance`` (branches, q)."""
    if not branches:
        return []
    inverse = Inverse(branches)

    def quantities(which, u):
        return inverse.quantities(which, inverse.parameter(which, inverse.low[which] + inverse.span[which] * graded(u)))

    cells = cells_of(quantities, tolerance, graded)
    return [replace(b, cells=c, piece=b.piece.erring(c.error)) for b, c in zip(branches, cells, strict=True)]


class Inverse:
    """Parameters of the pieces of many branches at given pressures, and what the pieces say there."""

    def __init__(self, branches: Sequence[Branch]):
        self.low = np.array([b.p_low for b in branches])
        self.span = np.array([b.p_high for b in branches]) - self.low
        self._ends = np.array([(b.t_low, b.t_high) for b in branches])
        pieces = [b.piece for b in branches]
        largest = np.array([np.abs(piece.coefficients[:, 0]).sum() for piece in pieces])
        self._blur = 16 * _EPS * np.maximum(largest, np.maximum(np.abs(self.low), np.abs(self.low + self.span)))
        self._pressures = _Sums([piece.first_coefficients for piece in pieces])
        self._quantities = _Sums([piece.coefficients for piece in pieces])
        # over this share t is all but linear, also where the curve turns
        self._grid = self._ends[:, :1] + np.diff(self._ends) * _GRID
        every = np.repeat(np.arange(len(pieces)), _GRID.size)
        shares = self._share(every, self._pressures(every, self._grid.ravel())[0]).reshape(self._grid.shape)
        self._shares = np.maximum.accumulate(shares, axis=1)

    def quantities(self, which: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Quantities (m, q) of the pieces of the branches ``which`` at ``t``, both (m,)."""
        return self._quantities(which, t).T

    def parameter(self, which: np.ndarray, p: np.ndarray) -> np.ndarray:
        """t at which the pressure of the branches ``which`` is ``p``, both (m,), clipped to the branch; safeguarded Newton."""
        low, high = self._ends[which].T
        low, high, t = low.copy(), high.copy(), low.copy()
        left = np.flatnonzero(self.span[which] > 0)
        t[left] = self._between(which[left], self._share(which[left], p[left]))
        for _ in range(80):
            if not left.size:
                break
            here = t[left]
            value, slope = self._pressures(which[left], here)
            miss = p[left] - value
            # next to a flat end rounding would send what is there already anywhere
            off = np.abs(miss) > self._blur[which[left]]
            left, here, miss, slope = left[off], here[off], miss[off], slope[off]
            below = miss > 0
            low[left[below]], high[left[~below]] = here[below], here[~below]
            new = here + np.divide(miss, slope, out=np.full(here.shape, np.inf), where=slope > 0)
            t[left] = np.where((new >= low[left]) & (new <= high[left]), new, 0.5 * (low[left] + high[left]))
            left = left[(np.abs(t[left] - here) > 16 * _EPS) & ((high - low)[left] > 16 * _EPS)]
        return t

    def _share(self, which, p):
        span = self.span[which]
        share = np.divide(p - self.low[which], span, out=np.zeros_like(p), where=span > 0)
        return parameter(np.clip(share, 0.0, 1.0))

    def _between(self, which, share):
        """t at the ``share``, by the grid."""
        after = np.clip(np.count_nonzero(self._shares[which] <= share[:, None], axis=1), 1, _GRID.size - 1)
        (x0, x1), (t0, t1) = ((v[which, after - 1], v[which, after]) for v in (self._shares, self._grid))
        way = np.divide(share - x0, x1 - x0, out=np.zeros_like(share), where=x1 > x0)
        return t0 + np.clip(way, 0.0, 1.0) * (t1 - t0)


class _Sums:
    """Chebyshev sums of many pieces: those with as many coefficients are summed up together."""

    def __init__(self, coefficients: Sequence[np.ndarray]):
        self._size = np.array([c.shape[0] for c in coefficients])
        self._rank, self._tables = np.empty(self._size.size, int), {}
        for size in np.unique(self._size).tolist():
            members = np.flatnonzero(self._size == size)
            self._rank[members] = np.arange(members.size)
            self._tables[size] = np.stack([coefficients[i] for i in members], axis=2)

    def __call__(self, which, t) -> np.ndarray:
        """Sums (q, m) of the pieces ``which`` at ``t`` in [0, 1], both (m,)."""
        out = np.empty((next(iter(self._tables.values())).shape[1], which.size))
        sizes = self._size[which]
        for size, table in self._tables.items():
            rows = np.flatnonzero(sizes == size)
            # few at a time: what is known of them stays in the cache
            for start in range(0, rows.size, _CHUNK):
                some = rows[start : start + _CHUNK]
                out[:, some] = clenshaw(table, self._rank[which[some]], 2 * t[some] - 1)
        return out
