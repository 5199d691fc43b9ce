"""The extremal periodic orbit of every strip of a batch with several relaxation times; compare ``orbit.engine``, with one.

Why the orbits are extremal is shown in ``windows``. ``unloading`` takes the always engaged orbit where it is admissible, else the
first orbit above it; ``loading`` the free orbit where it is admissible, else the first orbit below ``max(D, 0)``.
"""

from dataclasses import replace

import numpy as np

from ..groups import ROUNDING, TWO_PI
from ..march import Orbit, turn
from ..regimes import CODE
from ..solved import Record, Solved, settle
from .extremal import ENGAGED, FREE, ORBIT, ROWS, STEPS, Search, agrees, certified
from .march import march
from .problem import ModeStrips, state_at, zones_of

#: strips solved at a time: what a call of NumPy costs is shared by more of them than 2,048 (2 to 3 times faster with two times),
#: and memory stays bounded (with 15 times 30 MB a matrix)
CHUNK = 16384


def solve_modes(kernel, strips: ModeStrips, unloading: bool) -> Solved:
    """Solve a batch with the generated ``kernel``; ``certified`` is false for every strip that must not be used."""
    solved = Solved.empty(strips.size)
    for start in range(0, strips.size, CHUNK):
        part = np.arange(start, min(start + CHUNK, strips.size))
        solved.put(part, _Batch(kernel, strips.take(part), unloading).solve())
    settle(lambda nearby: _Batch(kernel, nearby, unloading).solve(), strips, solved, unloading)
    return solved


class _Batch:
    def __init__(self, kernel, strips: ModeStrips, unloading: bool):
        self.kernel, self.strips, self.unloading = kernel, strips, unloading
        self.record = Record(kernel, strips)
        self.solved = self.record.solved

    def solve(self) -> Solved:
        s = self.strips
        sticky = s.p_0 > 0
        # saturated contact, and adhesion all along: closed forms of the always engaged orbit
        R, least = self.kernel.modulus_ratio(s.m), s.D - 1 + s.p_0
        self.full = least >= R
        # by how much pressures of saturated contact fall short, times how long: 1e-12 of their means at most
        self.nearly = np.maximum(R - least, 0.0) ** 1.5 <= 64 * ROUNDING * (1 + np.abs(s.D) + s.p_0) * np.sqrt(R)
        self.constant = self.full | sticky & (s.D <= -s.p_0) & (2 - s.D - s.p_0 <= s.delta_0)
        free = np.where(sticky, (s.D <= -s.delta_0) & (not self.unloading), s.D <= 0)
        closed = ~free & self.constant & (self.unloading | ~sticky)
        self.record.constant(np.flatnonzero(free), "f")
        self._closed(np.flatnonzero(closed))
        self._always_engaged(np.flatnonzero(~free & ~closed & ~sticky), "cf")
        left = np.flatnonzero(~free & ~closed & sticky)
        s = s.take(left)
        # states beyond all orbits; the highest is free
        self._first(left, _lowest_state(self.kernel, s) if self.unloading else s.m.share.sum(axis=1) * np.maximum(s.D, 0.0))
        return self.solved

    def _first(self, index, z):
        """Strips ``index`` from the states ``z`` beyond all orbits."""
        search = Search(self.kernel, self.strips.take(index), z, self.unloading)
        # from below the first march tells which are never released: their engaged orbits are the first, or below all others
        search.run(1 if self.unloading else STEPS)
        held, constant = search.kind == ENGAGED, self.constant[index]
        self._closed(index[held & constant])
        k = np.flatnonzero(held & ~constant)
        z, known = self._always_engaged(index[k], "ac", search.edges[:, k])
        on = known & ~self.solved.certified[index[k]] & self.unloading
        search.resume(k[on], z[:, on])
        search.run()
        self.solved.searched[index] = True
        self.record.constant(index[search.kind == FREE], "f")
        for sequence in ROWS:
            k = np.flatnonzero((search.kind == ORBIT) & (search.sequence == CODE[sequence]))
            self.record.orbits(index[k], sequence, Orbit.of(sequence, search.edges[list(ROWS[sequence])][:, k]))

    def _closed(self, index):
        """Saturated contact, or adhesion all along."""
        self.record.saturated_contact(index[self.full[index]])
        self.record.saturated_adhesion(index[~self.full[index]])

    def _always_engaged(self, index, sequence, met=None):
        """Write those of the always engaged orbits of the strips ``index`` that are orbits of the strip; the states of all, and
        which are known."""
        if not index.size:
            return np.empty((self.strips.modes, 0)), np.zeros(0, bool)
        s = self.strips.take(index)
        z, edges, known, within = _engaged(self.kernel, replace(s, bare=True) if sequence == "cf" else s, met)
        self.solved.searched[index] = True
        k = np.flatnonzero(within)
        self.record.orbits(index[k], sequence, Orbit.of(sequence, edges[:, k]))
        # of a gap that hardly opens rounding may leave nothing
        self.record.saturated_contact(index[~known & self.nearly[index]])
        return z, known


def _lowest_state(kernel, s: ModeStrips) -> np.ndarray:
    """State below every orbit: displacements are nowhere below the profile, nor below ``-p_0``."""
    e = kernel.profile(s.start, s.D) - s.m.S * kernel.saturated_overstress(s.start, s.m)
    return np.einsum("ij...,j...->i...", s.m.share, np.maximum(e, -s.p_0))


def _engaged(kernel, strips: ModeStrips, met: np.ndarray | None):
    """The one orbit of each strip that is never released, by Newton's method on its edges, checked by a march:
    from edges (4, N) that marches ``met``, then from those met from below all orbits.

    Without release ``w = u + max(z - u - J_0 p_0, 0)`` is a convex function of the state, so the period map is convex and
    monotone: each Newton step from below lands below the fixed point again, higher up. It cannot miss.

    Returns states, edges b and a (2, N), which are known, and which are orbits of the strip: their gaps stay within its reach."""
    left, none = np.arange(strips.size), np.zeros(strips.size)
    # seen from -p_0: adding p_0 to w, p and every e leaves the foundation's law unchanged
    s = replace(strips, p_0=none, delta_0=none, D=strips.D + strips.p_0, bare=True)
    z, edges = np.full((s.modes, s.size), np.nan), np.full((2, s.size), np.nan)
    known, within = np.zeros((2, s.size), bool)
    for attempt in range(met is None, 2):
        here = s.take(left)
        if attempt:
            met = march(kernel, here, np.ones(left.size, bool), _lowest_state(kernel, here), here.start).edges
        edges[:, left], good, rounded = certified(kernel, here, "ac", np.nan_to_num(_engaged_edges(met)))
        k = left[good]
        here = s.take(k)
        z[:, k] = state_at(kernel, "ac", here, edges[:, k], here.start)
        period = march(kernel, here, np.ones(k.size, bool), z[:, k], here.start)
        # rounding may make one of no length in the valley of a contact all but a period long: its middle is next to the crest
        one = (period.contacts == 1) & ~period.lost & (np.abs(edges[:, k].sum(axis=0)) < np.pi)
        k = k[agrees(_engaged_edges(period.edges), edges[:, k], rounded[good]) & one]
        known[k] = True
        # not seen from -p_0: where that is large against the gap, rounding would decide
        here = s.take(k)
        _, (_, start, entry, _) = zones_of(kernel, "ac", here, edges[:, k])
        gap = kernel.gap_entry(start, entry, -here.p_0, here.D, here.m)
        # it opens at a, and turns once before the valley: its slope is a sine, log-concave, less a log-convex sum
        widest = turn(kernel.gap_event, gap, 1, start, start + np.mod(np.pi - start, TWO_PI))
        within[k] = strips.bare or kernel.gap_event(widest, *gap)[0] <= strips.delta_0[k]
        left = np.flatnonzero(~known)
        if not left.size:
            break
    return z - strips.m.J * strips.p_0, edges, known, within


def _engaged_edges(met):
    """Edges b, a of an always engaged orbit, b first, of those (4, N) that a march met; b in the valley where it met none."""
    b, a = np.where(np.isnan(met[1]), np.pi, met[1]), met[2]
    b = np.where(b > a, b - TWO_PI, b)
    return np.array([b, a]) - TWO_PI * np.floor((a + 0.5 * np.pi) / TWO_PI)
