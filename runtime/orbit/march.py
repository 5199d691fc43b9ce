"""One period of a material point from an onset phase: the edges it meets and how far it misses a periodic orbit.

The march is the return map of the strip on the phase x of its onset. It is not iterated: its sign, and bounds on its
slope, drive the search for the extremal orbit (``search``).

Every event of a strip (gap closes, gap reaches delta_0, pressure falls to -p_0) is a zero of a function F with
``F + T F' = one harmonic of the phase``. At a zero the slope of F has the sign of that harmonic, so F crosses zero at most once
inside the arc where the harmonic keeps its sign: the arc is a bracket, in which safeguarded Newton cannot find a wrong zero.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..numerics.roots import falling_root
from ..numerics.rounding import EPS
from .batch import Batch, pick
from .groups import ROUNDING, TWO_PI, Cycle
from .regimes import ORBIT_EDGES

#: edges this close to the crest are on it: the bracket of one that is on it would be halved a thousand times
LEAST_PHASE = 1e-60
#: how closely extremes are placed, radians: their values are off by the square
_PLACED = 1e-9
#: how closely edges are located for bounds of them, which are ten times further off: so close that starts from them converge
_CLOSE = 1e-6


@dataclass(slots=True)
class Orbit(Batch):
    """A march from the onset x; arrays of shape (n,).

    Attributes:
        x: onset phase. b, a, c: edges met (contact begins, contact ends, adhesion ends); NaN where absent.
        engaged: still in contact or adhesion when the onset phase comes round again; then r is -inf.
        r: gap to the threshold of the next onset at ``x + 2 pi``; positive: the next onset comes later than x,
            negative: it came earlier, zero: x belongs to a periodic orbit.
    """

    x: np.ndarray
    b: np.ndarray
    a: np.ndarray
    c: np.ndarray
    engaged: np.ndarray
    r: np.ndarray

    @classmethod
    def blank(cls, n: int, engaged: bool = False) -> Orbit:
        """n places for orbits, none of them known, or for bounds on them."""
        return cls(*np.full((4, n), np.nan), np.full(n, engaged), np.full(n, np.nan))

    @classmethod
    def of(cls, sequence: str, edges: np.ndarray) -> Orbit:
        """The periodic orbits of a ``sequence`` with these edges, (k, n) in the order of ``regimes.ORBIT_EDGES``."""
        out = cls.blank(edges.shape[1])
        places = {"acaf": (0, 1, 2, 3), "afc": (0, 0, 1, 2), "af": (0, None, None, 1), "ac": (0, 0, 1, 1), "cf": (0, 0, 1, 1)}
        for edge, place in zip("xbac", places[sequence], strict=True):
            if place is not None:
                getattr(out, edge)[:] = edges[place]
        out.r[:] = 0.0
        return out

    def edges(self, sequence: str) -> np.ndarray:
        """The edges of a ``sequence``, (k, n)."""
        return np.array([getattr(self, edge) for edge in ORBIT_EDGES[sequence]])


def march(kernel, cycle: Cycle, x: np.ndarray) -> Orbit:
    """March every cycle from its onset phase ``x``."""
    # downward zero of the gap after the onset, where H + p_0 > 0; NaN where the gap stays open
    s, end = cycle.strips, cycle.centre + cycle.half_b
    b, i = np.where(cycle.direct, x, np.nan), np.flatnonzero(~cycle.direct & (x < end))
    closes = Event(kernel.gap_event, kernel.gap_entry(x[i], cycle.gap_on[i], -s.p_0[i], s.D[i], s.beta[i]))
    b[i] = _crossing(closes, np.maximum(x, cycle.centre - cycle.half_b)[i], end[i])
    contact = ~np.isnan(b)
    a = contact_end(kernel, cycle, b, cycle.q_on)
    c = adhesion_end(kernel, cycle, np.where(contact, a, x), np.where(contact, 0.0, cycle.gap_on))
    c = np.where(cycle.bare & np.isfinite(a), a, c)
    engaged = np.isnan(c)
    r = np.full(x.shape, -np.inf)
    free = np.flatnonzero(~engaged)
    if free.size:
        r[free] = closing(kernel, cycle.among(free), x[free], b[free], a[free], c[free])
    return Orbit(x.copy(), b, a, c, engaged, r)


def contact_end(kernel, cycle: Cycle, b, q, way=0, after=None):
    """Where contacts that begin at b with the excess pressure q end: at its downward zero, where H + p_0 < 0, not before
    ``after``. NaN without contact, inf if it never ends.

    ``way``: 1 for phases that are certain to be later (here and below: -1, earlier), whatever rounding does to the threshold.
    """
    s, low, high = cycle.strips, cycle.centre + cycle.half_b, cycle.centre + TWO_PI - cycle.half_b
    a, i = np.where(np.isnan(b), np.nan, np.inf), np.flatnonzero(~np.isnan(b) & (low < high))
    low = np.fmax(low, b if after is None else after)
    entry = kernel.excess_entry(b[i], q[i], s.p_0[i], s.D[i], s.alpha[i], s.beta[i], s.L[i])
    event = Event(kernel.excess_event, entry, -way * (s.noise()[i] + ROUNDING * entry[4]) if way else 0.0)
    a[i] = np.fmin(_crossing(event, low[i], high[i], None if after is None else low[i], way), np.inf)
    return a


def adhesion_end(kernel, cycle: Cycle, start, gap, way=0):
    """Where adhesion that pulls a ``gap`` from ``start`` on ends: at the upward zero of gap - delta_0, where
    H + p_0 + delta_0 < 0. NaN where the strip stays engaged."""
    s, high = cycle.strips, cycle.centre + TWO_PI - cycle.half_c
    c, i = np.full(start.shape, np.nan), np.flatnonzero(~cycle.bare & (start < high))
    first, reach = start[i], s.delta_0[i]
    entry = kernel.gap_entry(first, gap[i], -s.p_0[i], s.D[i], s.beta[i])
    event = Event(kernel.gap_event, entry, reach + way * s.noise()[i] if way else reach, -1.0)
    low = np.maximum((cycle.centre + cycle.half_c)[i], first)
    c[i] = _crossing(event, low, high[i], _stands_still(first, reach), way)
    return c


def next_onset(kernel, cycle: Cycle, c, way):
    """Onsets, less 2 pi, that cycles released at c meet next, or NaN: gap - delta_0 falls through zero where H + delta_0 > 0."""
    s, low = cycle.strips, np.maximum(cycle.centre + TWO_PI - cycle.half_d, c)
    entry = kernel.gap_entry(c, s.delta_0 + cycle.jump, 0.0, s.D, s.beta)
    event, guess = Event(kernel.gap_event, entry, s.delta_0 - way * s.noise()), TWO_PI - _stands_still(c, -cycle.jump)
    x = _crossing(event, low, cycle.centre + TWO_PI + cycle.half_d, guess, way) - TWO_PI
    # a surface out of reach of the undeformed foundation is not met if nothing is left of w that would change its gap
    left = np.abs(kernel.profile(c, s.D) + s.delta_0 + cycle.jump) * kernel.decay(low - c, s.beta)
    return np.where((way < 0) & (s.D <= -s.delta_0) & (left < 0.25 * EPS * s.delta_0), np.nan, x)


def _stands_still(phase, rise):
    """Phase where the gap of a foundation that stands still has grown by ``rise`` since this one."""
    return np.arccos(np.clip(np.cos(phase) - rise, -1.0, 1.0))


def _crossing(event: Event, low, high, guess=None, way=0):
    """Phases where events fall through zero in the arcs from ``low`` to ``high``, NaN where they do not; ``way``: phases that are
    later or earlier by the sign of the event, the end of the arc where none close by is.

    That they fall is seen from the sign at the end. Where there is next to no memory the event function follows the harmonic and
    vanishes there but for rounding; it is deepest half way."""
    high = np.maximum(low, high)
    phase, meets = np.full(low.size, np.nan), np.zeros(low.size, bool)
    for where in (high, 0.5 * (low + high)):
        ask = np.flatnonzero(~meets)
        if ask.size:
            meets[ask] = event(where[ask], ask)[0] <= 0
    here = np.flatnonzero(meets)
    event, low, high, guess = event.among(here), low[here], high[here], None if guess is None else guess[here]
    x = falling_root(event, low, high, guess, _CLOSE if way else LEAST_PHASE)
    if way:
        x = np.clip(x + 10 * way * _CLOSE, low, high)
        x = np.where(way * event(x, np.arange(x.size))[0] <= 0, x, high if way > 0 else low)
    phase[here] = x
    return phase


def between(left: Orbit, right: Orbit) -> Orbit:
    """Edges interpolated to where r vanishes linearly between two onsets: a start for Newton, not an orbit."""
    fall = left.r - right.r
    share = np.clip(np.divide(left.r, fall, out=np.full(fall.shape, 0.5), where=np.isfinite(fall) & (fall > 0)), 0, 1)
    mixed = [(1 - share) * getattr(left, e) + share * getattr(right, e) for e in ("x", "b", "a", "c")]
    return Orbit(*mixed, left.engaged.copy(), left.r.copy())


class Event:
    """An event function of a batch, its constants worked out once: value and slope at phases of elements, ascending."""

    def __init__(self, function, constants, offset=0.0, sign=1.0):
        self.function, self.sign, self.rows = function, sign, np.empty((1 + len(constants), constants[1].size))
        for row, value in zip(self.rows, (offset, *constants), strict=True):
            row[:] = value
        self._asked, self._last = None, self.rows

    def among(self, index) -> Event:
        """The elements at ``index``, which ascends and repeats nothing."""
        if index.size == self.rows.shape[1]:
            return self
        offset, *constants = self.rows[:, index]
        return Event(self.function, constants, offset, self.sign)

    def __call__(self, phase, sub):
        # iterations ask for the same elements again and again, mostly for all of them
        if sub is not self._asked:
            self._asked = sub
            self._last = self.rows if sub.size == self.rows.shape[1] else self.rows[:, sub]
        offset, *constants = self._last
        value, slope = self.function(phase, *constants)
        return self.sign * (value - offset), self.sign * slope


def turn(event, constants, sign: int, low, high) -> np.ndarray:
    """Phases up to ``high`` where the slope of an ``event`` with these ``constants``, of this ``sign`` at ``low``, is zero."""

    def slope(phase, index):
        return event(phase, *(pick(constant, index) for constant in constants))[1] * sign

    return falling_root(slope, low, np.maximum(high, low), tolerance=_PLACED)


def closing(kernel, cycle: Cycle, x, b, a, c):
    """Sum of the increments of z over the period: small when beta is large, and then still exact."""
    s, contact = cycle.strips, ~np.isnan(b)
    # a contact that begins at the onset, or ends without adhesion, leaves nothing of the zone beside it
    r = kernel.relaxation_increment(x, np.where(contact, b, c), kernel.profile(x, s.D) + cycle.gap_on + s.p_0, s.beta)
    i = np.flatnonzero(contact)
    r[i] += kernel.contact_increment(b[i], a[i], cycle.q_on[i], s.p_0[i], s.D[i], s.alpha[i], s.beta[i], s.J[i], s.L[i])
    r[i] += kernel.relaxation_increment(a[i], c[i], kernel.profile(a[i], s.D[i]) + s.p_0[i], s.beta[i])
    return r + kernel.relaxation_increment(c, x + TWO_PI, kernel.profile(c, s.D) + s.delta_0 + cycle.jump, s.beta)
