"""Newton on the chain of edges of one regime, from a rough start.

A period is a chain: the onset leads to the next edge, each edge to the one after it, and the last back to the onset. Every
link is a generated function that gives its value and both derivatives at once, so a step eliminates the edges one after
another and leaves one unknown, the onset. What comes out is an orbit of the boundary equations, nothing more: whether it is
admissible, stable and the extremal one is asked elsewhere (``certificate``, ``exclusion``).
"""

from dataclasses import dataclass

import numpy as np

from . import regimes
from .groups import TWO_PI, Cycle

#: iterations at most, and before strips that are done are set aside. Where there is an orbit with a free part Newton needs half
#: of them; next to complete contact, where two edges all but coincide, more
_ITERATIONS, _TOGETHER = 10, 3
_ITERATIONS_BARE, _TOGETHER_BARE = 24, 2
_TIGHTENING = 5
#: a step this large after so many iterations leads nowhere, but where contact is all but complete
_WILD, _LOST_AFTER = 0.1, 7
#: a step this small leaves an error of its square
_SMALL = 1e-7
#: largest correction that an orbit may still ask for
CONVERGED = 1e-13
#: share of the way to the end of its arc that an edge may move at once
_BOLD = 0.9
#: sign of the slope with which the event of each link is met: gap and pressure fall, the gap opens where adhesion ends
_SENSE = {"acaf": (-1, -1, 1, -1), "afc": (-1, 1, -1), "af": (1, -1), "ac": (-1, -1), "cf": (-1, -1)}
#: edges of each sequence, x for the onset (of contact, where nothing else is met)
EDGES = {sequence: "x" + "".join(edges[1:]) for sequence, edges in regimes.EDGES.items() if edges}


@dataclass(slots=True)
class Chain:
    """Edges (k, n) of orbits; which ``converged``; ``correction`` (n,): the last step, taken from boundary equations that do not
    cancel; ``evaluations`` (n,) of the links of a period."""

    edges: np.ndarray
    converged: np.ndarray
    correction: np.ndarray
    evaluations: np.ndarray


def follow(kernel, cycle: Cycle, sequence: str, edges: np.ndarray) -> Chain:
    """Newton from ``edges`` (k, n) for cycles that are all taken to follow ``sequence``."""
    n = cycle.size
    edges, result = edges.copy(), edges.copy()
    low, high = arcs(cycle, sequence)
    bare = sequence in ("ac", "cf")
    iterations, together, wild = (_ITERATIONS_BARE, _TOGETHER_BARE, np.inf) if bare else (_ITERATIONS, _TOGETHER, _WILD)
    spent, step_size = np.zeros(n), np.full(n, np.inf)
    index, part = np.arange(n), cycle
    # where a link is lost to rounding or overflows the step is no number, and the strip is left to the search
    with np.errstate(all="ignore"):
        for iteration in range(1, iterations + 1):
            move = _step(*links(kernel, part, sequence, edges))
            size = np.abs(move).max(axis=0)
            edges = moved(edges, move, low, high, size)
            if iteration < together:
                continue
            far = wild if iteration >= _LOST_AFTER else np.inf
            going = np.flatnonzero((size > _SMALL) & (size < far)) if iteration < iterations else index[:0]
            if going.size < index.size:
                result[:, index], step_size[index], spent[index] = edges, size, iteration
                if not going.size:
                    break
                index, part = index[going], part.among(going)
                edges, low, high = edges[:, going], low[:, going], high[:, going]
        step, sense = _refined(kernel, cycle, sequence, result)
        spent += 1
        correction = np.abs(step).max(axis=0)
        converged = sense & (step_size <= _SMALL) & (correction <= 1e3 * _SMALL)
        result = np.where(converged, result + step, result)
        # next to a fold, or where a closing link cancels, more is left to correct than the square of a step
        rest = np.flatnonzero(converged & (correction > CONVERGED))
        while rest.size:
            step, sense = _refined(kernel, cycle.among(rest), sequence, result[:, rest])
            spent[rest] += 1
            size = np.abs(step).max(axis=0)
            closer = np.flatnonzero(sense & (size < 0.5 * correction[rest]))
            rest = rest[closer]
            result[:, rest] += step[:, closer]
            correction[rest] = size[closer]
            rest = rest[correction[rest] > CONVERGED]
    return Chain(result, converged, np.where(converged, correction, np.inf), spent)


def moved(edges, move, low, high, size):
    """Edges after a step, kept inside their arcs and in order; where the step (of this ``size``) is no number, the edges before
    it."""
    new = np.minimum(np.maximum(edges + move, edges + _BOLD * (low - edges)), edges + _BOLD * (high - edges))
    for before, after in zip(new[:-1], new[1:], strict=True):
        np.maximum(before, after, out=after)
    lost = np.flatnonzero(np.isnan(size))
    new[:, lost] = edges[:, lost]
    return new


def tighten(kernel, cycle: Cycle, sequence: str, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Edges (k, n) after a few steps on the links alone, and the last step (n,).

    The closing link is a difference of phases: it knows a short gap to rounding of the edges, which the balance of z over the
    long contact does not. On a slow foundation it is the other way round.
    """
    size = np.full(cycle.size, np.inf)
    with np.errstate(all="ignore"):
        for _ in range(_TIGHTENING):
            values, before, after = links(kernel, cycle, sequence, edges)
            move = _step(values, before, after)
            edges = edges + move
            size = np.abs(move).max(axis=0)
    return edges, np.where(np.isfinite(size), size, np.inf)


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


def links(kernel, cycle: Cycle, sequence: str, edges):
    """Values of the links along the chain and their derivatives by the edge before and the edge after, k of each."""
    s = cycle.strips
    found, first = [], edges[0]
    rest = iter(edges[1:])
    here = first
    if sequence == "acaf":
        b = next(rest)
        found.append(kernel.gap_link(here, b, cycle.gap_on, -s.p_0, s.D, s.beta))
        here = b
    if sequence != "af":
        a = next(rest)
        found.append(kernel.excess_link(here, a, cycle.q_on, s.p_0, s.D, s.alpha, s.beta, s.L))
        here = a
    if sequence in ("ac", "cf"):
        found.append(kernel.gap_link(here, first + TWO_PI, 0.0, 0.0, s.D, s.beta))
    else:
        c = next(rest)
        gap = cycle.gap_on if sequence == "af" else 0.0
        value, before, after = kernel.gap_link(here, c, gap, -s.p_0, s.D, s.beta)
        found.append((value - s.delta_0, before, after))
        value, before, after = kernel.gap_link(c, first + TWO_PI, s.delta_0 + cycle.jump, 0.0, s.D, s.beta)
        found.append((value - s.delta_0, before, after))
    return zip(*found, strict=True)


def _step(values, before, after):
    """Newton step of the edges (k, n)."""
    constant, linear = [np.zeros_like(values[0])], [np.ones_like(values[0])]
    for value, back, on in zip(values[:-1], before[:-1], after[:-1], strict=True):
        constant.append(-(value + back * constant[-1]) / on)
        linear.append(-back * linear[-1] / on)
    slope = -before[-1] * linear[-1] / after[-1]
    first = (values[-1] + before[-1] * constant[-1]) / (after[-1] * (slope - 1))
    return np.array([k + m * first for k, m in zip(constant, linear, strict=True)])


def _refined(kernel, cycle: Cycle, sequence: str, edges):
    """A step from the generated boundary equations, whose closing balance keeps its digits however slow the foundation is, and
    where all events are met in the right sense.

    That balance is the sum of the changes of z: of the closing link, of those before it, and of the contact's times -J. On a fast
    foundation, which forgets what is summed, the closing link itself is rounded less.
    """
    s = cycle.strips
    linked, before, after = links(kernel, cycle, sequence, edges)
    residual = getattr(kernel, f"residual_{regimes.EQUATIONS[sequence]}")
    *values, closing = residual(*edges, s.alpha, s.beta, s.J, s.L, s.p_0, s.delta_0, s.D, s.chi)
    contact = {"acaf": 1, "af": None}.get(sequence, 0)
    balance = closing - sum(value * (-s.J if i == contact else 1.0) for i, value in enumerate(values))
    balance = np.where(s.beta < TWO_PI, linked[-1], balance)
    sense = np.all([sign * slope > 0 for sign, slope in zip(_SENSE[sequence], after, strict=True)], axis=0)
    return _step((*values, balance), before, after), sense
