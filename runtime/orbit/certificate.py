"""What a strip must satisfy before it is returned.

A small residual proves nothing: a wrong orbit balances too. An orbit is accepted when its edges lie in the arcs in which
the events they stand for can happen at all (then each is the first crossing, see ``march``), in one period, when the
zones between them stay within their gaps, and when it is stable: an extremal orbit is, one in between is not.
"""

import numpy as np

from ..numerics.rounding import EPS
from .groups import ROUNDING, TWO_PI, Cycle, Strips
from .march import Orbit
from .sensitivity import slope_excess

#: most that rounding blurs edges by, and the slope of the onset map, which is one at a fold but for a root of the distance
STABLE = 1e-6


def saturates(kernel, s: Strips) -> np.ndarray:
    """Where saturated contact exists, ``D - 1 + p_0 >= R``, but for rounding: a gap of that size is none."""
    R = kernel.modulus_ratio(s.alpha, s.beta)
    return s.D - 1 + s.p_0 >= R - EPS * (1 + np.abs(s.D) + s.p_0 + R)


def edges_admissible(kernel, cycle: Cycle, orbit: Orbit) -> np.ndarray:
    """Every edge lies in the arc of its event, in order, within one period; and the contact that is not met stays open."""
    s = cycle.strips
    contact = ~np.isnan(orbit.b)
    slack = ROUNDING * (1 + np.abs(s.D) + s.beta + s.p_0 + s.delta_0)
    turn = ROUNDING * TWO_PI
    # Newton's method may have gone on by a period
    ok = (kernel.forcing(orbit.x, s.D, s.beta) + s.delta_0 >= -slack) & (np.abs(orbit.x - cycle.centre) <= np.pi + turn)
    b, a = np.where(contact, orbit.b, orbit.x), np.where(contact, orbit.a, orbit.c)
    ok &= ~contact | (cycle.direct | (kernel.forcing(b, s.D, s.beta) + s.p_0 >= -slack))
    ok &= ~contact | (kernel.forcing(a, s.D, s.beta) + s.p_0 <= slack)
    ok &= kernel.forcing(orbit.c, s.D, s.beta) + s.p_0 + s.delta_0 <= slack
    ok &= (orbit.x <= b + turn) & (b <= a + turn) & (a <= orbit.c + turn) & (orbit.c <= orbit.x + TWO_PI + turn)
    # least at the end of the arc, but without memory next to nothing there and least on the way
    end = cycle.centre + cycle.half_b
    open_ = np.flatnonzero(~contact & (orbit.x < end))
    for share in (0.5, 1.0):
        phase = orbit.x[open_] + share * (end[open_] - orbit.x[open_])
        gap = kernel.gap_after(orbit.x[open_], phase, cycle.gap_on[open_], -s.p_0[open_], s.D[open_], s.beta[open_])
        ok[open_] &= gap >= -s.noise()[open_]
    return ok


def stable(kernel, cycle: Cycle, orbit: Orbit) -> np.ndarray:
    """Slope of the onset map at most one: true of both extremal orbits, false of every orbit in between."""
    log_slope, excess = slope_excess(kernel, cycle, orbit)
    # a foundation without memory meets its onset at the very end of the arc, where F is rounding
    return (log_slope <= STABLE) | (excess <= ROUNDING * (1 + np.abs(cycle.strips.D) + cycle.strips.delta_0))


def attracting(kernel, cycle: Cycle, orbit: Orbit) -> np.ndarray:
    """Slope of the onset map below one by more than rounding blurs, however slow the foundation is."""
    log_slope, _ = slope_excess(kernel, cycle, orbit)
    return log_slope < -STABLE * np.minimum(1.0, TWO_PI / np.maximum(cycle.strips.beta, 1.0))


def greatest_gap(kernel, strips: Strips, a) -> np.ndarray:
    """Greatest gap of strips in contact until a that adhere everywhere else, as far as it counts: whether it exceeds delta_0.

    gap - delta_0 rises through zero only where ``H + p_0 + delta_0 < 0``, so it is enough to look at the end of that arc."""
    centre, half = kernel.forcing_arc(strips.p_0 + strips.delta_0, strips.D, strips.beta)
    end = centre + TWO_PI - half
    return kernel.gap_after(a, np.maximum(end, a), np.zeros(strips.size), -strips.p_0, strips.D, strips.beta)
