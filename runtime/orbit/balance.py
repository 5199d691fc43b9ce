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

from dataclasses import dataclass

import numpy as np

from ..numerics.rounding import EPS
from .batch import Batch
from .groups import ROUNDING, Cycle, Strips
from .march import TWO_PI, Orbit


@dataclass(slots=True)
class Reference(Batch):
    """What the bounds need of n strips and their references, arrays (n,).

    ``storage``, ``loss``: of complete contact. ``turned``: end of the arc where contact ends. ``q_on``: excess pressure as
    contact begins. ``x``, ``c``: onset and end of adhesion of the reference, 0 for a foundation at rest, as are ``b``, ``a``,
    its contact, and ``pressed``, its Q. ``turn``: by how much later contact ends if it begins earlier by one. ``level``:
    omega less ``u + delta_0`` at the crest. ``kept``: ``beta r``. ``least``: of the sum of ``w_l - w_y``. ``end``: adhesion
    does not end after. ``noise``: of a displacement. ``sines``: of -x and c, summed.
    """

    alpha: np.ndarray
    beta: np.ndarray
    L: np.ndarray
    p_0: np.ndarray
    delta_0: np.ndarray
    D: np.ndarray
    storage: np.ndarray
    loss: np.ndarray
    gap_on: np.ndarray
    jump: np.ndarray
    turned: np.ndarray
    q_on: np.ndarray
    x: np.ndarray
    c: np.ndarray
    level: np.ndarray
    kept: np.ndarray
    least: np.ndarray
    pressed: np.ndarray
    b: np.ndarray
    a: np.ndarray
    turn: np.ndarray
    end: np.ndarray
    noise: np.ndarray
    sines: np.ndarray

    def contact_end(self, t, sine, cosine):
        """About where a contact ends that begins at ``-t``, of this sine and cosine."""
        return self.a + self.turn * (t + self.b)


class _Rest(Reference):
    """A foundation at rest."""

    __slots__ = ()

    def contact_end(self, t, sine, cosine):
        # adhesion lifts, pressure relaxes
        relaxed = self.L * self.beta / self.alpha * (sine - t * cosine)
        lifted = t * (self.p_0 + self.D - 1 + cosine)
        return t + 2 * (lifted - relaxed) / (self.beta * np.maximum(sine, EPS))


def beside(kernel, cycle: Cycle, known: Orbit, end) -> Reference:
    """Orbits or marches with contact as references; adhesion does not ``end`` after."""
    s, noise = cycle.strips, cycle.strips.noise()
    w_c = kernel.profile(known.c, s.D) + s.delta_0 + cycle.jump
    return Reference(
        *_groups(kernel, cycle),
        q_on=cycle.q_on,
        x=known.x,
        c=known.c,
        level=np.minimum(w_c, w_c * kernel.decay(known.x + TWO_PI - known.c, s.beta)) - s.D - s.delta_0,
        kept=s.beta * (known.r - noise),
        least=np.zeros(cycle.size),
        pressed=_sum(kernel, s, known.b, known.a),
        b=known.b,
        a=known.a,
        turn=_turn(kernel, s, known),
        end=end,
        noise=noise,
        sines=np.sin(known.c) - np.sin(known.x),
    )


def at_rest(kernel, cycle: Cycle) -> Reference:
    """The foundation at rest as reference."""
    zero = np.zeros(cycle.size)
    return _Rest(
        *_groups(kernel, cycle),
        q_on=zero,
        x=zero,
        c=zero,
        level=-cycle.strips.D - cycle.strips.delta_0,
        kept=zero,
        least=zero - np.inf,
        pressed=zero,
        b=zero,
        a=zero,
        turn=zero,
        end=zero + np.pi,
        noise=cycle.strips.noise(),
        sines=zero,
    )


def _groups(kernel, cycle: Cycle):
    s = cycle.strips
    modulus = kernel.storage(s.alpha, s.beta), kernel.loss(s.alpha, s.beta, s.L)
    ends = cycle.centre + TWO_PI - cycle.half_b
    return s.alpha, s.beta, s.L, s.p_0, s.delta_0, s.D, *modulus, cycle.gap_on, cycle.jump, ends


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
    r = reference
    rise = versine - r.gap_on - r.noise
    lag = np.maximum(r.p_0 + r.D - rise, 0.0)
    t = arc_versine(rise)
    most = arc_versine(rise - lag * np.expm1((t - lo) / r.beta))
    least = -lag * np.expm1(np.minimum(most - lo, 0.0) / r.beta)
    return np.where(lag > 0, np.maximum(arc_versine(rise + least), -r.b), np.inf)


def balance_bound(kernel, reference: Reference, lo, hi):
    """Lower bound of the balance of all orbits with an onset between -hi and -lo, less that of the reference."""
    r = reference
    # contact, at least: the pressure of complete contact, and what fades of its difference to the one at -t
    low = versine(lo)
    t = _contact(r, lo, low)
    possible, t = np.isfinite(t), np.minimum(t, TWO_PI)
    sin_t, cos_t = _sine_cosine(t)
    e = np.minimum(np.maximum(r.contact_end(t, sin_t, cos_t), 0.0), r.turned)
    sin_e, cos_e = _sine_cosine(e)
    mean = r.D - 1 + r.p_0
    begins = mean + r.storage * cos_t + r.loss * sin_t
    late = mean + r.storage * cos_e - r.loss * sin_e + (r.q_on - begins) * kernel.decay(e + t, r.alpha)
    blur = 2 * ROUNDING * (1 + r.beta + (1 + r.alpha) * (np.abs(late) + np.abs(mean)))
    summed = mean * (e + t) + sin_e + sin_t + r.beta * (cos_e - cos_t)
    pressed = np.where(t > 0, np.maximum(summed - r.alpha * late - blur - r.pressed, 0.0), 0.0)
    holds = (t > 0) & (late > blur)
    held, drop = np.where(holds, e, 0.0), np.where(holds, 1 - cos_e, 0.0)
    # engagement, at most
    crest, near = r.D + r.delta_0, lo
    turned = np.flatnonzero(lo + hi > TWO_PI)
    if turned.size:
        near = lo.copy()
        near[turned] = TWO_PI - hi[turned]
        low[turned] = versine(near[turned])
    high = versine(np.minimum(hi, np.pi)) + r.noise
    later = np.maximum(r.c, near)
    free = np.maximum(TWO_PI - lo - np.where(low > crest, later, r.c), 0.0)
    out = high - crest
    c = np.minimum(arc_versine(high + r.jump + np.maximum(out, 0.0) * np.expm1(free / r.beta)), r.end)
    free = np.maximum(TWO_PI - hi - c, 0.0)
    c = np.where(out < 0, np.minimum(arc_versine(high + r.jump + out * np.expm1(free / r.beta)), c), c)
    longer = np.maximum(hi + r.x, 0.0) + np.maximum(c - r.c, 0.0)
    free = np.maximum(TWO_PI - hi - c, 0.0)
    # displacement, at least
    steep, onset = r.level + low, -r.x
    begun, ended = np.maximum(np.minimum(t, near), onset), np.maximum(np.minimum(held, near), r.c)
    apart = (r.level + 1 + r.delta_0) * (begun - onset + ended - r.c)
    apart -= _sine_cosine(begun)[0] + _sine_cosine(ended)[0] - r.sines
    apart += (TWO_PI - begun - later) * steep + (later - ended) * np.minimum(r.level + drop + r.delta_0, steep)
    apart += np.maximum(steep, 0.0) * (r.beta * np.expm1(free / r.beta) - free)
    least = r.kept + pressed - r.p_0 * longer + np.maximum(apart, r.least) - TWO_PI * r.noise
    return np.where(possible, least, np.inf)
