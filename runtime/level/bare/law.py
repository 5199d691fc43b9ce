"""Friction laws of levels without adhesion over nominal pressure, as Chebyshev series between the pressures at which they are not smooth.

A law is not smooth at p = 0, where the crests touch (its powers are those of ``p^(1/4)``); at ``P(h)``, where the strips at the edge of the cell come into
contact; where the level is in complete contact; and where all below it is. Towards these pressures it has roots of the distance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_CHUNK = 32768


@dataclass(frozen=True)
class Piece:
    """A law between pressures ``low`` and ``high`` (G,): coefficients (G, n + 1, q) over ``omega``; ``quartic``: it starts at p = 0."""

    low: np.ndarray
    high: np.ndarray
    coefficients: np.ndarray
    quartic: bool

    def pressure(self, omega: np.ndarray) -> np.ndarray:
        """Pressures (G, n) at the parameters ``omega`` (n,) in [0, 1]."""
        return pressures(self.low, self.high, omega, self.quartic)

    def parameter(self, group, p):
        """x in [-1, 1] of the pressures ``p`` (m,) of the laws ``group`` (m,)."""
        share = np.clip((p - self.low[group]) / (self.high - self.low)[group], 0.0, 1.0)
        return 4 / np.pi * np.arcsin(np.sqrt(np.sqrt(share)) if self.quartic else np.sqrt(share)) - 1


def pressures(low, high, omega, quartic: bool):
    """Pressures (G, n) at parameters ``omega`` (n,) between ``low`` and ``high`` (G,)."""
    share = np.sin(0.5 * np.pi * omega) ** (4 if quartic else 2)
    return low[:, None] + (high - low)[:, None] * share


@dataclass(frozen=True)
class BareLaws:
    """Laws of a level at velocities (G,): ``pieces`` that follow one another; from ``p_full`` (G,) on everything below is saturated, with the means
    ``full`` (G, q). ``error`` (G,) bounds the friction, own and carried, Pa; ``steepest`` (G,): its greatest slope over pressure. Quantities: friction, contact, adhesion of the level, then of each below."""

    pieces: list[Piece]
    p_full: np.ndarray
    full: np.ndarray
    error: np.ndarray
    steepest: np.ndarray

    def averages(self, group: np.ndarray, p: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """Sums of the law at pressures ``p`` (m, nodes) by ``weight`` (m, nodes), of the law ``group[i]`` in row i: (m, q)."""
        m, nodes = p.shape
        out = np.zeros((m, self.full.shape[1]))
        rows = max(1, _CHUNK // nodes)
        for start in range(0, m, rows):
            some = slice(start, start + rows)
            out[some] = self._averages(group[some], p[some], weight[some])
        return out

    def _averages(self, group, p, weight):
        owner, p, weight = np.repeat(np.arange(group.size), p.shape[1]), p.ravel(), weight.ravel()
        saturated = p >= self.p_full[group[owner]]
        share = np.bincount(owner[saturated], weight[saturated], minlength=group.size)
        out = share[:, None] * self.full[group]
        for j, piece in enumerate(self.pieces):
            inside = ~saturated & (p > 0) & (piece.high > piece.low)[group[owner]]
            if j:
                inside &= p > piece.low[group[owner]]
            if j + 1 < len(self.pieces):
                last = self.pieces[j + 1]
                inside &= (p <= piece.high[group[owner]]) | (last.high <= last.low)[group[owner]]
            index = np.flatnonzero(inside)
            if index.size:
                mine = owner[index]
                x = piece.parameter(group[mine], p[index])
                which, start = np.unique(mine, return_index=True)
                moments = _moments(x, weight[index], start, piece.coefficients.shape[1])
                out[which] += np.einsum("km,mkq->mq", moments, piece.coefficients[group[which]])
        return out


def _moments(x, weight, start, count):
    """Weighted sums of Chebyshev polynomials over runs of nodes that begin at ``start``, (count, runs)."""
    out = np.empty((count, start.size))
    out[0] = np.add.reduceat(weight, start)
    before, now, twice = weight, weight * x, 2 * x
    for k in range(1, count):
        out[k] = np.add.reduceat(now, start)
        before, now = now, twice * now - before
    return out
