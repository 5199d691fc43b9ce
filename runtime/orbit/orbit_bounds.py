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

* Where ``D <= -J_0 p_0`` a free state has ``w <= 0``: every onset lies before the one of a foundation at rest.
* Where ``D > -J_0 p_0`` a gap at the crest would have to be negative: every orbit with an onset is in contact there (one that
  snaps into contact is in contact anyway), and stays so at least until ``H + p_0`` turns negative. From contact that ends there,
  adhesion ends at c and the next onset is met at x: in every orbit adhesion ends after c, every onset lies before x, and there is
  none if c does not exist.

The phases are not solved for. Each is replaced by one that is further off, verified by the sign of an event: contact or adhesion
that is held longer (shorter) only leaves the state more (less) engaged than it is.
"""

from dataclasses import dataclass

import numpy as np

from .batch import Batch
from .bound import bound, close_enough
from .groups import EPS, ROUNDING, Cycle
from .march import TWO_PI

#: beta above which a foundation remembers too much of the most engaged state for bounds from it to say much: the balance of a
#: period (``balance``) is asked instead. 30 to 300 cost about the same
FAST = 60.0
#: contact and adhesion are taken to end after this share of the arc in which they can
_SOON = 0.1


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
    n = cycle.size
    out = OrbitBounds.blank(n)
    index = np.flatnonzero((cycle.half_b > 0) & (cycle.half_b < np.pi))
    if not index.size:
        return out
    part = cycle.among(index)
    near = [part.centre + half for half in (part.half_b, part.half_c)]
    start = [
        low + _SOON * (part.centre + TWO_PI - half - low) for low, half in zip(near, (part.half_b, part.half_c), strict=True)
    ]
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        a, c, released, spent = _release(kernel, part, part.centre - part.half_b, *start)
        # where one of the two was not found neither bounds anything
        out.a[index], out.c[index] = np.where(released, a, np.nan), np.where(released, c, np.nan)
        out.released[index] = released
        out.evaluations[index] += spent
        go = np.flatnonzero(released)
        if go.size:
            index, part = index[go], part.among(go)
            out.x[index], out.missed[index], spent = earliest_onset(kernel, part, c[go])
            out.evaluations[index] += spent
    return out


def least_engaged_bounds(kernel, cycle: Cycle) -> OrbitBounds:
    """Bounds from the least engaged state of an orbit with an onset, for cycles of strips within reach, ``D > -delta_0``."""
    s = cycle.strips
    out = OrbitBounds.blank(cycle.size)
    touches = cycle.touched
    reach = 0.5 * (s.D + s.delta_0 - s.noise())
    out.missed[:] = ~touches & (reach > 1)
    out.x[:] = np.where(touches, np.nan, -2 * np.arcsin(np.sqrt(np.clip(reach, 0.0, 1.0))))
    index = np.flatnonzero(touches)
    if index.size:
        part = cycle.among(index)
        a = part.centre + part.half_b
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            c, stays, used = _adhesion_ends(kernel, part, a)
            x, spent = _latest_onset(kernel, part, c)
        out.x[index], out.a[index], out.c[index], out.missed[index] = x, a, c, stays
        out.evaluations[index] = used + spent
    return out


def _adhesion_ends(kernel, cycle: Cycle, a):
    """Earlier ends of adhesion than that after contact until a, which strips stay engaged, and the evaluations spent."""
    s, noise, spent = cycle.strips, cycle.strips.noise(), np.ones(cycle.size)
    entry = kernel.gap_entry(a, 0.0, -s.p_0, s.D, s.beta)
    low = np.maximum(a, cycle.centre + cycle.half_c)
    high = np.maximum(cycle.centre + TWO_PI - cycle.half_c, low)
    stays = (cycle.half_b >= np.pi) | (kernel.gap_event(high, *entry)[0] - s.delta_0 < -noise)
    # of a foundation that stands still
    start = np.clip(np.arccos(np.clip(np.cos(a) - s.delta_0, -1.0, 1.0)), low, high)
    c, found = bound(kernel.gap_event, entry, s.delta_0, -1.0, start, low, -1.0, noise, close_enough(s.beta), spent, high)
    return np.where(found, c, low), stays, spent


def _latest_onset(kernel, cycle: Cycle, c):
    """Onsets (less 2 pi) after the next one of cycles released at c, NaN where none was found; and the evaluations spent."""
    s, spent = cycle.strips, np.zeros(cycle.size)
    entry = kernel.gap_entry(c, s.delta_0 + cycle.jump, 0.0, s.D, s.beta)
    low = np.maximum(cycle.centre + TWO_PI - cycle.half_d, c)
    high = np.maximum(cycle.centre + TWO_PI + cycle.half_d, low)
    start = np.clip(TWO_PI - np.arccos(np.clip(np.cos(c) + cycle.jump, -1.0, 1.0)), low, high)
    x, found = bound(kernel.gap_event, entry, s.delta_0, 1.0, start, high, 1.0, s.noise(), close_enough(s.beta), spent, low)
    return np.where(found, x - TWO_PI, np.nan), spent


def _release(kernel, cycle: Cycle, b, a, c):
    """Later ends of contact begun at b and of adhesion, sought from a and c, where both were found, and the evaluations spent."""
    s, noise = cycle.strips, cycle.strips.noise()
    spent, turned = np.zeros(cycle.size), cycle.centre + TWO_PI
    close = close_enough(s.beta)
    entry = kernel.excess_entry(b, cycle.q_on, s.p_0, s.D, s.alpha, s.beta, s.L)
    near, far = np.maximum(b, cycle.centre + cycle.half_b), turned - cycle.half_b
    blur, start = noise + ROUNDING * entry[4], np.clip(a, near, far)
    a, ends = bound(kernel.excess_event, entry, 0.0, 1.0, start, far, 1.0, blur, close, spent, near)
    entry = kernel.gap_entry(a, 0.0, -s.p_0, s.D, s.beta)
    near, far = np.maximum(a, cycle.centre + cycle.half_c), turned - cycle.half_c
    ends &= near < far
    start = np.clip(c, near, np.maximum(near, far))
    c, opens = bound(kernel.gap_event, entry, s.delta_0, -1.0, start, far, 1.0, noise, close, spent, near)
    return a, c, ends & opens, spent


def earliest_onset(kernel, cycle: Cycle, c):
    """Onsets (less 2 pi) before the next one of cycles released at c, NaN where none was found.

    Also which cycles miss it, and the evaluations spent.
    """
    s, noise = cycle.strips, cycle.strips.noise()
    spent = np.ones(cycle.size)
    entry = kernel.gap_entry(c, s.delta_0 + cycle.jump, 0.0, s.D, s.beta)
    far = np.maximum(cycle.centre + TWO_PI - cycle.half_d, c)
    near = np.maximum(cycle.centre + TWO_PI + cycle.half_d, far)
    missed = kernel.gap_event(near, *entry)[0] - s.delta_0 > noise
    # a surface out of reach of the undeformed foundation is not met if nothing is left of w that would change its gap
    left = np.abs(kernel.profile(c, s.D) + s.delta_0 + cycle.jump) * kernel.decay(far - c, s.beta)
    missed |= (s.D <= -s.delta_0) & (left < 0.25 * EPS * s.delta_0)
    # where a foundation that stands still meets it
    start = np.clip(TWO_PI - np.arccos(np.clip(np.cos(c) + cycle.jump, -1.0, 1.0)), far, near)
    close = close_enough(s.beta)
    x, found = bound(kernel.gap_event, entry, s.delta_0, 1.0, start, far, -1.0, noise, close, spent, near)
    return np.where(found & ~missed, x - TWO_PI, np.nan), missed, spent
