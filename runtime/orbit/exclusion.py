"""Proof without a march that no more extremal orbit exists beside one that is known.

Unloading. A more engaged orbit has an earlier onset, so the unloading orbit at x* is proven by excluding zeros of r between the
earliest onset and x*. It is enough that R falls strictly (``sensitivity.steep_margin``) all along from the onset before which
bounds on all orbits (``orbit_bounds``) leave none.

Loading, of a strip within reach, ``D > -delta_0``. A less engaged orbit has a later onset. None has the last one, x_e, nor does
the map lead on beyond it: there ``H = -delta_0``, so ``z = u + delta_0 = beta sin x_e > 0``, and H is less until the next arc of
onsets, so that contact, with ``alpha p' + p = H`` and p <= 0 as it begins, has p < 0 like adhesion, and ``beta z' + z = L p``:
z has fallen when x_e comes round again, and r < 0. Now R falls at a stable orbit and ends below zero. Where the slope T' of the
onset map grows up to x_e (``sensitivity.slope_grows``), R falls first and rises then: it is negative in between. It is enough if
R falls strictly up to where T' grows; or up to an onset before which all orbits have theirs. (From the least engaged state that
``orbit_bounds`` follows contact is certain, and so from all onsets before its own: adhesion ends after its.)

What is not proven here is left to ``search``; nothing is ever accepted for lack of a counterexample.
"""

import numpy as np

from .groups import Cycle
from .march import Orbit
from .orbit_bounds import OrbitBounds, bounds_beside
from .sensitivity import contact_length, slope_grows, steep_margin


def is_extremal(kernel, cycle: Cycle, orbit: Orbit, bounds: OrbitBounds, last: bool) -> np.ndarray:
    """Which orbits are proven to be the first (``last``: last) of their onset arc.

    ``bounds`` get an onset where they had none.
    """
    proven = falls_from(kernel, cycle, orbit, bounds.x, bounds.c, last)
    if last:
        return proven | slope_grows(kernel, cycle, orbit)
    rest = np.flatnonzero(~proven & np.isnan(bounds.x))
    if rest.size:
        part, known = cycle.among(rest), orbit.take(rest)
        beside = bounds_beside(kernel, part, known)
        proven[rest] = falls_from(kernel, part, known, beside.x, beside.c)
        bounds.x[rest] = beside.x
    return proven


def falls_from(kernel, cycle: Cycle, known: Orbit, x, c, last: bool = False) -> np.ndarray:
    """Where no zero of r lies between the known onset and ``x`` (NaN: unknown), before which (``last``: after which) there is
    none; ``c`` bounds the end of adhesion."""
    if np.isnan(x).all():
        return np.zeros(cycle.size, bool)
    half = falling_arc(kernel, cycle, known, c, last)
    # behind the centre of the arc, with c before the middle of its own, T' grows
    beyond = (x <= cycle.centre + half) | (known.c <= cycle.centre + np.pi) if last else cycle.centre - half <= x
    return np.isfinite(x) & (np.abs(known.x - cycle.centre) < half) & beyond


def falling_arc(kernel, cycle: Cycle, known: Orbit, c, last: bool) -> np.ndarray:
    """Half the width of the arc, about its centre, in which R falls strictly at every onset before (``last``: after) the known
    one from which adhesion does not end beyond ``c``; below zero if there is none. F exceeds ``steep_margin`` there."""
    s = cycle.strips
    # a later onset may make no contact
    shortest = np.zeros(cycle.size) if last else contact_length(known.b, known.a)
    margin = s.noise() + steep_margin(kernel, cycle, known.c, c, shortest)
    sure = np.isfinite(margin)
    return np.where(sure, kernel.forcing_arc(s.delta_0 - np.where(sure, margin, 0.0), s.D, s.beta)[1], -1.0)
