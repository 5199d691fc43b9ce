"""From pressure to penetration along a branch: where the curve first passes the pressure, refined by averages there.

The curve is interpolated part by part, from the end the branch of loading comes from, until the pressure lies on a branch of it
(``branches``). Where the interpolation's error leaves open which, the part is interpolated again, finer.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import compress, pairwise
from typing import NamedTuple

import numpy as np

from ..numerics.roots import falling_root
from ..numerics.rounding import EPS, LARGEST
from ..orbit.batch import Batch
from .averages import Averages, level_means
from .branches import Branch, ParameterAt, Piece, branches_of, rising
from .breaks import between_breaks, first_contact
from .interpolation import Intervals, interpolate
from .nonadhesive.law import penetrations
from .strips import AT_JUMP, CURVE_LIMIT, NO_CURVE, QUANTITIES, LevelBatch, cut_penetration

#: accuracy of the first look, of the pressure's scale, how much finer each further one is, and the finest: a pressure so close to
#: a turn of the curve is left undecided; nodes of an interval at first
ROUGH, _FINER, _CLOSEST, _FIRST = 1e-2, 0.03, 1e-8, 8
#: width of the first part of the curve to be looked at, in heights; each further one is twice as wide
_NEXT = 0.3
#: penetrations in each of them at which the crest is looked at, and part of a piece over which a curve is taken to be straight,
#: at least and at most
_LOOKS, _STEPS = 12, (1e-5, 1 / 64)
#: how much more than the estimated error of the interpolation a turn has to keep away from the pressure
_DOUBT = 2.0


class Root(NamedTuple):
    """Where a coarse curve passes the pressure: between the penetrations ``low`` and ``high``, or (nan) in the jump at ``D``, or
    (all nan) nowhere; how it rises over D, and the ``slope`` of all quantities over pressure, (q,). Or arrays of several."""

    D: float | np.ndarray
    rise: float | np.ndarray
    slope: np.ndarray
    low: float | np.ndarray = np.nan
    high: float | np.ndarray = np.nan


@dataclass(frozen=True)
class Penetrations(Batch):
    """Penetrations that carry given pressures: ``D`` (n,), NaN below pull-off; ``strips.QUANTITIES`` as last averaged ``near``
    them (NaN: nowhere), their ``near_errors`` and ``slope`` over pressure, (n, 4); which are ``undecided`` (n,): it is not known
    which part of the curve it is; and which lie ``in_jump`` (n,): D is one side of a curve that jumps over the pressure."""

    D: np.ndarray
    near: np.ndarray
    near_errors: np.ndarray
    slope: np.ndarray
    undecided: np.ndarray
    in_jump: np.ndarray

    @classmethod
    def at(cls, D: np.ndarray) -> Penetrations:
        """Of pressures of which nothing else is known, or asked, than ``D`` (n,)."""
        shape = D.size, len(QUANTITIES)
        return cls(D, np.full(shape, np.nan), *np.zeros((2, *shape)), *np.zeros((2, D.size), bool))

    def meeting(self, p: np.ndarray, means: Averages) -> tuple[np.ndarray, np.ndarray]:
        """Means (n, 4) at the pressures ``p`` (Pa, (n,)), along the secant from those near D to the ``means`` at D, but for the
        pressure, which is that at D; and their errors. These grow by the change of slope since the average before, and by what
        the errors of both averages make of the slope."""
        own, errors = (v[:, : len(QUANTITIES)].copy() for v in (means.values, means.errors))
        steps, miss, unknown = own - self.near, (p - own[:, 0])[:, None], errors + self.near_errors
        # a step of no more than what is not known tells nothing
        told = np.abs(steps[:, :1]) > unknown[:, :1]
        secant = np.divide(steps, steps[:, :1], out=self.slope.copy(), where=told)
        blurred = np.divide(unknown + np.abs(secant) * unknown[:, :1], np.abs(steps[:, :1]), out=np.zeros_like(own), where=told)
        doubt = np.abs(secant - np.where(told, self.slope, 0.0)) + blurred
        own[:, 1:] += (secant * miss)[:, 1:]
        # along a secant fractions leave what they can be, by less than their errors
        own[:, 2:] = np.clip(own[:, 2:], 0.0, 1.0)
        errors[:, 1:] += (np.abs(secant) * errors[:, :1] + doubt * np.abs(miss))[:, 1:]
        errors[:, :1] += np.abs(miss)
        return own, errors


def invert(columns: LevelBatch, p: np.ndarray, rtol: float) -> Penetrations:
    """Largest penetration (``unloading``) or smallest (``loading``) at which each column carries ``p`` (Pa, (n,)).

    The root is refined with averages to ``rtol``.
    """
    saturated = columns.saturated
    out = Penetrations.at(np.where(p >= saturated.p_sat, p / columns.material.K + 0.75 * columns.level.h, np.nan))
    # without adhesion there is no contact at no pressure, and adhesion holds no more than p_0
    p_0 = columns.adhesion.p_0
    rest = np.flatnonzero((p < saturated.p_sat) & ((p > 0) | ((p_0 > 0) & (p >= -p_0))))
    if rest.size:
        search = _with_adhesion if p_0 > 0 else _without_adhesion
        found = search(columns.at(rest, np.zeros(rest.size)), p[rest], saturated.D_sat[rest], rtol)
        out.put(rest, found)
    return out


def _without_adhesion(columns: LevelBatch, p: np.ndarray, full: np.ndarray, rtol: float) -> Penetrations:
    """``invert`` at p > 0 without adhesion. Orbits are in the order of w, which rises with D, no faster: there is one root, and
    no turn to look for; and w lies between the profile, 3 h/4 below its crests on average, and these. Next to the plane crests
    are paraboloids, at rest they carry ``K D^2/(2 pi h)``: pressures are nearly powers."""
    K, h = columns.material.K, columns.level.h
    low, high = p / K, np.minimum(p / K + 0.75 * h, full)
    D, power, slope = np.sqrt(2 * np.pi * h * low), np.full(p.size, 2.0), np.full((p.size, len(QUANTITIES)), np.nan)
    if columns.family is not None:
        D, power = penetrations(columns, p)
    for accuracy in (max(rtol, ROUGH), rtol) if columns.family is None else (rtol,):
        at = Root(np.log(np.clip(D, low, high)), power, slope, np.log(low), np.log(high))
        # however little the pressure is, friction goes with it
        x, near, errors, slope = _refine(columns, p, at, accuracy, 0.0, powers=True)
        D = np.clip(np.exp(x), low, high)
    return Penetrations(D, near, errors, np.nan_to_num(slope), *np.zeros((2, p.size), bool))


def _with_adhesion(columns: LevelBatch, p: np.ndarray, full: np.ndarray, rtol: float) -> Penetrations:
    """``invert`` with adhesion: to where the curve passes the pressure first, for all that is known of it once it is refined."""
    h, q, unloading, bottom = columns.level.h, columns.scales.size, columns.branch == "unloading", first_contact(columns)
    out, left, strips, floor = Penetrations.at(p * np.nan), np.arange(p.size), np.zeros(p.size, int), 1e-3 * columns.scales[0]
    size, ways = np.abs(p) + floor, [_growing(bottom, top, _NEXT * h, unloading) for top in cut_penetration(columns, p, full)]
    goal = np.maximum(ROUGH * (np.abs(p) + columns.scales[0]), rtol * size)
    walks = [_Walk(i, unloading, *of) for i, *of in zip(left, p, goal, _CLOSEST * size, ways, strict=True)]
    while left.size:
        _go_along(columns, [walks[i] for i in left], strips)
        nowhere = Root(np.nan, 0.0, np.zeros(q))
        root = Root(*(np.array(v) for v in zip(*(walks[i].root or nowhere for i in left), strict=True)))
        found = _refine(columns.at(left, np.zeros(left.size)), p[left], root, rtol, floor)
        undecided = np.array([walks[i].undecided != "" for i in left])
        out.put(left, Penetrations(*found, undecided, ~np.isnan(root.D) & np.isnan(root.low)))
        # by now it is known how strips change over next to the root
        turns = columns.crossings.turned(columns)
        left = np.array([i for i in left if walks[i].divide(turns.E[turns.velocity == columns.V[i]] + h, out.D[i])], int)
    undecided = np.array([walk.undecided for walk in walks], object)
    for why in (NO_CURVE, AT_JUMP):
        columns.work.limit_reached(columns.V[undecided == why], columns.level.l, why)
    return out


def _go_along(columns: LevelBatch, walks: list[_Walk], strips: np.ndarray) -> None:
    """All walks together, part by part, to where their curves first pass their pressures; ``strips`` (n,) counts the work."""
    bottom = first_contact(columns)
    while going := [walk for walk in walks if walk.now is not None or (walk.waiting and not walk.arrived)]:
        if fresh := [walk for walk in going if walk.now is None]:
            D = np.linspace(*np.array([walk.waiting.pop() for walk in fresh]).T, _LOOKS, axis=1)
            row, low, high, _ = between_breaks(columns, np.array([walk.column for walk in fresh]), D)
            # at the top the curve is but cut, or saturates
            ends = np.array((low, high, (low == D[row, 0]) & (low > bottom), high == D[row, -1]))
            for k, walk in enumerate(fresh):
                walk.now = ends[:, row == k]
        low, high, *inner = np.concatenate([walk.now for walk in going], axis=1)
        column, goal = np.repeat([(walk.column, walk.goal) for walk in going], [walk.now.shape[1] for walk in going], axis=0).T
        atol = np.column_stack((goal, np.full((low.size, columns.scales.size - 1), LARGEST)))
        intervals = Intervals(low, high, column.astype(int), *(v > 0 for v in inner), 0 * low, atol, np.full(low.size, np.inf))
        pieces = interpolate(columns, intervals, strips, first=_FIRST)
        known = branches_of([[*walk.known, *pieces[walk.column]] for walk in going], columns.branch == "unloading")
        for walk, row in zip(going, known, strict=True):
            walk.go_on(pieces[walk.column], row, bool(strips[walk.column] > CURVE_LIMIT))


def _growing(bottom: float, top: float, width: float, unloading: bool) -> list[tuple[float, float]]:
    """The way between two penetrations in parts that grow from the end at which the branch arrives; the last one first."""
    gone, width, parts = 0.0, max(width, EPS * (top - bottom)), []
    while gone < top - bottom:
        end = gone + width if top - bottom - gone > 2 * width else top - bottom
        parts.append((max(top - end, bottom), top - gone) if unloading else (bottom + gone, min(bottom + end, top)))
        gone, width = end, 2 * width
    return parts[::-1]


@dataclass
class _Walk:
    """One column along its curve, from the end its branch comes from to where it first passes the pressure ``p``.

    ``goal``: error of the curve's pressure that it may have so far, at last ``finest``, Pa. ``waiting``: what is ahead of it, the
    next part last; ``now``: the intervals it goes along, low and high ends and which of them are inner ones, (4, k); ``known``:
    pieces of all others. ``arrived``: it need not go on. ``undecided``: why, if it is.
    """

    column: int
    unloading: bool
    p: float
    goal: float
    finest: float
    waiting: list[tuple[float, float]]
    now: np.ndarray | None = None
    known: list[Piece] = field(default_factory=list)
    root: Root | None = None
    arrived: bool = False
    undecided: str = ""

    def go_on(self, found: list[Piece], row: list[Branch], exhausted: bool) -> None:
        """Look for the root in the branches of all that is known by now, the pieces ``found`` last included; where the work is
        not ``exhausted`` what comes to the pressure may be asked for again, finer."""
        self.now, self.known = None, [*self.known, *found]
        clings = self.p < 0 and not self.unloading
        if not row:
            return
        # as the first strips cling the pressure falls below zero, and where it is least is known when it comes back
        if clings and self.waiting and not (row[-1].p_high >= 0 > row[0].p_low + _DOUBT * row[0].errors.most[0]):
            return
        # where unloading comes from, and where the way of loading ends, the curve carries more than the pressure, but for errors
        end = 2 * (len(row) - (self.unloading or not self.waiting))
        least, k, most = (min(_place(row, self.p, doubts), end) for doubts in (-_DOUBT, 0.0, _DOUBT))
        joints = [row[j - 1 : j + 1] for j in range(max(least, 0) // 2 + 1, min((most + 1) // 2 + 1, len(row)))]
        inside = 0 <= least and most < 2 * len(row) - 1
        whole = inside and all(a.t_high == 1 and b.t_low == 0 and a.piece.high == b.piece.low for a, b in joints)
        if not (least == most or whole):
            if self.goal > self.finest and not exhausted:
                again = [self._comes_to(piece) for piece in self.known]
                self.goal = max(_FINER * self.goal, self.finest)
                self._ask_again(again)
                return
            # two branches that overlap by less than they are known to may be one
            if not (inside and all(a.inner_high and b.inner_low for a, b in joints)):
                self.undecided = NO_CURVE if exhausted else AT_JUMP
            k = max(k, 0)
        if 0 <= k < 2 * len(row) - 1:
            self.root = _in_jump(*row[k // 2 : k // 2 + 2], self.unloading) if k % 2 else _in_branch(row[k // 2], self.p)
        self.arrived = self.root is not None or clings

    def divide(self, turns: np.ndarray, D: float) -> bool:
        """Whether to ask again for what comes to the pressure, but for errors, and has ``turns`` (m, (n,)), where strips change
        over, before the root ``D``; divided there. The curve may turn as well, by less than it may err."""
        before = turns[~(turns <= D if self.unloading else turns >= D)]
        again = [((piece.low < before) & (before < piece.high)).any() and self._comes_to(piece) for piece in self.known]
        if any(again):
            self.root, self.undecided, self.arrived = None, "", False
            self._ask_again(again, before)
        return any(again)

    def _ask_again(self, again: list[bool], breaks: np.ndarray = np.empty(0)) -> None:
        """Go along the pieces asked for ``again``, divided at the ``breaks`` (m, (n,)), instead of what is known there."""
        ends = []
        for piece in compress(self.known, again):
            cuts = [piece.low, *np.sort(breaks[(piece.low < breaks) & (breaks < piece.high)]), piece.high]
            for low, high in pairwise(cuts):
                ends.append((low, high, piece.inner_low and low == piece.low, piece.inner_high and high == piece.high))
        self.now = np.array(ends).T
        self.known = [piece for piece, so in zip(self.known, again, strict=True) if not so]

    def _comes_to(self, piece: Piece) -> bool:
        """Whether the curve carries the pressure in a piece or next to it, but for errors."""
        t = np.array([0.0, 1.0, *(end for part in rising([piece])[0] for end in (part.t_low, part.t_high))])
        met, doubt = piece.values(t)[:, 0], max(_DOUBT * piece.errors.most[0], self.goal)
        return bool(met.min() - doubt <= self.p <= met.max() + doubt)


def _place(row: list[Branch], p: float, doubts: float) -> int:
    """Where a pressure, greater by so many errors, is: below all branches (-1), on number k (2 k), or just above it (2 k + 1)."""
    k = sum(part.p_low <= p + doubts * part.errors.most[0] for part in row) - 1
    return 2 * k + (k < 0 or p + doubts * row[k].errors.most[0] > row[k].p_high)


def _in_branch(part: Branch, p: float) -> Root:
    """Where a branch, which may be narrower than the rounding of D, carries the pressure."""
    t = float(ParameterAt([part])(np.zeros(1, int), np.array([p]))[0])
    # nearer to a turn it bends more, but for rounding
    for step in (np.clip(0.5 * min(t - part.t_low, part.t_high - t), *_STEPS), _STEPS[1]):
        ends = np.clip([t - step, t + step], part.t_low, part.t_high)
        low, high = part.piece.values(ends)
        if high[0] != low[0]:
            break
    D = part.piece.penetration(np.array([t, *ends, part.t_low, part.t_high]))
    step, apart = high - low, max(D[2] - D[1], EPS * abs(D[0]), 1 / LARGEST)
    return Root(float(D[0]), step[0] / apart, step / step[0], float(D[3]), float(D[4]))


def _in_jump(part: Branch, following: Branch, unloading: bool) -> Root:
    """A curve that jumps over the pressure carries it at the jump, where strips of both sides can stand side by side: as more of
    them have changed over, all goes from that of one side to that of the other, evenly as far as is known."""
    step = np.subtract(*(one.piece.values(np.array([t]))[0] for one, t in ((following, following.t_low), (part, part.t_high))))
    one, t = (part, part.t_high) if unloading else (following, following.t_low)
    return Root(float(one.piece.penetration(t)), 0.0, step / step[0] if step[0] else np.zeros(step.size))


def _refine(columns: LevelBatch, p, root: Root, rtol, floor, powers: bool = False):
    """Penetrations, quantities near them, their errors and slopes over pressure at a ``root`` of each column:
    Newton with the rise of the coarse curve, then of the last two averages. The pressure (Pa) is met to ``rtol`` of itself and
    the ``floor``. With ``powers`` penetrations are given and returned as logarithms, and those of pressures rise over them."""
    D, rise, slope, low, high = root
    of, back, least = (np.log, np.exp, np.finfo(float).tiny) if powers else (np.positive, np.positive, -np.inf)
    goal, able = rtol * (np.abs(p) + floor), np.flatnonzero((rise > 0) & (high > low))
    last, errors = np.full((p.size, 1 + slope.shape[1]), np.nan), np.zeros(slope.shape)

    def missing(x, sub):
        index = able[sub]
        at, accuracy = columns.at(index, back(x)), np.full(index.size, rtol)
        # without adhesion pressures are sums of what is nowhere negative: their errors are relative to them alone
        means = level_means(at, accuracy, at.atol(accuracy, pressure=0.0 if powers else 1e-3, fraction=1.0))
        new, before = np.column_stack((x, means.values)), last[index]
        new[:, 1] = np.maximum(new[:, 1], least)
        # a step of no more than what is not known tells nothing
        steps, last[index] = new - before, new
        unknown, errors[index] = means.errors + errors[index], means.errors
        wide = (steps[:, 0] * steps[:, 1] > 0) & (np.abs(steps[:, 1]) > unknown[:, 0])
        steep = np.divide(of(new[:, 1]) - of(before[:, 1]), steps[:, 0], out=np.zeros(x.size), where=wide)
        better = steep > 0
        # without a coarse curve quantities are taken to go with the pressure, that about as the contact at rest makes it rise
        alone = index[np.isnan(slope[index, 0])]
        slope[alone] = last[alone, 1:] / last[alone, 1:2]
        rise[alone] = np.maximum(columns.material.K * back(last[alone, 0]) / last[alone, 1] * last[alone, 3], 1.0)
        rise[index[better]], slope[index[better]] = steep[better], steps[better, 1:] / steps[better, 1:2]
        miss = p[index] - new[:, 1]
        return np.where(np.abs(miss) > goal[index], of(p[index]) - of(new[:, 1]), 0.0), -rise[index]

    falling_root(missing, low[able], high[able], D[able])
    # what is close enough takes another step: the average made there afterwards is next to the pressure
    D[able] = np.clip(last[:, 0] + (of(p) - of(last[:, 1])) / rise, low, high)[able]
    return D, last[:, 1:], errors, slope
