"""Error budget: how accurate every quantity of every level has to be. All that decides it, in one place:

- A quantity is asked for to ``rtol |value| + atol``; ``atol`` is that of a thousandth of its natural scale (``LevelBatch.atol``);
  of fractions it is ``rtol`` itself where only pressure and friction count. No friction has a larger scale than that of level 1,
  which all add to; those of laws that of a share of the friction in its contact (``friction_of_laws``), if that is more.
- Level 1 gets half the ``rtol`` of the result, as its laws err too; those of lower levels a multiple, less if points miss that.
- A piece of a law may err by as much more as fewer points meet its pressures (``interpolation.weighed``), further down than level
  2 the less contact there is; ``law.merged`` takes a part of what a law may err, ``lower_levels`` of what strip means may.
- Of what an interval of a curve may err its means get a part, ``interpolation.MEAN``.

Goal-oriented: a law's error counts as much as the part of the surface on which it is used. That part, and the greatest pressure
that laws are made for, are had from a plain sum over the strips of the level above; it deals out accuracy and enters no result,
and what a law lacks shows in the error of the friction it gives (``lower_levels``).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..numerics.quadrature import interior_nodes, mapped, mapped_weights
from ..orbit.foundation import foundation_of
from .strips import LevelBatch, SolvedStrips

#: strips between crest and valley, and points along each contact: shares of the surface are needed to a factor of two or so
_STRIPS, _POINTS = 24, 32
#: crest, the middles of so many equal strips, and next to the valley
_THETA = np.pi * np.concatenate(([0.0], (np.arange(_STRIPS) + 0.5) / _STRIPS, [0.999]))
#: a share is not known any better than this: one point of one contact has about a thousandth
_FINEST = 1e-6
#: contact is not known to be any less
LEAST_CONTACT = 1e-3
#: part of the friction in contact of level 1 that frictions of all lower levels may err relative to, beside themselves
_SHARED = 0.2
#: parts of a law that may each err by what the whole is allowed: mostly one or two branches are used
_PARTS = 2


def strips_across(columns: LevelBatch) -> SolvedStrips:
    """The crest, ``_STRIPS`` equal strips and one in the valley of each of the ``columns`` (n,), one column after the other."""
    every = np.arange(columns.size)
    return columns.solve(np.repeat(every, _THETA.size), np.tile(_THETA, every.size))


def peak_pressure(columns: LevelBatch, strips: SolvedStrips) -> np.ndarray:
    """Greatest local pressure of each of the ``columns``, Pa, (n,), -inf without contact, from their ``strips_across``.

    Mostly it is the crest's. But adhesion may hold flatter strips that steeper ones have let go of: before these do, the pressure
    is at most that of complete contact, ``K (E + A (1 + R))``, ``E = D - h``: it begins below that field and tends to it."""
    peak, (index, contact) = np.full(strips.p_mean.size, -np.inf), strips.touching
    peak[index] = contact.p_peak
    peak = peak.reshape(columns.size, -1)
    level, R = columns.level, foundation_of(columns.material).modulus_ratio(columns.level.k * columns.V)
    steeper = (columns.D - level.h)[:, None] + level.amplitude(_THETA[:-1]) * (1 + R[:, None])
    rising = peak[:, 1:] > peak[:, :-1]
    # where no strip touches there may be contact between two in different regimes
    code = strips.solved.code.reshape(peak.shape)
    rising |= (peak.max(axis=1) == -np.inf)[:, None] & (code[:, 1:] != code[:, :-1])
    return np.maximum(peak.max(axis=1), np.where(rising, columns.material.K * steeper, -np.inf).max(axis=1))


@dataclass(frozen=True)
class ErrorBudget:
    """Pressures of points of the level above. ``group`` (n,): the law that a point asks; ``p`` (n, m), Pa, ascending in every
    row (NaN: not known), with the ``share`` (n, m) of the surface on which the pressure is at most that;
    ``friction`` (n,): Pa of friction that an error is held against."""

    group: np.ndarray
    p: np.ndarray
    share: np.ndarray
    friction: np.ndarray

    def friction_of_laws(self, levels: int, groups: int) -> np.ndarray:
        """Pa, (groups,), that the accuracy of the laws of so many ``levels`` below is relative to beside themselves: a share of
        the mean friction over the contact alone, where they add to it."""
        friction = np.full(groups, np.inf)
        in_contact = self.friction / np.maximum(self.share[:, -1], LEAST_CONTACT)
        np.minimum.at(friction, self.group, _SHARED / levels * in_contact)
        return friction

    def further_down(self, levels: int) -> ErrorBudget:
        """For one of so many ``levels``, where it is not known what pressures are met: each may be on all of the contact."""
        contact = np.maximum(self.share[:, -1:], LEAST_CONTACT)
        return replace(self, p=np.full((self.group.size, 1), np.nan), share=contact, friction=self.friction / levels)

    def share_between(self, group: int, low: float, high: float) -> tuple[float, float]:
        """Share of the surface, times parts of a law, on which pressures between ``low`` and ``high`` (Pa) are met, at the point
        where that is most; and the least friction, Pa, that an error of the law there is relative to."""
        most, least = _FINEST, np.inf
        for i in np.flatnonzero(self.group == group):
            known = ~np.isnan(self.p[i, 0])
            below, above = np.interp((low, high), self.p[i], self.share[i]) if known else (0.0, self.share[i, 0])
            share = max(above - below, _FINEST) if high > low else _FINEST
            most, least = max(most, share), min(least, self.friction[i] / (_PARTS * share))
        return _PARTS * most, least


def error_budget(columns: LevelBatch, group: np.ndarray, strips: SolvedStrips) -> ErrorBudget:
    """Share of the surface of ``columns`` (n,) that has each pressure, from their ``strips_across``; ``group``: of their laws."""
    n = columns.size
    index, contact = strips.touching
    t, weights = mapped(interior_nodes(_POINTS)), mapped_weights(_POINTS)
    # no contact is pulled at harder than this
    p, share = np.full((strips.p_mean.size, t.size), -columns.adhesion.p_0), np.zeros((strips.p_mean.size, t.size))
    width = contact.a - contact.b
    phase = contact.b[:, None] + width[:, None] * t
    p[index] = contact.pressure(np.repeat(np.arange(index.size), t.size), phase.ravel()).reshape(phase.shape)
    share[index] = width[:, None] * weights / (2 * np.pi * _STRIPS)
    # crest and valley are none of the equal strips
    p, share = (v.reshape(n, -1, t.size)[:, 1:-1].reshape(n, -1) for v in (p, share))
    order = np.argsort(p, axis=1)
    p, share = (np.take_along_axis(v, order, axis=1) for v in (p, share))
    friction = np.abs(strips.tau_mean.reshape(n, -1)[:, 1:-1].mean(axis=1))
    return ErrorBudget(group, p, np.cumsum(share, axis=1), friction + 1e-3 * columns.scales[1])
