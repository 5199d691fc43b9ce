"""From pressure to penetration along a branch: where the curve first passes the pressure (``walk``), refined by means there."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..numerics.roots import falling_root
from ..numerics.rounding import LARGEST
from ..orbit.batch import Batch
from .averages import Averages, level_means
from .branches import Piece, branches_of
from .breaks import between_breaks, first_contact
from .curve import without_hidden
from .interpolation import Intervals, interpolate
from .nonadhesive.law import penetrations
from .strips import AT_JUMP, CURVE_LIMIT, NO_CURVE, QUANTITIES, LevelBatch, cut_penetration
from .walk import Root, Walk, growing

#: accuracy of the first look, of the pressure's scale, and the finest: a pressure so close to a turn of the curve is left
#: undecided; nodes of an interval at first; finest accuracy of averages, and how steep over pressure what asks for more has to be
_ROUGH, _CLOSEST, _FIRST, _FINEST, _STEEP = 1e-2, 1e-8, 8, 1e-14, 2.0
#: width of the first part of the curve to be looked at, in heights, and penetrations in each part at which the crest is
_NEXT, _LOOKS = 0.3, 12


@dataclass(frozen=True)
class Penetrations(Batch):
    """Penetrations that carry given pressures: ``D`` (n,), NaN below pull-off; ``strips.QUANTITIES`` as last averaged ``near``
    them (NaN: nowhere), their ``near_errors`` and ``slope`` over pressure, (n, 4), and how ``steep`` that is at most, relative to
    sizes, (n,); how far they are from those of ``other`` parts of the curve, (n, 4), where it is not known which one it is; and
    which lie ``in_jump`` (n,): D is one side of a curve that jumps over the pressure."""

    D: np.ndarray
    near: np.ndarray
    near_errors: np.ndarray
    slope: np.ndarray
    steep: np.ndarray
    other: np.ndarray
    in_jump: np.ndarray

    @classmethod
    def at(cls, D: np.ndarray) -> Penetrations:
        """Of pressures of which nothing else is known, or asked, than ``D`` (n,)."""
        shape = D.size, len(QUANTITIES)
        return cls(D, np.full(shape, np.nan), *np.zeros((2, *shape)), np.ones(D.size), np.zeros(shape), np.zeros(D.size, bool))

    def meeting(self, p: np.ndarray, means: Averages) -> tuple[np.ndarray, np.ndarray]:
        """Means (n, 4) at the pressures ``p`` (Pa, (n,)), along the secant from those near D to the ``means`` at D, but for the
        pressure, which is that at D; and their errors. These grow by the change of slope since the average before, and by what
        the errors of both averages make of the slope."""
        own, errors = (v[:, : len(QUANTITIES)].copy() for v in (means.values, means.errors))
        steps, miss, unknown = own - self.near, (p - own[:, 0])[:, None], errors + self.near_errors
        # a step of no more than what is not known tells nothing
        known = np.abs(steps[:, :1]) > unknown[:, :1]
        secant = np.divide(steps, steps[:, :1], out=self.slope.copy(), where=known)
        blur = np.divide(unknown + np.abs(secant) * unknown[:, :1], np.abs(steps[:, :1]), out=np.zeros_like(own), where=known)
        doubt = np.abs(secant - np.where(known, self.slope, 0.0)) + blur
        own[:, 1:] += (secant * miss)[:, 1:]
        # along a secant fractions leave what they can be, by less than their errors
        own[:, 2:] = np.clip(own[:, 2:], 0.0, 1.0)
        errors[:, 1:] += (np.abs(secant) * errors[:, :1] + doubt * np.abs(miss) + self.other)[:, 1:]
        errors[:, :1] += np.abs(miss)
        return own, errors


def invert(columns: LevelBatch, p: np.ndarray, rtol: float) -> Penetrations:
    """Largest penetration (``unloading``) or smallest (``loading``) at which each column carries ``p`` (Pa, (n,)), refined with
    averages to ``rtol``."""
    saturated = columns.saturated
    out = Penetrations.at(np.where(p >= saturated.p_sat, p / columns.material.K + columns.level.mean_plane, np.nan))
    # without adhesion there is no contact at no pressure, and adhesion holds no more than p_0
    p_0 = columns.adhesion.p_0
    rest = np.flatnonzero((p < saturated.p_sat) & ((p > 0) | ((p_0 > 0) & (p >= -p_0))))
    if rest.size:
        search = _with_adhesion if p_0 > 0 else _without_adhesion
        out.put(rest, search(columns.at(rest, np.zeros(rest.size)), p[rest], saturated.D_sat[rest], rtol))
    return out


def _without_adhesion(columns: LevelBatch, p: np.ndarray, full: np.ndarray, rtol: float) -> Penetrations:
    """``invert`` at p > 0 without adhesion. Orbits are in the order of w, which rises with D, no faster: there is one root, and
    no turn to look for; and w lies between the profile, 3 h/4 below its crests on average, and these. At rest crests carry
    ``K D^2/(2 pi h)`` (derivation: ``level.crests_at_rest``): pressures are nearly powers."""
    K, h = columns.material.K, columns.level.h
    low, high = p / K, np.minimum(p / K + columns.level.mean_plane, full)
    D, power, slope = np.sqrt(2 * np.pi * h * low), np.full(p.size, 2.0), np.full((p.size, len(QUANTITIES)), np.nan)
    if columns.family is not None:
        D, power = penetrations(columns, p)
    for accuracy in (max(rtol, _ROUGH), rtol) if columns.family is None else (rtol,):
        at = Root(np.log(np.clip(D, low, high)), power, slope, np.log(low), np.log(high))
        # however little the pressure is, friction goes with it
        x, near, errors, slope = _refine(columns, p, at, accuracy, 0.0, powers=True)
        D = np.clip(np.exp(x), low, high)
    return Penetrations(D, near, errors, np.nan_to_num(slope), np.ones(p.size), np.zeros(slope.shape), np.zeros(p.size, bool))


def _with_adhesion(columns: LevelBatch, p: np.ndarray, full: np.ndarray, rtol: float) -> Penetrations:
    """``invert`` with adhesion: to where the curve passes the pressure first, for all that is known of it once it is refined."""
    h, q, floor, left = columns.level.h, columns.scales.size, 1e-3 * columns.scales[0], np.arange(p.size)
    out, (walks, finest), looks = Penetrations.at(p * np.nan), _walks(columns, p, full, rtol, floor), {}
    while left.size:
        _advance(columns, [walks[i] for i in left], finest, looks)
        root = Root(*(np.array(v) for v in zip(*(walks[i].root or Root(np.nan, 0.0, np.zeros(q)) for i in left), strict=True)))
        found, steep = _refine_steep(columns.at(left, np.zeros(left.size)), p[left], root, rtol, floor)
        other = np.array([walks[i].other + np.zeros(q) for i in left])
        out.put(left, Penetrations(*found, steep, other, ~np.isnan(root.D) & np.isnan(root.low)))
        # by now it is known how strips change over next to the root
        turns = columns.crossings.turned(columns)
        left = np.array([i for i in left if walks[i].divide(turns.E[turns.velocity == columns.V[i]] + h, out.D[i])], int)
    for why in (NO_CURVE, AT_JUMP):
        columns.work.limit_reached(columns.V[[walk.undecided == why for walk in walks]], columns.level.l, why)
    return out


def _refine_steep(columns: LevelBatch, p: np.ndarray, root: Root, rtol: float, floor: float) -> tuple[tuple, np.ndarray]:
    """``_refine``, and again where a quantity is steep over the pressure: it may err by ``rtol``, for what that errs by, too.
    Returns also how steep they are, (n,)."""
    found, steep = _refine(columns, p, root, rtol, floor), np.ones(p.size)
    for _ in range(2):
        sizes = np.abs(found[1]) + 1e-3 * columns.scales
        now = np.fmax(np.abs(found[3]) * sizes[:, :1] / sizes, 1.0).max(axis=1)
        steep, more = np.minimum(now, rtol / _FINEST), np.flatnonzero(now > _STEEP * steep)
        finer = Root(found[0][more], *(v[more] for v in root[1:]))
        again = _refine(columns.at(more, np.zeros(more.size)), p[more], finer, rtol / steep[more], floor)
        for whole, part in zip(found, again, strict=True):
            whole[more] = part
    return found, steep


def _walks(columns: LevelBatch, p: np.ndarray, full: np.ndarray, rtol: float, floor: float) -> tuple[list[Walk], np.ndarray]:
    """A walk for each pressure; and what the curve may err by at last, Pa (n,). Those of one velocity go along the same parts,
    known as finely as any asks for."""
    unloading, bottom = columns.branch == "unloading", first_contact(columns)
    tops, size, finest, walks = np.maximum(cut_penetration(columns, p, full), bottom), np.abs(p) + floor, np.empty(p.size), {}
    for V in np.unique(columns.V):
        same = np.flatnonzero(columns.V == V)
        finest[same] = _CLOSEST * size[same].min()
        rough = np.maximum(_ROUGH * (np.abs(p[same]) + columns.scales[0]), rtol * size[same]).min()
        arrive, last = (tops[same], bottom) if unloading else ([bottom], tops[same].max())
        parts = growing(arrive, last, _NEXT * columns.level.h)[::-1]
        for i, least in zip(same.tolist(), _CLOSEST * size[same], strict=True):
            way = [part for part in parts if part[0] < tops[i]]
            walks[i] = Walk(i, unloading, p[i], rough, least, way, least / columns.material.K, top=tops[i])
    return [walks[i] for i in range(p.size)], finest


def _advance(columns: LevelBatch, walks: list[Walk], finest: np.ndarray, known: dict) -> None:
    """All walks together, part by part, to where their curves first pass their pressures, at last known to ``finest``, Pa (n,).
    ``known``: what one of them has looked at is so for all of its velocity."""
    while going := [walk for walk in walks if walk.now is not None or (walk.waiting and not walk.arrived)]:
        fresh = [walk for walk in going if walk.now is None]
        parts = [(columns.V[walk.column], *walk.waiting[-1]) for walk in fresh]
        for walk, intervals in zip(fresh, _once(known, parts, fresh, partial(_divided, columns)), strict=True):
            walk.waiting.pop()
            walk.goal, walk.now = walk.rough, intervals
        asked = [(columns.V[walk.column], walk.goal, walk.now.tobytes()) for walk in going]
        pieces = _once(known, asked, going, partial(_pieces, columns, finest))
        found = [[piece for piece in each if piece.low < walk.top] for each, walk in zip(pieces, going, strict=True)]
        rows = branches_of([[*walk.known, *more] for walk, more in zip(going, found, strict=True)], columns.branch == "unloading")
        for walk, more, row in zip(going, found, rows, strict=True):
            walk.advance(more, row, bool(columns.spent[walk.column] > CURVE_LIMIT))


def _once(known: dict, keys: list[tuple], walks: list[Walk], make: Callable[[list[Walk]], Iterable]) -> list:
    """What is ``known`` by the key of each walk; what is not is made, for all together, of one walk each."""
    if missing := {key: walk for key, walk in zip(keys, walks, strict=True) if key not in known}:
        known |= zip(missing, make([*missing.values()]), strict=True)
    return [known[key] for key in keys]


def _divided(columns: LevelBatch, walks: list[Walk]) -> list[np.ndarray]:
    """The next part of each walk's way between its breaks, as ``Walk.now``; at the top the curve is but cut, or saturates."""
    bottom, D = first_contact(columns), np.linspace(*np.array([walk.waiting[-1] for walk in walks]).T, _LOOKS, axis=1)
    row, low, high, _ = between_breaks(columns, np.array([walk.column for walk in walks]), D)
    ends = np.array((low, high, (low == D[row, 0]) & (low > bottom), high == D[row, -1]))
    return [ends[:, row == k] for k in range(len(walks))]


def _pieces(columns: LevelBatch, finest: np.ndarray, walks: list[Walk]) -> list[list[Piece]]:
    """The curve where each walk asks for it: of all quantities the pressure alone."""
    column = np.array([walk.column for walk in walks])
    rtol, atol = np.zeros(columns.size), np.full((columns.size, columns.scales.size), LARGEST)
    atol[column, 0] = [walk.goal for walk in walks]
    low, high, *inner = np.concatenate([walk.now for walk in walks], axis=1)
    intervals = Intervals.of(np.repeat(column, [walk.now.shape[1] for walk in walks]), low, high, rtol, atol)
    intervals.inner_low[:], intervals.inner_high[:] = (v > 0 for v in inner)
    pieces = interpolate(columns, without_hidden(columns, intervals, finest), first=_FIRST)
    return [pieces[i] for i in column]


def _refine(columns: LevelBatch, p, root: Root, rtol, floor, powers: bool = False):
    """Penetrations, quantities near them, their errors and slopes over pressure at a ``root`` of each column:
    Newton with the rise of the coarse curve, then of the last two averages. The pressure (Pa) is met to ``rtol`` of itself and
    the ``floor``. With ``powers`` penetrations are given and returned as logarithms, and those of pressures rise over them."""
    D, rise, slope, low, high = root
    of, back, least = (np.log, np.exp, np.finfo(float).tiny) if powers else (np.positive, np.positive, -np.inf)
    rtol, able = np.broadcast_to(rtol, p.shape), np.flatnonzero((rise > 0) & (high > low))
    goal, last, errors = rtol * (np.abs(p) + floor), np.full((p.size, 1 + slope.shape[1]), np.nan), np.zeros(slope.shape)

    def missing(x, sub):
        index = able[sub]
        at, accuracy = columns.at(index, back(x)), rtol[index]
        # without adhesion pressures are sums of what is nowhere negative: their errors are relative to them alone
        means = level_means(at, accuracy, at.atol(accuracy, pressure=0.0 if powers else 1e-3, fraction=1.0))
        new, before = np.column_stack((x, means.values)), last[index]
        new[:, 1] = np.maximum(new[:, 1], least)
        # a step of no more than what is not known tells nothing
        steps, last[index] = new - before, new
        unknown, errors[index] = means.errors + errors[index], means.errors
        wide = (steps[:, 0] * steps[:, 1] > 0) & (np.abs(steps[:, 1]) > unknown[:, 0])
        secant = np.divide(of(new[:, 1]) - of(before[:, 1]), steps[:, 0], out=np.zeros(x.size), where=wide)
        better = secant > 0
        # without a coarse curve quantities are taken to go with the pressure, that about as the contact at rest makes it rise
        alone = index[np.isnan(slope[index, 0])]
        slope[alone] = last[alone, 1:] / last[alone, 1:2]
        rise[alone] = np.maximum(columns.material.K * back(last[alone, 0]) / last[alone, 1] * last[alone, 3], 1.0)
        rise[index[better]], slope[index[better]] = secant[better], steps[better, 1:] / steps[better, 1:2]
        miss = p[index] - new[:, 1]
        return np.where(np.abs(miss) > goal[index], of(p[index]) - of(new[:, 1]), 0.0), -rise[index]

    falling_root(missing, low[able], high[able], D[able])
    # what is close enough takes another step: the average made there afterwards is next to the pressure; but none to an end, as a
    # turn of the curve is, for a pressure that is not told apart
    step = last[:, 0] + (of(p) - of(last[:, 1])) / rise
    within = np.clip(step, low, high)
    stay = (within != step) & (np.abs(p - last[:, 1]) <= errors[:, 0])
    D[able] = np.where(stay, last[:, 0], within)[able]
    return D, last[:, 1:], errors, slope
