"""What no orbit of a strip can exceed: bounds from the most engaged state that it can be in without being in contact all the
time, and from the least engaged one.

Contact is left where ``H + p_0 <= 0`` and made where ``H + p_0 >= 0`` (a snap into contact: where ``H + delta_0 >= 0``, and
``p_0 > delta_0``). So every orbit but saturated contact is in a gap at the phase where ``H + p_0`` turns positive, and there
nothing is more engaged than a gap that has just closed: engaged, with the least ``z = w - J_0 p``. (A free state has
``z = w > u + delta_0``, more than the ``u + J_0 p_0`` of that one where it does not snap. Where it does, the state just after the
snap, ``z = u + delta_0`` in contact, is more engaged than any in a gap.) The order of states is kept in time. Hence, if from that
state contact ends at a, adhesion ends at c and the next onset is met at x, then in every orbit contact and adhesion end before a
and c, so that

* no orbit is always engaged,
* every onset lies after x, and
* there is no onset, hence no orbit with one, if x does not exist.

On the other side, in a gap ``z = w - J_0 p`` rises only where it is negative, and contact has ``z <= u + J_0 p_0``. So no orbit
has ``z > max(D + J_0 p_0, 0)``. (Where w is continuous where p steps, read w for z, and 0 for J_0.)

* Where ``D <= -J_0 p_0`` a free state has ``w <= 0``: every onset lies before the one of a foundation at rest. If the gap closes
  after that, it is so still where ``H + p_0`` turns negative: there it is that of adhesion alone, or none.
* Where ``D > -J_0 p_0`` a gap at the crest would have to be negative: every orbit with an onset is in contact there (one that
  snaps into contact is in contact anyway), and stays so at least until ``H + p_0`` turns negative.

From the gap there adhesion ends at c and the next onset is met at x: in every orbit adhesion ends after c, every onset lies
before x, and there is none if c does not exist.

Beside a known orbit y there is a state nearer to all of them. Without release the period map E is convex in z, as
w is the larger of u and ``z - J p_0``, and keeps order. So its one fixed point, the orbit that is always engaged, as if gaps had
no limit, is more engaged than every orbit, and a step of Newton's method from any state ends at one that is more engaged still.
From y that step is closed form. E differs from the period of y by adhesion that is not released in the free zone, of length F:

    E(y) - y = -(p_0 - chi J p_0) (1 - exp(-F/beta)),   E' = exp(-2 pi/beta - (a - b) L/alpha),

so that z is less than that of y by ``(y - E(y))/(1 - E')``. As contact begins in y, after that has faded over the first adhesion,
the excess pressure is more by this over J; where y has no contact, by what is more than its gap where ``H + p_0`` turns negative.

The phases are solved for roughly. Each is replaced by one that is further off, verified by the sign of an event: contact or
adhesion that is held longer (shorter) only leaves the state more (less) engaged than it is.
"""

from dataclasses import dataclass

import numpy as np

from ..numerics.roots import falling_root
from ..numerics.rounding import EPS
from .batch import Batch
from .groups import ROUNDING, Cycle, arc_versine
from .march import TWO_PI, Event, Orbit
from .sensitivity import contact_length, fading

#: beta above which a foundation remembers too much of the most engaged state for bounds from it to say much, unless adhesion
#: moves it by more than the amplitude in a period. 30 to 300 cost about the same
FAST = 60.0
#: distance from the edges themselves at which their bounds are close enough
_CLOSE = 0.003


@dataclass(slots=True)
class OrbitBounds(Batch):
    """Bounds on all orbits of n cycles, arrays (n,): contact ends before ``a``, adhesion before ``c`` and begins after ``x``
    (NaN: no bound); of ``least_engaged_bounds``: after, after and before.

    ``released``: no orbit is always engaged. ``missed``: none has an onset.
    """

    x: np.ndarray
    a: np.ndarray
    c: np.ndarray
    released: np.ndarray
    missed: np.ndarray

    @classmethod
    def blank(cls, n: int) -> "OrbitBounds":
        """No bounds."""
        return cls(*(np.full(n, np.nan) for _ in range(3)), np.zeros(n, bool), np.zeros(n, bool))


def orbit_bounds(kernel, cycle: Cycle, slowest: float = np.inf) -> OrbitBounds:
    """Bounds for cycles of strips that are not in saturated contact, up to the beta ``slowest`` (see ``FAST``)."""
    s, out = cycle.strips, OrbitBounds.blank(cycle.size)
    says = s.beta <= np.maximum(slowest, TWO_PI * s.p_0)
    index = np.flatnonzero(says & (cycle.half_b > 0) & (cycle.half_b < np.pi))
    if not index.size:
        return out
    part = cycle.among(index)
    _follow(kernel, part, part.centre - part.half_b, part.q_on, part.centre + part.half_b, index, out)
    return out


def bounds_beside(kernel, cycle: Cycle, known: Orbit) -> OrbitBounds:
    """Bounds for cycles with ``known`` orbits."""
    s, out, contact = cycle.strips, OrbitBounds.blank(cycle.size), ~np.isnan(known.b)
    b = np.where(contact, known.b, np.maximum(known.x, cycle.centre + cycle.half_b))
    with np.errstate(all="ignore"):
        change = (s.p_0 - cycle.jump) * kernel.decay_loss(known.x + TWO_PI - known.c, s.beta) - s.noise()
        less = change / np.expm1(-fading(cycle, contact_length(known.b, known.a))) * kernel.decay(b - known.x, s.beta)
        gap = np.where(contact, 0.0, kernel.gap_after(known.x, b, cycle.gap_on, -s.p_0, s.D, s.beta))
        # without instantaneous compliance pressure has no memory
        more = np.divide(np.maximum(less - gap, 0.0), s.J, out=np.zeros(cycle.size), where=s.J > 0)
    _follow(kernel, cycle, b, cycle.q_on + more, np.where(contact, known.a, b), np.arange(cycle.size), out)
    return out


def _follow(kernel, cycle: Cycle, b, q_on, a, index, out: OrbitBounds) -> None:
    """Follow contact that begins at b with ``q_on`` and ends about a to the next onset; bounds go to the elements ``index`` of
    ``out``."""
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        a = _contact_end(kernel, cycle, b, q_on, a)
        go = np.flatnonzero(np.isfinite(a))
        index, cycle, a = index[go], cycle.among(go), a[go]
        c, _ = _adhesion_end(kernel, cycle, a, 0.0, 1.0)
        go = np.flatnonzero(np.isfinite(c))
        index, cycle, a, c = index[go], cycle.among(go), a[go], c[go]
        out.a[index], out.c[index], out.released[index] = a, c, True
        out.x[index], out.missed[index] = next_onset(kernel, cycle, c, -1.0)


def least_engaged_bounds(kernel, cycle: Cycle) -> OrbitBounds:
    """Bounds from the least engaged state of an orbit with an onset, for cycles of strips within reach, ``D > -delta_0``."""
    s, touched = cycle.strips, cycle.touched
    reach = s.D + s.delta_0 - s.noise()
    at_rest = -arc_versine(reach)
    a = cycle.centre + cycle.half_b
    start = np.where(touched, a, np.maximum(a, at_rest))
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        gap = np.where(touched, 0.0, np.maximum(kernel.gap_after(at_rest, start, cycle.gap_on, -s.p_0, s.D, s.beta), 0.0))
        c, stays = _adhesion_end(kernel, cycle, start, gap, -1.0)
        c = np.fmax(c, np.maximum(start, cycle.centre + cycle.half_c))
        x, _ = next_onset(kernel, cycle, c, 1.0)
    x = np.fmin(x, np.where(touched, np.nan, at_rest))
    missed = stays | (cycle.half_b >= np.pi) | (~touched & (reach > 2))
    return OrbitBounds(x, a, c, np.zeros(cycle.size, bool), missed)


def next_onset(kernel, cycle: Cycle, c, side: float):
    """Onsets (less 2 pi) behind (``side`` 1) or before (-1) the next one of cycles released at c, NaN where none was found.

    Also which cycles miss it (asked for -1).
    """
    s = cycle.strips
    closes = Event(kernel.gap_event, kernel.gap_entry(c, s.delta_0 + cycle.jump, 0.0, s.D, s.beta), s.delta_0)
    low = np.maximum(cycle.centre + TWO_PI - cycle.half_d, c)
    high = np.maximum(cycle.centre + TWO_PI + cycle.half_d, low)
    # of a foundation that stands still
    start = TWO_PI - np.arccos(np.clip(np.cos(c) + cycle.jump, -1.0, 1.0))
    x = _beyond(closes, start, low, high, side, s.noise())
    missed = np.zeros(cycle.size, bool)
    if side < 0:
        missed = closes(high, np.arange(cycle.size))[0] > s.noise()
        # a surface out of reach of the undeformed foundation is not met if nothing is left of w that would change its gap
        left = np.abs(kernel.profile(c, s.D) + s.delta_0 + cycle.jump) * kernel.decay(low - c, s.beta)
        missed |= (s.D <= -s.delta_0) & (left < 0.25 * EPS * s.delta_0)
        x = np.where(missed, np.nan, x)
    return x - TWO_PI, missed


def _contact_end(kernel, cycle: Cycle, b, q_on, low):
    """Phases behind the end of contact begun at b with ``q_on``, NaN where none was found. It does not end before
    ``low``."""
    s = cycle.strips
    entry = kernel.excess_entry(b, q_on, s.p_0, s.D, s.alpha, s.beta, s.L)
    high = cycle.centre + TWO_PI - cycle.half_b
    return _beyond(Event(kernel.excess_event, entry), low, low, high, 1.0, s.noise() + ROUNDING * entry[4])


def _adhesion_end(kernel, cycle: Cycle, a, gap, side: float):
    """Phases behind (``side`` 1) or before (-1) the end of adhesion from a ``gap`` at a, NaN where none was found.

    Also which cycles are certain to stay engaged.
    """
    s = cycle.strips
    low = np.maximum(a, cycle.centre + cycle.half_c)
    high = np.maximum(low, cycle.centre + TWO_PI - cycle.half_c)
    closed = Event(kernel.gap_event, kernel.gap_entry(a, gap, -s.p_0, s.D, s.beta), s.delta_0, -1.0)
    over = -closed(high, np.arange(cycle.size))[0]
    c, noise = np.full(cycle.size, np.nan), s.noise()
    ask = np.flatnonzero((low < high) & (over > noise))
    # of a foundation that stands still
    start = np.arccos(np.clip(np.cos(a) - s.delta_0, -1.0, 1.0))[ask]
    c[ask] = _beyond(closed.take(ask), start, low[ask], high[ask], side, noise[ask])
    return c, over < -noise


def _beyond(event: Event, start, low, high, side: float, noise):
    """Phases behind (``side`` 1) or before (-1) the zeros through which events fall between ``low`` and ``high``, not far from
    them if possible, NaN where none is verified. ``start``: about where they fall."""
    x = falling_root(event, low, high, start, _CLOSE)
    found, ask = np.full(x.size, np.nan), np.arange(x.size)
    for further in (1, 10, np.inf):
        phase = np.minimum(np.maximum(x[ask] + side * further * _CLOSE, low[ask]), high[ask])
        good = side * event(phase, ask)[0] < -noise[ask]
        found[ask[good]], ask = phase[good], ask[~good]
        if not ask.size:
            break
    return found
