"""Coordinates in which a period preserves the order of states (``order``): dashpot displacements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .problem import ModeStrips, pick, rates


@dataclass(slots=True)
class Order:
    """Coordinates of the order for a batch: ``z = share e``, ``e = back z`` (n, n, N or 1), ``g`` (n, N or 1):
    ``sum_j z_j = g . e``.

    ``rate``: ``1/alpha_i``, capped. ``gamma = sum g_i/alpha_i``.
    """

    share: np.ndarray
    back: np.ndarray
    g: np.ndarray
    rate: np.ndarray

    @classmethod
    def of(cls, kernel, s: ModeStrips) -> Order:
        m = s.m
        n = s.modes
        unit = np.eye(n)[:, :, None]
        back = np.stack([kernel.dashpots(unit[:, j], 0.0, m) for j in range(n)], axis=1)
        return cls(m.share, back, m.share.sum(axis=0), rates(m.alpha))

    def take(self, index) -> Order:
        return Order(*(pick(a, index) for a in (self.share, self.back, self.g, self.rate)))

    @property
    def gamma(self) -> np.ndarray:
        return (self.g * self.rate).sum(axis=0)

    def to_z(self, e):
        return np.einsum("ij...,j...->i...", self.share, e)

    def to_e(self, z):
        return np.einsum("ij...,j...->i...", self.back, z)
