"""Along the curve over penetration, from the end a branch of loading comes from, to where it first passes a pressure.

The curve is interpolated part by part, and sampled; what it does between samples is bounded by the interpolation's error. Where
that leaves open whether a turn reaches the pressure, the part is interpolated again, finer.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ..numerics.rounding import LARGEST
from ..orbit.batch import Batch
from .breaks import between_breaks, first_contact
from .effort import CURVE_LIMIT, NO_CURVE
from .interpolation import Intervals, interpolate
from .piece import Piece
from .strips import LevelBatch

#: accuracy of the first look, of the pressure's scale, and how much finer each further one is; nodes of an interval at first
ROUGH, _FINER, _FIRST = 1e-2, 0.03, 8
#: width of the first part of the curve to be looked at, in heights; each further one is twice as wide
_NEXT = 0.3
#: penetrations in each of them at which the crest is looked at, and parameters of a piece at which it is sampled
_LOOKS, _SAMPLES = 12, np.linspace(0, 1, 65)
#: how much more than the estimated error of the interpolation a turn has to keep away from the pressure
_DOUBT = 2.0
#: share of that error by which a pressure may come back without a turn, as where two pieces meet
_RIPPLE = 0.02
#: place of a pressure that loading never comes to carry
_PULLED_OFF = -1


class Root(NamedTuple):
    """Where a coarse curve passes the pressure: between the penetrations ``low`` and ``high``, or (nan) in the jump at ``D``, or
    (all nan) nowhere; how it rises over D, and the ``slope`` of all quantities over pressure, (q,). Or arrays of several."""

    D: float | np.ndarray
    rise: float | np.ndarray
    slope: np.ndarray
    low: float | np.ndarray = np.nan
    high: float | np.ndarray = np.nan


@dataclass
class Samples(Batch):
    """Penetrations along a curve, which of its pieces they belong to, quantities (m, q), and how far the pressure may err."""

    D: np.ndarray
    piece: np.ndarray
    values: np.ndarray
    error: np.ndarray

    @classmethod
    def of(cls, pieces: Sequence[Piece], unloading: bool) -> list[Samples]:
        """Of each of the ``pieces``, in the order in which they are come to."""
        t = _SAMPLES[::-1] if unloading else _SAMPLES
        ordered = sorted(pieces, key=lambda piece: piece.low, reverse=unloading)
        constant = lambda value: np.full(t.size, value)  # noqa: E731
        return [cls(i.penetration(t), constant(i.low), i.values(t), constant(i.errors.most[0])) for i in ordered]


def first_passes(columns: LevelBatch, p: np.ndarray, top: np.ndarray, rtol: float) -> tuple[Root, np.ndarray]:
    """Where the curve of each column first passes the pressure ``p`` (Pa, (n,)), below ``top`` (n,), where unloading comes from,
    and which are undecided, (n,). All columns go along their curves together, a part of each at a time."""
    h, unloading, bottom = columns.level.h, columns.branch == "unloading", first_contact(columns)
    finest = rtol * (np.abs(p) + 1e-3 * columns.scales[0])
    goal = np.maximum(ROUGH * (np.abs(p) + columns.scales[0]), finest)
    parts = [_growing(bottom, D, _NEXT * h, unloading) for D in top]
    walks = [_Walk(i, unloading, *of) for i, of in enumerate(zip(p, goal, finest, parts, strict=True))]
    strips, nothing_else = np.zeros(p.size, int), np.full((p.size, columns.scales.size), LARGEST)
    while going := [walk for walk in walks if walk.waiting or walk.now is not None]:
        if fresh := [walk for walk in going if walk.now is None]:
            D = np.linspace(*np.array([walk.waiting.pop() for walk in fresh]).T, _LOOKS, axis=1)
            column = np.array([walk.column for walk in fresh])
            row, low, high, _ = between_breaks(columns, column, D)
            found = Intervals.of(column[row], low, high, np.zeros(p.size), nothing_else)
            # at the top the curve is but cut, or saturates
            found.inner_low[:], found.inner_high[:] = (low == D[row, 0]) & (low > bottom), high == D[row, -1]
            for k, walk in enumerate(fresh):
                walk.now = found.take(row == k)
        for walk in going:
            walk.now.atol[:, 0] = walk.goal
        pieces = interpolate(columns, Intervals.joined([walk.now for walk in going]), strips, first=_FIRST)
        for walk in going:
            walk.go_on(Samples.of(pieces[walk.column], unloading), bool(strips[walk.column] > CURVE_LIMIT))
    undecided = np.array([walk.undecided for walk in walks])
    columns.work.limit_reached(columns.V[undecided], columns.level.l, NO_CURVE)
    nowhere = Root(np.nan, 0.0, np.zeros(columns.scales.size))
    return Root(*(np.array(v) for v in zip(*(walk.root or nowhere for walk in walks), strict=True))), undecided


def _growing(bottom: float, top: float, width: float, unloading: bool) -> list[tuple[float, float]]:
    """The way between two penetrations in parts that grow from the end at which the branch arrives; the last one first."""
    gone, parts = 0.0, []
    while gone < top - bottom:
        end = gone + width if top - bottom - gone > 2 * width else top - bottom
        parts.append((max(top - end, bottom), top - gone) if unloading else (bottom + gone, min(bottom + end, top)))
        gone, width = end, 2 * width
    return parts[::-1]


@dataclass
class _Walk:
    """One column along its curve, from the end its branch comes from to where it first passes the pressure ``p``.

    ``goal``: error of the curve's pressure that it may have so far, at last ``finest``, Pa. ``waiting``: what is ahead of it, the
    next part last; ``now``: the part it goes along. ``known``: samples of what was gone along before, as far as they matter, and
    ``held``: parts that they are of, loading to less than no pressure, until it is known where the curve is least.
    """

    column: int
    unloading: bool
    p: float
    goal: float
    finest: float
    waiting: list[tuple[float, float]]
    now: Intervals | None = None
    known: list[Samples] = field(default_factory=list)
    held: list[Intervals] = field(default_factory=list)
    root: Root | None = None
    undecided: bool = False

    def go_on(self, found: list[Samples], exhausted: bool) -> None:
        """Along the samples of a part; where the work is not ``exhausted`` these may be asked for again, finer."""
        part, self.now, self.known = self.now, None, [*self.known, *found]
        if not self.known:
            return
        every, clings = Samples.joined(self.known), self.p < 0 and not self.unloading
        p = every.values[:, 0]
        if clings and self.waiting and not _returns(p, every.error).any():
            self.held.append(part)
            return
        least, k, most = sorted(self._passing(every, doubts) for doubts in (-_DOUBT, 0.0, _DOUBT))
        steps = np.diff(p[max(least - 1, 0) : most + 1]) * (-1 if self.unloading else 1)
        certain = least == most or (0 <= least and most < p.size and (steps >= -_RIPPLE * every.error[k]).all())
        if self.goal > self.finest and not certain:
            if not exhausted:
                self.goal, self.now = max(_FINER * self.goal, self.finest), Intervals.joined([*self.held, part])
                self.known, self.held = ([], []) if clings else (self.known[: len(self.known) - len(found)], [])
                return
            self.undecided = True
        if 0 <= k < p.size:
            self.root = self._root(every, k)
        if self.root is not None or clings:
            self.waiting = []
        self.known = [every.take(slice(-1, None))]

    def _passing(self, every: Samples, doubts: float) -> int:
        """Number of the first sample beyond the pressure, if that is so many errors greater; as many as there are: none is; -1:
        loading never comes to carry it."""
        p, shifted = every.values[:, 0], self.p + doubts * every.error
        beyond, start = p < shifted if self.unloading else p >= shifted, 0
        if not self.unloading:
            # as the first strips cling the pressure falls below zero, and what rises before it is least is left again
            back = _returns(p, every.error)
            start = int(p[: back.argmax() + 1 if back.any() else p.size].argmin()) if self.p < 0 else int(beyond.argmin())
            if self.p < 0 and beyond[start]:
                return _PULLED_OFF
        return start + max(int(beyond[start:].argmax()), 1) if beyond[start:].any() else p.size

    def _root(self, every: Samples, k: int) -> Root:
        """Between samples ``k - 1`` and ``k``. A curve that jumps over the pressure carries it at the jump, where strips of both
        sides can stand side by side: as more of them have changed over, all goes from that of one side to that of the other,
        evenly as far as is known."""
        step, wide = every.values[k] - every.values[k - 1], every.D[k] - every.D[k - 1]
        slope = step / step[0] if step[0] else np.zeros(step.size)
        if every.piece[k] != every.piece[k - 1] or step[0] * wide <= 0:
            return Root(float(every.D[k]), 0.0, slope)
        # the pressure rises with D all along a part of the piece
        rises = np.diff(every.values[:, 0]) * np.diff(every.D) > 0
        rises &= every.piece[1:] == every.piece[k]
        rises &= every.piece[:-1] == every.piece[k]
        off = np.flatnonzero(~rises)
        ends = every.D[[off[off < k - 1].max(initial=-1) + 1, off[off > k - 1].min(initial=rises.size)]]
        D = every.D[k - 1] + (self.p - every.values[k - 1, 0]) / step[0] * wide
        return Root(float(np.clip(D, ends.min(), ends.max())), step[0] / wide, slope, float(ends.min()), float(ends.max()))


def _returns(p: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Where pressures come back to zero after they were less."""
    return (p >= 0) & (np.minimum.accumulate(p) < -_DOUBT * error)
