"""Proof without a march that no more extremal orbit exists beside one that is known.

Unloading. A more engaged orbit has an earlier onset, so the unloading orbit at x* is proven by excluding zeros of r between the
earliest onset and x*. It is enough that R falls strictly (``sensitivity.falls``) all along from the onset before which
bounds on all orbits (``orbit_bounds``) leave none.

Loading, of a strip within reach, ``D > -delta_0``. A less engaged orbit has a later onset. None has the last one, x_e, nor does
the map lead on beyond it: there ``H = -delta_0``, so ``z = u + delta_0 = beta sin x_e > 0``, and H is less until the next arc of
onsets, so that contact, with ``alpha p' + p = H`` and p <= 0 as it begins, has p < 0 like adhesion, and ``beta z' + z = L p``:
z has fallen when x_e comes round again, and r < 0. Now R falls at a stable orbit and ends below zero. Where the slope T' of the
onset map grows up to x_e (``sensitivity.slope_grows``), R falls first and rises then: it is negative in between. It is also
enough if R falls strictly up to an onset before which all orbits have theirs. (From the least engaged state that
``orbit_bounds`` follows contact is certain, and so from all onsets before its own: adhesion ends after its.)

What is not proven here is left to ``search``; nothing is ever accepted for lack of a counterexample.
"""

import numpy as np

from .groups import Cycle
from .march import Orbit
from .orbit_bounds import bounds_beside
from .sensitivity import falls, slope_grows


def is_extremal(kernel, cycle: Cycle, orbit: Orbit, bounds: Orbit, last: bool) -> np.ndarray:
    """Which orbits are proven to be the first (``last``: last) of their onset arc.

    ``bounds`` (``orbit_bounds``) are set where there were none.
    """
    if last:
        return falls(kernel, cycle, orbit, bounds) | slope_grows(kernel, cycle, orbit)
    proven = falls(kernel, cycle, bounds, orbit)
    rest = np.flatnonzero(~proven & np.isnan(bounds.x))
    if rest.size:
        part, known = cycle.among(rest), orbit.among(rest)
        beside = bounds_beside(kernel, part, known)
        proven[rest] = falls(kernel, part, beside, known)
        bounds.put(rest, beside)
    return proven
