"""Newton on the generated boundary equations of a regime from a good orbit, and when its answer counts as converged.

Their closing balance, the sum of the changes of z over a period, keeps its digits however slow the foundation is. On a fast one,
which forgets what is summed, or where the last gap is short, the closing link itself (``chain``) is rounded less.
"""

import numpy as np

from . import regimes
from .certificate import STABLE
from .chain import ITERATIONS, gap_zones, links, step
from .groups import ROUNDING, TWO_PI, Cycle
from .march import Orbit
from .sensitivity import slope_excess
from .solved import edges_of, groups, orbit_of

#: largest correction that an orbit may still ask for
CONVERGED = 1e-13


def refined(kernel, sequence: str, cycle: Cycle, orbit: Orbit, blurred: bool = True):
    """The orbit with its edges refined, whether nothing was left to correct, and how far rounding may have moved the edges where
    it blurs them (else 0).

    ``blurred``: corrections that rounding blurs may be larger, even where it might pretend an orbit.
    """
    # the cycle of an always adhering strip is the bare one, shifted: its boundary equations are those of "ac" at p_0 = 0
    edges = edges_of(sequence, orbit)
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
            new = np.maximum.accumulate(now + move, axis=0)
            edges[:, index[better]], correction[index[better]] = new[:, better], size[better]
            stalls[index[~better]] += 1
            index = index[(stalls[index] < 2) & (size > CONVERGED)]
            if not index.size:
                break
        blur = np.zeros(cycle.size)
        stalled = np.flatnonzero(stalls > 0)
        if stalled.size:
            part = cycle.take(stalled)
            uncertain = _attainable(kernel, part, sequence, edges[:, stalled])
            if not blurred:
                # of an orbit that others approach in a period, by this share of their distance, rounding leaves no doubt
                falls = -slope_excess(kernel, part, orbit_of(sequence, edges[:, stalled]))[0]
                uncertain = np.where(falls > STABLE, np.minimum(uncertain, ROUNDING / np.minimum(falls, 1e-3)), 0.0)
            blur[stalled] = np.fmin(uncertain, STABLE)
    return orbit_of(sequence, edges), correction <= CONVERGED + blur, blur


def _equations(kernel, cycle: Cycle, sequence: str, edges) -> tuple:
    """The boundary equations, the last freed of what the others miss, and their derivatives by the edge before and the one after;
    an edge that is grazed stays where it is."""
    s = cycle.strips
    linked, before, after = links(kernel, cycle, sequence, gap_zones(cycle, sequence), edges)
    *values, closing = getattr(kernel, f"residual_{regimes.EQUATIONS[sequence]}")(*edges, *groups(s))
    zones = regimes.ZONES[sequence][0]
    balance = closing - sum(value * (-s.J if zone == "c" else 1.0) for value, zone in zip(values, zones, strict=False))
    last = edges[0] + TWO_PI - edges[-1]
    short = s.beta * (TWO_PI * np.abs(after[-1]) + s.delta_0) + last < 1
    balance = np.where((s.beta < TWO_PI) | short, linked[-1], balance)
    return (*values, balance), before, np.where(after == 0, np.inf, after)


def _attainable(kernel, cycle: Cycle, sequence: str, edges) -> np.ndarray:
    """Greatest uncertainty of an edge that equations known to rounding leave, by elimination of absolute values: of the order of
    rounding in general, and of its square root where an edge is nearly grazed or at a fold."""
    s = cycle.strips
    _, before, after = _equations(kernel, cycle, sequence, edges)
    size = 1 + np.abs(s.D) + s.p_0
    slow = TWO_PI / (TWO_PI + s.beta)
    R = kernel.modulus_ratio(s.alpha, s.beta)
    gap = ROUNDING * (1 + s.delta_0 + (size + s.delta_0) * slow)
    excess = ROUNDING * (R + (size + R) * TWO_PI / (TWO_PI + s.alpha))
    closing = ROUNDING * (size + s.delta_0) * slow
    constant, linear = [np.zeros(cycle.size)], [np.ones(cycle.size)]
    for zone, back, on in zip(regimes.ZONES[sequence][0][:-1], before, after, strict=False):
        noise = excess if zone == "c" else gap
        closing = closing + noise
        constant.append((noise + np.abs(back) * constant[-1]) / np.abs(on))
        linear.append(-back * linear[-1] / on)
    first = (closing + np.abs(before[-1]) * constant[-1]) / np.abs(before[-1] * linear[-1] + after[-1])
    return np.max([k + np.abs(m) * first for k, m in zip(constant, linear, strict=True)], axis=0)
