"""Pressure and displacement of solved strips at any phase, from their edges, without solving again."""

import numpy as np

from .chain import gap_zones
from .groups import TWO_PI, Strips, adhesive_cycle, bare_cycle
from .regimes import CODE, ZONES
from .solved import Solved


def fields(kernel, strips: Strips, solved: Solved, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Dimensionless pressure and gap at ``phase``; all arguments of shape (n,), one phase per strip.

    At an edge the value is that of the zone which begins there.
    """

    def saturated(s, phase):
        return kernel.saturated_pressure(phase, s.D, s.alpha, s.beta, s.L)

    def zones(sequence, s, edges):
        cycle = (bare_cycle if sequence in ("ac", "cf") else adhesive_cycle)(kernel, s)
        gaps = iter(gap_zones(cycle, sequence))
        for zone, start in zip(ZONES[sequence][0], edges, strict=True):
            yield zone, start, cycle.q_on if zone == "c" else next(gaps)[0]

    def contact(s, start, phase, q_on):
        return kernel.excess_after(start, phase, q_on, s.p_0, s.D, s.alpha, s.beta, s.L) - s.p_0

    def gap(s, start, phase, first, pressure):
        return kernel.gap_after(start, phase, first, pressure, s.D, s.beta)

    return by_regime(kernel, strips, solved, phase, (saturated, zones, contact, gap))


def by_regime(kernel, strips, solved: Solved, phase: np.ndarray, foundation: tuple) -> tuple[np.ndarray, np.ndarray]:
    """Pressure and gap of strips of whatever foundation, regime by regime and zone by zone, by four functions of it.

    ``saturated(strips, phase)``: pressure of saturated contact. ``zones(sequence, strips, edges)``: of each zone its letter, its
    start and what it starts from. ``contact(strips, start, phase, entry)``: the pressure with that. ``gap(strips, start, phase,
    entry, pressure)``: the gap.
    """
    saturated, zones, contact, gap_after = foundation
    p, gap = np.zeros(strips.size), np.zeros(strips.size)
    for sequence, code in CODE.items():
        index = np.flatnonzero(solved.code == code)
        if not index.size:
            continue
        s, later = strips.take(index), phase[index]
        if sequence == "c":
            p[index] = saturated(s, later)
        elif sequence in ("a", "f"):
            p[index] = 0.0 if sequence == "f" else -s.p_0
            gap[index] = p[index] - kernel.profile(later, s.D)
        else:
            edges = [getattr(solved, name)[index] for name in ZONES[sequence][1]]
            later = edges[0] + np.mod(later - edges[0], TWO_PI)
            for zone, start, entry, *_ in zones(sequence, s, edges):
                inside, at = later >= start, np.maximum(later, start)
                pressure = contact(s, start, at, entry) if zone == "c" else -s.p_0 if zone == "a" else np.zeros(index.size)
                open_ = np.zeros(index.size) if zone == "c" else gap_after(s, start, at, entry, pressure)
                p[index], gap[index] = np.where(inside, pressure, p[index]), np.where(inside, open_, gap[index])
    return p, gap
