"""Rigorous bounds on the slope of the onset-to-onset map over an interval of onset phases.

With R(x) = r(x) exp(x/beta), r from ``march``, the chain rule through the edges gives
``beta R' = exp(x/beta) (N - H(x) - delta_0)`` with

``N = exp(-2 pi/beta - (a - b) L/alpha) (H_x + slope_on) (H_c + delta_0 + jump)/(H_c + delta_0 + p_0)``;

at a periodic orbit the slope of the map is ``T' = N/(H_x + delta_0)``. Along the onset arc b grows, a and c fall with x
(a later onset is a less engaged orbit), so every factor is bounded by its values at the ends of an interval and at the
extremum of the one harmonic H.
"""

from dataclasses import dataclass

import numpy as np

from .march import TWO_PI, Orbit
from .problem import Cycle


@dataclass(frozen=True, slots=True)
class SlopeBounds:
    """Bounds over an interval: least and greatest N, least and greatest ``H + delta_0`` (onset threshold)."""

    N_min: np.ndarray
    N_max: np.ndarray
    F_min: np.ndarray
    F_max: np.ndarray


def slope_factor(kernel, cycle: Cycle, orbit: Orbit) -> np.ndarray:
    """N at each orbit (not engaged)."""
    s = cycle.strips
    forcing_x = kernel.forcing(orbit.x, s.D, s.beta)
    forcing_c = kernel.forcing(orbit.c, s.D, s.beta)
    onset = np.maximum(forcing_x + cycle.slope_on, 0.0)
    return _product(_damping(kernel, cycle, _length(orbit.b, orbit.a)) * onset, _release(cycle, forcing_c))


def onset_margin(kernel, cycle: Cycle, x: np.ndarray) -> np.ndarray:
    """``H(x) + delta_0``: positive in the onset arc."""
    s = cycle.strips
    return kernel.forcing(x, s.D, s.beta) + s.delta_0


def slope_bounds(kernel, cycle: Cycle, left: Orbit, right: Orbit) -> SlopeBounds:
    """Bounds over [left.x, right.x]; ``left`` may be engaged (then its edges are replaced by the ends of their arcs)."""
    s = cycle.strips
    last_a = cycle.centre + TWO_PI - cycle.half_b
    last_c = cycle.centre + TWO_PI - cycle.half_c
    b_left = np.where(np.isnan(left.b) & ~np.isnan(right.b), right.b, left.b)
    a_left = np.where(left.engaged, last_a, left.a)
    c_left = np.where(left.engaged, last_c, left.c)
    longest = np.where(
        left.engaged & np.isnan(left.b) & np.isnan(right.b), 0.0, _length(b_left, a_left)
    )
    shortest = _length(right.b, right.a)
    F_left, F_right = onset_margin(kernel, cycle, left.x), onset_margin(kernel, cycle, right.x)
    top = s.D - 1 + np.hypot(1, s.beta) + s.delta_0
    F_min = np.minimum(F_left, F_right)
    F_max = np.where((left.x < cycle.centre) & (right.x > cycle.centre), top, np.maximum(F_left, F_right))
    shift = cycle.slope_on - s.delta_0
    H_left = np.where(left.engaged, -s.p_0 - s.delta_0, kernel.forcing(c_left, s.D, s.beta))
    H_right = kernel.forcing(right.c, s.D, s.beta)
    bottom = s.D - 1 - np.hypot(1, s.beta)
    middle = cycle.centre + np.pi
    H_c_min = np.where((right.c < middle) & (c_left > middle), bottom, np.minimum(H_left, H_right))
    H_c_max = np.maximum(H_left, H_right)
    return SlopeBounds(
        N_min=_product(_damping(kernel, cycle, longest) * np.maximum(F_min + shift, 0.0), _release(cycle, H_c_min)),
        N_max=_product(_damping(kernel, cycle, shortest) * np.maximum(F_max + shift, 0.0), _release(cycle, H_c_max)),
        F_min=F_min,
        F_max=F_max,
    )


def _product(factor, release):
    """Zero where nothing of the onset is remembered, also when the end of adhesion grazes."""
    return np.multiply(factor, release, out=np.zeros_like(factor), where=factor > 0)


def _length(b, a):
    return np.where(np.isnan(b), 0.0, np.maximum(a - b, 0.0))


def _damping(kernel, cycle: Cycle, contact_length):
    s = cycle.strips
    return kernel.decay(TWO_PI, s.beta) * kernel.decay(contact_length * s.L, s.alpha)


def _release(cycle: Cycle, forcing_c):
    """``(H_c + delta_0 + jump)/(H_c + delta_0 + p_0)`` where the denominator is negative: at least 1, inf at grazing."""
    s = cycle.strips
    margin = -(forcing_c + s.delta_0 + s.p_0)
    excess = s.p_0 - cycle.jump
    ratio = np.divide(excess, margin, out=np.full_like(margin, np.inf), where=margin > 0)
    return np.where(cycle.bare | (excess <= 0), 1.0, 1 + ratio)
