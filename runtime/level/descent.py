"""Along the curve over penetration, from the end a branch of loading comes from, down to where it first passes a pressure.

The curve is interpolated part by part; what it does between samples is bounded by the interpolation's error. Where that leaves
open whether a turn reaches the pressure, the part is interpolated again, finer.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .branches import Branch, loaded, rising
from .breaks import breaks_on, first_contact, threshold_width
from .effort import CURVE_LIMIT, NO_CURVE
from .interpolation import interpolate
from .interval import Interval
from .piece import Piece
from .strips import LevelBatch

#: accuracy of the first look, of the pressure's scale, and how much finer each further one is
ROUGH, _FINER = 1e-2, 0.03
#: width of the first part of the curve to be looked at, in heights; each further one is twice as wide
_NEXT = 0.3
#: penetrations in each of them at which the crest is looked at
_LOOKS = 12
#: how much more than the estimated error of the interpolation a turn has to keep away from the pressure
_DOUBT = 2.0
#: place of a pressure that loading never comes to carry
_PULLED_OFF = -1


@dataclass(frozen=True)
class Root:
    """Where a coarse curve passes the pressure: between the penetrations ``low`` and ``high``, or (nan) in the jump at ``D``; how
    it rises over D, and the ``slope`` of all quantities over pressure, (q,)."""

    D: float
    rise: float
    slope: np.ndarray
    low: float = np.nan
    high: float = np.nan


class Descent:
    """All columns go along their curves together, a part of each at a time."""

    def __init__(self, columns: LevelBatch, p: np.ndarray, top: np.ndarray, rtol: float):
        self.columns, self.p = columns, p
        self.scale = np.abs(p) + columns.scales[0]
        finest = rtol * (np.abs(p) + 1e-3 * columns.scales[0])
        self.inside = threshold_width(columns, top)
        bottom, unloading = first_contact(columns), columns.branch == "unloading"
        # at the top the curve is but cut, or saturates
        every = [_growing(Interval(i, bottom, D, inner_high=True), _NEXT * columns.level.h, unloading) for i, D in enumerate(top)]
        goals = np.maximum(ROUGH * self.scale, finest)
        self.walks = [_Walk(unloading, *of) for of in zip(p, goals, finest, every, strict=True)]

    def run(self) -> tuple[list[Root | None], np.ndarray]:
        """Where each column carries its pressure (None: nowhere), and which are undecided."""
        strips = np.zeros(self.p.size, int)
        while going := [(i, walk) for i, walk in enumerate(self.walks) if walk.waiting]:
            self._divide([walk for _, walk in going if not walk.divided])
            now = [walk.next() for _, walk in going]
            goal = np.array([walk.goal for walk in self.walks])
            every = [interval for some in now for interval in some]
            pieces = interpolate(self.columns, np.minimum(goal / self.scale, 0.1), every, strips, goal)
            for (i, walk), intervals in zip(going, now, strict=True):
                walk.go_on(intervals, pieces[i], bool(strips[i] > CURVE_LIMIT))
        undecided = np.array([walk.undecided for walk in self.walks])
        self.columns.work.limit_reached(self.columns.V[undecided], self.columns.level.l, NO_CURVE)
        return [walk.root for walk in self.walks], undecided

    def _divide(self, walks: list[_Walk]) -> None:
        """What is next of each of the ``walks``, one interval, is divided at its breaks."""
        if not walks:
            return
        share, every = np.linspace(0, 1, _LOOKS), [walk.waiting[-1][0] for walk in walks]
        D = np.array([i.low + (i.high - i.low) * share for i in every])
        found, _ = breaks_on(self.columns, np.array([i.column for i in every]), D)
        for walk, rest, breaks in zip(walks, every, found, strict=True):
            parts, inside = [], self.inside[rest.column]
            for D in breaks:
                parts.append(replace(rest, high=D - inside, inner_high=False))
                rest = replace(rest, low=D + inside, inner_low=False)
            walk.waiting[-1] = [part for part in (*parts, rest) if part.high > part.low]
            walk.divided = True


def _growing(rest: Interval, width: float, unloading: bool) -> list[list[Interval]]:
    """An interval in parts that grow from the end at which the branch arrives; the last one first."""
    parts = []
    while rest.high - rest.low > 2 * width:
        lower, upper = rest.split(rest.high - width if unloading else rest.low + width, soft=True)
        rest, part = (lower, upper) if unloading else (upper, lower)
        parts.append([part])
        width *= 2
    return [[rest], *parts[::-1]] if rest.high > rest.low else []


@dataclass
class _Walk:
    """One column along its curve, from the end its branch comes from to where it first passes the pressure ``p``.

    ``goal``: error of the curve's pressure that it may have so far, at last ``finest``, Pa. ``waiting``: what is ahead of it, the
    next part last, which is ``divided`` at its breaks or not yet. ``held``: loading to less than no pressure, what was gone along
    until it is known where the curve is least, and rises there. ``passed``: the last branch before what is next.
    """

    unloading: bool
    p: float
    goal: float
    finest: float
    waiting: list[list[Interval]]
    divided: bool = False
    held: tuple[list[Interval], list[Branch]] = ([], [])
    passed: Branch | None = None
    root: Root | None = None
    undecided: bool = False

    def next(self) -> list[Interval]:
        """The next part."""
        self.divided = False
        return self.waiting.pop()

    def go_on(self, intervals: list[Interval], pieces: list[Piece], exhausted: bool) -> None:
        """Along the ``pieces`` of a part; where the work is not ``exhausted`` these may be asked for again, finer."""
        every = [part for row in rising(pieces) for part in row]
        parts = sorted(every, key=lambda part: (part.piece.low, part.t_low), reverse=self.unloading)
        clings = self.p < 0 and not self.unloading
        if clings:
            intervals, parts = self.held[0] + intervals, self.held[1] + parts
            self.held = intervals, parts
            if self.waiting and not any(part.p_high >= 0 for part in parts):
                return
            parts, self.held = loaded(parts), ([], [])
        if self.goal > self.finest and len({self._passing(parts, doubts) for doubts in (-_DOUBT, 0.0, _DOUBT)}) > 1:
            if not exhausted:
                self.goal, self.divided = max(_FINER * self.goal, self.finest), True
                self.waiting.append(intervals)
                return
            self.undecided = True
        self.root = self._root(parts)
        if self.root is not None or clings:
            self.waiting = []
        elif parts:
            self.passed = parts[-1]

    def _passing(self, parts: list[Branch], doubts: float) -> int | None:
        """The first part that goes past the pressure, if that is so many errors of the curve greater."""
        if not self.unloading and parts and self.p + doubts * parts[0].errors.most[0] < min(parts[0].p_low, 0.0):
            return _PULLED_OFF
        for k, part in enumerate(parts):
            shifted = self.p + doubts * part.errors.most[0]
            if part.p_low < shifted if self.unloading else part.p_high >= shifted:
                return k
        return None

    def _root(self, parts: list[Branch]) -> Root | None:
        index = self._passing(parts, 0.0)
        if index is None or index == _PULLED_OFF:
            return None
        part = parts[index]
        if self.p > part.p_high if self.unloading else self.p < part.p_low:
            return self._in_jump(parts[index - 1] if index else self.passed or part, part)
        t = part.reaches(self.p)
        step = 1e-4 * (part.t_high - part.t_low)
        ends = np.clip([t - step, t + step], part.t_low, part.t_high)
        values, D = part.piece.values(ends), part.piece.penetration(ends)
        rise, wide = np.diff(values, axis=0)[0], D[1] - D[0]
        slope = rise / rise[0] if rise[0] > 0 else np.zeros(rise.size)
        low, high = (float(part.piece.penetration(e)) for e in (part.t_low, part.t_high))
        return Root(float(part.piece.penetration(t)), rise[0] / wide if wide > 0 else 0.0, slope, low, high)

    def _in_jump(self, before: Branch, after: Branch) -> Root:
        """A curve that jumps over the pressure carries it at the jump, where strips of both sides can stand side by side: as more
        of them have changed over, all goes from that of one side to that of the other, evenly as far as is known."""
        t_before, t_after = (before.t_low, after.t_high) if self.unloading else (before.t_high, after.t_low)
        ends = [part.piece.values(np.array([t]))[0] for part, t in ((before, t_before), (after, t_after))]
        jump = ends[1] - ends[0]
        slope = jump / jump[0] if jump[0] else np.zeros(jump.size)
        return Root(float(after.piece.penetration(t_after)), 0.0, slope)
