"""Friction laws of levels without adhesion over nominal pressure, as Chebyshev series between the pressures at which
they are not smooth.

A law is not smooth at p = 0, where the crests touch (its powers are those of ``p^(1/4)``); at ``P(h)``, where the
strips at the edge of the cell come into contact; where the level is in complete contact; and where all below it is.
Towards these pressures it has roots of the distance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

#: how much steeper a law is feared to be beyond its end
_FEARED = 2.0


@dataclass(frozen=True)
class Piece:
    """A law between pressures ``low`` and ``high`` (G,): coefficients (G, n + 1, q) over ``omega``; ``quartic``: it
    starts at p = 0."""

    low: np.ndarray
    high: np.ndarray
    coefficients: np.ndarray
    quartic: bool

    def parameter(self, group, p):
        """x in [-1, 1] of the pressures ``p`` (m,) of the laws ``group`` (m,)."""
        share = np.clip((p - self.low[group]) / (self.high - self.low)[group], 0.0, 1.0)
        return 4 / np.pi * np.arcsin(np.sqrt(np.sqrt(share)) if self.quartic else np.sqrt(share)) - 1


def pressures(low, high, omega, quartic: bool):
    """Pressures (G, n) at parameters ``omega`` (n,) between ``low`` and ``high`` (G,)."""
    share = np.sin(0.5 * np.pi * omega) ** (4 if quartic else 2)
    return low[:, None] + (high - low)[:, None] * share


@dataclass(frozen=True)
class Laws:
    """Laws of a level at velocities (G,): ``pieces`` that follow one another; ``breaks`` (G, k): the pressures that
    part the sharpest of them, ascending, inf for none; from ``p_full`` (G,) on everything below is saturated, with the
    means ``full`` (G, q). ``top`` (G,): as far as the law goes, beyond it stays what it is there; ``steepest``
    (G,): the greatest slope of friction, own and carried, over pressure; ``most`` (G,): what it never exceeds.
    Quantities: friction and contact of the level, then of each below; the last one bounds the error of all friction, Pa."""

    pieces: list[Piece]
    breaks: np.ndarray
    p_full: np.ndarray
    full: np.ndarray
    top: np.ndarray
    steepest: np.ndarray
    most: np.ndarray

    def averages(self, group: np.ndarray, owner: np.ndarray, p: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """Sums (m, q) over the nodes of each column, ``group`` (m,) its law, of the law at ``p`` by ``weight``
        (nodes,); ``owner`` (nodes,), ascending: the column of each node."""
        g = group[owner]
        saturated = p >= self.p_full[g]
        out = np.bincount(owner[saturated], weight[saturated], minlength=group.size)[:, None] * self.full[group]
        beyond = np.where(saturated, 0.0, np.maximum(p - self.top[g], 0.0))
        if beyond.any():
            out[:, -1] += _FEARED * np.bincount(owner, weight * beyond, minlength=group.size) * self.steepest[group]
        todo = ~saturated & (p > 0)
        for piece in reversed(self.pieces):
            index = np.flatnonzero(todo & (piece.high > piece.low)[g] & (p >= piece.low[g]))
            todo[index] = False
            if index.size:
                mine = owner[index]
                which, start = np.unique(mine, return_index=True)
                moments = _moments(piece.parameter(g[index], p[index]), weight[index], start, piece.coefficients.shape[1])
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
