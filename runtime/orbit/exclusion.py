"""Proof without a search that no more engaged orbit exists beside one that is known.

A more engaged orbit has an earlier onset, so the unloading orbit at x* is proven by excluding zeros of r between the earliest
onset and x*. With ``orbit_bounds`` it is enough that R falls strictly (``sensitivity.steep_margin``) all along from the onset
before which there is none; on a slow foundation the balance of a period is asked (``balance``); and last one march from that
onset, whose r may be more than R can lose before it falls strictly. What is not proven here is left to ``search``; nothing is
ever accepted for lack of a counterexample.
"""

import numpy as np

from .balance_exclusion import first
from .groups import Cycle
from .march import TWO_PI, Orbit, march
from .orbit_bounds import FAST, OrbitBounds
from .sensitivity import over, steep_margin


def alone(kernel, cycle: Cycle, orbit: Orbit, bounds: OrbitBounds) -> tuple[np.ndarray, np.ndarray]:
    """Which orbits are proven to be the first of their onset arc, and the event evaluations spent on each."""
    proven, spent = falls_from(kernel, cycle, orbit, bounds.x, bounds.c, np.nan), np.zeros(cycle.size)
    rest = np.flatnonzero(~proven & (cycle.strips.beta > FAST))
    if rest.size:
        part = cycle.among(rest)
        proven[rest], spent[rest] = first(kernel, part, orbit.take(rest), *onsets_within(part, bounds.take(rest)))
    rest = np.flatnonzero(~proven)
    if rest.size:
        part = cycle.among(rest)
        outer, used = march(kernel, part, onsets_within(part, bounds.take(rest))[0])
        falls = falls_from(kernel, part, orbit.take(rest), outer.x, outer.c, outer.r)
        proven[rest], spent[rest] = ~outer.engaged & falls, spent[rest] + used
    return proven, spent


def onsets_within(cycle: Cycle, bounds: OrbitBounds) -> tuple[np.ndarray, np.ndarray]:
    """Phases before which no orbit has its onset, and after which its adhesion does not end."""
    return np.fmax(cycle.centre - cycle.half_d, bounds.x), np.fmin(cycle.centre + TWO_PI - cycle.half_c, bounds.c)


def falls_from(kernel, cycle: Cycle, known: Orbit, x, c, r) -> np.ndarray:
    """Where no zero of r lies between an onset ``x`` (NaN: unknown), beyond which there is none, and the known one.

    R falls strictly wherever F exceeds ``steep_margin``, an arc that has to hold the known onset; ``c`` bounds the end of
    adhesion. From x to that arc R falls no faster than the margin lets it, too little to use up ``r``, known at x; with r NaN the
    arc has to reach x.
    """
    s, noise = cycle.strips, cycle.strips.noise()
    margin = noise + steep_margin(kernel, cycle, np.fmax(c, known.c), known)
    sure = np.isfinite(x) & np.isfinite(margin)
    margin = np.where(sure, margin, 0.0)
    half = kernel.forcing_arc(s.delta_0 - margin, s.D, s.beta)[1]
    way = np.where(sure, np.maximum(cycle.centre - half - x, 0.0), 0.0)
    kept = r - noise > margin * np.expm1(np.minimum(over(way, s.beta), 700.0))
    return sure & (np.abs(known.x - cycle.centre) < half) & ((way == 0) | kept)
