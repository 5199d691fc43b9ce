"""Newton on the boundary equations of a regime from a good orbit, and when its answer counts as converged."""

import numpy as np

from ..numerics.rounding import EPS
from .certificate import STABLE
from .chain import CONVERGED, tighten
from .groups import Cycle
from .march import Orbit
from .polish import polish
from .regimes import EQUATIONS
from .solved import edges_of, orbit_of

#: corrections may be this many times what rounding leaves uncertain
_ROUNDINGS = 32


def refined(kernel, sequence: str, cycle: Cycle, orbit: Orbit, ends=None, blurred: bool = True):
    """The orbit with its edges refined, whether nothing was left to correct, how far rounding may have moved the edges where it
    blurs them (else 0), and the evaluations it took.

    ``ends``: orbits from an earlier and a later onset, between whose edges those of this one lie. ``blurred``: corrections that
    rounding blurs may be larger.
    """
    bounds = (-np.inf, np.inf)
    if ends is not None:
        one, two = (edges_of(sequence, end) for end in ends)
        bounds = np.minimum(one, two), np.maximum(one, two)
    # the cycle of an always adhering strip is the bare one, shifted: its boundary equations are those of "ac" at p_0 = 0
    found = polish(kernel, EQUATIONS[sequence], cycle.strips, edges_of(sequence, orbit), bounds)
    limit = np.where(blurred & found.stalled, _ROUNDINGS * np.minimum(found.attainable, STABLE), 0.0)
    edges, correction = found.edges, found.correction
    if sequence in ("ac", "cf"):
        loose = np.flatnonzero((correction <= CONVERGED + limit) & (found.attainable > EPS * (_ROUNDINGS + cycle.strips.beta)))
        if loose.size:
            closer, last = tighten(kernel, cycle.take(loose), sequence, edges[:, loose])
            moved = np.abs(closer - edges[:, loose]).max(axis=0)
            better = (last < found.attainable[loose]) & (moved <= _ROUNDINGS * found.attainable[loose])
            edges[:, loose[better]], correction[loose[better]] = closer[:, better], last[better]
    return orbit_of(sequence, edges), correction <= CONVERGED + limit, limit, found.evaluations
