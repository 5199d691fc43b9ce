"""The extremal periodic orbits of a strip.

The motion over one period preserves the order "engaged before free, then z ascending". The most engaged orbit is
therefore the always engaged one if it is admissible, else the least fixed point of the onset-to-onset map, else the
free one; the least engaged orbit is the free one if admissible, else the greatest fixed point, else the always engaged
one. Fixed points are found by exclusion, never by iteration, so slow contraction and neighbouring folds cost little.
"""

from dataclasses import dataclass
from typing import Any

from mpmath import mp

from .flow import ContactFlow, GapFlow, Strip, bracketed_root, decay
from .passage import ENGAGED, MISSED, RETURNED, ReturnMap

UNLOADING, LOADING = "unloading", "loading"


class Unresolved(ArithmeticError):
    """Two fixed points, or a fixed point and a graze, lie too close together to be told apart."""


@dataclass(frozen=True)
class Orbit:
    """Periodic orbit: zones (letter, start, end) in phase s, the contact flow if any, and the map's slope there."""

    zones: tuple
    contact: Any
    slope: Any


def extremal_orbit(strip, branch):
    """The most (``unloading``) or the least (``loading``) engaged periodic orbit."""
    if branch not in (UNLOADING, LOADING):
        raise ValueError(f"unknown branch {branch!r}")
    if branch == UNLOADING:
        orbit = engaged_orbit(strip) or next(returning_orbits(strip), None) or free_orbit(strip)
    else:
        orbit = free_orbit(strip) or next(returning_orbits(strip, descending=True), None) or engaged_orbit(strip)
    if orbit is None:
        raise Unresolved("no orbit found")
    return orbit


def attracting_orbits(strip):
    """All attracting periodic orbits, from the most to the least engaged."""
    returning = [orbit for orbit in returning_orbits(strip) if orbit.slope < 1]
    return [orbit for orbit in (engaged_orbit(strip), *returning, free_orbit(strip)) if orbit]


# -- orbits without onset ----------------------------------------------------------------------------------------------


def free_orbit(strip):
    """The undisturbed surface ``w = 0``, if the gap ``-u >= -delta`` stays above ``Delta`` or just touches it."""
    if strip.delta > -strip.Delta:
        return None
    return Orbit((("f", mp.zero, 2 * mp.pi),), None, decay(2 * mp.pi, strip.beta))


def engaged_orbit(strip):
    """The orbit that is never free, or None.

    If release is put out of action, ``p + P0`` and ``w + P0`` follow the rules of a strip without adhesion, raised by
    P0: exactly one orbit. It is admissible if its gap never rises through ``Delta``.
    """
    if strip.P0 == 0:
        return _without_adhesion(strip) if strip.delta >= 1 + strip.ratio else None
    bare = Strip(strip.alpha, strip.beta, 0, 0, strip.delta + strip.P0, strip.closure, J=strip.J)
    orbit = _without_adhesion(bare)
    zones = tuple((letter.replace("f", "a"), start, end) for letter, start, end in orbit.zones)
    letters = [letter for letter, _, _ in zones]
    contact = orbit.contact
    if letters == ["a"] and 2 - strip.P0 - strip.delta > strip.Delta:
        return None
    if letters == ["c", "a"]:
        b, a = zones[0][1:]
        contact = ContactFlow(strip, b, -strip.P0)
        arc = strip.arc_below(-strip.P0 - strip.Delta)
        adhesion = GapFlow(strip, a, strip.u(a), strip.P0)
        if arc is not None and arc[1] > a and adhesion.gap_above(strip.Delta)(arc[1])[0] > 0:
            return None
    elif letters == ["c"]:
        contact = ContactFlow(strip, mp.zero, mp.zero)
        contact.excess = mp.zero
    return Orbit(zones, contact, orbit.slope)


def _without_adhesion(strip):
    """The only periodic orbit of a strip with ``P0 = 0``, whose onset map contracts in the measure m."""
    turn = 2 * mp.pi
    if strip.delta <= 0:
        return free_orbit(strip)
    if strip.delta >= 1 + strip.ratio:
        contact = ContactFlow(strip, mp.zero, mp.zero)
        contact.excess = mp.zero
        return Orbit((("c", mp.zero, turn),), contact, decay(turn, strip.alpha))
    returns = ReturnMap(strip)
    return _polished(returns, *returns.onset, falling=True)


# -- orbits with one onset per period ----------------------------------------------------------------------------------


def returning_orbits(strip, descending=False):
    """Orbits with an onset, attracting or not, from the most engaged on (or from the least, if descending)."""
    returns = ReturnMap(strip)
    if returns.onset is None or returns.release is None:
        return
    if strip.P0 == 0:
        if 0 < strip.delta < 1 + strip.ratio:
            yield _without_adhesion(strip)
        return
    ends = _finite_range(returns)
    if ends is None:
        return
    for first, second, falling in _isolated(returns, *ends, descending):
        yield _polished(returns, first.d, second.d, falling)


def _finite_range(returns):
    """Passages at the ends of the interval of onsets that return, or None.

    Early onsets stay engaged and late ones miss the next onset; the margins of release and return, monotone in the
    onset, mark the limits.
    """
    low, high = (returns.passage(d) for d in returns.onset)
    if low.outcome == MISSED or high.outcome == ENGAGED:
        return None
    if low.outcome == ENGAGED:
        low = _limit(returns, lambda item: item.release_margin, ENGAGED)
    if high.outcome == MISSED:
        high = _limit(returns, lambda item: item.return_margin, MISSED)
    if low is None or high is None or low.d >= high.d:
        return None
    return low, high


def _limit(returns, margin, outcome):
    """The passage that returns next to the onset where its margin vanishes, just on the returning side.

    None if none returns there, as when points go straight from staying engaged to missing.
    """
    root = bracketed_root(lambda d: margin(returns.passage(d)), *returns.onset, sign=1)
    offset = mp.mpf(10) ** (14 - mp.dps)
    for _ in range(8):
        found = returns.passage(root + offset if outcome == ENGAGED else root - offset)
        if found.outcome == RETURNED:
            return found
        offset *= 10
    return None


def _isolated(returns, first, second, descending):
    """Intervals of onsets that hold exactly one fixed point each, in order: (first, second, falling).

    Bounds of Y' bound Y between two passages. An interval where Y has one sign holds none; where Y is monotone, the
    signs at the ends tell; any other is halved.
    """
    advance, bounds = returns.advance, returns.advance_slope_bounds
    stack = [(first, advance(first), second, advance(second))]
    while stack:
        first, y_first, second, y_second = stack.pop()
        width = second.d - first.d
        low, high = bounds(first, second)
        if low >= 0 or high <= 0:
            if (y_first >= 0) != (y_second >= 0):
                yield first, second, high <= 0
            continue
        if _least(y_first, y_second, low, high, width) > 0 or _largest(y_first, y_second, low, high, width) < 0:
            continue
        if width < mp.mpf(10) ** (-mp.dps / 2):
            raise Unresolved(f"fold or graze within 1e-{mp.dps // 2} of an onset at {mp.nstr(first.d, 17)}")
        middle = returns.passage((first.d + second.d) / 2)
        halves = (first, y_first, middle, advance(middle)), (middle, advance(middle), second, y_second)
        stack.extend(halves if descending else halves[::-1])


def _least(y_first, y_second, low, high, width):
    """Least value that Y can take between its end values if ``low <= Y' <= high``, ``low < 0 < high``."""
    if high == mp.inf:
        return y_first + low * width
    return (y_first * high - y_second * low + low * high * width) / (high - low)


def _largest(y_first, y_second, low, high, width):
    """Largest such value."""
    if high == mp.inf:
        return y_second - low * width
    return (y_second * high - y_first * low - low * high * width) / (high - low)


def _polished(returns, low, high, falling):
    """The orbit at the fixed point isolated between two onsets."""

    def event(d):
        item = returns.passage(d)
        if item.outcome != RETURNED:
            raise Unresolved(f"an onset at {mp.nstr(d, 17)} does not return: {item.outcome}")
        return returns.advance(item), returns.advance_slope(item)

    d = bracketed_root(event, low, high, sign=-1 if falling else 1)
    item = returns.passage(d)
    return Orbit(_zones(returns.strip, item), item.contact, returns.map_slope(item))


def _zones(strip, item):
    end = item.d + 2 * mp.pi
    if strip.P0 == 0:
        edges = (("c", item.d, item.a), ("f", item.a, end))
    elif item.b is None:
        edges = (("a", item.d, item.c), ("f", item.c, end))
    else:
        edges = (("a", item.d, item.b), ("c", item.b, item.a), ("a", item.a, item.c), ("f", item.c, end))
        edges = edges[1:] if strip.snaps else edges
    return edges
