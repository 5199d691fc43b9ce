"""Pieces of a curve over penetration, and the branches of it that load control follows: rising, not hidden by other parts.

A piece is a Chebyshev series. Whatever a quantity does next to an end, it is smooth and flat in its parameter there, which says
what it is at the end: the ends are no nodes. They are breaks, and next to one rounding decides which side of it a strip is on.

Unloading follows the largest penetration at which the level carries the pressure: from saturation downwards a part of the curve
counts only where its pressure lies below everything above it. Loading follows the smallest: from the first contact upwards only
where the pressure lies above everything below. What remains is a stack of rising branches in disjoint intervals of pressure.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial.chebyshev import chebval

from ..numerics.chebyshev import Series, derivatives
from ..numerics.gauss import GENTLE, STEEP, graded_share
from ..numerics.roots import falling_root
from ..numerics.rounding import EPS

if TYPE_CHECKING:
    from .segment import Segment

#: parameters at which turns are looked for: one may hide next to an end, where every piece is flat
_TURNS = np.concatenate(([0.0], 0.5 ** np.arange(10, 6, -1), np.arange(1, 64) / 64, 1 - 0.5 ** np.arange(7, 11), [1.0]))


def graded(t):
    """Share of a range of pressure that lies below parameter t: from 0 to 1, flat like t^4 at both ends."""
    return np.sin(0.5 * np.pi * np.sin(0.5 * np.pi * t) ** 2) ** 2


def parameter(share):
    """t at which ``graded`` is ``share``."""
    inner = 2 / np.pi * np.arcsin(np.sqrt(share))
    return 2 / np.pi * np.arcsin(np.sqrt(inner))


def share_of(t, inner_low: bool, inner_high: bool):
    """Share of an interval of D that lies below parameter t, where the curve goes on smoothly beyond either end, or not."""
    return graded_share(t, *(GENTLE if inner else STEEP for inner in (inner_low, inner_high)))


@dataclass(frozen=True)
class Errors:
    """Bounds of the errors of quantities, ``bounds`` (k, q), at places ``at`` (k,), ascending; interpolated between.

    Means next to a break are often known a thousand times less well than all others: one bound would not do."""

    at: np.ndarray
    bounds: np.ndarray

    @property
    def most(self) -> np.ndarray:
        """The largest of each quantity, (q,)."""
        return self.bounds.max(axis=0)

    def along(self, x: np.ndarray, columns: np.ndarray | list[int]) -> np.ndarray:
        """Of the sum of some quantities at the places ``x`` (m,), (m,)."""
        return np.interp(x, self.at, self.bounds[:, columns].sum(axis=1))

    def plus(self, more: np.ndarray) -> Errors:
        """Larger by ``more`` (q,)."""
        return Errors(self.at, self.bounds + more)

    def then(self, other: Errors) -> Errors:
        """These, then those of what follows."""
        return Errors(np.concatenate((self.at, other.at)), np.concatenate((self.bounds, other.bounds)))


@dataclass(frozen=True, eq=False)
class Piece:
    """Quantities over one interval of D: ``coefficients`` of shape (n + 1, q) in t, and their ``errors`` over t.

    ``inner_low``, ``inner_high``: the curve goes on smoothly beyond that end, in another piece."""

    low: float
    high: float
    coefficients: np.ndarray
    errors: Errors
    inner_low: bool = False
    inner_high: bool = False

    def penetration(self, t):
        """D at t."""
        return self.low + (self.high - self.low) * share_of(t, self.inner_low, self.inner_high)

    def values(self, t) -> np.ndarray:
        """Quantities at t (m,), shape (m, q)."""
        return chebval(2 * t - 1, self.coefficients).T


@dataclass(frozen=True, slots=True)
class Branch:
    """A monotone part of a curve: piece and parameters between which pressure rises from ``p_low`` to ``p_high``.

    ``inner_low``, ``inner_high``: the curve goes on smoothly, and rising, beyond that end."""

    piece: Piece
    t_low: float
    t_high: float
    p_low: float
    p_high: float
    inner_low: bool = False
    inner_high: bool = False

    @property
    def errors(self) -> Errors:
        """Those of its piece, over its parameter."""
        return self.piece.errors

    def parameter_at(self, p: float) -> float:
        """t at which it reaches the pressure ``p``, Pa, clipped to the branch."""
        return float(ParameterAt([self])(np.zeros(1, int), np.array([p]))[0])

    def errors_by_pressure(self) -> Errors:
        """The same over pressure."""
        known = self.piece.errors
        p = self.piece.values(np.clip(known.at, self.t_low, self.t_high))[:, 0]
        return Errors(np.maximum.accumulate(p), known.bounds)


def branches_of(curves: Sequence[Sequence[Piece]], unloading: bool) -> list[list[Branch]]:
    """Branches that load control follows on each of the curves, given by its pieces, in order of rising pressure."""
    ordered = [sorted(pieces, key=lambda piece: -piece.low) for pieces in curves]  # from high D to low D
    found = iter(rising([piece for pieces in ordered for piece in pieces]))
    rows = [[part for _ in pieces for part in next(found)] for pieces in ordered]
    if unloading:
        return [_standing_out(row, unloading)[::-1] for row in rows]
    return [_standing_out(loaded(row[::-1]), unloading) for row in rows]


def meets(part: Branch | Segment, overlap: float) -> bool:
    """Whether a part overlaps its neighbour by no more than the curve is uncertain: then they are one."""
    return overlap <= 2 * part.errors.most[0] + 64 * EPS * (abs(part.p_low) + abs(part.p_high))


def loaded(parts: list[Branch]) -> list[Branch]:
    """Of parts in order of rising D those that loading follows. When the first strips adhere the pressure falls below zero:
    rising parts before its minimum are none of them. One that rises by less than it errs need not come back to zero."""
    rises = (part.p_high >= max(0.0, part.p_low + 2 * part.errors.most[0]) for part in parts)
    back = next((k for k, rise in enumerate(rises) if rise), len(parts) - 1)
    return parts[min(range(back + 1), key=lambda k: parts[k].p_low, default=0) :]


def _standing_out(row: list[Branch], unloading: bool) -> list[Branch]:
    """Of a row what lies below (unloading) or above all that stands before it."""
    kept: list[Branch] = []
    for part in row:
        bound = (kept[-1].p_low if unloading else kept[-1].p_high) if kept else None
        if bound is None or (part.p_high <= bound if unloading else part.p_low >= bound):
            kept.append(part)
        elif part.p_low < bound < part.p_high:
            t = part.parameter_at(bound)
            if unloading and t > part.t_low:
                smooth = part.inner_high and meets(part, part.p_high - bound)
                kept.append(replace(part, t_high=t, p_high=bound, inner_high=smooth))
            elif not unloading and t < part.t_high:
                smooth = part.inner_low and meets(part, bound - part.p_low)
                kept.append(replace(part, t_low=t, p_low=bound, inner_low=smooth))
    return kept


def rising(pieces: Sequence[Piece]) -> list[list[Branch]]:
    """Of each piece the maximal parts in which pressure rises with D, from high to low D."""
    if not pieces:
        return []
    pressures = _pressures(pieces)
    every, last = np.arange(len(pieces)), _TURNS.size - 1
    rises = np.diff(pressures(every.repeat(_TURNS.size), np.tile(_TURNS, every.size))[0].reshape(every.size, -1)) > 0
    outside = np.zeros((len(pieces), 1), int)
    change = np.diff(rises.astype(int), axis=1, prepend=outside, append=outside)
    (which, first), end = np.nonzero(change > 0), np.nonzero(change < 0)[1]
    low, high = np.zeros(which.size), np.ones(which.size)
    turns, tops = np.flatnonzero(first > 0), np.flatnonzero(end < last)
    low[turns] = _turns(pressures, which[turns], first[turns], 1.0)
    high[tops] = _turns(pressures, which[tops], end[tops], -1.0)
    p_low, p_high = (pressures(which, t)[0] for t in (low, high))
    parts: list[list[Branch]] = [[] for _ in pieces]
    for k in np.flatnonzero((high > low) & (p_high > p_low))[::-1]:
        piece = pieces[which[k]]
        smooth = piece.inner_low and low[k] == 0.0, piece.inner_high and high[k] == 1.0
        parts[which[k]].append(Branch(piece, *(float(v[k]) for v in (low, high, p_low, p_high)), *smooth))
    return parts


def _turns(pressures: Series, which: np.ndarray, near: np.ndarray, sign: float) -> np.ndarray:
    """t of the pieces ``which`` next to point ``near`` of ``_TURNS`` from which on the slope of the pressure has this ``sign``,
    all (m,). At an end of a piece its slope says nothing: it is not asked there."""

    def slope(t, sub):
        _, first, second = pressures(which[sub], t)
        return -sign * first, -sign * second

    return falling_root(slope, _TURNS[np.maximum(near - 1, 0)], _TURNS[np.minimum(near + 1, _TURNS.size - 1)])


def _pressures(pieces: Sequence[Piece]) -> Series:
    """Pressure along each piece, with its first two derivatives by t."""
    every = []
    for piece in pieces:
        p = piece.coefficients[:, :1]
        slope = 2 * derivatives(p)
        every.append(np.concatenate((p, slope, 2 * derivatives(slope)), axis=1))
    return Series(every)


class ParameterAt:
    """Parameters at which branches reach pressures."""

    def __init__(self, parts: Sequence[Branch]):
        self._pressures = _pressures([part.piece for part in parts])
        self._ends = np.array([(part.t_low, part.t_high, part.p_low, part.p_high) for part in parts])
        largest = [np.abs(part.piece.coefficients[:, 0]).sum() for part in parts]
        self._rounding = 16 * EPS * np.maximum(largest, np.abs(self._ends[:, 2:]).max(axis=1))

    def __call__(self, which: np.ndarray, p: np.ndarray) -> np.ndarray:
        """t at which the branches ``which`` reach the pressures ``p``, clipped to the branch; all (m,)."""
        t_low, t_high, p_low, p_high = self._ends[which].T

        def missing(t, sub):
            value, slope, _ = self._pressures(which[sub], t)
            off = p[sub] - value
            # next to a flat end rounding would send what is there already anywhere
            return np.where(np.abs(off) > self._rounding[which[sub]], off, 0.0), -slope

        share = np.divide(p - p_low, p_high - p_low, out=np.zeros_like(p), where=p_high > p_low)
        # over this t is all but linear, also where the curve turns
        guess = t_low + (t_high - t_low) * parameter(np.clip(share, 0.0, 1.0))
        t = falling_root(missing, t_low, t_high, guess)
        return np.where(p <= p_low, t_low, np.where(p >= p_high, t_high, t))
