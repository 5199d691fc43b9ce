"""What no orbit of a strip can exceed: bounds from the most engaged state short of contact all the time, and the least engaged.

Contact is left where ``H + p_0 <= 0`` and made where ``H + p_0 >= 0`` (a snap into contact: where ``H + delta_0 >= 0``, and
``p_0 > delta_0``). So every orbit but saturated contact is in a gap at the phase where ``H + p_0`` turns positive, and there
nothing is more engaged than a gap that has just closed: engaged, with the least ``z = w - J_0 p``. (A free state has
``z = w > u + delta_0``, more than the ``u + J_0 p_0`` of that one where it does not snap. Where it does, the state just after the
snap, ``z = u + delta_0`` in contact, is more engaged than any in a gap.) The order of states is kept in time. Hence, if from that
state contact ends at a, adhesion ends at c and the next onset is met at x, then in every orbit contact and adhesion end before a
and c: no orbit is always engaged, every onset lies after x, and there is none, hence no orbit with one, if x does not exist.

On the other side, in a gap ``z = w - J_0 p`` rises only where it is negative, and contact has ``z <= u + J_0 p_0``. So no orbit
has ``z > max(D + J_0 p_0, 0)``. (Where w is continuous where p steps, read w for z, and 0 for J_0.)

* Where ``D <= -J_0 p_0`` a free state has ``w <= 0``: every onset lies before the one of a foundation at rest. If the gap closes
  after that, it is so still where ``H + p_0`` turns negative: there it is that of adhesion alone, or none.
* Where ``D > -J_0 p_0`` a gap at the crest would have to be negative: every orbit with an onset is in contact there (one that
  snaps into contact is in contact anyway), and stays so at least until ``H + p_0`` turns negative.

From the gap there adhesion ends at c and the next onset is met at x: in every orbit adhesion ends after c, every onset lies
before x, and there is none if c does not exist.

Nor is any orbit more engaged than the one that would be engaged all along if gaps had no limit. Adhesion that is not released
leaves every state more engaged after a period, so that an orbit's states rise, period by period, to those of that one: from the
end of its contact adhesion ends and the next onset is met as above. Where ``D <= -p_0`` that one has no contact: it adheres all
along at ``w = -p_0``, and its gap is known at the crest.

Each phase that is followed is further off than the event, by the sign of its function, whatever rounding does to that: contact or
adhesion that is held longer (shorter) only leaves the state more (less) engaged than it is. Bounds come as orbits: contact ends
before ``a``, adhesion before ``c`` and begins after ``x`` (NaN: no bound; inf: there is no onset); ``engaged`` where an orbit may
be so all along. Of ``least_engaged_bounds``: after, after and before (-inf: no onset).

That no orbit is more extremal than one that is known is proven without a march (``is_extremal``), or left to ``search``.
Unloading. A more engaged orbit has an earlier onset, so the unloading orbit at x* is proven by excluding zeros of r before x*. It
is enough that R falls strictly (``sensitivity.falls``) from the onset on before which bounds on all orbits leave none.

Loading, of a strip within reach, ``D > -delta_0``. A less engaged orbit has a later onset. None has the last one, x_e, nor does
the map lead on beyond it: there ``H = -delta_0``, so ``z = u + delta_0 = beta sin x_e > 0``, and H is less until the next arc of
onsets, so that contact, with ``alpha p' + p = H`` and p <= 0 as it begins, has p < 0 like adhesion, and ``beta z' + z = L p``:
z has fallen when x_e comes round again, and r < 0. Now R falls at a stable orbit and ends below zero. Where the slope T' of the
onset map grows up to x_e (``sensitivity.slope_grows``), R falls first and rises then: it is negative in between. It is also
enough if R falls strictly up to an onset before which all orbits have theirs. (From the least engaged state contact is certain,
and so from all onsets before its own: adhesion ends after its.)
"""

import numpy as np

from .groups import TWO_PI, Cycle, arc_versine
from .march import Orbit, adhesion_end, contact_end, next_onset
from .sensitivity import falls, slope_grows

#: beta above which bounds from the most engaged state say little, unless adhesion pulls hard: 30 to 300 cost about the same
_FAST = 60.0


def orbit_bounds(kernel, cycle: Cycle, slowest: float = _FAST) -> Orbit:
    """Bounds for cycles of strips not in saturated contact; up to the beta ``slowest``, but where ``D <= -p_0``."""
    s, out = cycle.strips, Orbit.blank(cycle.size, engaged=True)
    hangs, arc = s.D <= -s.p_0, (cycle.half_b > 0) & (cycle.half_b < np.pi)
    index = np.flatnonzero(hangs | (arc & (s.beta <= np.maximum(slowest, TWO_PI * s.p_0))))
    if index.size:
        part, hangs = cycle.among(index), hangs[index]
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            begins = np.where(hangs, np.nan, part.centre - part.half_b)
            a = contact_end(kernel, part, begins, part.q_on, 1, part.centre + part.half_b)
        # without contact, at the crest
        gap = np.where(hangs, np.minimum(-part.strips.D - part.strips.p_0, part.strips.delta_0), 0.0)
        out.put(index, bounds_after_contact(kernel, part, np.where(hangs, 0.0, a), gap))
    return out


def bounds_after_contact(kernel, cycle: Cycle, a, gap) -> Orbit:
    """Bounds for cycles of which it is known that in every orbit contact ends before ``a``, with this ``gap`` there or more."""
    out = Orbit.blank(cycle.size, engaged=True)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        out.a, out.c = a, adhesion_end(kernel, cycle, a, gap, 1)
        out.engaged = np.isnan(out.c)
        go = np.flatnonzero(~out.engaged)
        out.x[go] = np.nan_to_num(next_onset(kernel, cycle.among(go), out.c[go], -1), nan=np.inf)
    return out


def least_engaged_bounds(kernel, cycle: Cycle) -> Orbit:
    """Bounds from the least engaged state of an orbit with an onset, for cycles of strips within reach, ``D > -delta_0``."""
    s, touched, out = cycle.strips, cycle.touched, Orbit.blank(cycle.size, engaged=True)
    reach = s.D + s.delta_0 - s.noise()
    at_rest = -arc_versine(reach)
    out.a = cycle.centre + cycle.half_b
    start = np.where(touched, out.a, np.maximum(out.a, at_rest))
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        gap = np.where(touched, 0.0, np.maximum(kernel.gap_after(at_rest, start, cycle.gap_on, -s.p_0, s.D, s.beta), 0.0))
        out.c = adhesion_end(kernel, cycle, start, gap, -1)
        missed = np.isnan(out.c) | (cycle.half_b >= np.pi) | (~touched & (reach > 2))
        go = np.flatnonzero(~missed)
        out.c[go] = np.maximum(out.c, np.maximum(start, cycle.centre + cycle.half_c))[go]
        x = next_onset(kernel, cycle.among(go), out.c[go], 1)
    out.x[missed], out.x[go] = -np.inf, np.fmin(x, np.where(touched, np.nan, at_rest)[go])
    return out


def is_extremal(kernel, cycle: Cycle, orbit: Orbit, bounds: Orbit, last: bool) -> np.ndarray:
    """Which orbits are proven by ``bounds`` on all to be the first (``last``: last) of their onset arc."""
    if last:
        return falls(kernel, cycle, orbit, bounds) | slope_grows(kernel, cycle, orbit)
    return falls(kernel, cycle, bounds, orbit)
