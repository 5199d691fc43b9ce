"""The edges of one regime: rough ones, Newton from those on the chain they make, and from a good orbit until its answer counts.

Rough edges are those of a foundation that stands still while it is out of contact, what all others tend to as ``beta`` grows, and
are near to at any speed. A start that leads astray costs a search, never a wrong orbit.

Then w is the same at the end of contact as at the next onset; from one of a period's edges follow all, and that one from the
balance ``mean(w) = mean(p)`` (derivation: ``balance.standing_still``). With ``U = u(a)``, or the height at which w stands where
there is no contact, and contact and adhesion as long before the crest as after it (b = -a, x = -c, but for the step of w):

    cos a = 1 - D + U,  cos c = cos a - delta_0,
    pi (U + chi J p_0) + (1 - chi J) p_0 c = (L/J) (sin a - a cos a).

The left side less the right falls with the edge at a stable orbit; it rises before and after, next to folds. The onset itself is
had from ``cos x = cos c + chi J p_0``; where contact begins at once, b = x.

A period is a chain: the onset leads to the next edge, each edge to the one after it, and the last back to the onset. Every
link is a generated function that gives its value and both derivatives at once, so a step eliminates the edges one after
another and leaves one unknown, the onset. What comes out is an orbit of the boundary equations, nothing more: whether it is
admissible, stable and the extremal one is asked elsewhere (``certificate``, ``orbit_bounds``).

A good orbit is refined on the boundary equations of its regime. Their closing balance, the sum of the changes of z over a period,
keeps its digits on slow foundations; on a fast one, or where the last gap is short, the closing link is rounded less.
"""

import numpy as np

from ..numerics.rounding import EPS
from . import regimes
from .certificate import STABLE
from .groups import ROUNDING, TWO_PI, Cycle, arc_versine
from .march import Orbit
from .sensitivity import slope_excess

#: iterations at most. Where there is an orbit with a free part Newton mostly needs a third of them; next to complete contact,
#: where two edges all but coincide, all. 10 and 24 for these do as well
ITERATIONS = 14
#: share of the way to the end of its arc that an edge may move at once: with 0.7 Newton takes 6 % more steps, with 0.98 a fifth
#: more of the orbits are missed
_FARTHEST = 0.9
#: largest correction that an orbit may still ask for
CONVERGED = 1e-13
#: rounds of Newton for the edge, and the largest a they begin at: ``a sin a`` has its maximum there; up to it ``sin a - a cos a``
#: is no less than about this part of ``a**3/3``
_ROUNDS, _LONG, _CUBE = 4, 2.03, 0.65
#: length of a gap over half the arc in which the field pulls: 2 without memory, 3 if it is short. From 2.5 Newton finds all of
#: 67,000 orbits without adhesion, from 2.4 all but one in 2,000, from 2.75 all but one in 250, from 2 all but one in 20
_GAP = 2.5


def start(kernel, cycle: Cycle, sequence: str, bounds: Orbit | None = None) -> np.ndarray:
    """Edges (k, n), in the order of ``regimes.ORBIT_EDGES``, for cycles taken to follow ``sequence``: of the stable orbit of a
    foundation that stands still if there is one, else some near its fold. Where adhesion pulls so hard that w moves by more than
    the amplitude in a period, those of the ``bounds`` on all orbits, if there are any."""
    edges = _standing_still(kernel, cycle, sequence)
    if bounds is not None:
        s = cycle.strips
        pulled = np.flatnonzero(~np.isnan(bounds.x) & (TWO_PI * s.p_0 > s.beta))
        if pulled.size:
            edges[:, pulled] = _bounding(kernel, cycle.among(pulled), sequence, bounds.take(pulled))
    return edges


def _bounding(kernel, cycle: Cycle, sequence: str, bounds: Orbit) -> np.ndarray:
    """The edges that bound those of all orbits; contact begins as soon as the gap is closed at the pace it has at the onset."""
    s, x = cycle.strips, bounds.x
    pace = np.maximum(kernel.forcing(x, s.D, s.beta) + s.p_0 + cycle.gap_on, EPS)
    b = x + np.minimum(cycle.gap_on * s.beta / pace, 0.5 * np.maximum(cycle.centre + cycle.half_b - x, 0.0))
    a = np.maximum(b, bounds.a)
    c = np.maximum(a, bounds.c)
    return np.array({"acaf": (x, b, a, c), "afc": (x, a, c), "af": (x, c)}[sequence])


def _standing_still(kernel, cycle: Cycle, sequence: str) -> np.ndarray:
    """The edges at which a foundation that stands still is in balance."""
    if sequence == "af":
        # about half way between crest and valley the balance without its right side
        s, pull = cycle.strips, cycle.strips.p_0 - cycle.jump
        c = np.arccos(np.clip(1 - s.D - s.delta_0 - cycle.jump - 0.5 * pull, -1.0, 1.0))
        return np.array([-_onset(cycle, c), c])
    a = _contact(cycle)
    if sequence in ("ac", "cf"):
        return _nearly_complete(kernel, cycle, -a, a)
    c = _release(cycle, a)
    x = _onset(cycle, c)
    return np.array([-x, -a, a, c] if sequence == "acaf" else [-x, a, c])


def _release(cycle: Cycle, a):
    return np.arccos(np.maximum(np.cos(a) - cycle.strips.delta_0, -1.0))


def _onset(cycle: Cycle, c):
    return np.arccos(np.minimum(np.cos(c) + cycle.jump, 1.0))


def _contact(cycle: Cycle) -> np.ndarray:
    """Phase a of the end of contact, from a longer contact."""
    s = cycle.strips
    pull = s.p_0 - cycle.jump
    # on a foundation without instantaneous compliance contact lasts about beta^-1/2
    glassy = s.L / (s.J + np.maximum(s.beta, EPS) ** -1.5)
    longest = np.arccos(np.clip(s.delta_0 - 1, -1.0, 1.0))
    a = np.cbrt(3 * np.pi * np.maximum(s.D + s.p_0, 0.0) / (_CUBE * glassy + np.pi))
    a = np.minimum(a, np.minimum(_LONG, _FARTHEST * longest))
    for _ in range(_ROUNDS):
        cosine, sine = np.cos(a), np.sin(a)
        c = _release(cycle, a)
        value = np.pi * (s.D - 1 + cosine + cycle.jump) + pull * c - glassy * (sine - a * cosine)
        slope = sine * (np.pi + glassy * a - pull / np.maximum(np.sin(c), EPS))
        falls = slope > 0
        step = np.divide(value, slope, out=np.zeros_like(a), where=falls)
        a = np.clip(np.where(falls, a + step, 0.5 * (a + longest)), (1 - _FARTHEST) * a, _FARTHEST * longest)
    return a


def _nearly_complete(kernel, cycle: Cycle, x, a) -> np.ndarray:
    """Edges (2, n) of strips without adhesion: x and a, but for the short gaps where the saturated field hardly pulls."""
    s = cycle.strips
    pull = 1 - (s.D - 1) / kernel.modulus_ratio(s.alpha, s.beta)
    near = pull < 1
    half = arc_versine(pull)
    end = np.pi - np.arctan(s.beta) + np.arctan(s.alpha) - half
    return np.array([np.where(near, end - TWO_PI + _GAP * half, x), np.where(near, end, a)])


def follow(kernel, cycle: Cycle, sequence: str, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Newton from ``edges`` (k, n) for cycles all taken to follow ``sequence``: the edges, and which of them converged, (n,)."""
    result, converged, (low, high) = edges.copy(), np.zeros(cycle.size, bool), arcs(cycle, sequence)
    index, part, gaps = np.arange(cycle.size), cycle, gap_zones(cycle, sequence)
    # where a link is lost to rounding or overflows the step is no number, and the strip is left to the search
    with np.errstate(all="ignore"):
        for iteration in range(1, ITERATIONS + 1):
            move, slope = step(*links(kernel, part, sequence, gaps, edges))
            size = np.abs(move).max(axis=0)
            # edges stay inside their arcs
            least, most = edges + _FARTHEST * (low - edges), edges + _FARTHEST * (high - edges)
            edges = _in_order(np.minimum(np.maximum(edges + move, least), most))
            # a step this small leaves an error of its square, and one round less to ``refined``, which costs twice as much. Where
            # the map does not contract there is no extremal orbit ahead, nor one of this sequence where a step is longer than the
            # period: a zone of it vanishes
            ahead = (slope < 1) & (size < TWO_PI) | (iteration == 1)
            going = np.flatnonzero((size > 0.01 * STABLE) & ahead) if iteration < ITERATIONS else index[:0]
            if going.size < index.size:
                result[:, index], converged[index] = edges, size <= STABLE
                if not going.size:
                    break
                index, part, gaps = index[going], part.among(going), gaps[..., going]
                edges, low, high = edges[:, going], low[:, going], high[:, going]
    return result, converged


def _in_order(edges: np.ndarray) -> np.ndarray:
    """The edges (k, n), in place, none before the one before it: an accumulated maximum, in a fiftieth of the time."""
    for before, after in zip(edges[:-1], edges[1:], strict=True):
        np.maximum(before, after, out=after)
    return edges


def arcs(cycle: Cycle, sequence: str) -> tuple[np.ndarray, np.ndarray]:
    """Ends of the arcs in which each edge can lie, (k, n)."""
    centre, turned = cycle.centre, cycle.centre + TWO_PI
    ends = {
        "x": (centre - cycle.half_d, centre + cycle.half_d),
        "b": (centre - cycle.half_b, centre + cycle.half_b),
        "a": (centre + cycle.half_b, turned - cycle.half_b),
        "c": (centre + cycle.half_c, turned - cycle.half_c),
    }
    low, high = zip(*(ends[edge] for edge in regimes.ORBIT_EDGES[sequence]), strict=True)
    return np.array(low), np.array(high)


def gap_zones(cycle: Cycle, sequence: str) -> np.ndarray:
    """Of the m gaps of a period: what each begins with, its pressure, and what it ends with, (m, 3, n)."""
    s, zero = cycle.strips, np.zeros(cycle.size)
    zones = regimes.ZONES[sequence][0]
    found = []
    for i, zone in enumerate(zones):
        if zone == "a":
            last = zero if zones[i + 1 :].startswith("c") else s.delta_0
            found.append((zero if i else cycle.gap_on, -s.p_0, last))
        elif zone == "f":
            found.append((s.delta_0 + cycle.jump, zero, s.delta_0))
    return np.array(found)


def links(kernel, cycle: Cycle, sequence: str, gaps: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Values of the k links along the chain and their derivatives by the edge before and the edge after, (3, k, n)."""
    s, zones = cycle.strips, regimes.ZONES[sequence][0]
    ends = np.concatenate((edges[1:], edges[:1] + TWO_PI))
    out = np.empty((3, *edges.shape))
    gap = iter(gaps)
    for i, zone in enumerate(zones):
        if zone == "c":
            out[:, i] = kernel.excess_link(edges[i], ends[i], cycle.q_on, s.p_0, s.D, s.alpha, s.beta, s.L)
        else:
            first, pressure, last = next(gap)
            out[:, i] = kernel.gap_link(edges[i], ends[i], first, pressure, s.D, s.beta)
            out[0, i] -= last
    return out


def step(values, before, after) -> tuple[np.ndarray, np.ndarray]:
    """Newton step of the edges (k, n), every edge by the first one, and that by the last link; and the slope of the onset map."""
    constant, linear = [np.zeros_like(values[0])], [np.ones_like(values[0])]
    for value, back, on in zip(values[:-1], before[:-1], after[:-1], strict=True):
        constant.append(-(value + back * constant[-1]) / on)
        linear.append(-back * linear[-1] / on)
    slope = -before[-1] * linear[-1] / after[-1]
    first = (values[-1] + before[-1] * constant[-1]) / (after[-1] * (slope - 1))
    return np.array([k + m * first for k, m in zip(constant, linear, strict=True)]), slope


def refined(kernel, sequence: str, cycle: Cycle, orbit: Orbit, exists: bool = False, blurred: bool = False):
    """The orbit with its edges refined, whether nothing was left to correct, how far rounding may have moved edges (else 0).

    Corrections that rounding blurs may be larger: where an orbit ``exists`` those of a gap that all but grazes what ends it, and
    ``blurred`` all.
    """
    # the cycle of an always adhering strip is the bare one, shifted: its boundary equations are those of "ac" at p_0 = 0
    edges = orbit.edges(sequence)
    correction, stalls = np.full(cycle.size, np.inf), np.zeros(cycle.size, int)
    index = np.arange(cycle.size)
    with np.errstate(all="ignore"):
        for _ in range(ITERATIONS):
            now = edges[:, index]
            move, _ = step(*_equations(kernel, cycle.among(index), sequence, now))
            size = np.abs(move).max(axis=0)
            # at the limit of rounding a step no longer shrinks: it is the uncertainty, not a correction. Once may be chance, and
            # one larger than rounding makes them is a correction, whatever the one before was
            better = (size < correction[index]) | (size > STABLE)
            new = _in_order(now + move)
            edges[:, index[better]], correction[index[better]] = new[:, better], size[better]
            stalls[index[~better]] += 1
            index = index[(stalls[index] < 2) & (size > CONVERGED)]
            if not index.size:
                break
        orbit, blur = Orbit.of(sequence, edges), np.zeros(cycle.size)
        stalled = np.flatnonzero(stalls > 0)
        if stalled.size:
            part = cycle.take(stalled)
            # of an orbit that others approach in a period, by this share of their distance, rounding leaves no doubt; nor of one
            # without adhesion, which has no fold nor graze
            falls = -slope_excess(kernel, part, orbit.take(stalled))[0]
            wide = 1 / np.minimum(falls, 1e-3)
            if exists:
                rates = np.abs(_equations(kernel, part, sequence, edges[:, stalled])[-1]).min(axis=0)
                wide = np.maximum(wide, (1 + np.abs(part.strips.D) + part.strips.p_0 + part.strips.delta_0) / rates)
            sure = np.where(falls > STABLE, ROUNDING * wide, 0.0)
            blur[stalled] = np.where(blurred | part.bare, STABLE, np.minimum(sure, STABLE))
    return orbit, correction <= CONVERGED + blur, blur


def _equations(kernel, cycle: Cycle, sequence: str, edges) -> tuple:
    """The boundary equations, the last corrected by what the others miss, and their derivatives by the edge before and the one
    after; an edge that is grazed stays where it is."""
    s = cycle.strips
    linked, before, after = links(kernel, cycle, sequence, gap_zones(cycle, sequence), edges)
    *values, closing = getattr(kernel, f"residual_{regimes.EQUATIONS[sequence]}")(*edges, *s.arguments)
    zones = regimes.ZONES[sequence][0]
    balance = closing - sum(value * (-s.J if zone == "c" else 1.0) for value, zone in zip(values, zones, strict=False))
    last = edges[0] + TWO_PI - edges[-1]
    short = s.beta * (TWO_PI * np.abs(after[-1]) + s.delta_0) + last < 1
    balance = np.where((s.beta < TWO_PI) | short, linked[-1], balance)
    return (*values, balance), before, np.where(after == 0, np.inf, after)
