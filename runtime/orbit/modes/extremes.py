"""Extremes of the gap between the edges of orbits with several times, which tell where an orbit ends.

Each is where a slope vanishes that is a sine against a sum of decaying exponentials with terms of one sign: on the half
period where the sine does not oppose them, log-concave against log-convex, it has its sign on one interval at most. So the
brackets hold one zero each.
"""

import numpy as np

from ...numerics.roots import falling_root, rising_root
from ..batch import pick
from .fields import zones_of
from .march import TWO_PI
from .problem import ModeStrips

#: how closely extremes are placed, radians: their values are off by the square
_PLACED = 1e-9


def greatest_gap(kernel, edges: np.ndarray, s: ModeStrips) -> np.ndarray:
    """Of orbits that are engaged all along, edges b and a, (N,): the gap opens at a, and turns before the valley."""
    _, (_, start, z, _) = zones_of(kernel, "ac", s, edges)
    constants = kernel.gap_entry(start, z, -s.p_0, s.D, s.m)
    return _value(kernel.gap_event, constants, falling_root, start, start + np.mod(np.pi - start, TWO_PI))


def least_gap(kernel, edges: np.ndarray, s: ModeStrips) -> np.ndarray:
    """Of orbits without contact, edges d and c, (N,): the gap falls up to the crest at least, and rises at c."""
    start, end = edges
    (_, _, z, _), _ = zones_of(kernel, "af", s, edges)
    constants = kernel.gap_entry(start, z, -s.p_0, s.D, s.m)
    return _value(kernel.gap_event, constants, rising_root, np.maximum(start, TWO_PI * np.floor(end / TWO_PI)), end)


def _value(event, constants, root, low, high) -> np.ndarray:
    """Value of ``event`` where its slope passes zero between ``low`` and ``high``."""

    def slope(phase, index):
        return event(phase, *(pick(c, index) for c in constants))[1]

    return event(root(slope, low, np.maximum(high, low), tolerance=_PLACED), *constants)[0]
