"""Pressure in the contact of strips: its extremes, and where it passes a given value."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..orbit.crossing import crossing
from ..orbit.regimes import CODE
from .harmonic import passages

if TYPE_CHECKING:
    from .strips import SolvedStrips

#: contact this much faster than the wave forgets: pressure is local
_MEMORY = 1e-6


def contact_of(kernel, strips: SolvedStrips, index):
    """Contact of the strips ``index``, for a foundation with one time or several."""
    if hasattr(kernel, "MODES"):
        from ..orbit.modes.contact import ModeContact

        return ModeContact(kernel, strips, index)
    return Contact(kernel, strips, index)


class Contact:
    """Contact intervals of strips in phase, with the pressure in Pa inside them."""

    def __init__(self, kernel, strips: SolvedStrips, index):
        self.kernel = kernel
        self.s = strips.strips.take(index)
        solved = strips.solved
        self.unit = strips.scales["p"][index]
        self.flat = strips.scales["flat"][index]
        self.full = solved.code[index] == CODE["c"]
        s = self.s
        self.mean = np.where(self.flat, solved.p_mean[index], s.D - 1)
        storage, loss = kernel.storage(s.alpha, s.beta), kernel.loss(s.alpha, s.beta, s.L)
        self.amplitude = np.where(self.flat, 0.0, np.hypot(storage, loss))
        self.centre = -np.arctan2(loss, storage)  # phase of the saturated field's maximum
        self.b = np.where(self.full, self.centre - np.pi, solved.b[index])
        self.a = np.where(self.full, self.centre + np.pi, solved.a[index])
        snap = solved.code[index] == CODE["afc"]
        reach = np.divide(s.delta_0, s.J, out=np.zeros_like(s.J), where=snap)
        self.q_b = np.where(snap, s.p_0 - reach, 0.0)
        self.p_peak = self._peak()
        self.p_least = self._least()

    def pressure(self, rows, phase):
        """Pressure, Pa, of the strips ``rows`` (m,) at the phases ``phase`` (m,) or (nodes, m) in their contact."""
        s, full = self.s, self.full[rows]
        p = np.empty(phase.shape)
        i = rows[full]
        p[..., full] = self.mean[i] + self.amplitude[i] * np.cos(phase[..., full] - self.centre[i])
        i, rest = rows[~full], ~full
        q = self.kernel.excess_after(self.b[i], phase[..., rest], self.q_b[i], s.p_0[i], s.D[i], s.alpha[i], s.beta[i], s.L[i])
        p[..., rest] = q - s.p_0[i]
        return p * self.unit[rows]

    def _peak(self):
        """Greatest pressure in contact, Pa: where ``p = H``."""
        self.top = self.centre.copy()
        i = np.flatnonzero(~self.full)
        s = self.s.take(i)
        b, a, q_b = self.b[i], self.a[i], self.q_b[i]
        amplitude, centre, remembers = self.amplitude[i], self.centre[i], s.alpha > _MEMORY

        def lag(phase, sub):
            args = (b[sub], phase, q_b[sub], s.p_0[sub], s.D[sub], s.alpha[sub], s.beta[sub], s.L[sub])
            H, rise = self.kernel.forcing(phase, s.D[sub], s.beta[sub]), self.kernel.excess_after_slope(*args)
            # alpha p' = H - p falls through zero once: from entry, where p is below H, to exit; without memory rounding is all of
            # it
            behind = H + s.p_0[sub] - self.kernel.excess_after(*args)
            steepens = self.kernel.profile_slope(phase) - s.beta[sub] * np.cos(phase) - rise
            bend = -amplitude[sub] * np.cos(phase - centre[sub])
            return np.where(remembers[sub], behind, rise), np.where(remembers[sub], steepens, bend)

        self.top[i], _ = crossing(lag, b, a)
        return self.pressure(np.arange(self.b.size), self.top)

    def _least(self):
        """Pressure, Pa, just after entry (without T_sigma it steps there); in saturated contact the least."""
        entered = self.b + 1e-12 * (self.a - self.b)
        return self.pressure(np.arange(self.b.size), np.where(self.full, self.centre - np.pi, entered))

    def slope(self, rows, phase):
        """Derivative of the pressure by phase, in the strip's own unit, of strip ``rows`` at ``phase`` in its contact."""
        s = self.s
        out = -self.amplitude[rows] * np.sin(phase - self.centre[rows])
        part = np.flatnonzero(~self.full[rows])
        i = rows[part]
        args = (self.b[i], phase[part], self.q_b[i], s.p_0[i], s.D[i], s.alpha[i], s.beta[i], s.L[i])
        out[part] = self.kernel.excess_after_slope(*args)
        return out

    def passes(self, p, above):
        """Phases at which the pressure passes ``p`` (Pa) upward and downward; where it does not, both are the peak's."""
        up, down = self.top.copy(), self.top.copy()
        level = p / self.unit
        full = np.flatnonzero(above & self.full)
        up[full], down[full] = passages(level[full], self.mean[full], self.amplitude[full], self.centre[full])
        part = np.flatnonzero(above & ~self.full)
        up[part], down[part] = self.b[part], self.a[part]
        goal, s = level + self.s.p_0, self.s
        rising, falling = part[self.q_b[part] < goal[part]], part[goal[part] > 0]
        i, upward = np.concatenate((rising, falling)), np.arange(rising.size + falling.size) < rising.size
        sign, outer = np.where(upward, -1.0, 1.0), np.where(upward, self.b[i], self.a[i])
        low, high = np.where(upward, outer, self.top[i]), np.where(upward, self.top[i], outer)

        def excess(phase, sub):
            k = i[sub]
            args = (self.b[k], phase, self.q_b[k], s.p_0[k], s.D[k], s.alpha[k], s.beta[k], s.L[k])
            value = self.kernel.excess_after(*args) - goal[k]
            return sign[sub] * value, sign[sub] * self.kernel.excess_after_slope(*args)

        # as far along as on a parabola about the peak; at exit the excess is zero
        peak, least = self.p_peak[i] / self.unit[i] + s.p_0[i], np.where(upward, self.q_b[i], 0.0)
        share = np.divide(peak - goal[i], peak - least, out=np.zeros(i.size), where=peak > least)
        found, _ = crossing(excess, low, high, self.top[i] + (outer - self.top[i]) * np.sqrt(np.clip(share, 0.0, 1.0)))
        up[rising], down[falling] = found[upward], found[~upward]
        return up, down
