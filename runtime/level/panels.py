"""Panels of y between breakpoints of the integrand, and what is known at their nodes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..numerics.quadrature import interior_nodes, mapped, mapped_weights
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


@dataclass
class Stage:
    """Panels on the same number ``n`` of nodes, and what is ``known`` at the interior ones: codes, values, heights and edges,
    (panels, nodes, ...); empty for those that were not looked at yet, whose nodes are the first."""

    panels: Panels
    n: int = FIRST
    known: tuple[np.ndarray, ...] = ()

    def take(self, which) -> Stage:
        return Stage(self.panels.take(which), self.n, tuple(v[which] for v in self.known))

    @property
    def theta(self) -> np.ndarray:
        """Of the nodes at which strips are known, (panels, nodes)."""
        return self.panels.at(interior_nodes(self.n))

    def next_nodes(self) -> tuple[int, np.ndarray]:
        """How many nodes are next, and the thetas (panels, new nodes) of those of them that are not known."""
        n = 2 * self.n if self.known else self.n
        return n, self.panels.at(interior_nodes(n)[:: 2 if self.known else 1])

    def sums(self) -> np.ndarray:
        """Integrals over the panels, (panels, q)."""
        return self.panels.width[:, None] * (mapped_weights(self.n) @ self.known[1])
