"""Zones and states of orbits with several times, from their edges, without solving again."""

import numpy as np

from ..march import TWO_PI
from ..regimes import EQUATIONS, ZONES
from .problem import ModeStrips


def zones_of(kernel, sequence, s: ModeStrips, edges):
    """Zones of an orbit in the order met: letter, start, the overstress (contact) or the state z (elsewhere) there, and the
    state, (n, N)."""
    zones, _ = ZONES[sequence]
    z = getattr(kernel, f"state_{EQUATIONS[sequence]}")(*edges, *s.arguments)
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
