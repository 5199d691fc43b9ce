"""Pressure in the contact of strips: its extremes, and where it passes a given value.

With several times ``p = saturated field - C`` in contact, where C sums decaying exponentials. On a periodic orbit w is nowhere
below the profile, so every dashpot displacement is at or above its value in saturated contact, and the terms of C are all
positive. Then ``p' = (harmonic) + |C'|``, and where the harmonic falls it is ``-sin``, log-concave, against a log-convex
``|C'|``: p falls on one interval of a period at most. A contact ends while p falls, so p rises to its peak and falls from there:
each value is passed once either way.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..numerics.roots import falling_root
from .batch import at_points, pick
from .regimes import CODE, ZONES
from .solved import Solved

if TYPE_CHECKING:
    from .abstract_foundation import Foundation


class Contact:
    """Contact intervals of solved strips in phase, with the pressure in Pa inside them, arrays (m,).

    ``b``, ``a``: first and last phase (of saturated contact: a period around its peak), ``top``: phase of the peak ``p_peak``;
    ``p_entry``: pressure just after entry (it steps there without T_sigma, and where a strip snaps into contact); ``p_exit``: as
    contact ends; of saturated contact both are the least.
    """

    def __init__(self, foundation: Foundation, strips, solved: Solved, unit: np.ndarray, flat: np.ndarray):
        """Of dimensionless ``strips``, with the ``unit`` of their pressures, Pa, and which are ``flat``."""
        self.event, self.s, self.unit = foundation.kernel.excess_event, strips, unit
        self.full = solved.code == CODE["c"]
        self.mean = np.where(flat, solved.p_mean, strips.D - 1)
        storage, loss, compliance = foundation.moduli(strips)
        self.amplitude = np.where(flat, 0.0, np.hypot(storage, loss))
        self.centre = np.broadcast_to(-np.arctan2(loss, storage), self.mean.shape)  # phase of the saturated field's maximum
        self.b = np.where(self.full, self.centre - np.pi, solved.b)
        self.a = np.where(self.full, self.centre + np.pi, solved.a)
        snap = solved.code == CODE["afc"]
        reach = np.divide(strips.delta_0, compliance, out=np.zeros(snap.size), where=snap)
        self.q_b = np.where(snap, strips.p_0 - reach, 0.0)
        self.constants = foundation.excess(self.b, _entries(foundation, strips, solved), strips)
        self.top = self.centre.copy()
        part, every = np.flatnonzero(~self.full), np.arange(snap.size)
        self.top[part] = falling_root(lambda phase, sub: self._excess(part[sub], phase)[1], self.b[part], self.a[part])
        self.p_peak = self.pressure(every, self.top)
        entered = self.b + 1e-12 * (self.a - self.b)
        self.p_entry = self.pressure(every, np.where(self.full, self.centre - np.pi, entered))
        # the same for all, to the last digit, where it does not step
        rises = ~self.full & (compliance > 0)
        self.p_entry[rises] = ((self.q_b - strips.p_0) * unit)[rises]
        self.p_exit = np.where(self.full, self.p_entry, -strips.p_0 * unit)

    def entered(self, after: np.ndarray) -> np.ndarray:
        """Pressures, Pa, so much ``after`` entry in phase, (m,); NaN where that is half-way to the peak, or contact saturated."""
        soon = ~self.full & (after < 0.5 * (self.top - self.b))
        return np.where(soon, np.where(after > 0, self.pressure(np.arange(after.size), self.b + after), self.p_entry), np.nan)

    def _excess(self, rows: np.ndarray, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Pressure above -p_0 in partial contact, in the strip's own unit, and its slope, at phases (m,) or (nodes, m)."""
        constants = [pick(constant, rows) for constant in self.constants]
        if phase.ndim > 1:
            constants = at_points(constants)
        return self.event(phase, *constants)

    def pressure(self, rows: np.ndarray, phase: np.ndarray) -> np.ndarray:
        """Pressure, Pa, of the strips ``rows`` (m,) at the phases ``phase`` (m,) or (nodes, m) in their contact."""
        full = self.full[rows]
        p = np.empty(phase.shape)
        i = rows[full]
        p[..., full] = self.mean[i] + self.amplitude[i] * np.cos(phase[..., full] - self.centre[i])
        i = rows[~full]
        p[..., ~full] = self._excess(i, phase[..., ~full])[0] - self.s.p_0[i]
        return p * self.unit[rows]

    def slope(self, rows: np.ndarray, phase: np.ndarray) -> np.ndarray:
        """Derivative of the pressure by phase, in the strip's own unit, of strip ``rows`` at ``phase`` in its contact."""
        out = -self.amplitude[rows] * np.sin(phase - self.centre[rows])
        part = np.flatnonzero(~self.full[rows])
        out[part] = self._excess(rows[part], phase[part])[1]
        return out

    def passes(self, rows: np.ndarray, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Phases at which the strips ``rows`` pass the pressures ``p``, Pa, at most their peaks, upward and downward, (k,)."""
        level, full = p / self.unit[rows], self.full[rows]
        at = rows[full]
        up, down = self.b[rows], self.a[rows]
        up[full], down[full] = passages(level[full], self.mean[at], self.amplitude[at], self.centre[at])
        goal = level + self.s.p_0[rows]
        rising, falling = (np.flatnonzero(~full & passed) for passed in (self.q_b[rows] < goal, goal > 0))
        pair, upward = np.concatenate((rising, falling)), np.arange(rising.size + falling.size) < rising.size
        i, goal = rows[pair], goal[pair]
        sign, outer = np.where(upward, -1.0, 1.0), np.where(upward, self.b[i], self.a[i])
        low, high = np.where(upward, outer, self.top[i]), np.where(upward, self.top[i], outer)

        def excess(phase, sub):
            value, slope = self._excess(i[sub], phase)
            return sign[sub] * (value - goal[sub]), sign[sub] * slope

        # as far along as on a parabola about the peak; at exit the excess is zero
        peak, least = self.p_peak[i] / self.unit[i] + self.s.p_0[i], np.where(upward, self.q_b[i], 0.0)
        share = np.divide(peak - goal, peak - least, out=np.zeros(i.size), where=peak > least)
        found = falling_root(excess, low, high, self.top[i] + (outer - self.top[i]) * np.sqrt(np.clip(share, 0.0, 1.0)))
        up[rising], down[falling] = found[upward], found[~upward]
        return up, down


def _entries(foundation: Foundation, strips, solved: Solved) -> np.ndarray:
    """What is known of each strip as its contact begins, (..., m); nothing of saturated contact."""
    out = np.zeros(0)
    for sequence in ("ac", "cf", "acaf", "afc"):
        i = np.flatnonzero(solved.code == CODE[sequence])
        if i.size or not out.size:
            edges = [getattr(solved, name)[i] for name in ZONES[sequence][1]]
            found = foundation.entry(sequence, edges, strips.take(i))
            out = out if out.size else np.zeros((*found.shape[:-1], strips.size))
            out[..., i] = found
    return out


def passages(level: np.ndarray, mean: np.ndarray, amplitude: np.ndarray, centre: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Phases at which ``mean + amplitude cos(phase - centre)`` passes ``level`` upward and downward, about its peak ``centre``.

    Where it is above all along they are a period apart; all arguments of one shape, ``level`` nowhere above the peak."""
    cosine = np.divide(level - mean, amplitude, out=np.full(level.shape, -1.0), where=amplitude > 0)
    half = np.arccos(np.clip(cosine, -1, 1))
    return centre - half, centre + half
