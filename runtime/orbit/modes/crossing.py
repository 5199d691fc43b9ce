"""First crossings of sums of exponentials and one harmonic, for a whole batch at once, approached from one side.

Every event of a strip is a zero of ``G(s) = constant + a cos s + b sin s + sum_i c_i exp(-(s - start) r_i)``. With
several times its zeros lie in no closed-form arcs. But where G > 0 two parabolas bound it from below at all later
phases:

* a decaying term with ``c > 0`` is convex: its tangent lies below it; one with ``c < 0`` only rises. So with the slopes
  of the harmonic and of the positive terms alone G lies above ``G + slope t - hypot(a, b) t^2/2``;
* with the slopes of all terms it lies above the parabola whose curvature also takes in ``|c| r^2`` of the negative
  terms, which only falls.

Stepping to the farther of their zeros approaches the first zero of G, cannot pass it, and converges like Newton's
method where it is simple. No sign of any coefficient is assumed, and nothing is sampled.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .problem import pick

NONE, LOWER, UPPER, LOST = 0, 1, 2, -1
#: a step this small is below what the phase can be known to
_TOLERANCE = 2e-15
_ROUNDINGS, _SMALL = 4 * np.finfo(float).eps, 1e-8
_MAX_STEPS = 600


@dataclass(slots=True)
class Field:
    """``value = constant + a cos s + b sin s + sum_i c_i exp(-(s - start) r_i)`` of N strips: (N,), and (n, N) for
    ``c`` and ``r``."""

    start: np.ndarray
    constant: np.ndarray
    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    r: np.ndarray

    def take(self, index) -> Field:
        one = self.start[index], self.constant[index], self.a[index], self.b[index]
        return Field(*one, self.c[:, index], pick(self.r, index))


def first_crossing(field: Field, end: np.ndarray, height: np.ndarray):
    """Where ``field``, in between at its start, first leaves the range from 0 to ``height`` (inf: no upper limit) before ``end``.

    Returns phases (``end`` where it stays inside), which limit was met (``NONE``, ``LOWER``, ``UPPER``; ``LOST`` where
    the search did not end), the slope of the field there, and the evaluations each took; all of shape (N,).
    """
    n = end.size
    s, which, slope_there, spent = field.start.copy(), np.full(n, LOST), np.zeros(n), np.zeros(n)
    active, here, now, limit, top = np.arange(n), field, field.start.copy(), end, height
    size = np.hypot(here.a, here.b)
    for _ in range(_MAX_STEPS):
        if not active.size:
            break
        step, low_first, slope, margin = _safe_step(here, now, top, size)
        spent[active] += 1
        # a margin of a few roundings, still shrinking, is none: steps too small to change it would never end
        lost_in_rounding = (margin <= _ROUNDINGS * (np.abs(here.constant) + size)) & (step <= _SMALL) & (low_first == (slope < 0))
        reached = (step <= _TOLERANCE * np.maximum(1.0, np.abs(now))) | lost_in_rounding
        after = now + step
        beyond = after >= limit
        done = reached | beyond
        if done.any():
            i = active[done]
            s[i] = np.where(beyond[done], limit[done], after[done])
            which[i] = np.where(beyond[done], NONE, np.where(low_first[done], LOWER, UPPER))
            slope_there[i] = slope[done]
            rest = np.flatnonzero(~done)
            active, here, after, limit, top, size = active[rest], here.take(rest), after[rest], limit[rest], top[rest], size[rest]
        now = after
    return s, which, slope_there, spent


def _safe_step(f: Field, s, height, size):
    """A step over which the field stays in its range, whether the lower limit bounds it, the field's slope at ``s`` and
    its distance from that limit."""
    cosine, sine = np.cos(s), np.sin(s)
    lag = s - f.start
    term = f.c * np.exp(-lag * f.r)
    above = np.maximum(term, 0.0)
    rate = f.r * term
    rate_above = f.r * above
    harmonic = f.b * cosine - f.a * sine
    value = f.constant + f.a * cosine + f.b * sine + term.sum(axis=0)
    fast, slow = rate_above.sum(axis=0), (rate - rate_above).sum(axis=0)
    slope = harmonic - fast - slow
    bend = (f.r * rate_above).sum(axis=0)
    bend_below = bend - (f.r * rate).sum(axis=0)
    # a zone begins on the very limit that ended the zone before, and leads away from it
    at_start = lag == 0
    low = np.where(at_start & (slope > 0), np.maximum(value, 0.0), value)
    bounded = np.isfinite(height)
    room = np.where(bounded, height, 1.0) - value
    room = np.where(at_start & (slope < 0), np.maximum(room, 0.0), room)
    # to either limit by either parabola, all four at once: with few strips the number of calls is what counts
    gaps, rates = np.stack((low, low, room, room)), np.stack((harmonic - fast, slope, slow - harmonic, -slope))
    reach = _reach(gaps, rates, size + np.stack((np.zeros(s.shape), np.maximum(bend_below, 0.0), np.zeros(s.shape), bend)))
    step, up = np.maximum(reach[0], reach[1]), np.where(bounded, np.maximum(reach[2], reach[3]), np.inf)
    down = step <= up
    return np.minimum(step, up), down, slope, np.where(down, low, room)


def _reach(value, slope, curvature):
    """Zero of ``value + slope t - curvature t^2/2`` that follows t = 0; 0 where the value is not positive but for a
    rise from zero."""
    safe = np.maximum(value, 0.0)
    root = np.sqrt(slope * slope + 2 * curvature * safe)
    rising = slope > 0
    divisor = np.where(rising, curvature, root - slope)
    step = np.divide(np.where(rising, slope + root, 2 * safe), divisor, out=np.full(safe.shape, np.inf), where=divisor > 0)
    return np.where(value < 0, 0.0, np.where((value == 0) & ~rising, 0.0, step))
