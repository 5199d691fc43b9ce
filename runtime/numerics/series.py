"""Many Chebyshev series of several lengths, summed up together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import chebyshev


@dataclass(frozen=True)
class Series:
    """P series of q quantities each: number ``rank[i]`` of the stack ``stacks[size[i]]`` (k, n, q) is series i, of n =
    ``size[i]`` coefficients; ``size``, ``rank``: (P,)."""

    size: np.ndarray
    rank: np.ndarray
    stacks: dict[int, np.ndarray]

    @classmethod
    def make(cls, some: Sequence[np.ndarray]) -> Series:
        """From stacks (k, n, q), one after the other."""
        size = np.concatenate([np.full(c.shape[0], c.shape[1]) for c in some])
        stacks = {int(n): np.concatenate([c for c in some if c.shape[1] == n]) for n in np.unique(size)}
        rank = np.empty(size.size, int)
        for n in stacks:
            rank[size == n] = np.arange(np.count_nonzero(size == n))
        return cls(size, rank, stacks)

    def take(self, index) -> Series:
        """The series of an ``index``, which share their coefficients with these."""
        return Series(self.size[index], self.rank[index], self.stacks)

    @cached_property
    def derivative(self) -> Series:
        """Derivatives by t."""
        return Series(self.size, self.rank, {n: chebyshev.derivative(c) for n, c in self.stacks.items()})

    def quantity(self, k: int) -> Series:
        """Quantity k alone."""
        return Series(self.size, self.rank, {n: c[:, :, k : k + 1] for n, c in self.stacks.items()})

    @cached_property
    def _tables(self):
        return {n: np.ascontiguousarray(np.moveaxis(c, 0, 2)) for n, c in self.stacks.items()}

    def __call__(self, which: np.ndarray, t: np.ndarray) -> np.ndarray:
        """Sums (m, q) of the series ``which`` at ``t`` in [0, 1], both (m,)."""
        if len(self._tables) == 1:
            return chebyshev.clenshaw(*self._tables.values(), self.rank[which], t).T
        sizes, q = self.size[which], next(iter(self._tables.values())).shape[1]
        out = np.empty((which.size, q))
        for n, table in self._tables.items():
            rows = np.flatnonzero(sizes == n)
            if rows.size:
                out[rows] = chebyshev.clenshaw(table, self.rank[which[rows]], t[rows]).T
        return out
