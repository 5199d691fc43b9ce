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

The phases are solved for roughly. Each is replaced by one that is further off, verified by the sign of an event: contact or
adhesion that is held longer (shorter) only leaves the state more (less) engaged than it is.
"""

from dataclasses import dataclass

import numpy as np

from ..numerics.roots import falling_root
from ..numerics.rounding import EPS
from .batch import Batch
from .groups import ROUNDING, Cycle
from .march import TWO_PI, Event

#: beta above which a foundation remembers too much of the most engaged state for bounds from it to say much, unless adhesion
#: moves it by more than the amplitude in a period: the balance of one (``balance``) is asked instead. 30 to 300 cost about the
#: same
FAST = 60.0
#: distance from the edges themselves at which their bounds are close enough
_CLOSE = 0.003


@dataclass(slots=True)
class OrbitBounds(Batch):
    """Bounds on all orbits of n cycles, arrays (n,): contact ends before ``a``, adhesion before ``c`` and begins after ``x``
    (NaN: no bound); of ``least_engaged_bounds``: after, after and before.

    ``released``: no orbit is always engaged. ``missed``: none has an onset. ``evaluations``: of events.
    """

    x: np.ndarray
    a: np.ndarray
    c: np.ndarray
    released: np.ndarray
    missed: np.ndarray
    evaluations: np.ndarray

    @classmethod
    def blank(cls, n: int) -> "OrbitBounds":
        """No bounds."""
        return cls(*(np.full(n, np.nan) for _ in range(3)), np.zeros(n, bool), np.zeros(n, bool), np.zeros(n))


def orbit_bounds(kernel, cycle: Cycle) -> OrbitBounds:
    """Bounds for cycles of strips that are not in saturated contact."""
    out = OrbitBounds.blank(cycle.size)
    index = np.flatnonzero((cycle.half_b > 0) & (cycle.half_b < np.pi))
    if not index.size:
        return out
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        part = cycle.among(index)
        a, spent = _contact_end(kernel, part, part.centre - part.half_b)
        out.evaluations[index] += spent
        go = np.flatnonzero(np.isfinite(a))
        index, part, a = index[go], part.among(go), a[go]
        c, _, spent = _adhesion_end(kernel, part, a, 0.0, 1.0)
        out.evaluations[index] += spent
        go = np.flatnonzero(np.isfinite(c))
        index, part, a, c = index[go], part.among(go), a[go], c[go]
        out.a[index], out.c[index], out.released[index] = a, c, True
        out.x[index], out.missed[index], spent = earliest_onset(kernel, part, c)
        out.evaluations[index] += spent
    return out


def least_engaged_bounds(kernel, cycle: Cycle) -> OrbitBounds:
    """Bounds from the least engaged state of an orbit with an onset, for cycles of strips within reach, ``D > -delta_0``."""
    s, touched = cycle.strips, cycle.touched
    reach = 0.5 * (s.D + s.delta_0 - s.noise())
    at_rest = -2 * np.arcsin(np.sqrt(np.clip(reach, 0.0, 1.0)))
    a = cycle.centre + cycle.half_b
    start = np.where(touched, a, np.maximum(a, at_rest))
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        gap = np.where(touched, 0.0, np.maximum(kernel.gap_after(at_rest, start, cycle.gap_on, -s.p_0, s.D, s.beta), 0.0))
        c, stays, spent = _adhesion_end(kernel, cycle, start, gap, -1.0)
        c = np.fmax(c, np.maximum(start, cycle.centre + cycle.half_c))
        x, used = _next_onset(kernel, cycle, c, 1.0)
    x = np.fmin(x - TWO_PI, np.where(touched, np.nan, at_rest))
    missed = stays | (cycle.half_b >= np.pi) | (~touched & (reach > 1))
    return OrbitBounds(x, a, c, np.zeros(cycle.size, bool), missed, spent + used)


def earliest_onset(kernel, cycle: Cycle, c):
    """Onsets (less 2 pi) before the next one of cycles released at c, NaN where none was found.

    Also which cycles miss it, and the evaluations spent.
    """
    s = cycle.strips
    entry = kernel.gap_entry(c, s.delta_0 + cycle.jump, 0.0, s.D, s.beta)
    low = np.maximum(cycle.centre + TWO_PI - cycle.half_d, c)
    high = np.maximum(cycle.centre + TWO_PI + cycle.half_d, low)
    missed = kernel.gap_event(high, *entry)[0] - s.delta_0 > s.noise()
    # a surface out of reach of the undeformed foundation is not met if nothing is left of w that would change its gap
    left = np.abs(kernel.profile(c, s.D) + s.delta_0 + cycle.jump) * kernel.decay(low - c, s.beta)
    missed |= (s.D <= -s.delta_0) & (left < 0.25 * EPS * s.delta_0)
    x, spent = _next_onset(kernel, cycle, c, -1.0)
    return np.where(missed, np.nan, x - TWO_PI), missed, spent + 1


def _contact_end(kernel, cycle: Cycle, b):
    """Phases behind the end of contact begun at b, NaN where none was found, and the evaluations spent."""
    s = cycle.strips
    entry = kernel.excess_entry(b, cycle.q_on, s.p_0, s.D, s.alpha, s.beta, s.L)
    low, high = cycle.centre + cycle.half_b, cycle.centre + TWO_PI - cycle.half_b
    return _beyond(Event(kernel.excess_event, entry), low, low, high, 1.0, s.noise() + ROUNDING * entry[4])


def _adhesion_end(kernel, cycle: Cycle, a, gap, side: float):
    """Phases behind (``side`` 1) or before (-1) the end of adhesion from a ``gap`` at a, NaN where none was found.

    Also which cycles are certain to stay engaged, and the evaluations spent.
    """
    s, spent = cycle.strips, np.ones(cycle.size)
    low = np.maximum(a, cycle.centre + cycle.half_c)
    high = np.maximum(low, cycle.centre + TWO_PI - cycle.half_c)
    closed = Event(kernel.gap_event, kernel.gap_entry(a, gap, -s.p_0, s.D, s.beta), s.delta_0, -1.0)
    over = -closed(high, np.arange(cycle.size))[0]
    c, noise = np.full(cycle.size, np.nan), s.noise()
    ask = np.flatnonzero((low < high) & (over > noise))
    # of a foundation that stands still
    start = np.arccos(np.clip(np.cos(a) - s.delta_0, -1.0, 1.0))[ask]
    c[ask], used = _beyond(closed.take(ask), start, low[ask], high[ask], side, noise[ask])
    spent[ask] += used
    return c, over < -noise, spent


def _next_onset(kernel, cycle: Cycle, c, side: float):
    """Phases behind (``side`` 1) or before (-1) the next onset of cycles released at c, NaN where none was found, and the
    evaluations spent."""
    s = cycle.strips
    entry = kernel.gap_entry(c, s.delta_0 + cycle.jump, 0.0, s.D, s.beta)
    low = np.maximum(cycle.centre + TWO_PI - cycle.half_d, c)
    high = np.maximum(cycle.centre + TWO_PI + cycle.half_d, low)
    # of a foundation that stands still
    start = TWO_PI - np.arccos(np.clip(np.cos(c) + cycle.jump, -1.0, 1.0))
    return _beyond(Event(kernel.gap_event, entry, s.delta_0), start, low, high, side, s.noise())


def _beyond(event: Event, start, low, high, side: float, noise):
    """Phases behind (``side`` 1) or before (-1) the zeros through which events fall between ``low`` and ``high``, not far from
    them if possible, NaN where none is verified; and the evaluations spent. ``start``: about where they fall."""
    x, spent = falling_root(event, low, high, start, _CLOSE)
    found = np.full(x.size, np.nan)
    for further in (1, 10, np.inf):
        phase = np.clip(x + side * further * _CLOSE, low, high)
        ask = np.flatnonzero(np.isnan(found))
        if ask.size:
            good = side * event(phase[ask], ask)[0] < -noise[ask]
            spent[ask] += 1
            found[ask[good]] = phase[ask[good]]
    return found, spent
