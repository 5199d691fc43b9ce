"""From nominal pressure to penetration along a branch of loading: where the curve over penetration first passes the pressure
(``descent``), refined by averages there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..numerics.roots import falling_root
from ..orbit.batch import Batch
from .averages import Averages, level_means
from .descent import ROUGH, Root, first_passes
from .nonadhesive.average import penetrations
from .saturated import saturated_level
from .strips import QUANTITIES, LevelBatch


@dataclass(frozen=True)
class Inverse(Batch):
    """Penetrations that carry given pressures: ``D`` (n,), NaN below pull-off; ``strips.QUANTITIES`` as last averaged ``near``
    them (NaN: nowhere), their ``near_errors`` and ``slope`` over pressure, (n, 4); which are ``undecided`` (n,): the work ended
    before it was known which part of the curve it is; and which lie ``in_jump`` (n,), where D stands for one side of a curve that
    jumps over the pressure."""

    D: np.ndarray
    near: np.ndarray
    near_errors: np.ndarray
    slope: np.ndarray
    undecided: np.ndarray
    in_jump: np.ndarray

    @classmethod
    def at(cls, D: np.ndarray) -> Inverse:
        """Of pressures of which nothing else is known, or asked, than ``D`` (n,)."""
        shape = D.size, len(QUANTITIES)
        return cls(D, np.full(shape, np.nan), *np.zeros((2, *shape)), *np.zeros((2, D.size), bool))

    def meeting(self, p: np.ndarray, means: Averages) -> tuple[np.ndarray, np.ndarray]:
        """Means (n, 4), and their errors, at the pressures ``p`` (Pa, (n,)) next to those of the ``means`` at D: along the secant
        from those near it, and how far that differs from the slope before and what errors make of it; but for the pressure, which
        is that at D."""
        own, errors = (v[:, : len(QUANTITIES)].copy() for v in (means.values, means.errors))
        steps, miss, unknown = own - self.near, (p - own[:, 0])[:, None], errors + self.near_errors
        # a step of no more than what is not known tells nothing
        told = np.abs(steps[:, :1]) > unknown[:, :1]
        secant = np.divide(steps, steps[:, :1], out=self.slope.copy(), where=told)
        blurred = np.divide(unknown + np.abs(secant) * unknown[:, :1], np.abs(steps[:, :1]), out=np.zeros_like(own), where=told)
        doubt = np.abs(secant - np.where(told, self.slope, 0.0)) + blurred
        own[:, 1:] += (secant * miss)[:, 1:]
        errors[:, 1:] += (np.abs(secant) * errors[:, :1] + doubt * np.abs(miss))[:, 1:]
        errors[:, :1] += np.abs(miss)
        return own, errors


def cut_penetration(columns: LevelBatch, p_max: np.ndarray, full: np.ndarray) -> np.ndarray:
    """A penetration from which the level carries more than ``p_max`` (Pa, (n,)) on either branch, at most ``full`` (m, (n,)).

    Averaged over a period Eq. 5 says ``p_mean = K w_mean`` (the steps of w and p cancel), and w is nowhere below the profile: so
    ``p_mean >= K (D - 3 h/4)``. No pressure is below ``-p_0``; -inf, for a level that nothing presses on, counts as that.
    """
    level = columns.level
    p_max = np.maximum(p_max, -columns.adhesion.p_0)
    return np.minimum(p_max / columns.material.K + 0.75 * level.h + 1e-9 * (level.h + np.abs(p_max) / columns.material.K), full)


def invert(columns: LevelBatch, p: np.ndarray, rtol: float) -> Inverse:
    """Largest penetration (``unloading``) or smallest (``loading``) at which each column carries ``p`` (Pa, (n,)).

    The root is refined with averages to ``rtol``.
    """
    level, K = columns.level, columns.material.K
    saturated = saturated_level(columns.material, columns.adhesion, level, columns.V, columns.branch)
    out = Inverse.at(np.where(p >= saturated.p_sat, p / K + 0.75 * level.h, np.nan))
    # without adhesion there is no contact at no pressure
    rest = np.flatnonzero((p < saturated.p_sat) & ((p > 0) | (columns.adhesion.p_0 > 0)))
    if rest.size:
        search = _with_adhesion if columns.adhesion.p_0 > 0 else _without_adhesion
        found = search(columns.at(rest, np.zeros(rest.size)), p[rest], saturated.D_sat[rest], rtol)
        out.put(rest, found)
    return out


def _without_adhesion(columns: LevelBatch, p: np.ndarray, full: np.ndarray, rtol: float) -> Inverse:
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
    return Inverse(D, near, errors, np.nan_to_num(slope), *np.zeros((2, p.size), bool))


def _with_adhesion(columns: LevelBatch, p: np.ndarray, full: np.ndarray, rtol: float) -> Inverse:
    """``invert`` with adhesion."""
    root, undecided = first_passes(columns, p, cut_penetration(columns, p, full), rtol)
    in_jump = ~np.isnan(root.D) & np.isnan(root.low)
    return Inverse(*_refine(columns, p, root, rtol, 1e-3 * columns.scales[0]), undecided, in_jump)


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
