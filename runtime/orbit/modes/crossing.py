"""First crossings of sums of exponentials and one harmonic, for a whole batch at once, approached from one side.

Every event of a strip is a zero of ``G(s) = constant + a cos s + b sin s + sum_i c_i exp(-(s - start) r_i)``. With several times
its zeros lie in no closed-form arcs. But where G > 0 two parabolas bound it from below at all later phases:

* a decaying term with ``c > 0`` is convex: its tangent lies below it; one with ``c < 0`` only rises. So with the slopes
  of the harmonic and of the positive terms alone G lies above ``G + slope t - hypot(a, b) t^2/2``;
* with the slopes of all terms it lies above the parabola whose curvature also takes in ``|c| r^2`` of the negative
  terms, which only falls.

Stepping to the farther of their zeros approaches the first zero of G, cannot pass it, and converges like Newton's
method where it is simple. No sign of any coefficient is assumed, and nothing is sampled.
"""

from dataclasses import dataclass

import numpy as np

from ...numerics.rounding import EPS, LARGEST

NONE, LOWER, UPPER, LOST = 0, 1, 2, -1
#: a step this small is below what the phase can be known to; a margin so small is none, if the step is small, too
_ROUNDINGS, _SMALL = 4 * EPS, 1e-8
_MAX_STEPS = 600


@dataclass(slots=True)
class Field:
    """``constant + a cos s + b sin s + sum_i c_i exp(-(s - start) r_i)`` of N strips: (N,), and (n, N) for ``c`` and ``r``."""

    start: np.ndarray
    constant: np.ndarray
    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    r: np.ndarray

    def rise(self, index, limit) -> None:
        """Let the strips ``index``, which begin below zero, begin where they rise through it, at the ``limit`` at the latest."""
        below = Field(self.start[index], *(-v[..., index] for v in (self.constant, self.a, self.b, self.c)), self.r[:, index])
        start, _ = first_crossing(below, limit[index], np.full(index.size, np.inf))
        self.c[:, index] *= np.exp((self.start[index] - start) * self.r[:, index])
        self.start[index] = start


def first_crossing(field: Field, end: np.ndarray, height: np.ndarray):
    """Where ``field``, in between at its start, first leaves the range from 0 to ``height`` (inf: no upper limit) before ``end``.

    Returns phases (``end`` where it stays inside), and which limit was met (``LOST``: the search did not end), (N,)."""
    n = end.size
    s, which = field.start.copy(), np.full(n, LOST)
    # of the strips that go on, ``index``: where each is now, up to where it goes, the upper limit, and the field's parts
    index, r, above = np.arange(n), field.r, np.maximum(field.c, 0.0)
    falling, rising = above * r, (field.c - above) * r
    # rates; terms; how fast the positive and the negative ones fall; how fast that does
    terms = np.stack((r, field.c, falling, rising, falling * r, rising * r))
    ahead = np.stack((field.start, end, np.minimum(height, LARGEST), field.start, field.constant, field.a, field.b,
                      np.hypot(field.a, field.b)))  # fmt: skip
    for number in range(_MAX_STEPS):
        if not index.size:
            break
        step, low_first, margin, slope, curvature = _safe_step(ahead, terms, number == 0)
        now, end, _, _, constant, _, _, size = ahead
        now += step
        done = beyond = now >= end
        near = step <= _SMALL
        if near.any():
            # a margin of a few roundings, still shrinking, is none: steps too small to change it would never end
            lost_in_rounding = (margin <= _ROUNDINGS * (np.abs(constant) + size)) & (low_first == (slope < 0))
            # what is left behind a step follows from its square
            left = step * np.minimum(1.0, curvature * step / np.maximum(np.abs(slope), 1 / LARGEST))
            done = beyond | near & ((left <= _ROUNDINGS * np.maximum(1.0, np.abs(now))) | lost_in_rounding)
        if done.any():
            i = index[done]
            s[i] = np.where(beyond[done], end[done], now[done])
            which[i] = np.where(beyond[done], NONE, np.where(low_first[done], LOWER, UPPER))
            rest = np.flatnonzero(~done)
            index, ahead, terms = index[rest], ahead[:, rest], terms[..., rest]
    return s, which


def _safe_step(ahead, terms, first: bool):
    """A step that keeps the field in its range, whether the lower limit bounds it, the room to that, slope, most curvature."""
    now, _, height, start, constant, a, b, size = ahead
    cosine, sine = np.cos(now), np.sin(now)
    decayed, fast, slow, bend, lift = np.einsum("kiN,iN->kN", terms[1:], np.exp((start - now) * terms[0]))
    harmonic = b * cosine - a * sine
    value = constant + a * cosine + b * sine + decayed
    slope = harmonic - fast - slow
    low, room = value, height - value
    if first:
        # a zone begins on the very limit that ended the zone before, and leads away from it
        low = np.where(slope > 0, np.maximum(low, 0.0), low)
        room = np.where(slope < 0, np.maximum(room, 0.0), room)
    # to either limit by either parabola, all four at once: with few strips the number of calls is what counts
    gaps, rates, curvatures = np.empty((3, 4, value.size))
    gaps[:2], gaps[2:] = low, room
    rates[0], rates[1], rates[2], rates[3] = harmonic - fast, slope, slow - harmonic, -slope
    curvatures[:] = size
    curvatures[1] -= lift
    curvatures[3] += bend
    reach = _reach(gaps, rates, curvatures)
    step, up = np.maximum(reach[0], reach[1]), np.maximum(reach[2], reach[3])
    down = step <= up
    return np.minimum(step, up), down, np.where(down, low, room), slope, curvatures[1] + bend


def _reach(value, slope, curvature):
    """Zero of ``value + slope t - curvature t^2/2`` that follows t = 0; 0 where the value is not positive nor rises from 0."""
    safe = np.maximum(value, 0.0)
    root = np.sqrt(slope * slope + 2 * curvature * safe) + np.abs(slope)
    return np.where((slope > 0) & (value >= 0), root / curvature, 2 * safe / np.maximum(root, 1 / LARGEST))
