"""Orbits found by Newton from a rough start and proven to be the extremal ones: the way most strips are solved.

Newton may find any periodic orbit, or none. What it finds counts only with the certificate of an orbit and the proof that no
more extremal one exists; all else is left to ``search``.
"""

import numpy as np

from .balance_exclusion import exclude_out_of_reach
from .certificate import attracting, edges_admissible
from .chain import follow
from .exclusion import is_first, is_last
from .groups import Cycle
from .march import FROZEN, Orbit
from .orbit_bounds import FAST, OrbitBounds
from .refine import refined
from .solved import orbit_of
from .start import start


def certified(kernel, cycle: Cycle, sequence: str, edges: np.ndarray) -> tuple[Orbit, np.ndarray, np.ndarray]:
    """Orbits of ``sequence`` that Newton finds from ``edges`` (k, n), which are certified, and the evaluations of each."""
    found, good, spent = follow(kernel, cycle, sequence, edges)
    if sequence in ("acaf", "afc"):
        # the links along the chain lose what a period changes to rounding; the start is as good as an orbit
        frozen = np.flatnonzero(~good & (cycle.strips.alpha > FROZEN))
        found[:, frozen], good[frozen] = edges[:, frozen], True
    orbit, here = orbit_of(sequence, found), np.flatnonzero(good)
    # next to a fold or a graze the search knows better; a strip without adhesion has neither
    blurred = sequence in ("ac", "cf")
    new, good[here], _, more = refined(kernel, sequence, cycle.among(here), orbit.take(here), blurred=blurred)
    spent[here] += more
    orbit.put(here, new)
    here = np.flatnonzero(good)
    part, there = cycle.among(here), orbit.take(here)
    good[here] = edges_admissible(kernel, part, there)
    if sequence not in ("ac", "cf"):  # where p does not step the onset map contracts everywhere
        good[here] &= attracting(kernel, part, there)
    return orbit, good, spent


def extremal(kernel, cycle: Cycle, last: bool, bounds: OrbitBounds):
    """Extremal orbits with a free part, where they can be had without a search.

    Returns, for n cycles: a certified orbit of each (x NaN where there is none), its sequence (``""`` if none), which are proven
    extremal, which cycles are proven to have no such orbit at all, and the evaluations spent. ``bounds`` on all orbits: of the
    most engaged state, or for ``last`` of the least engaged one.
    """
    s = cycle.strips
    none = (cycle.half_d <= 0) | bounds.missed
    found = _Found(kernel, cycle, last, bounds)
    # along every orbit w is at least -p_0: a crest that does not come as deep makes no contact
    touches = s.D + s.p_0 > s.noise()
    if last:
        # next to saturated contact a less engaged orbit is rare: ask the search, which sees that first
        possible = ~none & (s.D - 1 + s.p_0 < kernel.modulus_ratio(s.alpha, s.beta))
        alone = ~cycle.touched
    else:
        hanging = np.flatnonzero(~none & (s.D <= -s.delta_0) & (s.beta > FAST))
        if hanging.size:
            none[hanging], found.evaluations[hanging] = exclude_out_of_reach(kernel, cycle.among(hanging))
        possible, alone = ~none, ~touches
    found.attempt("acaf", np.flatnonzero(possible & ~cycle.direct & touches))
    found.attempt("afc", np.flatnonzero(possible & cycle.direct))
    found.attempt("af", np.flatnonzero(possible & ~cycle.direct & ~found.proven & alone))
    return found.orbit, found.sequence, found.proven, none, found.evaluations


class _Found:
    """Orbits found so far: the most extremal one of each cycle, its sequence, whether it is proven to be extremal, work."""

    def __init__(self, kernel, cycle: Cycle, last: bool, bounds: OrbitBounds):
        self.kernel, self.cycle, self.last, self.bounds = kernel, cycle, last, bounds
        self.orbit = Orbit.blank(cycle.size)
        self.sequence = np.full(cycle.size, "", dtype="<U4")
        self.proven, self.evaluations = np.zeros(cycle.size, bool), np.zeros(cycle.size)

    def attempt(self, sequence: str, pick) -> None:
        """Newton for the cycles ``pick``, and the proof that what it finds is the most extremal orbit."""
        if not pick.size:
            return
        part, limits = self.cycle.among(pick), self.bounds.take(pick)
        edges = start(self.kernel, part, sequence, None if self.last else limits)
        orbit, good, used = certified(self.kernel, part, sequence, edges)
        self.evaluations[pick] += used
        here = np.flatnonzero(good)
        if not here.size:
            return
        pick, proof = pick[here], is_last if self.last else is_first
        sure, used = proof(self.kernel, part.among(here), orbit.take(here), limits.take(here))
        self.evaluations[pick] += used
        # of two orbits that are known the more extremal one is worth keeping
        found = self.orbit.x[pick]
        nearer = ~(found >= orbit.x[here]) if self.last else ~(found <= orbit.x[here])
        keep = np.flatnonzero(sure | nearer)
        self.orbit.put(pick[keep], orbit.take(here[keep]))
        self.sequence[pick[keep]] = sequence
        self.proven[pick] |= sure
