"""Pressure and displacement of solved strips at any phase, from their edges, without solving again."""

import numpy as np

from .groups import TWO_PI, Strips, adhesive_cycle, bare_cycle
from .regimes import CODE, ZONES
from .solved import Solved


def fields(kernel, strips: Strips, solved: Solved, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Dimensionless pressure and gap at ``phase``; all arguments of shape (n,), one phase per strip.

    At an edge the value is that of the zone which begins there.
    """

    def saturated(s, phase):
        return kernel.saturated_pressure(phase, s.D, s.alpha, s.beta, s.L)

    return by_regime(kernel, strips, solved, phase, saturated, _with_edges)


def by_regime(kernel, strips, solved: Solved, phase: np.ndarray, saturated, with_edges) -> tuple[np.ndarray, np.ndarray]:
    """Pressure and gap, regime by regime: ``saturated(strips, phase)`` is the pressure of saturated contact, ``with_edges(kernel,
    sequence, strips, solved, index, phase)`` both of the strips ``index`` in a regime with edges; strips of whatever
    foundation."""
    p, gap = np.zeros(strips.size), np.zeros(strips.size)
    for sequence, code in CODE.items():
        index = np.flatnonzero(solved.code == code)
        if not index.size:
            continue
        s = strips.take(index)
        if sequence == "c":
            p[index] = saturated(s, phase[index])
        elif sequence in ("a", "f"):
            p[index] = 0.0 if sequence == "f" else -s.p_0
            gap[index] = p[index] - kernel.profile(phase[index], s.D)
        else:
            p[index], gap[index] = with_edges(kernel, sequence, s, solved, index, phase[index])
    return p, gap


def _with_edges(kernel, sequence, s: Strips, solved: Solved, index, phase):
    zero = np.zeros(index.size)
    b, a, c, d = (getattr(solved, e)[index] for e in "bacd")
    # for each zone: where it starts, the gap and the excess pressure there; in the order met
    if sequence in ("ac", "cf"):
        cycle = bare_cycle(kernel, s)
        starts, gaps = [b, a], [zero, zero]
    else:
        cycle = adhesive_cycle(kernel, s)
        released = s.delta_0 + cycle.jump
        starts, gaps = {
            "acaf": ([d, b, a, c], [cycle.gap_on, zero, zero, released]),
            "afc": ([b, a, c], [zero, zero, released]),
            "af": ([d, c], [cycle.gap_on, released]),
        }[sequence]
    phase = starts[0] + np.mod(phase - starts[0], TWO_PI)
    p, gap = zero.copy(), zero.copy()
    for zone, start, first in zip(ZONES[sequence][0], starts, gaps, strict=True):
        inside = phase >= start
        if zone == "c":
            q = kernel.excess_after(start, np.maximum(phase, start), cycle.q_on, s.p_0, s.D, s.alpha, s.beta, s.L)
            zone_p, zone_gap = q - s.p_0, zero
        else:
            zone_p = -s.p_0 if zone == "a" else zero
            zone_gap = kernel.gap_after(start, np.maximum(phase, start), first, zone_p, s.D, s.beta)
        p, gap = np.where(inside, zone_p, p), np.where(inside, zone_gap, gap)
    return p, gap
