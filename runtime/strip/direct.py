"""Orbits found by Newton from a rough start and proven to be the extremal ones: the way most strips are solved.

Newton may find any periodic orbit, or none. What it finds counts only with the certificate of an orbit and the proof that no
more extremal one exists; all else is left to ``search``.
"""

import numpy as np

from .certificate import attracting, edges_admissible
from .chain import CONVERGED, follow
from .exclusion import alone
from .march import Orbit
from .outermost import Outermost
from .problem import Cycle
from .refine import refined
from .solved import orbit_of
from .start import start


def certified(kernel, cycle: Cycle, sequence: str, bounds: Outermost | None = None) -> tuple[Orbit, np.ndarray, np.ndarray]:
    """Orbits of ``sequence`` that Newton finds, which of them are certified, and the evaluations spent on each.

    ``bounds`` on all orbits, where there are any, are what Newton starts from.
    """
    chain = follow(kernel, cycle, sequence, start(kernel, cycle, sequence, bounds))
    spent = chain.evaluations
    orbit = orbit_of(sequence, chain.edges)
    good = chain.converged
    coarse = np.flatnonzero(good & (chain.correction > CONVERGED))
    if coarse.size:
        # next to a fold or a graze the search knows better; a strip without adhesion has neither
        blurred = sequence in ("ac", "cf")
        new, converged, _, more = refined(kernel, sequence, cycle.take(coarse), orbit.take(coarse), blurred=blurred)
        spent[coarse] += more
        orbit.put(coarse, new)
        good[coarse] = converged
    here = np.flatnonzero(good)
    part, there = cycle.take(here), orbit.take(here)
    good[here] = edges_admissible(kernel, part, there)
    if sequence not in ("ac", "cf"):  # where p does not step the onset map contracts everywhere
        good[here] &= attracting(kernel, part, there)
    return orbit, good, spent


def extremal(kernel, cycle: Cycle, last: bool, bounds: Outermost):
    """Extremal orbits with a free part, where they can be had without a search.

    Returns, for n cycles: a certified orbit of each (x NaN where there is none), its sequence (``""`` if none), which are proven extremal,
    which cycles are proven to have no such orbit at all, and the evaluations spent. ``bounds`` on all orbits hold for ``last=False`` only.
    """
    n = cycle.size
    found = Orbit.blank(n)
    sequences, proven, spent = np.full(n, "", dtype="<U4"), np.zeros(n, bool), np.zeros(n)
    s = cycle.strips
    arc = cycle.half_d > 0
    if last:
        # next to saturated contact a less engaged orbit is rare: ask the search, which sees that first
        possible = arc & (s.D - 1 + s.p_0 < kernel.modulus_ratio(s.alpha, s.beta))
    else:
        possible = arc & ~bounds.missed
    attempts = [("acaf", possible & ~cycle.direct), ("afc", possible & cycle.direct)]
    if last:
        attempts.append(("af", possible & ~cycle.direct))
    for sequence, kind in attempts:
        pick = np.flatnonzero(kind & ~proven)
        if not pick.size:
            continue
        part, limits = cycle.take(pick), bounds.take(pick)
        orbit, good, used = certified(kernel, part, sequence, limits)
        spent[pick] += used
        here = np.flatnonzero(good)
        if not here.size:
            continue
        sure, used = alone(kernel, part.take(here), orbit.take(here), last, limits.take(here))
        pick = pick[here]
        spent[pick] += used
        # of two orbits that are known the more extremal one is worth keeping
        nearer = ~(found.x[pick] >= orbit.x[here]) if last else ~(found.x[pick] <= orbit.x[here])
        keep = np.flatnonzero(sure | nearer)
        found.put(pick[keep], orbit.take(here[keep]))
        sequences[pick[keep]] = sequence
        proven[pick] |= sure
    return found, sequences, proven, ~arc | bounds.missed, spent
