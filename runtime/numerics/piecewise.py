"""Piecewise smooth functions of the members of a batch: Chebyshev series between breakpoints.

Compare Pachón, Platte & Trefethen, "Piecewise-smooth chebfuns" (IMA J. Numer. Anal. 30, 2010, 898). Turning points are found by
the signs of the derivative on a grid finer than the series' own nodes, then by bracketed Newton steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from . import chebyshev, endpoints, quadrature
from .intervals import Intervals
from .roots import falling_root
from .series import Series

#: points of the grid on which signs of a derivative are looked at, per coefficient: zeros of T_n are two points apart at least
_FINER = 4
#: points from which an inverse is guessed: from there Newton's method mostly takes two steps to rounding
_GUESSES = 33
_EPS = np.finfo(float).eps
#: rounding of a derivative, in roundings of its largest coefficient times the square of their number
_NOISE = 4


@lru_cache
def _grid(n: int) -> np.ndarray:
    """Parameters for the signs of a derivative of n coefficients, both ends included."""
    return np.concatenate(([0.0], chebyshev.nodes(_FINER * n - 1), [1.0]))


@dataclass(frozen=True)
class Piecewise:
    """Functions of ``members``: a series of ``series`` on each of the ``intervals`` (P pieces, by member, then by place), with
    its ``error`` (P, q).

    A point in a gap between two pieces belongs to the upper one, a point outside of all to the outermost; there the function has
    the value of that piece's end.
    """

    members: int
    intervals: Intervals
    series: Series
    error: np.ndarray

    @classmethod
    def make(cls, members: int, some: Sequence[tuple[Intervals, np.ndarray, np.ndarray]]) -> Piecewise:
        """From intervals, their coefficients (k, n, q) and errors (k, q), in any order."""
        intervals, errors = Intervals.joined([i for i, _, _ in some]), np.concatenate([e for _, _, e in some])
        order = np.lexsort((intervals.low, intervals.member))
        return cls(members, intervals.take(order), Series.make([c for _, c, _ in some]).take(order), errors[order])

    @cached_property
    def first(self) -> np.ndarray:
        """First piece of each member, and where those of the last one end, (members + 1,)."""
        return np.searchsorted(self.intervals.member, np.arange(self.members + 1))

    @cached_property
    def _uppers(self):
        # complex numbers are sorted by their real parts, then by their imaginary ones
        return self.intervals.member + 1j * self.intervals.high

    def piece(self, member: np.ndarray, x: np.ndarray) -> np.ndarray:
        """The piece of each ``member`` that ``x`` lies in, all (m,). ``ValueError`` for a member without pieces."""
        first, last = self.first[member], self.first[np.asarray(member) + 1] - 1
        if (last < first).any():
            raise ValueError("a member has no pieces")
        return np.clip(np.searchsorted(self._uppers, member + 1j * np.asarray(x)), first, last)

    def parameter(self, piece: np.ndarray, x: np.ndarray) -> np.ndarray:
        """Parameter in [0, 1] at which ``x`` lies in a ``piece``, all (m,); that of the nearer end outside."""
        i = self.intervals
        part = np.clip((x - i.low[piece]) / i.width[piece], 0.0, 1.0)
        return endpoints.parameter(part, i.strength_low[piece], i.strength_high[piece])

    def place(self, piece: np.ndarray, t: np.ndarray) -> np.ndarray:
        """x at the parameters ``t`` of the pieces, both (m,)."""
        i = self.intervals
        return i.low[piece] + i.width[piece] * endpoints.share(t, i.strength_low[piece], i.strength_high[piece])

    def __call__(self, member: np.ndarray, x: np.ndarray) -> np.ndarray:
        """Values (m, q) of each ``member`` at ``x``, both (m,)."""
        piece = self.piece(member, x)
        return self.series(piece, self.parameter(piece, x))

    def integrals(self) -> np.ndarray:
        """Integrals of each member over its pieces, (members, q)."""
        out = np.zeros((self.members, self.error.shape[1]))
        for n in self.series.stacks:
            # the map's derivative is no polynomial: as many nodes again as the series has
            t = chebyshev.nodes(2 * n + 1)
            rows = np.flatnonzero(self.series.size == n)
            values = self.series(np.repeat(rows, t.size), np.tile(t, rows.size)).reshape(rows.size, t.size, -1)
            weights = quadrature.weights(t.size) * self.intervals.take(rows).slopes(t)
            np.add.at(out, self.intervals.member[rows], (weights[:, :, None] * values).sum(axis=1))
        return out

    def turning_points(self, quantity: int) -> tuple[np.ndarray, np.ndarray]:
        """Pieces and parameters in (0, 1) at which the derivative of a quantity changes its sign, (k,), ascending."""
        slope, curvature = (s.quantity(quantity) for s in (self.series.derivative, self.series.derivative.derivative))
        found = [(np.empty(0, int), np.empty(0), np.empty(0), np.empty(0))]
        for n, stack in slope.stacks.items():
            t = _grid(n)
            rows = np.flatnonzero(slope.size == n)
            values = (chebyshev.vandermonde(n, tuple(t)) @ stack)[slope.rank[rows], :, 0]
            # next to a flat end rounding has no sign
            noise = _NOISE * _EPS * n * n * np.abs(stack).max(axis=1)[slope.rank[rows]]
            signs = np.sign(np.where(np.abs(values) > noise, values, 0.0))
            for outer, inner in ((0, 1), (-1, -2)):
                signs[:, outer] = np.where(signs[:, outer] == 0, signs[:, inner], signs[:, outer])
            row, at = np.nonzero(signs[:, :-1] * signs[:, 1:] < 0)
            found.append((rows[row], t[at], t[at + 1], signs[row, at]))
        piece, low, high, sign = (np.concatenate(v) for v in zip(*found, strict=True))

        def derivative(t, index):
            return tuple(sign[index] * s(piece[index], t)[:, 0] for s in (slope, curvature))

        t = falling_root(derivative, low, high).x
        order = np.lexsort((t, piece))
        return piece[order], t[order]

    def minima(self, quantity: int) -> tuple[np.ndarray, np.ndarray]:
        """Where each member is least in a quantity, and that value, both (members,); NaN and inf for a member without pieces."""
        piece, t = self.turning_points(quantity)
        every = np.arange(self.intervals.size)
        piece = np.concatenate((piece, every, every))
        t = np.concatenate((t, np.zeros(every.size), np.ones(every.size)))
        value = self.series.quantity(quantity)(piece, t)[:, 0]
        member = self.intervals.member[piece]
        order = np.lexsort((value, member))
        least = order[np.searchsorted(member[order], np.arange(self.members)).clip(max=max(order.size - 1, 0))]
        known = np.diff(self.first) > 0
        x, out = np.full(self.members, np.nan), np.full(self.members, np.inf)
        x[known], out[known] = self.place(piece[least], t[least])[known], value[least][known]
        return x, out

    def monotone(self, quantity: int) -> Monotone:
        """The parts of all pieces in which a quantity rises or falls."""
        piece, t = self.turning_points(quantity)
        every = np.arange(self.intervals.size)
        owner = np.concatenate((every, piece, every))
        cut = np.concatenate((np.zeros(every.size), t, np.ones(every.size)))
        order = np.lexsort((cut, owner))
        owner, cut = owner[order], cut[order]
        inner = np.flatnonzero((owner[1:] == owner[:-1]) & (cut[1:] > cut[:-1]))
        owner, low, high = owner[inner], cut[inner], cut[inner + 1]
        own = self.series.quantity(quantity)
        return Monotone(self, own, owner, low, high, own(owner, low)[:, 0], own(owner, high)[:, 0])


@dataclass(frozen=True)
class Monotone:
    """Parts (k,) of the pieces of ``function``, by piece, then by place: the ``piece``, the parameters ``t_low`` and ``t_high``
    of its ends, and the values ``low`` and ``high`` of the quantity there: it rises where ``high > low``."""

    function: Piecewise
    quantity: Series
    piece: np.ndarray
    t_low: np.ndarray
    t_high: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def take(self, index) -> Monotone:
        """Those of an ``index`` or a mask."""
        arrays = (self.piece, self.t_low, self.t_high, self.low, self.high)
        return Monotone(self.function, self.quantity, *(v[index] for v in arrays))

    @cached_property
    def _looks(self):
        """Parameters (k, looks) and values there, made monotone."""
        t = self.t_low[:, None] + (self.t_high - self.t_low)[:, None] * endpoints.share(np.linspace(0, 1, _GUESSES), 2, 2)
        values = self.quantity(np.repeat(self.piece, _GUESSES), t.ravel())[:, 0].reshape(t.shape)
        sign = np.where(self.high >= self.low, 1.0, -1.0)
        return t, np.maximum.accumulate(sign[:, None] * values, axis=1), sign

    def invert(self, part: np.ndarray, value: np.ndarray) -> np.ndarray:
        """Parameters at which the parts ``part`` have the ``value``, all (m,); the nearer end's where they don't."""
        t, seen, sign = self._looks
        goal = sign[part] * value
        after = np.clip(np.count_nonzero(seen[part] <= goal[:, None], axis=1), 1, _GUESSES - 1)
        (low, high), (below, above) = ((v[part, after - 1], v[part, after]) for v in (t, seen))
        rise = above - below
        share = np.divide(goal - below, rise, out=np.zeros_like(goal), where=rise > 0)
        guess = low + np.clip(share, 0.0, 1.0) * (high - low)
        piece, slope = self.piece[part], self.quantity.derivative
        blur = 16 * _EPS * np.maximum(np.abs(seen).max(axis=1), 0.0)[part]
        # outside and next to the ends, where rounding would decide, the ends themselves
        first, last = goal <= seen[part, 0], goal >= seen[part, -1]
        low, high = np.where(last, high, low), np.where(first, low, high)

        def missing(t, index):
            i, p = part[index], piece[index]
            miss = goal[index] - sign[i] * self.quantity(p, t)[:, 0]
            return np.where(np.abs(miss) <= blur[index], 0.0, miss), -sign[i] * slope(p, t)[:, 0]

        # by rounding the value may lie beyond the cell of the grid it seems to be in: one more on either side
        wider = np.where(first | last, low, t[part, np.maximum(after - 2, 0)])
        return falling_root(missing, wider, np.where(first | last, high, t[part, np.minimum(after + 1, _GUESSES - 1)]), guess).x

    def place(self, part: np.ndarray, t: np.ndarray) -> np.ndarray:
        """x at the parameters ``t`` of the parts, both (m,)."""
        return self.function.place(self.piece[part], t)
