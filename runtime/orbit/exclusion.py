"""Proof that no more extremal orbit exists beside one that is known, from a few evaluations of its neighbours' events.

A more engaged orbit has an earlier onset, so the unloading orbit at x* is proven by excluding zeros of r between the
start of the onset arc and x*, the loading orbit by excluding them between x* and the end of the arc. Edges of orbits
are ordered: from an earlier onset contact begins earlier, contact and adhesion end later. One-sided bounds of the
edges are enough for every inequality used, and a bound is verified by the sign of one event, so nothing is solved
for.

Mostly bounds at one onset x0 are enough, at the end of the arc or where ``orbit_bounds`` has moved it: R falls strictly
wherever F is not too small (``sensitivity.steep_margin``), and between there and x0 too little to use up the r of x0.
Otherwise x0 is moved on: r cannot vanish sooner than bounds on its slope between x0 and x* allow (``search.reach_on``).

On a slow foundation the balance of a period is asked first (``balance``): one evaluation in place of two bounds on every edge.

What is not proven here is left to ``search``; nothing is ever accepted for lack of a counterexample.
"""

import numpy as np

from . import balance
from .bound import bound, close_enough
from .groups import Cycle
from .march import TWO_PI, Orbit, march
from .orbit_bounds import OrbitBounds
from .search import reach_back, reach_on
from .sensitivity import slope_bounds, steep_margin

_EPS = np.finfo(float).eps
#: least relaxation time that is divided by
_LEAST = 1e-290
#: rounds, and the share of what is left that each has to gain: of strips with edges three prove all but one in a thousand
_ROUNDS, _STUCK = 3, 0.1


def alone(kernel, cycle: Cycle, orbit: Orbit, last: bool, bounds: OrbitBounds) -> tuple[np.ndarray, np.ndarray]:
    """Which orbits are proven to be the first (``last``: last) of their onset arc, and the event evaluations spent on each.

    ``bounds`` on all orbits: no onset lies before them, so it is enough that R falls from there on.
    """
    proven, spent = np.zeros(cycle.size, bool), np.zeros(cycle.size)
    if not last:
        known = np.flatnonzero(np.isfinite(bounds.x))
        part, limits = orbit.take(known), bounds.take(known)
        unknown = np.full(known.size, np.nan)
        outer = Orbit(limits.x, unknown, unknown, np.maximum(limits.c, part.c), np.zeros(known.size, bool), unknown, unknown)
        proven[known] = _falls_between(kernel, cycle.among(known), part, outer, 1.0)
        rest = np.flatnonzero(~proven & (cycle.strips.beta > balance.SLOW))
        if rest.size:
            part = cycle.among(rest)
            here = closed(kernel, part, orbit.take(rest))
            proven[rest], spent[rest] = balance.first(kernel, part, here, *onsets_within(part, bounds.take(rest)))
    rest = np.flatnonzero(~proven)
    if rest.size:
        part, sign = cycle.among(rest), -1.0 if last else 1.0
        end = part.centre - sign * part.half_d
        end = end if last else np.fmax(end, bounds.x[rest])
        proven[rest], used = _cleared(kernel, part, closed(kernel, part, orbit.take(rest)), sign, end)
        spent[rest] += used
    return proven, spent


def onsets_within(cycle: Cycle, bounds: OrbitBounds) -> tuple[np.ndarray, np.ndarray]:
    """Phases before which no orbit has its onset, and after which its adhesion does not end."""
    return np.fmax(cycle.centre - cycle.half_d, bounds.x), np.fmin(cycle.centre + TWO_PI - cycle.half_c, bounds.c)


def _falls_between(kernel, cycle: Cycle, known: Orbit, outer: Orbit, sign: float) -> np.ndarray:
    """Where no zero of r lies between the onsets of ``outer``, bounds beyond which there is none, and of the known orbit.

    R falls strictly wherever F exceeds ``steep_margin``, an arc in which the known onset lies. From where it begins (``sign`` <
    0: ends) to the outer onset r has the sign of that side: it has there, by at least ``outer.r``, and R falls no faster than
    that margin lets it. With ``outer.r`` NaN the arc has to reach the outer onset.
    """
    s = cycle.strips
    noise = 64 * _EPS * (1 + np.abs(s.D) + s.delta_0 + s.p_0)
    margin = noise + (steep_margin(kernel, cycle, outer, known) if sign > 0 else steep_margin(kernel, cycle, known, outer))
    sure = np.isfinite(margin)
    margin = np.where(sure, margin, 0.0)
    half = kernel.forcing_arc(s.delta_0 - margin, s.D, s.beta)[1]
    steep = sure & (np.abs(known.x - cycle.centre) < half)
    way = np.minimum(np.maximum(sign * (cycle.centre - outer.x) - half, 0.0) / np.maximum(s.beta, _LEAST), 700.0)
    kept = sign * outer.r - noise > margin * (np.expm1(way) if sign > 0 else -np.expm1(-way))
    return steep & ((way == 0) | kept)


def closed(kernel, cycle: Cycle, orbit: Orbit) -> Orbit:
    """Known orbits as marches that end where they begin."""
    s = cycle.strips
    w_end = kernel.profile(orbit.x, s.D) + s.delta_0
    return Orbit(orbit.x, orbit.b, orbit.a, orbit.c, np.zeros(cycle.size, bool), np.zeros(cycle.size), w_end)


def _cleared(kernel, cycle: Cycle, known: Orbit, sign: float, end) -> tuple[np.ndarray, np.ndarray]:
    """Where no zero of r lies between ``end``, of the onset arc or of what is left of it (``sign`` > 0: its start), and the
    onsets of ``known``."""
    n = cycle.size
    proven, spent = np.zeros(n, bool), np.zeros(n)
    active, part, here = np.arange(n), cycle, known
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        outer, used = enclose(kernel, cycle, end, known, sign)
        spent += used
        stuck = np.flatnonzero(outer.engaged)
        if stuck.size:
            closer, used = _released(kernel, cycle.among(stuck), known.take(stuck), outer.x[stuck], sign)
            outer.put(stuck, closer)
            spent[stuck] += used
        proven = ~outer.engaged & _falls_between(kernel, cycle, known, outer, sign)
        active = np.flatnonzero(~proven)
        if not active.size:
            return proven, spent
        part, here, outer = cycle.among(active), known.take(active), outer.take(active)
        for _ in range(_ROUNDS):
            x = _further(kernel, part, here, outer, sign)
            probe, used = enclose(kernel, part, x, here, sign)
            spent[active] += used
            gone = sign * (x - here.x) >= 0
            done = gone | (~probe.engaged & _falls_between(kernel, part, here, probe, sign))
            proven[active[done]] = True
            going = np.flatnonzero(~done & ~probe.engaged & (np.abs(x - outer.x) > _STUCK * np.abs(here.x - x)))
            if not going.size:
                break
            active, part, here, outer = active[going], part.among(going), here.take(going), probe.take(going)
    return proven, spent


def _further(kernel, cycle: Cycle, known: Orbit, outer: Orbit, sign: float) -> np.ndarray:
    """Onsets up to which no zero of r lies, from the one of ``outer`` towards the known one: r falls no faster than its bounds
    over all that way allow."""
    s = cycle.strips
    noise = 64 * _EPS * (1 + np.abs(s.D) + s.delta_0 + s.p_0)
    left, right = (outer, known) if sign > 0 else (known, outer)
    fall = slope_bounds(kernel, cycle, left, right).fall
    margin = np.maximum(sign * outer.r - noise, 0.0)
    way = reach_on(s.beta, margin, fall) if sign > 0 else reach_back(s.beta, margin, fall)
    return np.where(way > 0, outer.x + sign * np.minimum(way, 2 * TWO_PI), outer.x)


def _released(kernel, cycle: Cycle, known: Orbit, x, sign) -> tuple[Orbit, np.ndarray]:
    """A closer end for arcs whose end x may keep the strip engaged through the period.

    Whatever the onset, adhesion ends at the end of its own arc at the latest (``sign`` < 0: earliest), if it ends: no onset
    before the one that follows then belongs to an orbit.
    """
    s = cycle.strips
    latest = cycle.centre + (TWO_PI - cycle.half_c if sign > 0 else cycle.half_c)
    entry = kernel.gap_entry(latest, s.delta_0 + cycle.jump, 0.0, s.D, s.beta)
    noise = 64 * _EPS * (1 + np.abs(s.D) + s.delta_0 + s.p_0)
    spent = np.zeros(x.shape)
    start, far = known.x + TWO_PI, np.maximum(x + TWO_PI, latest)
    next_onset, found = bound(
        kernel.gap_event, entry, s.delta_0, 1.0, np.maximum(start, far), far, -sign, noise, close_enough(s.beta), spent
    )
    closer, used = enclose(kernel, cycle, np.where(found, next_onset - TWO_PI, x), known, sign)
    spent += used
    # bounds may miss an adhesion that ends just before its arc does: then the edges themselves
    missed = np.flatnonzero(closer.engaged)
    if missed.size:
        exact, used = march(kernel, cycle.among(missed), closer.x[missed])
        closer.put(missed, exact)
        spent[missed] += used
    return closer, spent


def _gap_at(kernel, cycle: Cycle, c, x):
    """Gap over delta_0 one period after the onset phase x, when adhesion ended at c."""
    s = cycle.strips
    c = np.minimum(c, x + TWO_PI)
    return kernel.gap_after(c, x + TWO_PI, s.delta_0 + cycle.jump, 0.0, s.D, s.beta) - s.delta_0


def enclose(kernel, cycle: Cycle, x, known: Orbit, sign) -> tuple[Orbit, np.ndarray]:
    """Bounds on the edges met from the onset x on the outer side of a known orbit, and on r there.

    ``sign`` > 0: x is earlier, b is bounded from below, a, c from above, r from below; ``sign`` < 0: the other way round.
    ``engaged`` marks where no bound was found. Contact that is lost on the way to a later onset counts as contact of no length.
    """
    s = cycle.strips
    centre = cycle.centre
    noise = 64 * _EPS * (1 + np.abs(s.D) + s.delta_0 + s.p_0)
    spent = np.ones(x.shape)
    if np.isnan(known.b).all():
        no, yes = np.zeros(x.shape, bool), np.ones(x.shape, bool)
        clinging = _release(kernel, cycle, x, x, x, yes, no, known.c, sign, noise, spent)
        if sign < 0:
            return clinging, spent
        # an earlier onset may lead to contact, at once at the earliest; either way the later end of adhesion bounds both
        b = np.maximum(x, centre - cycle.half_b)
        a, failed = _detachment(kernel, cycle, b, b, sign, noise, spent)
        either = _release(
            kernel, cycle, x, b, a, no, failed | clinging.engaged, np.maximum(known.c, clinging.c), sign, noise, spent
        )
        return either, spent
    # contact begins: an event that falls; its bound lies on the outer side of the known edge
    entry = kernel.gap_entry(x, cycle.gap_on, -s.p_0, s.D, s.beta)
    far = np.maximum(x, centre - cycle.half_b) if sign > 0 else centre + cycle.half_b
    b, found = bound(kernel.gap_event, entry, 0.0, 1.0, np.maximum(known.b, x), far, -sign, noise, close_enough(s.beta), spent)
    lost = failed = np.zeros(x.shape, bool)
    if sign < 0:
        # a gap that is still open at the end of the arc does not close
        open_ = kernel.gap_event(np.maximum(far, x), *entry)[0] > noise
        lost, failed = ~found & ~cycle.direct & open_, ~found & ~cycle.direct & ~open_
    b = np.where(cycle.direct | ~found, x, b)
    a, loose = _detachment(kernel, cycle, b, known.a, sign, noise, spent)
    b, a = np.where(lost, x, b), np.where(lost, x, a)
    return _release(kernel, cycle, x, b, a, lost, failed | loose, known.c, sign, noise, spent), spent


def _detachment(kernel, cycle: Cycle, b, start, sign, noise, spent):
    """Bound on the end of the contact that begins at b, and where none was found."""
    s = cycle.strips
    entry = kernel.excess_entry(b, cycle.q_on, s.p_0, s.D, s.alpha, s.beta, s.L)
    first, last = np.maximum(b, cycle.centre + cycle.half_b), cycle.centre + TWO_PI - cycle.half_b
    far = last if sign > 0 else first
    noise = noise + 64 * _EPS * entry[4]
    start = np.maximum(start, first)
    a, found = bound(kernel.excess_event, entry, 0.0, 1.0, start, far, sign, noise, close_enough(s.beta), spent)
    return np.where(found, a, far), ~found & (sign > 0)


def _release(kernel, cycle: Cycle, x, b, a, lost, failed, start, sign, noise, spent) -> Orbit:
    """The bounds completed by one on the end of adhesion after a, or after x where contact is ``lost``, and by r."""
    s = cycle.strips
    entry = kernel.gap_entry(a, np.where(lost, cycle.gap_on, 0.0), -s.p_0, s.D, s.beta)
    start = np.maximum(start, a)
    far = cycle.centre + TWO_PI - cycle.half_c if sign > 0 else np.maximum(a, cycle.centre + cycle.half_c)
    c, found = bound(kernel.gap_event, entry, s.delta_0, -1.0, start, far, sign, noise, close_enough(s.beta), spent)
    failed = failed | (~found & (sign > 0))
    c = np.where(found, c, far)
    r = np.where(failed, -np.inf, _gap_at(kernel, cycle, c, x))
    w_end = (kernel.profile(c, s.D) + s.delta_0 + cycle.jump) * kernel.decay(x + TWO_PI - c, s.beta)
    return Orbit(x, b, a, c, failed, r, w_end)
