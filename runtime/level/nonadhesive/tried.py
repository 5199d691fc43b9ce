"""Pieces of laws without adhesion through values at some nodes: whether these are enough, and what is kept of them."""

from __future__ import annotations

import numpy as np

from ...numerics.chebyshev import coefficients, interpolation_errors, lobatto
from .family import trimmed
from .law import pressures

#: nodes of a piece, tried in turn
NODES = (16, 32, 64, 128)
#: of what is allowed: what interpolating may err, and what is cut off a series
_INTERPOLATION, _TRIMMED = 1.0, 0.03
#: contact fractions are interpolated no finer than this, and on no more nodes
_CONTACT, _FOR_CONTACT = 1e-5, 16
#: how much more than the estimated error of a law is feared, and what is left of it in a mean over contacts: along a piece errors
#: change sign
_SURE, _CANCELLED = 2.0, 0.3
#: slopes of a law are looked at over steps of at least this share of the pressure
_STEP = 1e-3


class Tried:
    """Pieces through the ``values`` (m, n + 1, q) at ``lobatto(n)``: friction and contact of each level, and the error of
    all friction; which is known to ``friction`` (m,), Pa, everything else to ``rtol``."""

    def __init__(self, n: int, values: np.ndarray, friction: np.ndarray, rtol: float):
        self.n = n
        #: all friction first
        self.total = np.concatenate((values[:, :, :-1:2].sum(axis=2, keepdims=True), values[:, :, :-1]), axis=2)
        self.goal = np.full((friction.size, values.shape[2]), max(rtol, _CONTACT))
        self.goal[:, 0] = _INTERPOLATION * friction
        self.goal[:, 1::2] = self.goal[:, :1]
        self.coefficients = coefficients(self.total)
        alone = np.swapaxes(self.coefficients, 1, 2).reshape(-1, n + 1, 1)
        miss = interpolation_errors(alone, 0.1 * self.goal.reshape(-1, 1)).reshape(friction.size, -1)
        # between values that hardly differ there is little to miss
        self.miss = np.minimum(miss, 2 * np.ptp(self.total, axis=1))

    @property
    def done(self) -> np.ndarray:
        """Which need no more nodes, or get none, (m,)."""
        known = self.miss <= self.goal
        friction = known[:, 0] & known[:, 1::2].all(axis=1)
        return known.all(axis=1) | (self.n == NODES[-1]) | (friction & (self.n >= _FOR_CONTACT))

    def series(self, k: int, worst: float) -> np.ndarray:
        """Series of piece ``k``, (terms, q), whose values err by no more than ``worst``: one bound of the error of friction for
        all of a piece."""
        kept, lost = trimmed(self.coefficients[k, :, 1:], _TRIMMED * self.goal[k, 1:])
        series = np.pad(kept, ((0, 0), (0, 1)))
        series[0, -1] = _CANCELLED * (_SURE * self.miss[k, 0] + worst + lost[::2].sum())
        return series

    def most(self, k: int) -> float:
        """A bound of the friction of piece ``k``, Pa."""
        return np.abs(self.coefficients[k, :, 0]).sum()

    def steepest(self, k: int, low: float, high: float, first: bool) -> float:
        """Greatest slope of friction over pressure seen on piece ``k`` between pressures ``low`` and ``high``, the ``first`` of a
        law or another."""
        share = pressures(np.zeros(1), np.ones(1), lobatto(self.n), False)[0]
        rise, step = np.abs(np.diff(self.total[k, :, 0])), np.diff((high - low) * (share**2 if first else share))
        # differences of pressures that rounding or quadrature would make slopes of are none
        wide = step > _STEP * high
        return (rise[wide] / step[wide]).max(initial=0.0)
