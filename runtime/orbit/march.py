"""One period of a material point from an onset phase: the edges it meets and how far it misses a periodic orbit.

The march is the return map of the strip on the phase x of its onset. It is not iterated: its sign, and bounds on its
slope, drive the search for the extremal orbit (``search``).

Every event of a strip (gap closes, gap reaches delta_0, pressure falls to -p_0) is a zero of a function F with
``F + T F' = one harmonic of the phase``. At a zero the slope of F has the sign of that harmonic, so F crosses zero at most once
inside the arc where the harmonic keeps its sign: the arc is a bracket, in which safeguarded Newton cannot find a wrong zero.
"""

from dataclasses import dataclass

import numpy as np

from ..numerics.roots import falling_root
from .batch import Batch
from .groups import TWO_PI, Cycle

#: edges this close to the crest are on it: the bracket of one that is on it would be halved a thousand times
LEAST_PHASE = 1e-60


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
    def blank(cls, n: int) -> "Orbit":
        """n places for orbits, none of them known."""
        return cls(*(np.full(n, np.nan) for _ in range(4)), np.zeros(n, bool), np.full(n, np.nan))


def march(kernel, cycle: Cycle, x: np.ndarray, earlier: Orbit | None = None, later: Orbit | None = None) -> Orbit:
    """March every cycle from its onset phase ``x``.

    ``earlier`` and ``later``: orbits from an earlier and a later onset, if known. By the order of orbits b lies between theirs, a
    and c too (the other way round), which leaves narrow brackets; NaN edges bound nothing.
    """
    s = cycle.strips

    def first(edge, event, low, high, index):
        known = _Known(x, earlier, later, edge)
        return known.crossing(event, low[index], high[index], index)

    # downward zero of the gap after the onset, where H + p_0 > 0; NaN where the gap stays open
    rising, falling = cycle.centre - cycle.half_b, cycle.centre + cycle.half_b
    b = np.where(cycle.direct, x, np.nan)
    i = np.flatnonzero(~cycle.direct & (x < falling))
    if i.size:
        gap = Event(kernel.gap_event, kernel.gap_entry(x[i], cycle.gap_on[i], -s.p_0[i], s.D[i], s.beta[i]))
        b[i] = first("b", gap, np.maximum(x, rising), falling, i)
    # downward zero of the excess pressure p + p_0, where H + p_0 < 0; NaN without contact, +inf if it never ends
    contact = ~np.isnan(b)
    a, high = np.where(contact, np.inf, np.nan), rising + TWO_PI
    i = np.flatnonzero(contact & (falling < high))
    if i.size:
        entry = kernel.excess_entry(b[i], cycle.q_on[i], s.p_0[i], s.D[i], s.alpha[i], s.beta[i], s.L[i])
        a[i] = np.fmin(first("a", Event(kernel.excess_event, entry), np.fmax(falling, b), high, i), np.inf)
    # upward zero of gap - delta_0, where H + p_0 + delta_0 < 0; NaN where the strip stays engaged
    c = np.where(cycle.bare & np.isfinite(a), a, np.nan)
    start, high = np.where(contact, a, x), cycle.centre + TWO_PI - cycle.half_c
    i = np.flatnonzero(~cycle.bare & (start < high))
    if i.size:
        entry = kernel.gap_entry(start[i], np.where(contact, 0.0, cycle.gap_on)[i], -s.p_0[i], s.D[i], s.beta[i])
        closed = Event(kernel.gap_event, entry, s.delta_0[i], -1.0)
        c[i] = first("c", closed, np.maximum(cycle.centre + cycle.half_c, start), high, i)
    engaged = np.isnan(c)
    r = np.full(x.shape, -np.inf)
    free = np.flatnonzero(~engaged)
    if free.size:
        r[free] = closing(kernel, cycle.among(free), x[free], b[free], a[free], c[free])
    return Orbit(x.copy(), b, a, c, engaged, r)


def between(left: Orbit, right: Orbit) -> Orbit:
    """Edges interpolated to where r vanishes linearly between two onsets: a start for Newton, not an orbit."""
    fall = left.r - right.r
    share = np.clip(np.divide(left.r, fall, out=np.full(fall.shape, 0.5), where=np.isfinite(fall) & (fall > 0)), 0, 1)
    mixed = [(1 - share) * getattr(left, e) + share * getattr(right, e) for e in ("x", "b", "a", "c")]
    return Orbit(*mixed, left.engaged.copy(), left.r.copy())


class _Known:
    """What orbits from an earlier and a later onset say of an edge: bounds, and whether it exists at all."""

    def __init__(self, x, earlier: Orbit | None, later: Orbit | None, edge: str):
        if earlier is None or later is None:
            self.sure = np.zeros(x.shape, bool)
            return
        first, second = getattr(earlier, edge), getattr(later, edge)
        self.sure = np.isfinite(first) & np.isfinite(second)
        first, second = np.where(self.sure, first, 0.0), np.where(self.sure, second, 0.0)
        self.low, self.high = np.minimum(first, second), np.maximum(first, second)
        span = later.x - earlier.x
        share = np.divide(x - earlier.x, span, out=np.full(x.shape, 0.5), where=span > 0)
        self.guess = first + share * (second - first)

    def crossing(self, event, low, high, index):
        """Phases where the events of ``index`` fall through zero in the arcs from ``low`` to ``high``, NaN where they do not.
        That they do is known, or seen from the sign at the end.

        Where there is next to no memory the event function follows the harmonic and vanishes at the end but for rounding; it is
        deepest half way.
        """
        meets, high = self.sure[index], np.maximum(low, high)
        phase = np.full(index.size, np.nan)
        for where in (high, 0.5 * (low + high)):
            ask = np.flatnonzero(~meets)
            if ask.size:
                meets[ask] = event(where[ask], ask)[0] <= 0
        here = np.flatnonzero(meets)
        event, low, high, index, guess = event.take(here), low[here], high[here], index[here], None
        if self.sure.any():
            sure = self.sure[index]
            low = np.where(sure, np.clip(self.low[index], low, high), low)
            high = np.where(sure, np.clip(self.high[index], low, high), high)
            guess = np.where(sure, self.guess[index], 0.5 * (low + high))
        phase[here] = falling_root(event, low, high, guess, LEAST_PHASE)
        return phase


def _rows(size: int, *values) -> np.ndarray:
    """Arrays (size,) and numbers as the rows of one array."""
    out = np.empty((len(values), size))
    for row, value in zip(out, values, strict=True):
        row[:] = value
    return out


class Event:
    """An event function of a batch with its entry data worked into constants once: value and slope at later phases of the
    elements ``sub``, which ascend."""

    def __init__(self, function, constants, offset=0.0, sign=1.0):
        self.function, self.sign = function, sign
        self.constants = _rows(constants[1].size, offset, *constants)
        self._asked, self._last = None, self.constants

    def take(self, index) -> "Event":
        other = object.__new__(Event)
        other.function, other.sign, other.constants = self.function, self.sign, self.constants[:, index]
        other._asked, other._last = None, other.constants
        return other

    def __call__(self, phase, sub):
        # iterations ask for the same elements again and again, mostly for all of them
        if sub is not self._asked:
            self._asked = sub
            self._last = self.constants if sub.size == self.constants.shape[1] else self.constants[:, sub]
        offset, *constants = self._last
        value, slope = self.function(phase, *constants)
        return self.sign * (value - offset), self.sign * slope


def closing(kernel, cycle: Cycle, x, b, a, c):
    """Sum of the increments of z over the period: small when beta is large, and then still exact."""
    s = cycle.strips
    r = np.zeros(x.shape)
    contact = ~np.isnan(b)
    u_x = kernel.profile(x, s.D)
    end = x + TWO_PI
    first_end = np.where(contact, b, c)
    lead = ~cycle.direct
    i = np.flatnonzero(lead)
    r[i] += kernel.relaxation_increment(x[i], first_end[i], u_x[i] + cycle.gap_on[i] + s.p_0[i], s.beta[i])
    i = np.flatnonzero(contact)
    r[i] += kernel.contact_increment(b[i], a[i], cycle.q_on[i], s.p_0[i], s.D[i], s.alpha[i], s.beta[i], s.J[i], s.L[i])
    i = np.flatnonzero(contact & ~cycle.bare)
    r[i] += kernel.relaxation_increment(a[i], c[i], kernel.profile(a[i], s.D[i]) + s.p_0[i], s.beta[i])
    w_c = kernel.profile(c, s.D) + s.delta_0 + cycle.jump
    return r + kernel.relaxation_increment(c, end, w_c, s.beta)
