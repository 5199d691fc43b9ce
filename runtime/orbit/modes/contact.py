"""Pressure in the contact of strips with several times: its extremes, and where it passes a given value.

In contact ``p = saturated field - C`` where C sums decaying exponentials. On a periodic orbit w is nowhere below the
profile, so every dashpot displacement is at or above its value in saturated contact, and the terms of C are all
positive. Then ``p' = (harmonic) + |C'|``, and where the harmonic falls it is ``-sin``, log-concave, against a
log-convex ``|C'|``: p falls on one interval of a period at most. A contact ends while p falls, so p rises to its peak
and falls from there: each value is passed once either way, as with one time.
"""

from __future__ import annotations

import numpy as np

from ...level.harmonic import passages
from ..crossing import crossing
from ..regimes import CODE
from .fields import zones_of
from .problem import pick


class ModeContact:
    """Contact intervals of the strips ``index`` in phase, with the pressure in Pa inside them; as ``level`` asks for it.

    ``b``, ``a``: first and last phase (of saturated contact: a period around its peak), ``top``: phase of the peak
    ``p_peak``; ``p_least``: pressure at ``b``.
    """

    def __init__(self, kernel, strips, index):
        self.kernel = kernel
        self.s = s = strips.strips.take(index)
        solved = strips.solved
        self.unit = strips.scales["p"][index]
        self.flat = strips.scales["flat"][index]
        self.full = solved.code[index] == CODE["c"]
        self.mean = np.where(self.flat, solved.p_mean[index], s.D - 1)
        storage, loss = kernel.storage(s.m), kernel.loss(s.m)
        self.amplitude = np.where(self.flat, 0.0, np.hypot(storage, loss))
        self.centre = np.broadcast_to(-np.arctan2(loss, storage), index.shape)
        self.b = np.where(self.full, self.centre - np.pi, solved.b[index])
        self.a = np.where(self.full, self.centre + np.pi, solved.a[index])
        self.entry = np.zeros((s.modes, index.size))
        for sequence in ("acaf", "afc", "ac", "cf"):
            i = np.flatnonzero(solved.code[index] == CODE[sequence])
            if i.size:
                names = {"acaf": "dbac", "afc": "bac"}.get(sequence, "ba")
                edges = [getattr(solved, name)[index[i]] for name in names]
                for zone, _, overstress, _ in zones_of(kernel, sequence, s.take(i), edges):
                    if zone == "c":
                        self.entry[:, i] = overstress
                        break
        self.constants = kernel.excess_entry(self.b, self.entry, s.p_0, s.D, s.m)
        self.top = self._top()
        self.p_peak = self.pressure(np.arange(index.size), self.top)
        self.p_least = self.pressure(np.arange(index.size), np.where(self.full, self.centre - np.pi, self.b))

    def pressure(self, rows, phase):
        """Pressure, Pa, of the strips ``rows`` (m,) at the phases ``phase`` (m,) or (nodes, m) in their contact."""
        every = np.broadcast_to(rows, phase.shape).ravel()
        return self._at(every, phase.ravel())[0].reshape(phase.shape) * self.unit[rows]

    def slope(self, rows, phase):
        """Derivative of the pressure by phase, in the strip's own unit, of strip ``rows`` at ``phase`` in its contact."""
        return self._at(rows, phase)[1]

    def _at(self, rows, phase):
        """Pressure in the strip's own unit, and its slope."""
        turn = phase - self.centre[rows]
        p, slope = self.mean[rows] + self.amplitude[rows] * np.cos(turn), -self.amplitude[rows] * np.sin(turn)
        part = np.flatnonzero(~self.full[rows])
        if part.size:
            i = rows[part]
            q, dq = self.kernel.excess_event(phase[part], *(pick(c, i) for c in self.constants))
            p[part], slope[part] = q - self.s.p_0[i], dq
        return p, slope

    def _top(self):
        """Phase of the greatest pressure: the slope falls through zero once between entry and exit, where it is not
        negative from the start."""
        top = self.centre.copy()
        i = np.flatnonzero(~self.full)
        if not i.size:
            return top
        b, a = self.b[i], self.a[i]
        rising = self._at(i, b)[1] > 0

        def slope(phase, sub):
            return self._at(i[on[sub]], phase)[1], np.zeros(sub.size)

        on = np.flatnonzero(rising)
        top[i] = b
        top[i[on]], _ = crossing(slope, b[on], a[on])
        return top

    def passes(self, p, above):
        """Phases at which the pressure passes ``p`` (Pa) upward and downward; where it does not, both are the peak's."""
        up, down = self.top.copy(), self.top.copy()
        level = p / self.unit
        full = np.flatnonzero(above & self.full)
        up[full], down[full] = passages(level[full], self.mean[full], self.amplitude[full], self.centre[full])
        part = np.flatnonzero(above & ~self.full)
        for out, sign, ends in ((up, -1.0, (self.b, self.top)), (down, 1.0, (self.top, self.a))):
            out[part] = self._passage(part, level, sign, *ends)
        return up, down

    def _passage(self, part, level, sign, first, last):
        """Where the pressure passes ``level`` between two phases; at the outer one where it starts or ends beyond it."""
        outer = first if sign < 0 else last
        found = outer[part].copy()
        i = part[self._at(part, outer[part])[0] < level[part]]

        def excess(phase, sub):
            p, slope = self._at(i[sub], phase)
            return sign * (p - level[i[sub]]), sign * slope

        inside = np.isin(part, i)
        found[inside], _ = crossing(excess, first[i], last[i])
        return found
