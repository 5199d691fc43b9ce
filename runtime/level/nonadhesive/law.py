"""Friction laws of levels without adhesion over nominal pressure, as Chebyshev series between the pressures at which
they are not smooth.

A law is not smooth at p = 0, where the crests touch (its powers are those of ``p^(1/4)``); at ``P(h)``, where the
strips at the edge of the cell come into contact; where the level is in complete contact; and where all below it is.
Towards these pressures it has roots of the distance.
"""

from dataclasses import dataclass

import numpy as np

from ...numerics.chebyshev import coefficients
from .family import errors_alone
from .means import CANCELLED

#: nodes of a piece, tried in turn
NODES = (16, 32, 64, 128)
#: how much steeper a law is feared to be beyond its end
_FEARED = 2.0
#: slopes of a law are looked at over steps of at least this share of the pressure
_STEP = 1e-3


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


def pressures(low: np.ndarray, high: np.ndarray, omega: np.ndarray, quartic: np.ndarray) -> np.ndarray:
    """Pressures (m, n) at parameters ``omega`` (n,) between ``low`` and ``high`` of pieces that are ``quartic``, or not, (m,)."""
    share = np.sin(0.5 * np.pi * omega) ** np.where(quartic, 4, 2)[:, None]
    return low[:, None] + (high - low)[:, None] * share


def fit(values: np.ndarray, friction: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Series (m, n + 1, q) through the ``values`` of pieces at ``lobatto(n)``, whose last quantity is the error of all friction:
    of it one bound for all of a piece; bounds of all friction, Pa, (m,); and for which all friction, and that of each level, is
    known to ``friction`` (m,), Pa. Contact needs no more nodes than that."""
    frictions = values[:, :, :-1:2]
    of_total = coefficients(np.concatenate((frictions.sum(axis=2, keepdims=True), frictions), axis=2))
    goal = np.broadcast_to(friction[:, None], (friction.size, of_total.shape[2]))
    miss, series = errors_alone(of_total, goal), coefficients(values)
    series[:, :, -1] = 0.0
    series[:, 0, -1] = CANCELLED * (miss[:, 0] + values[:, :, -1].max(axis=1))
    return series, np.abs(of_total[:, :, 0]).sum(axis=1), (miss <= goal).all(axis=1)


def greatest_slope(p: np.ndarray, friction: np.ndarray) -> np.ndarray:
    """Greatest slope of ``friction`` over pressures ``p`` of pieces, (m, nodes), (m,): differences of pressures that rounding or
    quadrature would make slopes of are none."""
    step = np.diff(p, axis=1)
    slopes = np.divide(np.abs(np.diff(friction, axis=1)), step, out=np.zeros_like(step), where=step > _STEP * p[:, -1:])
    return slopes.max(axis=1, initial=0.0)


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
