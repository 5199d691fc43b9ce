"""Pressure in the contact of strips with several times.

In contact ``p = saturated field - C`` where C sums decaying exponentials. On a periodic orbit w is nowhere below the
profile, so every dashpot displacement is at or above its value in saturated contact, and the terms of C are all
positive. Then ``p' = (harmonic) + |C'|``, and where the harmonic falls it is ``-sin``, log-concave, against a
log-convex ``|C'|``: p falls on one interval of a period at most. A contact ends while p falls, so p rises to its peak
and falls from there: each value is passed once either way, as with one time.
"""

import numpy as np

from ..contact import Contact
from ..regimes import CODE, ZONES
from ..solved import Solved
from .fields import zones_of
from .problem import pick


class ModeContact(Contact):
    """Of a foundation with several relaxation times."""

    def _foundation(self) -> tuple:
        m = self.s.m
        return self.kernel.storage(m), self.kernel.loss(m), m.J_0

    def _enter(self, solved: Solved, index: np.ndarray) -> None:
        s, entry = self.s, np.zeros((self.s.modes, index.size))
        for sequence in ("acaf", "afc", "ac", "cf"):
            i = np.flatnonzero(solved.code[index] == CODE[sequence])
            if i.size:
                edges = [getattr(solved, name)[index[i]] for name in ZONES[sequence][1]]
                zones = zones_of(self.kernel, sequence, s.take(i), edges)
                entry[:, i] = next(overstress for zone, _, overstress, _ in zones if zone == "c")
        self.constants = self.kernel.excess_entry(self.b, entry, s.p_0, s.D, s.m)

    def _excess(self, rows: np.ndarray, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self.kernel.excess_event(phase, *(pick(c, rows) for c in self.constants))

    def _excess_alone(self, rows: np.ndarray, phase: np.ndarray) -> np.ndarray:
        every = np.broadcast_to(rows, phase.shape).ravel()
        return self._excess(every, phase.ravel())[0].reshape(phase.shape)
