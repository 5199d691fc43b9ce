"""From nominal pressure to penetration along a branch of loading: where the curve over penetration first passes the pressure
(``descent``), refined by averages there."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..numerics.roots import falling_root
from ..orbit.batch import Batch
from .descent import ROUGH, Descent
from .means import level_means
from .saturated import saturated_level
from .strips import LevelBatch


@dataclass(frozen=True)
class Inverse(Batch):
    """Penetrations that carry given pressures, arrays (n,): ``D`` (NaN below pull-off), the slope d(tau)/dp of the level there,
    how uncertain the slope is; which are ``undecided``: the work ended before it was known which part of the curve it is; and
    which lie ``in_jump``, where D stands for one side of a curve that jumps over the pressure."""

    D: np.ndarray
    slope: np.ndarray
    doubt: np.ndarray
    undecided: np.ndarray
    in_jump: np.ndarray


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
    out = Inverse(
        np.where(p >= saturated.p_sat, p / K + 0.75 * level.h, np.nan), *np.zeros((2, p.size)), *np.zeros((2, p.size), bool)
    )
    # without adhesion there is no contact at no pressure
    rest = np.flatnonzero((p < saturated.p_sat) & ((p > 0) | (columns.adhesion.p_0 > 0)))
    if rest.size:
        search = _with_adhesion if columns.adhesion.p_0 > 0 else _without_adhesion
        asked = replace(columns.asked, fractions=1.0)
        found = search(replace(columns, asked=asked).at(rest, np.zeros(rest.size)), p[rest], saturated.D_sat[rest], rtol)
        out.put(rest, found)
    return out


def _without_adhesion(columns: LevelBatch, p: np.ndarray, full: np.ndarray, rtol: float) -> Inverse:
    """``invert`` at p > 0 without adhesion. Orbits are in the order of w, which rises with D, no faster: there is one root, and
    no turn to look for; and w lies between the profile, 3 h/4 below its crests on average, and these."""
    rise, friction_slope = np.full(p.size, columns.material.K), np.zeros(p.size)
    low, high = p / rise, np.minimum(p / rise + 0.75 * columns.level.h, full)
    D = high.copy()
    for accuracy in (max(rtol, ROUGH), rtol):
        near = D, rise, friction_slope, low, high
        # however little the pressure is, friction goes with it
        D, friction_slope, doubt = _refine(columns, p, near, accuracy, floor=0.0)
    return Inverse(D, friction_slope, doubt, *np.zeros((2, p.size), bool))


def _with_adhesion(columns: LevelBatch, p: np.ndarray, full: np.ndarray, rtol: float) -> Inverse:
    """``invert`` with adhesion."""
    D, slope, doubt = np.full(p.size, np.nan), np.zeros(p.size), np.zeros(p.size)
    roots, undecided = Descent(columns, p, cut_penetration(columns, p, full), rtol).run()
    in_jump = np.array([root is not None and np.isnan(root.low) for root in roots])
    found = np.array([i for i, root in enumerate(roots) if root is not None], int)
    if found.size:
        near = [np.array([getattr(roots[i], name) for i in found]) for name in ("D", "slope", "friction_slope", "low", "high")]
        D[found], slope[found], doubt[found] = _refine(
            columns.at(found, D[found]), p[found], near, rtol, 1e-3 * columns.scales[0]
        )
    return Inverse(D, slope, doubt, undecided, in_jump)


def _refine(columns: LevelBatch, p, near, rtol, floor):
    """Penetrations, d(tau)/dp and how uncertain that is at the roots ``near`` these (arrays of the fields of ``Root``): Newton
    with the slope of the coarse curve, then of the last two averages. The pressure (Pa) is met to ``rtol`` of itself and the
    ``floor``."""
    D, slope, friction_slope, low, high = near
    # nothing but the coarse curve says what it is
    doubt, goal = np.abs(friction_slope), rtol * (np.abs(p) + floor)
    able = np.flatnonzero((slope > 0) & (high > low))
    last = np.full((3, p.size), np.nan)

    def missing(x, sub):
        index = able[sub]
        values = level_means(columns.at(index, x), np.full(index.size, rtol)).values
        new = np.stack((x, values[:, 0], values[:, 1]))
        moved, rise, rub = new - last[:, index]
        last[:, index], better = new, moved * rise > 0
        at, secant = index[better], rub[better] / rise[better]
        slope[at], doubt[at] = rise[better] / moved[better], np.abs(secant - friction_slope[at])
        friction_slope[at] = secant
        miss = p[index] - values[:, 0]
        return np.where(np.abs(miss) > goal[index], miss, 0.0), -slope[index]

    falling_root(missing, low[able], high[able], D[able])
    # what is close enough takes another step: the average made there afterwards is next to the pressure
    D[able] = np.clip(last[0] + (p - last[1]) / slope, low, high)[able]
    return D, friction_slope, doubt
