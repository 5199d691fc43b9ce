"""Newton on the chain of edges of one regime, from a rough start or from a good orbit.

A period is a chain: the onset leads to the next edge, each edge to the one after it, and the last back to the onset. Every
link is a generated function that gives its value and both derivatives at once, so a step eliminates the edges one after
another and leaves one unknown, the onset. What comes out is an orbit of the boundary equations, nothing more: whether it is
admissible, stable and the extremal one is asked elsewhere (``certificate``, ``exclusion``).
"""

import numpy as np

from . import regimes
from .certificate import STABLE
from .groups import TWO_PI, Cycle

#: iterations at most. Where there is an orbit with a free part Newton mostly needs a third of them; next to complete contact,
#: where two edges all but coincide, all. 10 and 24 for these do as well
ITERATIONS = 14
#: share of the way to the end of its arc that an edge may move at once
_BOLD = 0.9
#: edges of each sequence, x for the onset (of contact, where nothing else is met)
EDGES = {sequence: "x" + "".join(edges[1:]) for sequence, edges in regimes.EDGES.items() if edges}


def follow(kernel, cycle: Cycle, sequence: str, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Newton from ``edges`` (k, n) for cycles that are all taken to follow ``sequence``.

    Returns the edges, and which of them converged, (n,).
    """
    n = cycle.size
    result, converged = edges.copy(), np.zeros(n, bool)
    low, high = arcs(cycle, sequence)
    index, part, gaps = np.arange(n), cycle, gap_zones(cycle, sequence)
    # where a link is lost to rounding or overflows the step is no number, and the strip is left to the search
    with np.errstate(all="ignore"):
        for iteration in range(1, ITERATIONS + 1):
            move, slope = step(*links(kernel, part, sequence, gaps, edges))
            size = np.abs(move).max(axis=0)
            edges = moved(edges, move, low, high, size)
            # a step this small leaves an error of its square. Where the map does not contract the extremal orbit is passed, or
            # there is none
            going = np.flatnonzero((size > STABLE) & ((slope < 1) | (iteration == 1))) if iteration < ITERATIONS else index[:0]
            if going.size < index.size:
                result[:, index], converged[index] = edges, size <= STABLE
                if not going.size:
                    break
                index, part, gaps = index[going], part.among(going), gaps[..., going]
                edges, low, high = edges[:, going], low[:, going], high[:, going]
    return result, converged


def moved(edges, move, low, high, size):
    """Edges after a step, kept inside their arcs and in order; where the step (of this ``size``) is no number, the edges before
    it."""
    new = np.minimum(np.maximum(edges + move, edges + _BOLD * (low - edges)), edges + _BOLD * (high - edges))
    for before, after in zip(new[:-1], new[1:], strict=True):
        np.maximum(before, after, out=after)
    lost = np.flatnonzero(np.isnan(size))
    new[:, lost] = edges[:, lost]
    return new


def arcs(cycle: Cycle, sequence: str) -> tuple[np.ndarray, np.ndarray]:
    """Ends of the arcs in which each edge can lie, (k, n)."""
    centre, turned = cycle.centre, cycle.centre + TWO_PI
    ends = {
        "x": (centre - cycle.half_d, centre + cycle.half_d),
        "b": (centre - cycle.half_b, centre + cycle.half_b),
        "a": (centre + cycle.half_b, turned - cycle.half_b),
        "c": (centre + cycle.half_c, turned - cycle.half_c),
    }
    low, high = zip(*(ends[edge] for edge in EDGES[sequence]), strict=True)
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
