"""Rigorous bounds on the slope of the onset-to-onset map over an interval of onset phases.

With R(x) = r(x) exp(x/beta), r from ``march``, ``beta R' = exp(x/beta) (N - F)``, where ``F = H(x) + delta_0`` and ``N = F T'``,

``T' = exp(-2 pi/beta - (a - b) L/alpha) (1 + s_x/F) (1 + s_c/M)``, ``M = -(H_c + delta_0 + p_0)``,

``s_x`` and ``s_c`` the steps of the load at onset and release (derivation: ``onset_map.slope_of_the_onset_map``). Along the
onset arc b grows, a and c fall with x (a later onset is a less engaged orbit), so every factor is bounded by its values at the
ends of an interval and at the extremum of the one harmonic H. With g the
logarithm of T' without its factor of the onset, ``N - F = F (exp(g) - 1) + s_x exp(g)``: that stays finite where the onset
grazes, grows with g, is linear in F, and keeps its digits at large beta, where T' is one but for terms of order 1/beta.
"""

import numpy as np

from ..numerics.rounding import LARGEST
from .groups import ROUNDING, TWO_PI, Cycle
from .march import Orbit


def slope_excess(kernel, cycle: Cycle, orbit: Orbit) -> tuple[np.ndarray, np.ndarray]:
    """``log T'`` and ``N - F`` at each orbit (not engaged)."""
    F = onset_margin(kernel, cycle, orbit.x)
    gain = _log_gain(cycle, fading(cycle, orbit.b, orbit.a), release_margin(kernel, cycle, orbit.c))
    log_onset = np.log1p(over(cycle.onset_step, F))
    return np.add(gain, log_onset, out=np.full(F.shape, -np.inf), where=gain > -np.inf), _excess(cycle, F, gain)


def onset_margin(kernel, cycle: Cycle, x: np.ndarray) -> np.ndarray:
    """``F = H(x) + delta_0``: positive in the onset arc."""
    s = cycle.strips
    return kernel.forcing(x, s.D, s.beta) + s.delta_0


def release_margin(kernel, cycle: Cycle, c: np.ndarray) -> np.ndarray:
    """``M = -(H(c) + delta_0 + p_0)``: positive in the arc where adhesion ends."""
    s = cycle.strips
    return -(kernel.forcing(c, s.D, s.beta) + s.delta_0 + s.p_0)


def slope_bounds(kernel, cycle: Cycle, left: Orbit, right: Orbit) -> tuple[np.ndarray, np.ndarray]:
    """How fast R can fall and rise at most over [left.x, right.x] (``N - F`` from below and above, as rates >= 0); ``left`` may
    be engaged (then its edges are replaced by the ends of their arcs)."""
    a_left = np.where(left.engaged, cycle.centre + TWO_PI - cycle.half_b, left.a)
    c_left = np.where(left.engaged, cycle.centre + TWO_PI - cycle.half_c, left.c)
    b_left = np.where(np.isnan(left.b), right.b, left.b)
    F_min = np.minimum(onset_margin(kernel, cycle, left.x), onset_margin(kernel, cycle, right.x))
    F_max = onset_margin(kernel, cycle, np.clip(cycle.centre, left.x, right.x))
    M_left = np.where(left.engaged, 0.0, release_margin(kernel, cycle, c_left))
    M_min = np.minimum(M_left, release_margin(kernel, cycle, right.c))
    M_max = release_margin(kernel, cycle, np.clip(cycle.centre + np.pi, right.c, c_left))
    least = _log_gain(cycle, fading(cycle, b_left, a_left), M_max)
    most = _log_gain(cycle, fading(cycle, right.b, right.a), M_min)
    fall = -np.minimum(_excess(cycle, F_min, least), _excess(cycle, F_max, least))
    rise = np.maximum(_excess(cycle, F_min, most), _excess(cycle, F_max, most))
    return np.maximum(fall, 0.0), np.maximum(rise, 0.0)


def falls(kernel, cycle: Cycle, left: Orbit, right: Orbit) -> np.ndarray:
    """Where R falls strictly over [left.x, right.x] by more than rounding blurs: F and M are least at one of its ends, contacts
    are no shorter than that of ``right``. False where an end is not known (NaN)."""
    F = np.minimum(onset_margin(kernel, cycle, left.x), onset_margin(kernel, cycle, right.x)) - cycle.strips.noise()
    M = np.minimum(release_margin(kernel, cycle, left.c), release_margin(kernel, cycle, right.c))
    # the rounding of the terms of the gain, which may cancel
    most = _log_gain(cycle, (1 - ROUNDING) * fading(cycle, right.b, right.a), M)
    return (F > 0) & (most < 0) & (_excess(cycle, F, most) <= 0)


def slope_grows(kernel, cycle: Cycle, orbit: Orbit) -> np.ndarray:
    """Where T' grows with the onset, from that of ``orbit`` (not engaged) on until contact, if it is certain, is met no more.

    Contact gets shorter. Of the two factors, that of the onset grows where F falls, behind the centre of its arc, and that of the
    end of adhesion where M falls as c gets smaller, before the middle of its arc. Elsewhere contact may get shorter fast enough
    (derivation: ``onset_map.growth_of_the_slope``, with db/dx = 1 where contact begins at once). It is enough that

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


def fading(cycle: Cycle, b, a) -> np.ndarray:
    """``2 pi/beta + (a - b) L/alpha``, what a period with a contact from b to a (NaN: none) forgets; inf: everything."""
    s, length = cycle.strips, np.where(np.isnan(b), 0.0, np.maximum(a - b, 0.0))
    return over(TWO_PI + 0 * length, s.beta) + over(length * s.L, s.alpha)


def _log_gain(cycle: Cycle, forgets, M):
    """``log T'`` but for its factor of the onset: -inf where a period ``forgets`` all, else inf where the release grazes."""
    return np.subtract(np.log1p(over(cycle.release_step, M)), forgets, out=np.full(M.shape, -np.inf), where=forgets < np.inf)


def _excess(cycle: Cycle, F, gain):
    """``N - F`` at an onset of this F: inf where the end of adhesion grazes, 0 where the onset does, too, without a step."""
    F, grazes = np.maximum(F, 0.0), gain == np.inf
    fixed = np.where(grazes, 0.0, gain)
    return np.where(grazes & (F + cycle.onset_step > 0), np.inf, F * np.expm1(fixed) + cycle.onset_step * np.exp(fixed))


def over(numerator, denominator):
    """``numerator/denominator`` for ``numerator >= 0``: 0 if it is 0, inf where it is too large, or over nothing positive."""
    out = np.where(numerator > 0, np.inf, 0.0)
    return np.divide(numerator, denominator, out=out, where=(denominator > numerator / LARGEST) & (numerator > 0))
