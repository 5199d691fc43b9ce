"""Proof by the balance of one period that no more engaged orbit exists beside one that is known.

Let l be a periodic orbit with a slope of the onset map below one, or the march of one period with ``r > 0``, that meets
contact. Suppose that there is an orbit with an earlier onset.

* From there to l every onset leads to contact and to the end of adhesion, as it does for both, so r is continuous. It
  is positive just before l. Where it last vanishes before l it does not fall: there is an orbit y before l at which
  the slope of the map is not below one.
* Contact is longer in y than in l, adhesion ends later, and it ends where free flow leads on to y itself,

      (u(c) + delta_0 + [w]) exp(c/beta) = (u(y) + delta_0) exp((y + 2 pi)/beta),

  whose left side falls in the arc of c and whose right side grows in the arc of y. So (``sensitivity``)

      log T'(y) <= log(1 + s_x/F(y)) + log(1 + s_c/M(c)) - 2 pi/beta - (a - b) L/alpha,

  a and b those of l, which is negative unless F or M is smaller at y than some number each, that is unless y lies
  before a phase x_1 known in closed form. Contact in an orbit before x_1 is known to be longer than in l: with that
  the same leads to an earlier phase.
* An orbit before x_1 is more engaged than the march from x_1: its contact covers that one's, under no less pressure.
  Every orbit obeys ``beta z' = p - w``, so that p and w have the same mean. Compared with l it has no larger w
  anywhere, a traction of ``-p_0`` for as much longer as it is engaged (at most from the start of the onset arc to the
  end of the arc of c), and the gain in pressure of that contact. If the gain is more than the traction takes, with
  ``beta r`` of l, the means differ: y does not exist, nor the orbit supposed. If it is not, it is for all y after
  some earlier phase, and that phase takes the place of x_1.

The pressure over ``-p_0``, q, summed over contact is closed form: ``alpha p' + p = u + beta u'`` there.
"""

import numpy as np

from .bound import bound
from .march import TWO_PI, Orbit
from .problem import Cycle
from .sensitivity import fading, gains, onset_margin, release_margin

_EPS = np.finfo(float).eps
#: bounds this close to an edge are good enough
_CLOSE = 0.05
#: rounds, and the least by which each has to get on
_TIERS, _PROGRESS = 3, 1e-3
#: share of the engagement that is allowed by the balance by which the end of adhesion is moved; the onset moves alike
_SHARE = 0.45
#: contact is sought by so much later than it is thought to begin, and earlier than to end
_SURELY = 0.03


def first(kernel, cycle: Cycle, known: Orbit, start, end) -> tuple[np.ndarray, np.ndarray]:
    """Which of the ``known`` orbits or marches, r >= 0, have no orbit before them; and the evaluations spent on each.

    ``start``, ``end``: no onset lies before, and adhesion does not end after.
    """
    s = cycle.strips
    noise = 64 * _EPS * (1 + np.abs(s.D) + s.delta_0 + s.p_0)
    longest = _longer(known, start, end)
    kept = s.beta * (known.r - noise)
    proven, spent = np.zeros(cycle.size, bool), np.zeros(cycle.size)
    index = np.flatnonzero(~np.isnan(known.b))
    part, here = cycle.take(index), known.take(index)
    surplus, length = kept[index], here.a - here.b
    reached = here.x, here.c
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        for tier in range(_TIERS):
            x, c, used = _next(kernel, part, here, reached, surplus, length, noise[index])
            spent[index] += used
            closer = np.flatnonzero(x < reached[0] - _PROGRESS)
            if not closer.size:
                break
            index, part, here, reached = index[closer], part.take(closer), here.take(closer), (x[closer], c[closer])
            gain, length, used = _gain(kernel, part, here, reached[0], noise[index])
            spent[index] += used
            surplus = gain + kept[index]
            done = (reached[0] <= start[index]) | (surplus > s.p_0[index] * longest[index])
            proven[index[done]] = True
            going = np.flatnonzero(~done)
            if not going.size:
                break
            index, part, here, reached = index[going], part.take(going), here.take(going), (reached[0][going], reached[1][going])
            surplus, length = surplus[going], length[going]
            if tier == 0:
                first, used = _onset_before(kernel, part, end[index], start[index], here.x, noise[index])
                longest[index] = _longer(here, first, end[index])
                spent[index] += used
    return proven, spent


def _next(kernel, cycle: Cycle, known: Orbit, reached, surplus, length, noise):
    """A phase before which the orbit y must lie, the end of adhesion that leads there, and the evaluations.

    ``reached``: the same from the round before, which tells of y a ``surplus`` and a contact of at least this ``length``.
    """
    arc, release = _suspects(kernel, cycle, known, length)
    # an orbit after the phase x is engaged no longer than from x on, and until the end of adhesion that leads to x
    allowed = surplus / cycle.strips.p_0
    spread = reached[1] + _SHARE * (allowed - _longer(known, *reached))
    by_slope = release >= spread
    c = np.minimum(np.where(by_slope, release, spread), cycle.centre + TWO_PI - cycle.half_c)
    x, spent = onset_after(kernel, cycle, c, known.x, noise)
    short = _longer(known, x, c) < allowed
    return np.where(by_slope, np.maximum(arc, x), np.where(short, x, np.inf)), c, spent


def _longer(known: Orbit, x, c):
    """By how much the engagement from x to c is longer than the known one."""
    return np.maximum(known.x - x, 0.0) + np.maximum(c - known.c, 0.0)


def _suspects(kernel, cycle: Cycle, known: Orbit, length):
    """Where an orbit y must lie: its onset before the first phase or its end of adhesion after the second; NaN: unknown."""
    s = cycle.strips
    F, M = onset_margin(kernel, cycle, known.x), release_margin(kernel, cycle, known.c)
    onset, release = gains(cycle)
    at_onset, at_release = np.log1p(onset / F), np.log1p(release / M)
    share = fading(cycle, length) * (1 - 64 * _EPS) / (at_onset + at_release)
    fits = (F > 0) & (M > 0) & (share > 1)
    F, M = (
        np.where(fits, gain / np.expm1(np.minimum(share * log, 700.0)), np.nan)
        for gain, log in ((onset, at_onset), (release, at_release))
    )
    arc = cycle.centre - kernel.forcing_arc(s.delta_0 - F, s.D, s.beta)[1]
    last = cycle.centre + TWO_PI - kernel.forcing_arc(s.p_0 + s.delta_0 + M, s.D, s.beta)[1]
    return arc, last


def _onset_before(kernel, cycle: Cycle, c, start, x, noise):
    """The start, or a later phase before the onset that free flow from c leads to.

    No orbit whose adhesion ends before c has an earlier onset.
    """
    s = cycle.strips
    entry = kernel.gap_entry(c, s.delta_0 + cycle.jump, 0.0, s.D, s.beta)
    spent = np.zeros(c.shape)
    far, near = np.maximum(start + TWO_PI, c), x + TWO_PI
    guess = np.clip(TWO_PI - c, far, near)
    phase, found = bound(kernel.gap_event, entry, s.delta_0, 1.0, guess, far, -1.0, noise, _CLOSE + 0 * c, spent, near)
    return np.where(found, phase - TWO_PI, start), spent


def onset_after(kernel, cycle: Cycle, c, x, noise):
    """Onsets after the one that free flow from c leads to, no later than x where that is found (else inf)."""
    s = cycle.strips
    entry = kernel.gap_entry(c, s.delta_0 + cycle.jump, 0.0, s.D, s.beta)
    spent = np.zeros(c.shape)
    far = x + TWO_PI
    near = np.minimum(np.maximum(c, cycle.centre - cycle.half_d + TWO_PI), far)
    # on a slow foundation the gap is the same about the crest
    guess = np.clip(TWO_PI - c, near, far)
    phase, found = bound(kernel.gap_event, entry, s.delta_0, 1.0, guess, far, 1.0, noise, _CLOSE + 0 * c, spent, near)
    return np.where(found, phase - TWO_PI, np.inf), spent


def _gain(kernel, cycle: Cycle, known: Orbit, x, noise):
    """Of an orbit with an onset before x: the least sum of the pressure over -p_0 in contact, less that of ``known``, and the
    least length of that contact; and the evaluations."""
    s = cycle.strips
    spent = np.ones(x.shape)
    x = np.minimum(x, known.x)
    near = np.minimum(np.maximum(x, cycle.centre - cycle.half_b), known.b)
    entry = kernel.gap_entry(x, cycle.gap_on, -s.p_0, s.D, s.beta)
    # on a slow foundation w stays, and the gap closes where the profile has risen by as much
    guess = np.clip(_SURELY - np.arccos(np.minimum(np.cos(x) + cycle.gap_on, 1.0)), near, known.b)
    b, found = bound(kernel.gap_event, entry, 0.0, 1.0, guess, known.b, 1.0, noise, _CLOSE + 0 * x, spent, near)
    b = np.where(cycle.direct, x, np.where(found, b, known.b))
    entry = kernel.excess_entry(b, cycle.q_on, s.p_0, s.D, s.alpha, s.beta, s.L)
    blur = noise + 64 * _EPS * entry[4]
    far = np.maximum(cycle.centre + TWO_PI - cycle.half_b, known.a)
    guess = np.clip(known.a + known.b - b - _SURELY, known.a, far)
    a, found = bound(kernel.excess_event, entry, 0.0, 1.0, guess, known.a, -1.0, blur, _CLOSE + 0 * x, spent, far)
    a = np.where(found, a, known.a)
    left = kernel.excess_event(a, *entry)[0]
    pressed = [
        kernel.profile_integral(one, two, s.D) + s.beta * kernel.profile_rise(one, two) + s.p_0 * (two - one)
        for one, two in ((b, a), (known.b, known.a))
    ]
    gain = pressed[0] - pressed[1] - s.alpha * left
    return gain - TWO_PI * noise - 64 * _EPS * (s.beta + s.alpha * np.abs(left)), a - b, spent
