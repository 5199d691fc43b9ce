"""One period of a material point from an onset phase: the edges it meets and how far it misses a periodic orbit.

The march is the return map of the strip on the phase x of its onset. It is not iterated: its sign, and bounds on its
slope, drive the search for the extremal orbit (``search``).
"""

from dataclasses import dataclass, fields

import numpy as np

from .crossing import crossing
from .problem import Cycle

TWO_PI = 2 * np.pi


@dataclass(slots=True)
class Orbit:
    """A march from the onset x; arrays of shape (n,).

    Attributes:
        x: onset phase. b, a, c: edges met (contact begins, contact ends, adhesion ends); NaN where absent.
        engaged: still in contact or adhesion when the onset phase comes round again; then r is -inf.
        r: gap to the threshold of the next onset at ``x + 2 pi``; positive: the next onset comes later than x,
            negative: it came earlier, zero: x belongs to a periodic orbit.
        w_end: free displacement at ``x + 2 pi``.
    """

    x: np.ndarray
    b: np.ndarray
    a: np.ndarray
    c: np.ndarray
    engaged: np.ndarray
    r: np.ndarray
    w_end: np.ndarray

    def take(self, index: np.ndarray) -> "Orbit":
        return Orbit(*(getattr(self, f.name)[index] for f in fields(self)))

    def put(self, index: np.ndarray, other: "Orbit") -> None:
        """Overwrite the elements ``index`` with ``other``."""
        for f in fields(self):
            getattr(self, f.name)[index] = getattr(other, f.name)


def march(kernel, cycle: Cycle, x: np.ndarray) -> tuple[Orbit, np.ndarray]:
    """March every cycle from its onset phase ``x``; also returns the event evaluations each took."""
    spent = np.ones(x.shape)
    b = _contact_begins(kernel, cycle, x, spent)
    a = _contact_ends(kernel, cycle, x, b, spent)
    c = _adhesion_ends(kernel, cycle, x, b, a, spent)
    engaged = np.isnan(c)
    r, w_end = np.full(x.shape, -np.inf), np.full(x.shape, np.nan)
    free = np.flatnonzero(~engaged)
    if free.size:
        r[free], w_end[free] = _closing(kernel, cycle.take(free), x[free], b[free], a[free], c[free])
    return Orbit(x.copy(), b, a, c, engaged, r, w_end), spent


def _contact_begins(kernel, cycle: Cycle, x, spent):
    """Downward zero of the gap after the onset, where H + p_0 > 0; NaN where the gap stays open."""
    s = cycle.strips
    b = np.where(cycle.direct, x, np.nan)
    end = cycle.centre + cycle.half_b
    reach = np.flatnonzero(~cycle.direct & (x < end))
    if not reach.size:
        return b

    def gap(phase, sub):
        i = reach[sub]
        args = (x[i], phase, cycle.gap_on[i], -s.p_0[i], s.D[i], s.beta[i])
        return kernel.gap_after(*args), kernel.gap_after_slope(*args)

    at_end, _ = gap(end[reach], np.arange(reach.size))
    spent[reach] += 1
    reach = reach[at_end <= 0]
    start = np.maximum(x[reach], cycle.centre[reach] - cycle.half_b[reach])
    b[reach], used = crossing(gap, start, end[reach])
    spent[reach] += used
    return b


def _contact_ends(kernel, cycle: Cycle, x, b, spent):
    """Downward zero of the excess pressure p + p_0, where H + p_0 < 0; NaN without contact, +inf if it never ends."""
    s = cycle.strips
    a = np.full(x.shape, np.nan)
    touched = np.flatnonzero(~np.isnan(b))

    def excess(phase, sub):
        i = touched[sub]
        args = (b[i], phase, cycle.q_on[i], s.p_0[i], s.D[i], s.alpha[i], s.beta[i], s.L[i])
        return kernel.excess_after(*args), kernel.excess_after_slope(*args)

    low = cycle.centre[touched] + cycle.half_b[touched]
    high = cycle.centre[touched] + TWO_PI - cycle.half_b[touched]
    at_end, _ = excess(high, np.arange(touched.size))
    spent[touched] += 1
    leaves = (at_end <= 0) & (high > low)
    a[touched[~leaves]] = np.inf
    touched, low, high = touched[leaves], low[leaves], high[leaves]
    a[touched], used = crossing(excess, np.maximum(low, b[touched]), high)
    spent[touched] += used
    return a


def _adhesion_ends(kernel, cycle: Cycle, x, b, a, spent):
    """Upward zero of gap - delta_0, where H + p_0 + delta_0 < 0; NaN where the strip stays engaged."""
    s = cycle.strips
    c = np.where(cycle.bare & np.isfinite(a), a, np.nan)
    contact = ~np.isnan(b)
    start = np.where(contact, a, x)
    first = np.where(contact, 0.0, cycle.gap_on)
    low = cycle.centre + cycle.half_c
    high = cycle.centre + TWO_PI - cycle.half_c
    leaves = np.flatnonzero(~cycle.bare & np.isfinite(start) & (start < high))

    def closed(phase, sub):
        i = leaves[sub]
        args = (start[i], phase, first[i], -s.p_0[i], s.D[i], s.beta[i])
        return s.delta_0[i] - kernel.gap_after(*args), -kernel.gap_after_slope(*args)

    if not leaves.size:
        return c
    at_end, _ = closed(high[leaves], np.arange(leaves.size))
    spent[leaves] += 1
    leaves = leaves[at_end <= 0]
    c[leaves], used = crossing(closed, np.maximum(low[leaves], start[leaves]), high[leaves])
    spent[leaves] += used
    return c


def _closing(kernel, cycle: Cycle, x, b, a, c):
    """Sum of the increments of z over the period (small when beta is large, and then still exact), and w at its end."""
    s = cycle.strips
    r = np.zeros(x.shape)
    contact = ~np.isnan(b)
    u_x = kernel.profile(x, s.D)
    end = x + TWO_PI
    first_end = np.where(contact, b, c)
    lead = ~cycle.direct
    i = np.flatnonzero(lead)
    r[i] += kernel.relaxation_increment(
        x[i], first_end[i], u_x[i] + cycle.gap_on[i] + s.p_0[i], s.beta[i]
    )
    i = np.flatnonzero(contact)
    r[i] += kernel.contact_increment(
        b[i], a[i], cycle.q_on[i], s.p_0[i], s.D[i], s.alpha[i], s.beta[i], s.J[i], s.L[i]
    )
    i = np.flatnonzero(contact & ~cycle.bare)
    r[i] += kernel.relaxation_increment(a[i], c[i], kernel.profile(a[i], s.D[i]) + s.p_0[i], s.beta[i])
    w_c = kernel.profile(c, s.D) + s.delta_0 + cycle.jump
    r += kernel.relaxation_increment(c, end, w_c, s.beta)
    return r, w_c * kernel.decay(end - c, s.beta)
