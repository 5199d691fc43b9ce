"""Pressure and gap of solved strips with several times at any phase, from their edges, without solving again."""

import numpy as np

from ..fields import by_regime
from ..regimes import EQUATIONS, ZONES
from ..solved import Solved
from .march import TWO_PI
from .polish import arguments
from .problem import ModeStrips


def fields(kernel, strips: ModeStrips, solved: Solved, phase: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Dimensionless pressure and gap at ``phase``; all arguments of shape (N,), one phase per strip.

    At an edge the value is that of the zone which begins there.
    """

    def saturated(s, phase):
        return kernel.saturated_pressure(phase, s.D, s.m)

    def zones(sequence, s, edges):
        return zones_of(kernel, sequence, s, edges)

    def contact(s, start, phase, overstress):
        return kernel.contact_pressure(phase, kernel.overstress_after(start, phase, overstress, s.m), s.D)

    def gap(s, start, phase, z, pressure):
        return kernel.gap_after(start, phase, z, pressure, s.D, s.m)

    return by_regime(kernel, strips, solved, phase, (saturated, zones, contact, gap))


def zones_of(kernel, sequence, s: ModeStrips, edges):
    """Zones of an orbit in the order met: letter, start, the overstress (contact) or the state z (elsewhere) there, and the
    state, (n, N)."""
    zones, _ = ZONES[sequence]
    z = getattr(kernel, f"state_{EQUATIONS[sequence]}")(*edges, *arguments(s))
    for i, (zone, start) in enumerate(zip(zones, edges, strict=True)):
        end = edges[i + 1] if i + 1 < len(edges) else edges[0] + TWO_PI
        if zone == "c":
            snapped = sequence == "afc"
            overstress = kernel.overstress(z, -s.delta_0 / s.m.J_0 if snapped else -s.p_0, s.m)
            yield zone, start, overstress, z
            z = z + kernel.contact_increment(start, end, overstress, s.m)
        else:
            yield zone, start, z, z
            z = z + kernel.relaxation_increment(start, end, z, -s.p_0 if zone == "a" else 0.0, s.m)


def state_at(kernel, sequence, s: ModeStrips, edges, phase):
    """State z (n, N) of orbits at a ``phase`` (N,), and whether they are engaged there."""
    phase = edges[0] + np.mod(phase - edges[0], TWO_PI)
    state, engaged = np.empty((s.modes, s.size)), np.zeros(s.size, bool)
    for zone, start, entry, z in zones_of(kernel, sequence, s, edges):
        inside, later = phase >= start, np.maximum(phase, start)
        if zone == "c":
            change = kernel.contact_increment(start, later, entry, s.m)
        else:
            change = kernel.relaxation_increment(start, later, z, -s.p_0 if zone == "a" else 0.0, s.m)
        state, engaged = np.where(inside, z + change, state), np.where(inside, zone != "f", engaged)
    return state, engaged
