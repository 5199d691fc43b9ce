"""Pieces of laws without adhesion through values at some nodes: whether these are enough, and what is kept of them."""

from __future__ import annotations

import numpy as np

from ...numerics.chebyshev import coefficients, lobatto
from .family import errors_alone
from .law import pressures

#: nodes of a piece, tried in turn
NODES = (16, 32, 64, 128)
#: how much more than the estimated error of a law is feared, and what is left of it in a mean over contacts: along a piece errors
#: change sign
_SURE, _CANCELLED = 2.0, 0.3
#: slopes of a law are looked at over steps of at least this share of the pressure
_STEP = 1e-3


class Tried:
    """Pieces through the ``values`` (m, n + 1, q) at ``lobatto(n)``: friction and contact of each level, and the error of
    all friction. ``done`` (m,): all friction, and that of each level, is known to ``friction`` (m,), Pa; contact needs no more
    nodes than that."""

    def __init__(self, values: np.ndarray, friction: np.ndarray):
        self.coefficients, frictions = coefficients(values[:, :, :-1]), values[:, :, :-1:2]
        #: all friction first
        self.total = frictions.sum(axis=2)
        self.of_total = coefficients(np.concatenate((self.total[:, :, None], frictions), axis=2))
        goal = np.broadcast_to(friction[:, None], (friction.size, self.of_total.shape[2]))
        miss = errors_alone(self.of_total, goal)
        self.miss, self.done = miss[:, 0], (miss <= goal).all(axis=1)

    def series(self, k: int, worst: float) -> np.ndarray:
        """Series of piece ``k``, (terms, q), whose values err by no more than ``worst``: one bound of the error of friction for
        all of a piece."""
        series = np.pad(self.coefficients[k], ((0, 0), (0, 1)))
        series[0, -1] = _CANCELLED * (_SURE * self.miss[k] + worst)
        return series

    def most(self, k: int) -> float:
        """A bound of the friction of piece ``k``, Pa."""
        return np.abs(self.of_total[k, :, 0]).sum()

    def steepest(self, k: int, low: float, high: float, first: bool) -> float:
        """Greatest slope of friction over pressure seen on piece ``k`` between pressures ``low`` and ``high``, the ``first`` of a
        law or another."""
        p = pressures(np.array([low]), np.array([high]), lobatto(self.total.shape[1] - 1), first)[0]
        rise, step = np.abs(np.diff(self.total[k])), np.diff(p)
        # differences of pressures that rounding or quadrature would make slopes of are none
        wide = step > _STEP * high
        return (rise[wide] / step[wide]).max(initial=0.0)
