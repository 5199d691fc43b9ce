"""The extremal periodic orbit of every strip of a batch.

Why these are the extremal orbits. The period map of a material point preserves the order "engaged before free, then by
z = w - J_0 p": in a gap two states keep their distance in z up to a positive factor, in contact likewise, and a state
that is engaged earlier stays so. Therefore iterates from the deepest contact rise to the most engaged periodic orbit and
iterates from infinitely far fall to the least engaged one, and there is no longer period.

* Always engaged states contract onto one candidate: saturated contact, saturated adhesion, or contact with saturated
  adhesion. If its inequalities hold it is the most engaged orbit; nothing more engaged exists.
  Where it is not, bounds on all orbits (``orbit_bounds``) mostly tell without solving for it.
* Every other orbit but the free one has an onset phase and is a zero of the onset map's defect ``r``. The first (or last) of
  them is had from Newton with a proof that it is alone on its side, or else from a search that passes over none (``extremal``).
* The free orbit is the least engaged one, where it is admissible: ``D <= -delta_0`` (``D <= 0`` without adhesion).

``unloading`` asks in the order engaged, first zero, free; ``loading`` in the order free, last zero, engaged.
"""

import numpy as np

from .balance import may_cling
from .certificate import greatest_gap, saturates
from .extremal import Extremal, extremal, unique
from .groups import Strips, adhesive_cycle, bare_cycle
from .orbit_bounds import FAST, least_engaged_bounds, orbit_bounds
from .regimes import CODE, ZONES
from .solved import UNDECIDED, Record, Solved, settle

#: Strips solved at a time: memory stays bounded. Fewer cost more calls, more leave the cache
CHUNK = 131072


def solve_strips(kernel, strips: Strips, unloading: bool) -> Solved:
    """Solve a batch with the generated ``kernel``; ``certified`` is false for every strip that must not be used."""
    if strips.size > CHUNK // 128:
        # glibc hands freed memory back at once, page by page, beyond twice the largest block that was ever freed
        np.empty(31 * CHUNK)
    solved = _Batch(kernel, strips, unloading).solve()
    settle(lambda nearby: _Batch(kernel, nearby, unloading).solve(), strips, solved, unloading)
    return solved


class _Batch:
    """Strips, and what is known of them so far."""

    def __init__(self, kernel, strips: Strips, unloading: bool):
        self.kernel, self.strips, self.unloading = kernel, strips, unloading
        self.record = Record(kernel, strips)

    def solve(self) -> Solved:
        adhesive = self.strips.p_0 > 0
        self._without_adhesion(np.flatnonzero(~adhesive))
        index = np.flatnonzero(adhesive)
        for i in range(0, index.size, CHUNK):
            self._with_adhesion(index[i : i + CHUNK])
        return self.record.solved

    # -- stages: each decides what it can and returns the other strips -----------------------------------------------------------

    def _with_adhesion(self, index):
        if self.unloading:
            index, partial = self._saturated(index)
        else:
            index = self._free(index)
        if not index.size:
            return
        cycle = adhesive_cycle(self.kernel, self.strips.among(index))
        bounds = orbit_bounds(self.kernel, cycle, FAST) if self.unloading else least_engaged_bounds(self.kernel, cycle)
        self.record.solved.searched[index] = cycle.half_d > 0
        if self.unloading:
            rest = self._contact_with_saturated_adhesion(index, partial & bounds.engaged)
            index, cycle, bounds = index[rest], cycle.among(rest), bounds.among(rest)
        if index.size:  # orbits that are free once per period
            index = index[self._written(index, extremal(self.kernel, cycle, not self.unloading, bounds))]
        if self.unloading:
            self._free(index)
        else:
            self._contact_with_saturated_adhesion(*self._saturated(index))

    def _free(self, index):
        s = self.strips
        free = s.D[index] <= -s.delta_0[index]
        self.record.constant(index[free], "f", 0.0, 0.0, 0.0, 0.0)
        return index[~free]

    def _saturated(self, index):
        """Also which of the others may be in contact with saturated adhesion."""
        s = self.strips.among(index)
        full = saturates(self.kernel, s)
        self.record.saturated_contact(index[full])
        clings = ~full & may_cling(self.kernel, s)
        hold = clings & (s.D <= -s.p_0)
        self.record.constant(index[hold], "a", -s.p_0[hold], 0.0, 0.0, 1.0)
        rest = ~full & ~hold
        return index[rest], clings[rest]

    def _written(self, index, found: Extremal) -> np.ndarray:
        """Keep what was ``found`` of the strips ``index``; returns which have no such orbit."""
        self.record.solved.code[index] = found.code
        for sequence in ZONES:
            pick = np.flatnonzero(found.certified & (found.code == CODE[sequence]))
            self.record.orbits(index[pick], sequence, found.orbit.take(pick))
        return found.code == UNDECIDED

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
            self.record.solved.searched[index] = True
            self._written(index, unique(self.kernel, bare_cycle(self.kernel, self.strips.among(index)), "cf"))

    def _contact_with_saturated_adhesion(self, index, ask):
        """Solve those to ``ask`` of as strips without adhesion at ``D + p_0``; returns which of all have no such orbit."""
        rest, ask = np.ones(index.size, bool), np.flatnonzero(ask)
        if ask.size:
            self.record.solved.searched[index[ask]] = True
            strips = self.strips.among(index[ask])
            found = unique(self.kernel, bare_cycle(self.kernel, strips), "ac")
            # there is such an orbit without a limit to the gap: one that is not found is not certified, never passed over
            gap = greatest_gap(self.kernel, strips, found.orbit.a)
            found.code[found.certified & (gap > strips.delta_0)] = UNDECIDED
            rest[ask] = self._written(index[ask], found)
        return np.flatnonzero(rest)
