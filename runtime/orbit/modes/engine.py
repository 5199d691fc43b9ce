"""The extremal periodic orbit of every strip of a batch with several relaxation times; the same answers as
``orbit.engine`` gives for one.

Why the orbits are extremal is shown in ``order``. ``unloading`` takes the always engaged orbit where it is admissible,
else the first orbit above it; ``loading`` the free orbit where it is admissible, else the first orbit below
``max(D, 0)``.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...numerics.rounding import EPS
from ..regimes import CODE, ZONES
from ..solved import Solved
from .engaged import engaged
from .extremal import ENGAGED, FREE, ORBIT, ROWS, extremal, highest_state, lowest_state
from .march import TWO_PI
from .polish import arguments
from .problem import ModeStrips

#: strips solved at a time: what a call of NumPy costs is shared by more of them than 2,048 (2 to 3 times faster with two times),
#: and memory stays bounded (with 15 times 30 MB a matrix)
CHUNK = 16384
#: distances in roundings of D at which a strip on the end of a branch is settled
_SHIFTS = (8, 64, 512)


def solve_modes(kernel, strips: ModeStrips, unloading: bool) -> Solved:
    """Solve a batch with the generated ``kernel``; ``certified`` is false for every strip that must not be used."""
    solved = Solved.empty(strips.size)
    for start in range(0, strips.size, CHUNK):
        part = np.arange(start, min(start + CHUNK, strips.size))
        solved.put(part, _Batch(kernel, strips.take(part), unloading).solve())
    for roundings in _SHIFTS:
        index = np.flatnonzero(~solved.certified)
        if not index.size:
            break
        # which side of a branch's end these are on is below the rounding of the inputs: they get the solution of the
        # side it is followed to
        these = strips.take(index)
        shift = roundings * EPS * these.size_of_lengths
        again = _Batch(kernel, replace(these, D=these.D + (shift if unloading else -shift)), unloading).solve()
        again.evaluations += solved.evaluations[index]
        good = np.flatnonzero(again.certified)
        solved.put(index[good], again.take(good))
    return solved


class _Batch:
    def __init__(self, kernel, strips: ModeStrips, unloading: bool):
        self.kernel, self.strips, self.unloading = kernel, strips, unloading
        self.solved = Solved.empty(strips.size)
        self.start = np.full(strips.size, np.pi)

    def solve(self) -> Solved:
        s = self.strips
        sticky = s.p_0 > 0
        # saturated contact, and adhesion all along: closed forms of the always engaged orbit
        self.full = s.D - 1 + s.p_0 >= self.kernel.modulus_ratio(s.m)
        self.clinging = sticky & (s.D <= -s.p_0) & (2 - s.D - s.p_0 <= s.delta_0)
        bare_free = ~sticky & (s.D <= 0)
        away = sticky & (s.D <= -s.delta_0) & (not self.unloading)
        decided = away | bare_free
        if self.unloading:
            decided |= self.full | self.clinging
            self._closed(np.flatnonzero((self.full | self.clinging) & ~bare_free))
        self._free(np.flatnonzero(away | bare_free))
        decided_full = ~sticky & self.full & ~decided
        self._closed(np.flatnonzero(decided_full))
        index = np.flatnonzero(~decided & ~decided_full)
        if index.size:
            self._search(index)
        return self.solved

    def _search(self, index):
        bare = self.strips.p_0[index] == 0
        self._always_engaged(index[bare], "cf")
        index = index[~bare]
        if index.size:
            self._first(index, *self._outside(index), ask=True)

    def _outside(self, index):
        """States beyond all orbits, and whether they are engaged."""
        s = self.strips.take(index)
        z = lowest_state(self.kernel, s, self.start[index]) if self.unloading else highest_state(self.kernel, s)
        return z, np.full(index.size, self.unloading)

    def _first(self, index, z, engaged, ask: bool):
        """Strips ``index`` from the states ``z`` beyond all orbits; ``ask``: the engaged orbit is not known yet."""
        s = self.strips.take(index)
        found = extremal(self.kernel, s, self.start[index], z, engaged, self.unloading, not ask)
        self.solved.code[index] = CODE["acaf"]
        self.solved.evaluations[index] += found.evaluations
        self._free(index[found.kind == FREE])
        orbit = found.kind == ORBIT
        for number, sequence in enumerate(ROWS, 1):
            k = np.flatnonzero(orbit & (found.sequence == number))
            self._write(index[k], sequence, sequence, s.take(k), found.edges[list(ROWS[sequence])][:, k])
        held = np.flatnonzero(found.kind == ENGAGED)
        if held.size and not self.unloading:
            closed = (self.full | self.clinging)[index[held]]
            self._closed(index[held[closed]])
            held = held[~closed]
        if held.size and ask:
            z, good = self._always_engaged(index[held], "ac", found.held.take(held))
            rest = np.flatnonzero(good & ~self.solved.certified[index[held]])
            if rest.size and self.unloading:
                self._first(index[held[rest]], z[:, rest], np.ones(rest.size, bool), False)

    def _always_engaged(self, index, sequence, near=None):
        """Solve the always engaged orbits of the strips ``index``; write those that are orbits of the strip.

        Returns their states and which are known."""
        if not index.size:
            return np.empty((self.strips.modes, 0)), np.zeros(0, bool)
        s = self.strips.take(index)
        whole = replace(s, bare=True) if sequence == "cf" else s
        z, edges, known, within, spent = engaged(self.kernel, whole, self.start[index], near)
        self.solved.evaluations[index] += spent
        k = np.flatnonzero(within)
        self.solved.code[index] = CODE[sequence]
        self._write(index[k], "ac", sequence, s.take(k).raised(), edges[:, k])
        return z, known

    # -- writing results ---------------------------------------------------------------------------------------------

    def _free(self, index):
        self._set(index, "f", 0.0, 0.0, 0.0, 0.0)

    def _closed(self, index):
        """Saturated contact, or adhesion all along."""
        full = index[self.full[index]]
        s = self.strips.take(full)
        self._set(full, "c", *self.kernel.means_c(*arguments(s)), 1.0, 0.0)
        hold = index[~self.full[index]]
        self._set(hold, "a", -self.strips.p_0[hold], 0.0, 0.0, 1.0)

    def _set(self, index, sequence, p_mean, tau_mean, contact, adhesion):
        if not index.size:
            return
        out = self.solved
        out.code[index] = CODE[sequence]
        out.p_mean[index], out.tau_mean[index] = p_mean, tau_mean
        out.contact_fraction[index], out.adhesion_fraction[index] = contact, adhesion
        out.certified[index] = True

    def _write(self, index, equations, sequence, s, e):
        out = self.solved
        out.code[index], out.certified[index] = CODE[sequence], True
        out.p_mean[index], out.tau_mean[index] = getattr(self.kernel, f"means_{equations}")(*e, *arguments(s))
        if sequence == "ac":
            out.p_mean[index] -= self.strips.p_0[index]
        named = dict(zip(ZONES[sequence][1], e, strict=True))
        for name, values in named.items():
            getattr(out, name)[index] = values
        contact = (named["a"] - named["b"]) / TWO_PI if "b" in named else np.zeros(index.size)
        out.contact_fraction[index] = contact
        if sequence == "cf":
            out.adhesion_fraction[index] = 0.0
        elif sequence == "ac":
            out.adhesion_fraction[index] = 1 - contact
        else:
            out.adhesion_fraction[index] = (e[-1] - e[0]) / TWO_PI - contact
