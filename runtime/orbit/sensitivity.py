"""Rigorous bounds on the slope of the onset-to-onset map over an interval of onset phases.

With R(x) = r(x) exp(x/beta), r from ``march``, the chain rule through the edges gives
``beta R' = exp(x/beta) (N - F)``, where ``F = H(x) + delta_0`` and ``N = F T'`` with

``T' = exp(-2 pi/beta - (a - b) L/alpha) (1 + s_x/F) (1 + s_c/M)``, ``M = -(H_c + delta_0 + p_0)``,

``s_x`` and ``s_c`` the steps of the load at onset and release; at a periodic orbit T' is the slope of the map, which the
derivation proves (``onset_slope_*``). Along the onset arc b grows, a and c fall with x (a later onset is a less engaged
orbit), so every factor is bounded by its values at the ends of an interval and at the extremum of the one harmonic H. The
logarithm of T' is kept beside N: at large beta T' is one but for terms of order 1/beta, which N - F would lose to rounding.
"""

from dataclasses import dataclass

import numpy as np

from .groups import ROUNDING, Cycle
from .march import TWO_PI, Orbit

#: least relaxation time that is divided by
_LEAST = 1e-290


@dataclass(frozen=True, slots=True)
class SlopeBounds:
    """Over an interval: how fast R can fall and rise at most (``N - F`` from below and above, as rates >= 0), and whether it
    falls strictly."""

    fall: np.ndarray
    rise: np.ndarray
    falls: np.ndarray


def slope_excess(kernel, cycle: Cycle, orbit: Orbit) -> tuple[np.ndarray, np.ndarray]:
    """``log T'`` and N at each orbit (not engaged)."""
    F = onset_margin(kernel, cycle, orbit.x)
    M = release_margin(kernel, cycle, orbit.c)
    return _log_slope(cycle, contact_length(orbit.b, orbit.a), F, M), _numerator(
        kernel, cycle, contact_length(orbit.b, orbit.a), F, M
    )


def onset_margin(kernel, cycle: Cycle, x: np.ndarray) -> np.ndarray:
    """``F = H(x) + delta_0``: positive in the onset arc."""
    s = cycle.strips
    return kernel.forcing(x, s.D, s.beta) + s.delta_0


def release_margin(kernel, cycle: Cycle, c: np.ndarray) -> np.ndarray:
    """``M = -(H(c) + delta_0 + p_0)``: positive in the arc where adhesion ends."""
    s = cycle.strips
    return -(kernel.forcing(c, s.D, s.beta) + s.delta_0 + s.p_0)


def slope_bounds(kernel, cycle: Cycle, left: Orbit, right: Orbit) -> SlopeBounds:
    """Bounds over [left.x, right.x]; ``left`` may be engaged (then its edges are replaced by the ends of their arcs)."""
    last_a = cycle.centre + TWO_PI - cycle.half_b
    last_c = cycle.centre + TWO_PI - cycle.half_c
    b_left = np.where(np.isnan(left.b) & ~np.isnan(right.b), right.b, left.b)
    a_left = np.where(left.engaged, last_a, left.a)
    c_left = np.where(left.engaged, last_c, left.c)
    longest = np.where(left.engaged & np.isnan(left.b) & np.isnan(right.b), 0.0, contact_length(b_left, a_left))
    shortest = contact_length(right.b, right.a)
    F_left, F_right = onset_margin(kernel, cycle, left.x), onset_margin(kernel, cycle, right.x)
    top = onset_margin(kernel, cycle, cycle.centre)
    F_min = np.minimum(F_left, F_right)
    F_max = np.where((left.x < cycle.centre) & (right.x > cycle.centre), top, np.maximum(F_left, F_right))
    M_left = np.where(left.engaged, 0.0, release_margin(kernel, cycle, c_left))
    M_right = release_margin(kernel, cycle, right.c)
    middle = cycle.centre + np.pi
    deepest = release_margin(kernel, cycle, middle)
    M_max = np.where((right.c < middle) & (c_left > middle), deepest, np.maximum(M_left, M_right))
    M_min = np.minimum(M_left, M_right)
    # T' falls with F and M, N grows with F
    log_min = _log_slope(cycle, longest, F_max, M_max)
    log_max = _log_slope(cycle, shortest, F_min, M_min)
    N_min = _numerator(kernel, cycle, longest, F_min, M_max)
    N_max = _numerator(kernel, cycle, shortest, F_max, M_min)
    N_min = np.where(np.isfinite(N_min), N_min, 0.0)
    fall = np.minimum(-F_max * np.expm1(np.minimum(log_min, 0.0)), np.maximum(F_max - N_min, 0.0))
    growth = np.where(log_max < 700, np.expm1(np.clip(log_max, 0.0, 700.0)), np.inf)
    rise = np.minimum(
        np.multiply(F_max, growth, out=np.zeros_like(F_max), where=(growth > 0) & (F_max > 0)), np.maximum(N_max - F_min, 0.0)
    )
    return SlopeBounds(fall, rise, (log_max < 0) | (N_max < F_min))


def steep_margin(kernel, cycle: Cycle, latest, right: Orbit) -> np.ndarray:
    """The F beyond which R falls strictly at every onset before that of ``right`` from which adhesion ends before ``latest``, inf
    if that is unknown.

    There contact is longer than in ``right`` and adhesion ends between the two phases, where M is least at one of them:
    ``log T' <= log B + log(1 + s_x/F)`` with a B that does not depend on the onset, negative where ``F > s_x/(1/B - 1)``.
    """
    M = np.minimum(release_margin(kernel, cycle, latest), release_margin(kernel, cycle, right.c))
    # the rounding of the terms of log B, which may cancel
    log_B = np.log1p(over(cycle.release_step, M)) - (1 - ROUNDING) * fading(cycle, contact_length(right.b, right.a))
    return np.divide(cycle.onset_step, np.expm1(np.minimum(-log_B, 700.0)), out=np.full(log_B.shape, np.inf), where=log_B < 0)


def slope_grows(kernel, cycle: Cycle, orbit: Orbit) -> np.ndarray:
    """Where T' grows with the onset, from that of ``orbit`` (not engaged) on until contact, if it is certain, is met no more.

    Contact gets shorter. Of the two factors, that of the onset grows where F falls, behind the centre of its arc, and that of the
    end of adhesion where M falls as c gets smaller, before the middle of its arc. Elsewhere contact may get shorter fast enough:
    along adhesion ``db/dx = exp(-(b - x)/beta) (F + s_x)/(H_b + p_0)`` (1 where it begins at once) and
    ``da/dc = -exp((c - a)/beta) M/(H_a + p_0)``, so that it is enough that

    ``s_x F' <= (L/alpha) F (F + s_x) db/dx``,  ``-s_c M' <= (L/alpha) M (M + s_c) da/dc``

    with F, M and their slopes at x and c, where they are least and steepest, and H as large as it can be.
    """
    s, steep = cycle.strips, np.hypot(1, cycle.strips.beta)
    F, M = onset_margin(kernel, cycle, orbit.x), release_margin(kernel, cycle, orbit.c)
    before, behind = cycle.centre - orbit.x, orbit.c - cycle.centre - np.pi
    within = (before <= np.pi / 2) & (behind <= np.pi / 2) & (F > 0) & (M > 0)
    adheres = cycle.centre + cycle.half_b - orbit.x
    begins = np.where(cycle.direct, 1.0, (F + cycle.onset_step) * kernel.decay(adheres, s.beta))
    most = np.where(cycle.direct, 1.0, s.D - 1 + steep + s.p_0)
    onset_grows = cycle.onset_step * steep * np.sin(before) * s.alpha * most <= s.L * F * (F + cycle.onset_step) * begins
    most = steep + 1 - s.D - s.p_0
    release_grows = cycle.release_step * steep * np.sin(behind) * s.alpha * most <= s.L * M**2 * (M + cycle.release_step)
    return within & ((before <= 0) | (cycle.touched & onset_grows)) & ((behind <= 0) | (cycle.touched & release_grows))


def contact_length(b, a):
    """Length of contact, 0 where there is none."""
    return np.where(np.isnan(b), 0.0, np.maximum(a - b, 0.0))


def fading(cycle: Cycle, length) -> np.ndarray:
    """``2 pi/beta + (a - b) L/alpha``, what a period with a contact of this ``length`` forgets."""
    s = cycle.strips
    return TWO_PI / np.maximum(s.beta, _LEAST) + np.where(length > 0, length * s.L / np.maximum(s.alpha, _LEAST), 0.0)


def _log_slope(cycle: Cycle, length, F, M):
    """``log T'``: -inf where nothing of the onset is remembered, +inf where the onset or the end of adhesion grazes."""
    s = cycle.strips
    memory = over(TWO_PI + 0 * length, s.beta) + over(length * s.L, s.alpha)
    gain = np.log1p(over(cycle.onset_step, F)) + np.log1p(over(cycle.release_step, M))
    return np.where(np.isinf(memory), -np.inf, gain - np.where(np.isinf(memory), 0.0, memory))


def _numerator(kernel, cycle: Cycle, length, F, M):
    """``N = F T'`` with F multiplied in, so that it stays finite where the onset grazes."""
    s = cycle.strips
    damping = kernel.decay(TWO_PI, s.beta) * kernel.decay(length * s.L, s.alpha)
    factor = damping * np.maximum(F + cycle.onset_step, 0.0)
    return np.multiply(factor, 1 + over(cycle.release_step, M), out=np.zeros_like(factor), where=factor > 0)


def over(numerator, denominator):
    """``numerator/denominator`` for ``numerator >= 0``: 0 if it is 0, inf where the denominator is not positive or too small."""
    out = np.where(numerator > 0, np.inf, 0.0)
    return np.divide(
        numerator, denominator, out=out, where=(denominator > 0) & (denominator > 1e-290 * numerator) & (numerator > 0)
    )
