"""The extremal periodic orbit of every strip of a batch with several relaxation times; the same answers as
``orbit.engine`` gives for one.

Why the orbits are extremal is shown in ``windows``. ``unloading`` takes the always engaged orbit where it is admissible,
else the first orbit above it; ``loading`` the free orbit where it is admissible, else the first orbit below
``max(D, 0)``.
"""

from dataclasses import replace

import numpy as np

from ..march import Orbit
from ..regimes import CODE
from ..solved import Record, Solved, settle
from .engaged import engaged
from .extremal import ENGAGED, FREE, ORBIT, ROWS, Search, highest_state, lowest_state
from .problem import ModeStrips

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
        self.full = s.D - 1 + s.p_0 >= self.kernel.modulus_ratio(s.m)
        self.constant = self.full | sticky & (s.D <= -s.p_0) & (2 - s.D - s.p_0 <= s.delta_0)
        free = np.where(sticky, (s.D <= -s.delta_0) & (not self.unloading), s.D <= 0)
        closed = ~free & self.constant & (self.unloading | ~sticky)
        self._free(np.flatnonzero(free))
        self._closed(np.flatnonzero(closed))
        left = np.flatnonzero(~free & ~closed)
        self._always_engaged(left[~sticky[left]], "cf")
        left = left[sticky[left]]
        s = s.take(left)
        # states beyond all orbits
        z = lowest_state(self.kernel, s) if self.unloading else highest_state(self.kernel, s)
        self._first(left, z, np.full(left.size, self.unloading), ask=True)
        return self.solved

    def _first(self, index, z, engaged, ask: bool):
        """Strips ``index`` from the states ``z`` beyond all orbits; ``ask``: the engaged orbit is not known yet."""
        if not index.size:
            return
        found = Search(self.kernel, self.strips.take(index), z, engaged, self.unloading, not ask).run()
        self.solved.code[index] = CODE["acaf"]
        self.solved.searched[index] = True
        self._free(index[found.kind == FREE])
        orbit = found.kind == ORBIT
        for number, sequence in enumerate(ROWS, 1):
            k = np.flatnonzero(orbit & (found.sequence == number))
            self.record.orbits(index[k], sequence, Orbit.of(sequence, found.edges[list(ROWS[sequence])][:, k]))
        held = found.kind == ENGAGED
        closed = held & self.constant[index] & (not self.unloading)
        self._closed(index[closed])
        held = np.flatnonzero(held & ~closed)
        z, known = self._always_engaged(index[held], "ac", found.edges[:, held])
        rest = np.flatnonzero(known & ~self.solved.certified[index[held]] & self.unloading)
        self._first(index[held[rest]], z[:, rest], np.ones(rest.size, bool), False)

    def _free(self, index):
        self.record.constant(index, "f", 0.0, 0.0, 0.0, 0.0)

    def _closed(self, index):
        """Saturated contact, or adhesion all along."""
        self.record.saturated_contact(index[self.full[index]])
        hold = index[~self.full[index]]
        self.record.constant(hold, "a", -self.strips.p_0[hold], 0.0, 0.0, 1.0)

    def _always_engaged(self, index, sequence, met=None):
        """Solve the always engaged orbits of the strips ``index``; write those that are orbits of the strip.

        Returns their states and which are known."""
        if not index.size:
            return np.empty((self.strips.modes, 0)), np.zeros(0, bool)
        s = self.strips.take(index)
        whole = replace(s, bare=True) if sequence == "cf" else s
        z, edges, known, within = engaged(self.kernel, whole, met)
        self.solved.searched[index] = True
        k = np.flatnonzero(within)
        self.solved.code[index] = CODE[sequence]
        self.record.orbits(index[k], sequence, Orbit.of(sequence, edges[:, k]))
        return z, known
