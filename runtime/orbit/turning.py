"""Strips near the end of a branch by fold: where r is least, and what that tells.

``beta R' = exp(x/beta) F (T' - 1)`` (``sensitivity``): r is least about where the slope of the onset map is one,
which is one equation for the march from an onset in place of the one that closes a period. Where r is negative there
a stable orbit lies before it, about as far as a parabola says; marches from onsets on both sides of it isolate it,
where R falls strictly between them, and ``balance`` proves it to be the first.

Where r is positive there is none: let l and m be marches from onsets shortly before and after, r > 0 in both, and
``T' > 1`` at m. Then

* no orbit lies before l (``balance``, or ``exclusion``),
* none lies between them, by bounds on the slope of r (``search.excluded``),
* and none after m can be the most engaged one, if ``T' > 1`` at every orbit after m, while the most engaged orbit
  with an onset has ``T' <= 1``.

If no orbit with an onset is the most engaged one and none is always engaged, the most engaged orbit is free. That
needs no least r: where ``T' > 1`` at all orbits there is none to look for. It is shown by bounds on the slope on a
few intervals. After the last of them, past the middle of the onset arc, later onsets have a shorter contact and a
smaller F, and M is no larger than where adhesion ends after the last of them, if that is before the middle of its
arc, or else than in that middle.
"""

from dataclasses import dataclass

import numpy as np

from . import balance
from .bound import bound
from .chain import arcs, links, moved
from .exclusion import none_before
from .groups import TWO_PI, Cycle
from .march import Orbit, closing, march
from .polish import newton
from .search import SearchResult, excluded
from .sensitivity import contact_length, fading, gains, onset_margin, release_margin, slope_bounds, slope_excess

_EPS = np.finfo(float).eps
_ITERATIONS = 9
#: a step this small leaves an error of its square
_SMALL = 1e-7
#: rounds of the start on a foundation that does not move in a gap
_ROUNDS = 8
#: how far from the least r the marches on both sides begin if it is positive: of the distance at which a parabola has twice
#: that r, and at most
_WAY, _FURTHEST = 0.6, 0.3
#: and where they begin if it is negative, of the distance at which a parabola vanishes
_OUTER, _INNER = 1.4, 0.6
#: ends of the intervals on which T' > 1 is shown one by one, from where r is least, and from the start of the onset arc, if
#: need be on more of them; and where in that arc the last of them ends at the latest
_TOWARDS = np.array([0.0, 1e-4, 0.02, 0.2, 1.0])
_ALL_ALONG = np.linspace(0.0, 1.0, 7), np.linspace(0.0, 1.0, 21)
_TOP = 0.9
#: bounds this close to an onset are good enough
_CLOSE = 0.05


@dataclass(slots=True)
class Turning:
    """What is told of n cycles: which are proven to have ``none`` with an onset that is the most engaged orbit, and the first
    orbits that are ``isolated``, with all evaluations spent."""

    none: np.ndarray
    isolated: SearchResult


def turning(kernel, cycle: Cycle, start, end) -> Turning:
    """For cycles whose adhesion begins before contact. ``start``, ``end``: no onset lies before, and adhesion does not end
    after."""
    with np.errstate(all="ignore"):
        x, curvature, r, spent = _least(kernel, cycle)
        way = np.sqrt(2 * np.abs(r) / curvature)
    result = Turning(np.zeros(cycle.size, bool), SearchResult(cycle.size))
    result.isolated.evaluations += spent
    # a strip within reach is not free
    hangs = cycle.strips.D <= -cycle.strips.delta_0
    for shares in _ALL_ALONG:
        ask = np.flatnonzero(np.isnan(x) & hangs & ~result.none)
        if ask.size:
            result.none[ask], used = _unstable_after(kernel, cycle.among(ask), start[ask], shares)
            result.isolated.evaluations[ask] += used
    index = np.flatnonzero((way > 0) & np.isfinite(way))
    if index.size:
        below, way = r[index] < 0, way[index]
        apart = np.where(below, way, np.minimum(_WAY * way, _FURTHEST))
        inner = np.where(below, -_INNER, 1.0)
        _settle(
            kernel, cycle, index, x[index] - np.where(below, _OUTER, 1.0) * apart, x[index] + inner * apart, start, end, result
        )
    return result


def _settle(kernel, cycle: Cycle, index, before, after, start, end, result: Turning) -> None:
    """March the cycles ``index`` from the onsets ``before`` and ``after``, and enter what that proves."""
    n, isolated = index.size, result.isolated
    marches, used = march(kernel, cycle.take(np.tile(index, 2)), np.concatenate((before, after)))
    left, right = marches.take(slice(0, n)), marches.take(slice(n, None))
    isolated.evaluations[index] += used[:n] + used[n:]
    part = cycle.among(index)
    one, none = np.zeros(n, bool), np.zeros(n, bool)
    ask = np.flatnonzero((left.r > 0) & ~right.engaged)
    ends, there, here = part.among(ask), left.take(ask), right.take(ask)
    bounds = slope_bounds(kernel, ends, there, here)
    one[ask] = (here.r <= 0) & bounds.falls
    none[ask] = (here.r > 0) & excluded(kernel, ends, there, here, bounds, False)
    none &= _rises(kernel, part, right)
    # past the middle of both arcs T' only grows
    ask = np.flatnonzero(none & ((right.x < part.centre) | (right.c > part.centre + np.pi)))
    if ask.size:
        none[ask], used = _unstable_after(kernel, part.among(ask), right.x[ask], _TOWARDS)
        isolated.evaluations[index[ask]] += used
    go = np.flatnonzero(one | none)
    if not go.size:
        return
    part, ends = part.among(go), left.take(go)
    first, used = balance.first(kernel, part, ends, start[index[go]], end[index[go]])
    rest = np.flatnonzero(~first)
    if rest.size:
        first[rest], more = none_before(kernel, part.among(rest), ends.take(rest), start[index[go[rest]]])
        used[rest] += more
    isolated.evaluations[index[go]] += used
    go = go[first]
    result.none[index[go]] = none[go]
    here = go[one[go]]
    isolated.found[index[here]] = True
    isolated.left.put(index[here], left.take(here))
    isolated.right.put(index[here], right.take(here))


def _unstable_after(kernel, cycle: Cycle, x, shares) -> tuple[np.ndarray, np.ndarray]:
    """Where every orbit with an onset after x has ``T' > 1``, and the evaluations spent.

    It is shown on intervals that end at these ``shares`` of the way to the middle of the onset arc, or beyond.
    """
    s = cycle.strips
    noise = 64 * _EPS * (1 + np.abs(s.D) + s.delta_0 + s.p_0)
    middle = cycle.centre + np.pi
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        latest = np.maximum(x, cycle.centre + _TOP * cycle.half_d)
        after, spent = _onset_after(kernel, cycle, middle, latest, noise)
    top = np.maximum(np.maximum(x, cycle.centre), np.minimum(after, latest))
    n, many = cycle.size, shares.size
    nodes = (x + shares[:, None] * (top - x)).ravel()
    marches, used = march(kernel, cycle.take(np.tile(np.arange(n), many)), nodes)
    spent += used.reshape(many, n).sum(axis=0)
    left, right = marches.take(slice(0, -n)), marches.take(slice(n, None))
    last = marches.take(slice(-n, None))
    # from here on M is at most what it is where adhesion ends now, or in the middle of the arc
    last.c = np.minimum(last.c, middle)
    proven = _rises(kernel, cycle, last)
    unstable = np.tile(top <= x, many - 1)
    ask = np.flatnonzero(~unstable & ~right.engaged)
    pieces, left, right = cycle.take(np.tile(np.arange(n), many - 1)[ask]), left.take(ask), right.take(ask)
    bounds = slope_bounds(kernel, pieces, left, right)
    none = (left.r > 0) & (right.r > 0) & excluded(kernel, pieces, left, right, bounds, False)
    unstable[ask] = none | (bounds.fall <= 0)
    return proven & unstable.reshape(many - 1, n).all(axis=0), spent


def _onset_after(kernel, cycle: Cycle, c, x, noise):
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


def _rises(kernel, cycle: Cycle, orbit: Orbit) -> np.ndarray:
    """Where ``T' > 1`` by more than rounding; not where the strip stays engaged."""
    rises = np.zeros(cycle.size, bool)
    index = np.flatnonzero(~orbit.engaged)
    part, orbit = cycle.among(index), orbit.take(index)
    blur = 64 * _EPS * fading(part, contact_length(orbit.b, orbit.a))
    rises[index] = slope_excess(kernel, part, orbit)[0] > blur
    return rises


def _least(kernel, cycle: Cycle):
    """Onset of the march that ends with the least r (NaN: not found), the curvature of r there, that r, and the evaluations."""
    edges = _start(cycle)
    low, high = arcs(cycle, "acaf")
    slope, size = np.full(cycle.size, np.nan), np.full(cycle.size, np.inf)
    spent = np.zeros(cycle.size)
    index, part = np.arange(cycle.size), cycle
    for iteration in range(1, _ITERATIONS + 1):
        here = edges[:, index]
        residual, jacobian = _equations(kernel, part, here)
        move, turn = newton(residual, jacobian)
        step = np.abs(move).max(axis=0)
        edges[:, index] = moved(here, move, low[:, index], high[:, index], step)
        slope[index], size[index], spent[index] = turn, step, iteration
        going = np.flatnonzero(~(step <= _SMALL) & np.isfinite(step))
        if not going.size:
            break
        if going.size < index.size:
            index, part = index[going], part.among(going)
    x, F = edges[0], onset_margin(kernel, cycle, edges[0])
    found = (size <= _SMALL) & (slope > 0) & (F > 0)
    r, _ = closing(kernel, cycle, *edges)
    return np.where(found, x, np.nan), F * slope / cycle.strips.beta, r, spent


def _equations(kernel, cycle: Cycle, edges):
    """The links of the march and ``log T'``, and their Jacobian, the last row full."""
    s = cycle.strips
    x, b, a, c = edges
    (began, ended, opened, _), before, after = links(kernel, cycle, "acaf", edges)
    F, M = onset_margin(kernel, cycle, x), release_margin(kernel, cycle, c)
    onset, release = gains(cycle)
    rate = s.L / s.alpha
    log_slope = np.log1p(onset / F) + np.log1p(release / M) - fading(cycle, a - b)
    last = [
        -onset / (F * (F + onset)) * _forcing_slope(kernel, x, s.beta),
        rate,
        -rate,
        release / (M * (M + release)) * _forcing_slope(kernel, c, s.beta),
    ]
    rows = [[before[0], after[0], 0, 0], [0, before[1], after[1], 0], [0, 0, before[2], after[2]], last]
    return [began, ended, opened, log_slope], rows


def _forcing_slope(kernel, phase, beta):
    return kernel.profile_slope(phase) - beta * np.cos(phase)


def _start(cycle: Cycle):
    """Edges (4, n) where ``T' = 1`` on a foundation so slow that it stands still in a gap: they lie alike about the crest."""
    s = cycle.strips
    low, high = arcs(cycle, "acaf")
    c = np.ones(cycle.size)
    ratio = s.L * s.beta / s.alpha
    _, release = gains(cycle)
    for _ in range(_ROUNDS):
        a = np.arccos(np.clip(np.cos(c) + s.delta_0, -1.0, 1.0))
        c = np.arcsin(np.clip(release / (np.pi + ratio * a), 0.0, 1.0))
    edges = np.array([-c, -a, a, c])
    edges = np.clip(edges, low + 0.02 * (high - low), high - 0.02 * (high - low))
    return np.maximum.accumulate(edges, axis=0)
