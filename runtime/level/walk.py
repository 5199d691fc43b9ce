"""One column's way along its curve, from the end its branch comes from to where it first passes a pressure.

The curve is interpolated part by part until the pressure lies on a branch of it (``branches``). Where the interpolation's error
leaves open which, what comes to the pressure is interpolated again, finer, or divided where strips change over.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..numerics.rounding import EPS, LARGEST
from .branches import Branch, Piece, rising
from .look import DOUBT
from .strips import AT_JUMP, NO_CURVE

#: how much finer each further look is; part of a piece over which a curve is taken to be straight, at least and at most
_FINER, _STEPS = 0.03, (1e-5, 1 / 64)


class Root(NamedTuple):
    """Where a coarse curve passes the pressure: between the penetrations ``low`` and ``high``, or (nan) in the jump at ``D``, or
    (all nan) nowhere; how it rises over D, and the ``slope`` of all quantities over pressure, (q,). Or arrays of several."""

    D: float | np.ndarray
    rise: float | np.ndarray
    slope: np.ndarray
    low: float | np.ndarray = np.nan
    high: float | np.ndarray = np.nan


def growing(arrive: Iterable[float], last: float, width: float) -> list[tuple[float, float]]:
    """Parts, low and high ends, of the way to the penetration ``last`` from where walks ``arrive``, the first furthest from it:
    parts grow from ``width``, and again where others arrive, whom only short ones pass by."""
    sign = 1 if min(arrive) < last else -1
    starts, end, parts = sorted(sign * D for D in arrive), sign * last, []
    at = starts[0]
    first = step = max(width, 2 * EPS * max(abs(at), abs(end)))
    while at < end:
        to = at + step if end - at > 2 * step else end
        others = starts[bisect_right(starts, at) : bisect_left(starts, to)]
        to = others[0] if others and step > first else to
        parts.append((at, to) if sign > 0 else (-to, -at))
        at, step = to, first if others else 2 * step
    return parts


@dataclass
class Walk:
    """The way of a ``column`` to its pressure ``p``, Pa; from the penetration ``top`` on its curve carries more.

    Pressures may err by ``rough`` where a part is interpolated first, by ``finest`` at last, by ``goal`` in what is interpolated
    now. ``waiting``: parts that are left, the next one last, but for what is as ``narrow``, m; ``now``: intervals to interpolate,
    their low and high ends and which of these are inner ones, (4, k); ``known``: the pieces so far, each with its goal.
    ``arrived``: nothing more is to be interpolated. ``undecided``: why the root is not certain, if it is not, and how far
    quantities differ between the places where it may be (``other``, (q,))."""

    column: int
    unloading: bool
    p: float
    rough: float
    finest: float
    waiting: list[tuple[float, float]]
    narrow: float = 0.0
    goal: float = np.nan
    now: np.ndarray | None = None
    known: dict[Piece, float] = field(default_factory=dict)
    root: Root | None = None
    arrived: bool = False
    undecided: str = ""
    other: np.ndarray | float = 0.0
    top: float = np.inf

    def advance(self, found: list[Piece], row: list[Branch], exhausted: bool) -> None:
        """Look for the root in the branches (``row``) of all that is known by now, the pieces ``found`` last included; where the
        work is not ``exhausted`` what comes to the pressure may be asked for again, finer."""
        self.now = None
        self.known.update(dict.fromkeys(found, self.goal))
        clings = self.p < 0 and not self.unloading
        # as the first strips cling the pressure falls below zero, and where it is least is known when it comes back
        if not row or (clings and self.waiting and not (row[-1].p_high >= 0 > row[0].p_low + DOUBT * row[0].errors.most[0])):
            return
        k, least, most = self._place(row)
        doubtful = least < most or bool(self._near(row, k, self._coarser(row)))
        if doubtful and not exhausted and self._interpolate_finer(row, k):
            return
        if least < most:
            # what is left may carry it
            if self.waiting and not exhausted and (least < 0 if self.unloading else most == 2 * len(row) - 1):
                return
            self.other = self._apart(row, least, most, exhausted)
            if self.other.any():
                self.undecided = NO_CURVE if exhausted else AT_JUMP
        k = max(k, 0) if doubtful else k
        if 0 <= k < 2 * len(row) - 1:
            highest = min(self.top, row[-1].piece.high) if self.p > row[-1].p_high else -np.inf
            self.root = _in_jump(*row[k // 2 : k // 2 + 2], self.unloading) if k % 2 else _in_branch(row[k // 2], self.p, highest)
        self.arrived = self.root is not None or clings

    def _place(self, row: list[Branch]) -> tuple[int, int, int]:
        """Where the pressure is: below all branches (-1), on number k (2 k) or just above it (2 k + 1); and where it may be at
        least and at most, for all they may err by, if those are not parts of one."""
        low, high = np.array([(part.p_low, part.p_high) for part in row]).T
        # where unloading comes from, and where the way of loading ends, the curve carries more than the pressure, but for errors
        high[-1] = np.inf if self.unloading or not self.waiting else high[-1]

        def place(p):
            k = np.count_nonzero(low <= p) - 1
            return int(2 * k + (k < 0 or (p > high)[k]))

        k = place(self.p)
        # a turn that no node met may be off by what was asked for, whatever the errors say, while more can be asked for; what
        # lies behind does not matter as long as the pressure is met before
        unseen = [self.known[part.piece] * (self.known[part.piece] > self.finest) for part in row]
        doubts = np.maximum(unseen, [DOUBT * part.errors.most[0] for part in row])
        doubts[slice(max(k, 0) // 2) if self.unloading else slice((k + 3) // 2, None)] = 0.0
        least, most = place(self.p - doubts), place(self.p + doubts)
        joints = [row[j - 1 : j + 1] for j in range(max(least, 0) // 2 + 1, min((most + 1) // 2 + 1, len(row)))]
        inside = 0 <= least and most < 2 * len(row) - 1
        whole = inside and all(a.t_high == 1 and b.t_low == 0 and b.piece.low - a.piece.high <= self.narrow for a, b in joints)
        # between two of them each may still be known better
        whole &= not (k % 2 and any(unseen[k // 2 : k // 2 + 2]))
        return (k, k, k) if whole else (k, least, most)

    def _apart(self, row: list[Branch], least: int, most: int, exhausted: bool) -> np.ndarray:
        """How far quantities (q,) differ between the places from ``least`` to ``most`` at which the pressure may be."""
        parts, nowhere = row[max(least, 0) // 2 : (most + 1) // 2 + 1], least < 0 or exhausted
        ends = [(part, self.p + side * DOUBT * part.errors.most[0]) for part in parts for side in (-1, 1)]
        values = np.array([part.piece.values(np.array([part.parameter_at(p)]))[0] for part, p in ends])
        # two branches that overlap by less than they are known to may be one
        one = not nowhere and most < 2 * len(row) - 1 and all(a.inner_high and b.inner_low for a, b in pairwise(parts))
        return np.maximum(np.ptp(values, axis=0) * (not one), np.abs(values).max(axis=0) * nowhere)

    def _coarser(self, row: list[Branch]) -> list[Piece]:
        """Pieces without a branch that are known less well than those that have some: one may hide there."""
        on = {part.piece: self.known[part.piece] for part in row}
        return [piece for piece in self.known if piece not in on and self.known[piece] > min(on.values())]

    def _near(self, row: list[Branch], k: int, among: Iterable[Piece]) -> list[Piece]:
        """Those pieces ``among`` some in which the curve may carry the pressure before it does at place ``k`` of the branches."""
        last, sign = (k // 2, 1) if self.unloading else ((k + 1) // 2, -1)
        met = sign * row[last].piece.low if 0 <= last < len(row) else -np.inf
        return [piece for piece in among if sign * piece.low >= met and self._comes_to(piece)]

    def divide(self, turns: np.ndarray, D: float) -> bool:
        """Whether to ask again for what comes to the pressure, but for errors, and has ``turns`` (m, (n,)), where strips change
        over, before the root ``D``; divided there. The curve may turn as well, by less than it may err."""
        before = turns[~(turns <= D if self.unloading else turns >= D)]
        again = [one for one in self.known if ((one.low < before) & (before < one.high)).any() and self._comes_to(one)]
        if again:
            self.root, self.undecided, self.other, self.arrived = None, "", 0.0, False
            self._interpolate_again(again, min(self.known[piece] for piece in again), before)
        return bool(again)

    def _interpolate_finer(self, row: list[Branch], k: int) -> bool:
        """Whether to ask again for what may carry the pressure before place ``k``: if some of it may be known better."""
        near = self._near(row, k, self.known)
        goal = max(_FINER * max((self.known[piece] for piece in near), default=0.0), self.finest)
        again = [piece for piece in near if self.known[piece] > goal]
        if again:
            self._interpolate_again(again, goal)
        return bool(again)

    def _interpolate_again(self, again: list[Piece], goal: float, breaks: np.ndarray = np.empty(0)) -> None:
        """Go along the pieces asked for ``again``, up to the ``top``, with a new ``goal``, divided at ``breaks`` (m, (n,))."""
        self.goal, ends = goal, []
        for piece in again:
            del self.known[piece]
            cut, inner = min(piece.high, self.top), piece.inner_high or self.top < piece.high
            for low, high in pairwise(np.unique(np.clip([piece.low, cut, *breaks], piece.low, cut))):
                ends.append((low, high, piece.inner_low and low == piece.low, inner and high == cut))
        self.now = np.array(ends).T

    def _comes_to(self, piece: Piece) -> bool:
        """Whether the curve carries the pressure in a piece or next to it, but for errors."""
        t = np.array([0.0, 1.0, *(end for part in rising([piece])[0] for end in (part.t_low, part.t_high))])
        met, doubt = piece.values(t)[:, 0], max(DOUBT * piece.errors.most[0], self.known[piece])
        return bool(met.min() - doubt <= self.p <= met.max() + doubt)


def _in_branch(part: Branch, p: float, most: float) -> Root:
    """Where a branch, which may be narrower than the rounding of D, carries the pressure; it may go on up to ``most``."""
    t = part.parameter_at(p)
    # nearer to a turn it bends more, but for rounding
    for step in (np.clip(0.5 * min(t - part.t_low, part.t_high - t), *_STEPS), _STEPS[1]):
        ends = np.clip([t - step, t + step], part.t_low, part.t_high)
        low, high = part.piece.values(ends)
        if high[0] != low[0]:
            break
    D = part.piece.penetration(np.array([t, *ends, part.t_low, part.t_high]))
    step, apart = high - low, max(D[2] - D[1], EPS * abs(D[0]), 1 / LARGEST)
    return Root(float(D[0]), step[0] / apart, step / step[0], float(D[3]), float(max(D[4], most)))


def _in_jump(part: Branch, following: Branch, unloading: bool) -> Root:
    """A curve that jumps over the pressure carries it at the jump, where strips of both sides can stand side by side: as more of
    them have changed over, all goes from that of one side to that of the other, evenly as far as is known."""
    step = np.subtract(*(one.piece.values(np.array([t]))[0] for one, t in ((following, following.t_low), (part, part.t_high))))
    one, t = (part, part.t_high) if unloading else (following, following.t_low)
    return Root(float(one.piece.penetration(t)), 0.0, step / step[0] if step[0] else np.zeros(step.size))
