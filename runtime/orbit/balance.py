"""Proofs by the balance of a period that a strip out of reach of the undeformed foundation, ``D <= -delta_0``, has no orbit with
an onset. The formulas and what proves them: ``balance`` of the derivation.

In every orbit p and w have the same mean. With Q the sum of the pressure over -p_0 in contact and E the length of engagement

    0 = Q - p_0 E - sum of w,

so there is no orbit where the right side is positive. It is bounded from below for all orbits with an onset ``-xi`` between two
phases, ``lo <= xi <= hi``. Along every orbit w is at least ``-p_0``; with that, contact and adhesion end where the sine is not
negative: a and c lie between 0 and pi.

* Contact. At ``-lo`` the strip is engaged with a gap of ``gap_on`` at most, or in contact. While it adheres its w falls, so
  the gap is closed at the latest at ``-t``, where u has risen by ``gap_on``, or by less, if the fall of w until then is taken off
  that is certain whenever the gap closes. From there on its excess pressure is at least that of a contact that begins at
  ``-t``, until it ends at a, where the excess pressure falls. The sum of that lesser pressure from ``-t`` to any phase e is
  closed form and no more than the sum to a: ``alpha p' + p = u + beta u'``.
* Engagement. Free flow leads from c to the onset: ``cos c = cos xi - jump - W (exp(F/beta) - 1)``, ``-W = u(xi) + delta_0``,
  where F is the length of the free zone: c and with it E are bounded from above at hi and the longest F.
* Displacement. Nowhere is w above zero. Let ``V(s) = -u(s) - delta_0``. In contact -w is ``V(s) + delta_0``. Where the strip is
  free -w fades towards its onset, to ``V(xi)``. If it adheres before its contact w has fallen since the onset, and before ``-t``
  u is no more either: V(xi) again. If it adheres after its contact w falls from where that ended, on or behind the crest; so it
  is at most u(e) after any phase e up to which contact is certain to last. As V grows towards the valley, V(lo) stands for V(xi).
"""

import numpy as np

from hystrip.generated.stable import versine

from .groups import ROUNDING, TWO_PI, Cycle, arc_versine

#: parts into which the onsets are divided, and each part that is not excluded again: without the second and third division ten
#: strips take an eighth longer, for searches of single ones, and mixed strips 4 %
_PARTS = (8, 4, 4)


def exclude_out_of_reach(kernel, cycle: Cycle) -> np.ndarray:
    """Cycles of strips out of reach, ``D <= -delta_0``, that cannot stay engaged, proven to have no orbit with an onset."""
    with np.errstate(all="ignore"):
        held = _held_best(cycle)
        none = balance_bound(kernel, cycle, held, held) > 0
        index = np.flatnonzero(none)
        lo, width = np.zeros(index.size), np.pi
        for parts in _PARTS:
            width /= parts
            index, lo = index.repeat(parts), (lo[:, None] + width * np.arange(parts)).ravel()
            open_ = ~(balance_bound(kernel, cycle.take(index), lo, lo + width) > 0)
            index, lo = index[open_], lo[open_]
    none[index] = False
    return none


def _held_best(cycle: Cycle):
    """About the onset, less its sign, from which a strip out of reach is held best: a step of Newton on a foundation that stands
    still in a gap. Nineteen of twenty strips of which nothing can be proven show it there."""
    s = cycle.strips
    sine, cosine, glassy = np.sin(1.0), np.cos(1.0), s.L * s.beta / s.alpha
    a = np.arccos(np.minimum(cosine + s.delta_0, 1.0))
    weight = np.pi + glassy * a
    slope = cosine * weight + glassy * sine**2 / np.sin(a)
    return np.clip(1.0 - (sine * weight - cycle.release_step) / slope, 0.0, np.pi)


def balance_bound(kernel, cycle: Cycle, lo, hi):
    """Lower bound of the balance of all orbits with an onset between -hi and -lo, both between 0 and pi."""
    s, low = cycle.strips, versine(lo)
    noise, out, mean = s.noise(), low - s.D - s.delta_0, s.D - 1 + s.p_0
    # contact, at least: the pressure of complete contact, and what fades of its difference to the one at -t
    t = _contact(cycle, lo, low)
    possible, t = np.isfinite(t), np.minimum(t, TWO_PI)
    e = np.minimum(t, cycle.centre + TWO_PI - cycle.half_b)
    (sin_t, cos_t), (sin_e, cos_e) = _sine_cosine(t), _sine_cosine(e)
    storage, loss = kernel.storage(s.alpha, s.beta), kernel.loss(s.alpha, s.beta, s.L)
    begins = mean + storage * cos_t + loss * sin_t
    late = mean + storage * cos_e - loss * sin_e - begins * kernel.decay(e + t, s.alpha)
    blur = 2 * ROUNDING * (1 + s.beta + (1 + s.alpha) * (np.abs(late) + np.abs(mean)))
    summed = mean * (e + t) + sin_e + sin_t + s.beta * (cos_e - cos_t)
    pressed = np.where(t > 0, np.maximum(summed - s.alpha * late - blur, 0.0), 0.0)
    holds = (t > 0) & (late > blur)
    held, drop = np.where(holds, e, 0.0), np.where(holds, 1 - cos_e, 0.0)
    # engagement, at most
    high = versine(hi) + noise
    away = (high - s.D - s.delta_0) * np.expm1(np.maximum(TWO_PI - 2 * lo, 0.0) / s.beta)
    longest = hi + np.minimum(arc_versine(high + cycle.jump + away), np.pi)
    # displacement, at least
    begun, ended, free = np.minimum(t, lo), np.minimum(held, lo), np.maximum(TWO_PI - longest, 0.0)
    apart = (1 - s.D) * (begun + ended) - _sine_cosine(begun)[0] - _sine_cosine(ended)[0]
    apart += (TWO_PI - begun - lo) * out + (lo - ended) * np.minimum(drop - s.D, out)
    apart += out * (s.beta * np.expm1(free / s.beta) - free)
    return np.where(possible, pressed - s.p_0 * longest + apart - TWO_PI * noise, np.inf)


def _contact(cycle: Cycle, lo, low):
    """Phase t, so that contact begins before -t if the onset is not after -lo, of versine ``low``; 0 where it may not begin, inf
    where no orbit may have such an onset: its w would be less than -p_0."""
    s = cycle.strips
    rise = low - cycle.gap_on - s.noise()
    lag = np.maximum(s.p_0 + s.D - rise, 0.0)
    t = arc_versine(rise)
    most = arc_versine(rise - lag * np.expm1((t - lo) / s.beta))
    least = -lag * np.expm1(np.minimum(most - lo, 0.0) / s.beta)
    return np.where(lag > 0, arc_versine(rise + least), np.inf)


def _sine_cosine(phase):
    """Both to rounding of one, by the tangent of half the phase: a fraction of their cost."""
    tangent = np.tan(0.5 * phase)
    double = 2 / (1 + tangent * tangent)
    return tangent * double, double - 1
