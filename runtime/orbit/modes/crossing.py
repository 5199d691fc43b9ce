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

from ...numerics.rounding import EPS, LARGEST

NONE, LOWER, UPPER, LOST = 0, 1, 2, -1
#: a step this small is below what the phase can be known to; a margin so small is none, if the step is small, too
_ROUNDINGS, _SMALL = 4 * EPS, 1e-8
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

    def amplitudes(self) -> np.ndarray:
        """Of the positive terms, their rates and the rates of those, then of the negative terms, (6, n, N)."""
        above = np.maximum(self.c, 0.0)
        falling, rising = above * self.r, (self.c - above) * self.r
        return np.stack((above, falling, falling * self.r, self.c - above, rising, rising * self.r))


@dataclass(slots=True)
class _Ahead:
    """Fields on their way: strips ``index``, where each is ``now``, up to where it goes, upper limit, and the field's parts."""

    index: np.ndarray
    now: np.ndarray
    end: np.ndarray
    height: np.ndarray
    start: np.ndarray
    constant: np.ndarray
    a: np.ndarray
    b: np.ndarray
    size: np.ndarray
    r: np.ndarray
    terms: np.ndarray

    def take(self, rest) -> _Ahead:
        return _Ahead(*(getattr(self, name)[..., rest] for name in self.__slots__))


def first_crossing(field: Field, end: np.ndarray, height: np.ndarray):
    """Where ``field``, in between at its start, first leaves the range from 0 to ``height`` (inf: no upper limit) before ``end``.

    Returns phases (``end`` where it stays inside), and which limit was met (``NONE``, ``LOWER``, ``UPPER``; ``LOST`` where
    the search did not end), (N,).
    """
    n = end.size
    s, which = field.start.copy(), np.full(n, LOST)
    go = _Ahead(np.arange(n), field.start, end, np.minimum(height, LARGEST), field.start, field.constant, field.a, field.b,
                np.hypot(field.a, field.b), field.r, field.amplitudes())  # fmt: skip
    for number in range(_MAX_STEPS):
        if not go.index.size:
            break
        step, low_first, slope, margin = _safe_step(go, number == 0)
        # a margin of a few roundings, still shrinking, is none: steps too small to change it would never end
        lost_in_rounding = (
            (margin <= _ROUNDINGS * (np.abs(go.constant) + go.size)) & (step <= _SMALL) & (low_first == (slope < 0))
        )
        reached = (step <= _ROUNDINGS * np.maximum(1.0, np.abs(go.now))) | lost_in_rounding
        go.now = go.now + step
        beyond = go.now >= go.end
        done = reached | beyond
        if done.any():
            i = go.index[done]
            s[i] = np.where(beyond[done], go.end[done], go.now[done])
            which[i] = np.where(beyond[done], NONE, np.where(low_first[done], LOWER, UPPER))
            go = go.take(np.flatnonzero(~done))
    return s, which


def _safe_step(f: _Ahead, first: bool):
    """A step over which the field stays in its range, whether the lower limit bounds it, the field's slope where it is and
    its distance from that limit."""
    cosine, sine = np.cos(f.now), np.sin(f.now)
    above, fast, bend, below, slow, lift = np.einsum("kiN,iN->kN", f.terms, np.exp((f.start - f.now) * f.r))
    harmonic = f.b * cosine - f.a * sine
    value = f.constant + f.a * cosine + f.b * sine + above + below
    slope = harmonic - fast - slow
    low, room = value, f.height - value
    if first:
        # a zone begins on the very limit that ended the zone before, and leads away from it
        low = np.where(slope > 0, np.maximum(low, 0.0), low)
        room = np.where(slope < 0, np.maximum(room, 0.0), room)
    # to either limit by either parabola, all four at once: with few strips the number of calls is what counts
    gaps, rates, curvatures = np.empty((3, 4, value.size))
    gaps[:2], gaps[2:] = low, room
    rates[0], rates[1], rates[2], rates[3] = harmonic - fast, slope, slow - harmonic, -slope
    curvatures[:] = f.size
    curvatures[1] -= lift
    curvatures[3] += bend
    reach = _reach(gaps, rates, curvatures)
    step, up = np.maximum(reach[0], reach[1]), np.maximum(reach[2], reach[3])
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
    return np.where((value < 0) | (value == 0) & ~rising, 0.0, step)
