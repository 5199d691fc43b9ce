"""Lower bound, in closed form, of the balance of one period of all orbits with an onset in some interval.

Every orbit obeys ``beta z' = p - w``, so that p and w have the same mean. Let l be a reference: a periodic orbit with a slope of
the onset map below one, the march of one period with ``r >= 0`` (then ``beta r`` is the sum of its p - w), or the foundation at
rest, ``w = p = 0``, beneath a strip out of its reach. Let y be an orbit that is more engaged than l. With Q the sum of the
pressure over -p_0 in contact and E the length of engagement, its balance less that of l is

    0 = beta r + (Q_y - Q_l) - p_0 (E_y - E_l) + sum of (w_l - w_y),

so there is no such orbit where the right side is positive. It is bounded from below for all y with an onset ``-xi`` between two
phases, ``lo <= xi <= hi``. Along every orbit w is at least ``-p_0``; with that, contact and adhesion end where the sine is not
negative: a and c lie between 0 and pi.

* Contact. At ``-lo`` the strip y is engaged with a gap of ``gap_on`` at most, or in contact. While it adheres its w falls, so
  the gap is closed at the latest at ``-t``, where u has risen by ``gap_on``, or by less, if the fall of w until then is taken off
  that is certain whenever the gap closes. From there on its excess pressure is at least that of a contact that begins at
  ``-t``, until it ends at a, where the excess pressure falls. The sum of that lesser pressure from ``-t`` to any phase e is
  closed form and no more than the sum to a: ``alpha p' + p = u + beta u'``.
* Engagement. Free flow leads from c to the onset: ``cos c = cos xi - jump - W (exp(F/beta) - 1)``, ``-W = u(xi) + delta_0``,
  where F is the length of the free zone: c and with it E are bounded from above at hi and the longest F.
* Displacement. Nowhere is w_l less than w_y. Where l is free let ``w_l >= omega`` and ``V(s) = omega - u(s) - delta_0``. If y is
  in contact there ``w_l - w_y = V(s) + delta_0`` at least. If it is free the distance fades towards its onset, to ``V(xi)``.
  If it adheres before its contact w has fallen since the onset, and before ``-t`` u is no more either: V(xi) again. If it
  adheres after its contact w falls from where that ended, on or behind the crest; so it is at most u(e) after any phase e up to
  which contact is certain to last. As V grows towards the valley, V(lo) stands for V(xi).
"""

from dataclasses import dataclass, replace

import numpy as np

from .batch import Batch
from .groups import ROUNDING, Cycle, Strips
from .march import TWO_PI, Orbit


@dataclass(slots=True)
class Reference(Batch):
    """What the bounds need of n strips and their references, arrays (n,).

    ``orbit``: the reference, all zero for a foundation at rest. ``storage``, ``loss``: of complete contact. ``level``: omega less
    ``u + delta_0`` at the crest. ``kept``: ``beta r``. ``least``: of the sum of ``w_l - w_y``. ``pressed``: Q of the reference.
    ``turn``: by how much later contact ends if it begins earlier by one. ``end``: adhesion does not end after.
    """

    cycle: Cycle
    orbit: Orbit
    storage: np.ndarray
    loss: np.ndarray
    level: np.ndarray
    kept: np.ndarray
    least: np.ndarray
    pressed: np.ndarray
    turn: np.ndarray
    end: np.ndarray


def beside(kernel, cycle: Cycle, known: Orbit, end) -> Reference:
    """Orbits or marches with contact as references; adhesion does not ``end`` after."""
    s = cycle.strips
    w_c = kernel.profile(known.c, s.D) + s.delta_0 + cycle.jump
    level = np.minimum(w_c, w_c * kernel.decay(known.x + TWO_PI - known.c, s.beta)) - s.D - s.delta_0
    kept, pressed = s.beta * (known.r - s.noise()), _sum(kernel, s, known.b, known.a)
    least, turn = np.zeros(cycle.size), _turn(kernel, s, known)
    return Reference(cycle, known, *_modulus(kernel, s), level, kept, least, pressed, turn, end)


def at_rest(kernel, cycle: Cycle) -> Reference:
    """The foundation at rest as reference."""
    s, zero = cycle.strips, np.zeros(cycle.size)
    rest = Orbit(zero, zero, zero, zero, zero > 0, zero)
    begun = replace(cycle, q_on=zero)  # no less pressure than that
    end = zero + np.pi
    return Reference(begun, rest, *_modulus(kernel, s), -s.D - s.delta_0, zero, zero - np.inf, zero, zero + 1, end)


def _modulus(kernel, s: Strips):
    return kernel.storage(s.alpha, s.beta), kernel.loss(s.alpha, s.beta, s.L)


def arc_versine(height):
    """Phase where ``1 - cos`` is this much, at most pi."""
    return 2 * np.arcsin(np.sqrt(np.minimum(np.maximum(0.5 * height, 0.0), 1.0)))


def versine(phase):
    return 2 * np.sin(0.5 * phase) ** 2


def _sine_cosine(phase):
    """Both to rounding of one, by the tangent of half the phase: a fraction of their cost."""
    tangent = np.tan(0.5 * phase)
    double = 2 / (1 + tangent * tangent)
    return tangent * double, double - 1


def _sum(kernel, s, b, a):
    """Sum of the pressure over -p_0 from b to a, but for ``-alpha`` times its rise: ``p + alpha p' = u + beta u'``."""
    return kernel.profile_integral(b, a, s.D + s.p_0) + s.beta * kernel.profile_rise(b, a)


def _turn(kernel, s: Strips, known: Orbit):
    """By how much later contact ends, if it begins earlier by one."""
    one, two = (kernel.forcing(edge, s.D, s.beta) + s.p_0 for edge in (known.b, known.a))
    return np.clip(-one / two, 0.0, 1.0) * kernel.decay(known.a - known.b, s.alpha)


def _contact(reference: Reference, lo, versine):
    """Phase t, so that contact begins before -t if the onset is not after -lo, of this ``versine``; 0 where it may not begin, inf
    where no orbit may have such an onset: its w would be less than -p_0."""
    s = reference.cycle.strips
    rise = versine - reference.cycle.gap_on - s.noise()
    lag = np.maximum(s.p_0 + s.D - rise, 0.0)
    t = arc_versine(rise)
    most = arc_versine(rise - lag * np.expm1((t - lo) / s.beta))
    least = -lag * np.expm1(np.minimum(most - lo, 0.0) / s.beta)
    return np.where(lag > 0, np.maximum(arc_versine(rise + least), -reference.orbit.b), np.inf)


def balance_bound(kernel, reference: Reference, lo, hi):
    """Lower bound of the balance of all orbits with an onset between -hi and -lo, less that of the reference."""
    r, l, cycle, s = reference, reference.orbit, reference.cycle, reference.cycle.strips  # noqa: E741
    noise = s.noise()
    # contact, at least: the pressure of complete contact, and what fades of its difference to the one at -t
    low = versine(lo)
    t = _contact(r, lo, low)
    possible, t = np.isfinite(t), np.minimum(t, TWO_PI)
    sin_t, cos_t = _sine_cosine(t)
    e = np.minimum(np.maximum(l.a + r.turn * (t + l.b), 0.0), cycle.centre + TWO_PI - cycle.half_b)
    sin_e, cos_e = _sine_cosine(e)
    mean = s.D - 1 + s.p_0
    begins = mean + r.storage * cos_t + r.loss * sin_t
    late = mean + r.storage * cos_e - r.loss * sin_e + (cycle.q_on - begins) * kernel.decay(e + t, s.alpha)
    blur = 2 * ROUNDING * (1 + s.beta + (1 + s.alpha) * (np.abs(late) + np.abs(mean)))
    summed = mean * (e + t) + sin_e + sin_t + s.beta * (cos_e - cos_t)
    pressed = np.where(t > 0, np.maximum(summed - s.alpha * late - blur - r.pressed, 0.0), 0.0)
    holds = (t > 0) & (late > blur)
    held, drop = np.where(holds, e, 0.0), np.where(holds, 1 - cos_e, 0.0)
    # engagement, at most
    crest, near = s.D + s.delta_0, lo
    turned = np.flatnonzero(lo + hi > TWO_PI)
    if turned.size:
        near = lo.copy()
        near[turned] = TWO_PI - hi[turned]
        low[turned] = versine(near[turned])
    high = versine(np.minimum(hi, np.pi)) + noise
    later = np.maximum(l.c, near)
    free = np.maximum(TWO_PI - lo - np.where(low > crest, later, l.c), 0.0)
    out = high - crest
    c = np.minimum(arc_versine(high + cycle.jump + np.maximum(out, 0.0) * np.expm1(free / s.beta)), r.end)
    free = np.maximum(TWO_PI - hi - c, 0.0)
    c = np.where(out < 0, np.minimum(arc_versine(high + cycle.jump + out * np.expm1(free / s.beta)), c), c)
    longer = np.maximum(hi + l.x, 0.0) + np.maximum(c - l.c, 0.0)
    free = np.maximum(TWO_PI - hi - c, 0.0)
    # displacement, at least
    steep, onset = r.level + low, -l.x
    begun, ended = np.maximum(np.minimum(t, near), onset), np.maximum(np.minimum(held, near), l.c)
    apart = (r.level + 1 + s.delta_0) * (begun - onset + ended - l.c)
    apart -= _sine_cosine(begun)[0] + _sine_cosine(ended)[0] - np.sin(l.c) - np.sin(onset)
    apart += (TWO_PI - begun - later) * steep + (later - ended) * np.minimum(r.level + drop + s.delta_0, steep)
    apart += np.maximum(steep, 0.0) * (s.beta * np.expm1(free / s.beta) - free)
    least = r.kept + pressed - s.p_0 * longer + np.maximum(apart, r.least) - TWO_PI * noise
    return np.where(possible, least, np.inf)
