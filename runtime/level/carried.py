"""Second term of Eq. 13: what the levels below contribute in the contact of a strip, ``(1/l) int law[p(x)] dx``.

In contact ``p - p* + alpha p' = H - p*``: like every event function, p passes a given pressure upward at most once and downward
at most once, each in an arc known in closed form. So the contact is cut at the breaks of the law (pull-off, jumps, saturation)
and each part integrated by itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from hystrip.solver import kernel_of
from hystrip.strip.crossing import crossing
from hystrip.strip.problem import snaps_in
from hystrip.strip.regimes import CODE

from .law import Law
from .panels import interior_nodes, mapped_weights
from .strips import Columns, SolvedStrips

TWO_PI = 2 * np.pi
#: how much the last doubling of nodes may be trusted to have gained over the one before
_GAIN = 0.1


@dataclass(frozen=True)
class CarriedByLaws:
    """Contributions of the next level down. ``laws[g]`` belongs to group g; the last column is an error estimate of friction.

    ``nodes``: points per part of the contact.
    """

    laws: list[Law]
    nodes: int
    scales: np.ndarray

    def crossed(self, kernel, strips: SolvedStrips, group: np.ndarray) -> np.ndarray:
        """See ``strips.Carry``."""
        crossed = np.zeros(group.size, int)
        contact = np.flatnonzero(strips.solved.contact_fraction > 0)
        if contact.size:
            peak = contact_of(kernel, strips, contact).p_peak
            for g in np.unique(group[contact]):
                mine = group[contact] == g
                crossed[contact[mine]] = np.searchsorted(self.laws[g].breaks, peak[mine])
        return crossed

    def over_contact(self, kernel, strips: SolvedStrips, group: np.ndarray):
        """See ``strips.Carry``. The contributions are the law's quantities from friction on, then their error."""
        m = group.size
        q = self.scales.size
        carried = np.zeros((m, q))
        contact = strips.solved.contact_fraction > 0
        for g in np.unique(group[contact]):
            index = np.flatnonzero(contact & (group == g))
            carried[index] = _one_law(kernel, self.laws[g], strips, index, self.nodes)
        return carried


def peak_pressure(columns: Columns) -> np.ndarray:
    """Greatest local pressure of each column, Pa, (n,): at its crest, the most engaged strip; -inf without contact."""
    strips = columns.solve(np.arange(columns.size), np.zeros(columns.size))
    peak = np.full(columns.size, -np.inf)
    index = np.flatnonzero(strips.solved.contact_fraction > 0)
    if index.size:
        peak[index] = contact_of(kernel_of(columns.material), strips, index).p_peak
    return peak


def _one_law(kernel, law: Law, strips: SolvedStrips, index, nodes):
    contact = contact_of(kernel, strips, index)
    breaks = law.breaks
    breaks = breaks[breaks < contact.p_peak.max(initial=-np.inf)]
    n, q = index.size, law.saturated.size
    total, error = np.zeros((n, q - 1)), np.zeros(n)
    # phases between which the pressure exceeds each break, nested
    up, down, reached = [], [], []
    for p in breaks:
        above = contact.p_peak > p
        u, d = contact.passes(p, above)
        up.append(u), down.append(d), reached.append(above)
    for j in range(len(breaks)):
        inner = reached[j + 1] if j + 1 < len(breaks) else np.zeros(n, bool)
        if breaks[j] >= law.p_sat:
            total[reached[j]] += ((down[j] - up[j])[:, None] * law.saturated[1:])[reached[j]]
            continue
        for pick, low, high in (
            (reached[j] & ~inner, up[j], down[j]),
            (inner, up[j], up[j + 1] if j + 1 < len(breaks) else up[j]),
            (inner, down[j + 1] if j + 1 < len(breaks) else down[j], down[j]),
        ):
            rows = np.flatnonzero(pick & (high > low))
            if rows.size:
                value, miss = _part(contact, law, rows, low[rows], high[rows], nodes)
                total[rows] += value
                error[rows] += miss
    return np.concatenate((total, error[:, None]), axis=1) / TWO_PI


def _part(contact: _Contact, law: Law, rows, low, high, nodes):
    """Integral of the law over one part of the contact, smooth inside, and its error in friction.

    The error is the change against half the nodes, times what the last doubling gained, and that of the law itself there.
    """
    t, fine, coarse, coarser = _rule(nodes)
    s = low[:, None] + (high - low)[:, None] * t
    p = contact.pressure(np.repeat(rows, nodes - 1), s.ravel())
    values = law(p)[:, 1:].reshape(rows.size, nodes - 1, -1)
    width = (high - low)[:, None]
    best = width * np.einsum("j,pjq->pq", fine, values)
    half = width * np.einsum("j,pjq->pq", coarse, values[:, 1::2])
    quarter = width * np.einsum("j,pjq->pq", coarser, values[:, 3::4])
    friction = law.friction_columns
    change, before = (np.abs(one - two)[:, friction].sum(axis=1) for one, two in ((best, half), (half, quarter)))
    gain = np.divide(change, before, out=np.ones_like(change), where=before > change)
    own = width[:, 0] * (law.friction_error_at(p).reshape(rows.size, nodes - 1) @ fine)
    return best, change * np.maximum(gain, _GAIN) + own


@lru_cache
def _rule(n: int):
    """Phases on (0, 1) and weights of the rule with square-root ends, and its weights with half and a quarter of the nodes."""
    return np.sin(0.5 * np.pi * interior_nodes(n)) ** 2, mapped_weights(n), mapped_weights(n // 2), mapped_weights(n // 4)


def contact_of(kernel, strips: SolvedStrips, index):
    """Contact of the strips ``index``, for a foundation with one time or several."""
    if hasattr(kernel, "MODES"):
        from hystrip.modes.contact import ModeContact

        return ModeContact(kernel, strips, index)
    return _Contact(kernel, strips, index)


class _Contact:
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
        snap = snaps_in(s) & (solved.code[index] == CODE["afc"])
        reach = np.divide(s.delta_0, s.J, out=np.zeros_like(s.J), where=snap)
        self.q_b = np.where(snap, s.p_0 - reach, 0.0)
        self.p_peak = self._peak()

    def pressure(self, rows, phase):
        """Pressure, Pa, of strip ``rows`` at ``phase`` in its contact."""
        s = self.s
        p = np.empty(rows.size)
        full = self.full[rows]
        i = rows[full]
        p[full] = self.mean[i] + self.amplitude[i] * np.cos(phase[full] - self.centre[i])
        i, rest = rows[~full], ~full
        q = self.kernel.excess_after(self.b[i], phase[rest], self.q_b[i], s.p_0[i], s.D[i], s.alpha[i], s.beta[i], s.L[i])
        p[rest] = q - s.p_0[i]
        return p * self.unit[rows]

    def _peak(self):
        """Greatest pressure in contact, Pa: where ``p = H``."""
        self.top = self.centre.copy()
        i = np.flatnonzero(~self.full)
        s = self.s.take(i)
        # p - H falls through zero once: from entry, where p is below H, to exit, where it is above
        b, a, q_b = self.b[i], self.a[i], self.q_b[i]

        def lag(phase, sub):
            q = self.kernel.excess_after(b[sub], phase, q_b[sub], s.p_0[sub], s.D[sub], s.alpha[sub], s.beta[sub], s.L[sub])
            H = self.kernel.forcing(phase, s.D[sub], s.beta[sub])
            return H + s.p_0[sub] - q, np.zeros(sub.size)

        self.top[i], _ = crossing(lag, b, a)
        peak = np.empty(self.b.size)
        rows = np.arange(self.b.size)
        peak[:] = self.pressure(rows, self.top)
        return peak

    def passes(self, p, above):
        """Phases at which the pressure passes ``p`` (Pa) upward and downward; where it does not, both are the peak's."""
        up, down = self.top.copy(), self.top.copy()
        level = p / self.unit
        full = np.flatnonzero(above & self.full)
        cosine = np.divide(
            level[full] - self.mean[full], self.amplitude[full], out=np.full(full.size, -1.0), where=self.amplitude[full] > 0
        )
        half = np.arccos(np.clip(cosine, -1, 1))
        up[full], down[full] = self.centre[full] - half, self.centre[full] + half
        part = np.flatnonzero(above & ~self.full)
        if part.size:
            s = self.s.take(part)
            b, a, top = self.b[part], self.a[part], self.top[part]
            q_b, goal = self.q_b[part], level[part] + s.p_0

            def excess(phase, sub, sign):
                args = (b[sub], phase, q_b[sub], s.p_0[sub], s.D[sub], s.alpha[sub], s.beta[sub], s.L[sub])
                value = self.kernel.excess_after(*args) - goal[sub]
                return sign * value, sign * self.kernel.excess_after_slope(*args)

            starts = q_b < goal
            first = b.copy()
            rising = np.flatnonzero(starts)
            first[rising], _ = crossing(lambda x, sub: excess(x, rising[sub], -1.0), b[rising], top[rising])
            up[part] = first
            ends = goal > 0
            last = a.copy()
            falling = np.flatnonzero(ends)
            last[falling], _ = crossing(lambda x, sub: excess(x, falling[sub], 1.0), top[falling], a[falling])
            down[part] = last
        return up, down
