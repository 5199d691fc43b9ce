"""The extremal periodic orbit of every strip of a batch.

Why these are the extremal orbits. The period map of a material point preserves the order "engaged before free, then by
z = w - J_0 p": in a gap two states keep their distance in z up to a positive factor, in contact likewise, and a state
that is engaged earlier stays so. Therefore iterates from the deepest contact rise to the most engaged periodic orbit and
iterates from infinitely far fall to the least engaged one, and there is no longer period.

* Always engaged states contract onto one candidate: saturated contact, saturated adhesion, or contact with saturated
  adhesion. If its inequalities hold it is the most engaged orbit; nothing more engaged exists.
  Where it is not, bounds on all orbits (``orbit_bounds``) mostly tell without solving for it.
* Every other orbit but the free one has an onset phase and is a zero of the onset map's defect ``r``. The first (or last) of
  them is had from Newton with a proof that it is alone on its side (``direct``), or else from a search that passes over none
  (``isolated_orbits``).
* The free orbit is the least engaged one, where it is admissible: ``D <= -delta_0`` (``D <= 0`` without adhesion).

``unloading`` asks in the order engaged, first zero, free; ``loading`` in the order free, last zero, engaged.
"""

import numpy as np

from .certificate import greatest_gap
from .closed_form_exclusion import may_cling, saturates
from .direct import certified, extremal
from .groups import Cycle, Strips, adhesive_cycle, bare_cycle
from .isolated_orbits import isolated_orbits
from .march import Orbit
from .orbit_bounds import FAST, OrbitBounds, least_engaged_bounds, orbit_bounds
from .regimes import CODE
from .solved import Record, Solved, settle
from .start import start

#: Strips solved at a time: their working arrays stay in the cache, and memory stays bounded.
CHUNK = 32768


def solve_strips(kernel, strips: Strips, unloading: bool) -> Solved:
    """Solve a batch with the generated ``kernel``; ``certified`` is false for every strip that must not be used."""
    solved = _Batch(kernel, strips, unloading).solve()
    settle(lambda nearby: _Batch(kernel, nearby, unloading).solve(), strips, solved, unloading)
    return solved


class _Batch:
    """Strips, and what is known of them so far: solutions, orbits with an onset, x NaN where none is known, and bounds on all."""

    def __init__(self, kernel, strips: Strips, unloading: bool):
        self.kernel, self.strips, self.unloading = kernel, strips, unloading
        self.record = Record(kernel, strips)
        self.known, self.bounds = Orbit.blank(strips.size), OrbitBounds.blank(strips.size)

    def solve(self) -> Solved:
        adhesive = self.strips.p_0 > 0
        self._without_adhesion(np.flatnonzero(~adhesive))
        index = np.flatnonzero(adhesive)
        onset = (self._direct, self._searched)
        for stage in (self._engaged, *onset, self._free) if self.unloading else (self._free, *onset, self._engaged):
            if index.size:
                index = np.concatenate([stage(index[i : i + CHUNK]) for i in range(0, index.size, CHUNK)])
        return self.record.solved

    # -- the three kinds of orbit; each stage decides what it can and returns the other strips ----------------------------------

    def _free(self, index):
        s = self.strips
        free = s.D[index] <= -s.delta_0[index]
        self.record.constant(index[free], "f", 0.0, 0.0, 0.0, 0.0)
        return index[~free]

    def _engaged(self, index):
        s = self.strips.among(index)
        full = saturates(self.kernel, s)
        self.record.saturated_contact(index[full])
        reaches = ~full & may_cling(self.kernel, s)
        clinging = s.D <= -s.p_0
        hold = reaches & clinging
        self.record.constant(index[hold], "a", -s.p_0[hold], 0.0, 0.0, 1.0)
        done = full | hold
        partial = reaches & ~clinging
        if self.unloading:
            partial &= ~self._bounded(index, s, ~done)
        partial = np.flatnonzero(partial)
        if partial.size:
            done[partial] = self._contact_with_saturated_adhesion(index[partial])
        return index[~done]

    def _bounded(self, index, s: Strips, ask) -> np.ndarray:
        """Bound all orbits of the strips ``index`` of which to ``ask``; returns of which none is always engaged."""
        released = np.zeros(index.size, bool)
        ask = np.flatnonzero(ask & (s.beta <= FAST))
        if ask.size:
            bounds = orbit_bounds(self.kernel, adhesive_cycle(self.kernel, s.among(ask)))
            released[ask] = bounds.released
            self.bounds.put(index[ask], bounds)
            self.record.solved.evaluations[index[ask]] += bounds.evaluations
        return released

    def _direct(self, index):
        """Orbits that are free once per period, as far as they can be had without a search."""
        cycle = adhesive_cycle(self.kernel, self.strips.among(index))
        if not self.unloading:
            bounds = least_engaged_bounds(self.kernel, cycle)
            self.bounds.put(index, bounds)
            self.record.solved.evaluations[index] += bounds.evaluations
        orbit, sequences, proven, none, spent = extremal(
            self.kernel, cycle, last=not self.unloading, bounds=self.bounds.take(index)
        )
        self.record.solved.evaluations[index] += spent
        for sequence in ("acaf", "afc", "af"):
            pick = np.flatnonzero(proven & (sequences == sequence))
            self.record.orbits(index[pick], sequence, orbit.take(pick))
        self.known.put(index, orbit)
        self.bounds.missed[index] = none
        return index[~proven]

    def _searched(self, index):
        """Orbits that are free once per period, of those that may have one."""
        none = self.bounds.missed[index]
        missed, index = index[none], index[~none]
        if not index.size:
            return missed
        cycle = adhesive_cycle(self.kernel, self.strips.among(index))
        known, limit = self.known.take(index), self.bounds.x[index]
        result = isolated_orbits(self.kernel, cycle, not self.unloading, known, limit)
        self.record.solved.evaluations[index] += result.evaluations
        for sequence, pick in result.of(cycle).items():
            self.record.solved.code[index[pick]] = CODE[sequence]
            good = pick[result.certified[pick]]
            self.record.orbits(index[good], sequence, result.orbit.take(good))
        lost = ~result.found & ~result.ended
        self.record.solved.code[index[lost]] = CODE["acaf"]
        return np.sort(np.concatenate((missed, index[~result.found & result.ended])))

    def _without_adhesion(self, index):
        if not index.size:
            return
        s = self.strips.among(index)
        full = saturates(self.kernel, s)
        free = ~full & (s.D <= 0)
        self.record.saturated_contact(index[full])
        self.record.constant(index[free], "f", 0.0, 0.0, 0.0, 0.0)
        index = index[~full & ~free]
        if index.size:
            orbit, found = self._bare(index, "cf", bare_cycle(self.kernel, self.strips.among(index)))
            self.record.solved.code[index] = CODE["cf"]
            pick = np.flatnonzero(found)
            self.record.orbits(index[pick], "cf", orbit.take(pick))

    def _contact_with_saturated_adhesion(self, index):
        """Solve as the strip without adhesion at ``D + p_0``; returns which strips are decided."""
        strips = self.strips.among(index)
        cycle = bare_cycle(self.kernel, strips)
        orbit, found = self._bare(index, "ac", cycle)
        pick = np.flatnonzero(found)
        pick = pick[greatest_gap(self.kernel, strips.among(pick), orbit.take(pick)) <= strips.delta_0[pick]]
        self.record.orbits(index[pick], "ac", orbit.take(pick))
        # there is such an orbit without a limit to the gap: one that is not found is not certified, never passed over
        done = ~found
        done[pick] = True
        return done

    def _bare(self, index, sequence: str, cycle: Cycle) -> tuple[Orbit, np.ndarray]:
        """Orbits without adhesion, and which are certified.

        Where p does not step the onset map contracts everywhere (``sensitivity``): an orbit that is found is the only one.
        """
        orbit, found, spent = certified(self.kernel, cycle, sequence, start(self.kernel, cycle, sequence))
        self.record.solved.evaluations[index] += spent
        rest = np.flatnonzero(~found)
        if rest.size:
            result = isolated_orbits(self.kernel, cycle.among(rest), last=False)
            self.record.solved.evaluations[index[rest]] += result.evaluations
            orbit.put(rest, result.orbit)
            found[rest] = result.certified
        return orbit, found
