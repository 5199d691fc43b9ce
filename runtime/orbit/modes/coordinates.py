"""Coordinates in which a period preserves the order of states (``order``): dashpot displacements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .problem import ModeStrips, pick, rates


@dataclass(slots=True)
class Order:
    """Coordinates of the order for a batch: ``z = share e``, ``e = back z`` (n, n, N or 1); ``rate``: ``1/alpha_i``, capped."""

    share: np.ndarray
    back: np.ndarray
    rate: np.ndarray

    @classmethod
    def of(cls, kernel, s: ModeStrips) -> Order:
        m = s.m
        n = s.modes
        unit = np.eye(n)[:, :, None]
        back = np.stack([kernel.dashpots(unit[:, j], 0.0, m) for j in range(n)], axis=1)
        return cls(m.share, back, rates(m.alpha))

    def take(self, index) -> Order:
        return Order(*(pick(a, index) for a in (self.share, self.back, self.rate)))

    def to_z(self, e):
        return np.einsum("ij...,j...->i...", self.share, e)

    def to_e(self, z):
        return np.einsum("ij...,j...->i...", self.back, z)
