"""Newton on the boundary equations of a regime from a good orbit, and when its answer counts as converged."""

import numpy as np

from .march import Orbit
from .polish import polish
from .problem import Cycle
from .solved import edges_of, orbit_of

#: Largest correction that an orbit may still ask for: this much, or this many times what rounding leaves uncertain, which
#: itself must not be worse than near a fold.
CONVERGED, _ROUNDINGS, _COARSEST = 1e-13, 32, 1e-6


def refined(kernel, sequence: str, cycle: Cycle, orbit: Orbit, ends=None, blurred: bool = True) -> tuple[Orbit, np.ndarray, np.ndarray]:
    """The orbit with its edges refined, whether nothing was left to correct, and the evaluations it took.

    ``ends``: orbits from an earlier and a later onset, between whose edges those of this one lie. ``blurred``: corrections that
    rounding blurs may be larger.
    """
    bounds = (-np.inf, np.inf)
    if ends is not None:
        one, two = (edges_of(sequence, end) for end in ends)
        bounds = np.minimum(one, two), np.maximum(one, two)
    # the cycle of an always adhering strip is the bare one, shifted: its boundary equations are those of "ac" at p_0 = 0
    found = polish(kernel, "ac" if sequence == "cf" else sequence, cycle.strips, edges_of(sequence, orbit), bounds)
    limit = np.where(blurred & found.stalled, _ROUNDINGS * np.minimum(found.attainable, _COARSEST), 0.0)
    new = orbit_of(sequence, found.edges)
    return new, found.correction <= CONVERGED + limit, found.evaluations
