"""Zones, states and extreme gaps of orbits with several times, from their edges, without solving again.

Extremes of the gap tell where an orbit ends. Each is where a slope vanishes that is a sine against a sum of decaying
exponentials with terms of one sign: on the half period where the sine does not oppose them, log-concave against log-convex,
it has its sign on one interval at most. So the brackets hold one zero each.
"""

import numpy as np

from ..march import TWO_PI, extreme
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


def greatest_gap(kernel, edges: np.ndarray, s: ModeStrips) -> np.ndarray:
    """Of orbits that are engaged all along, edges b and a, (N,): the gap opens at a, and turns before the valley."""
    _, (_, start, z, _) = zones_of(kernel, "ac", s, edges)
    constants = kernel.gap_entry(start, z, -s.p_0, s.D, s.m)
    return extreme(kernel.gap_event, constants, 1, start, start + np.mod(np.pi - start, TWO_PI))


def least_gap(kernel, edges: np.ndarray, s: ModeStrips) -> np.ndarray:
    """Of orbits without contact, edges d and c, (N,): the gap falls up to the crest at least, and rises at c."""
    start, end = edges
    (_, _, z, _), _ = zones_of(kernel, "af", s, edges)
    constants = kernel.gap_entry(start, z, -s.p_0, s.D, s.m)
    return extreme(kernel.gap_event, constants, -1, np.maximum(start, TWO_PI * np.floor(end / TWO_PI)), end)
