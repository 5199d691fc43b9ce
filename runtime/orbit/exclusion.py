"""Proof without a march that no more engaged orbit exists beside one that is known.

A more engaged orbit has an earlier onset, so the unloading orbit at x* is proven by excluding zeros of r between the earliest
onset and x*. With ``orbit_bounds`` it is enough that R falls strictly (``sensitivity.steep_margin``) all along from the onset
before which there is none; on a slow foundation the balance of a period is asked (``balance``). What is not proven here is left
to ``search``; nothing is ever accepted for lack of a counterexample.
"""

import numpy as np

from . import balance
from .groups import Cycle
from .march import TWO_PI, Orbit
from .orbit_bounds import OrbitBounds
from .sensitivity import steep_margin


def alone(kernel, cycle: Cycle, orbit: Orbit, bounds: OrbitBounds) -> tuple[np.ndarray, np.ndarray]:
    """Which orbits are proven to be the first of their onset arc, and the event evaluations spent on each."""
    proven, spent = _falls_from(kernel, cycle, orbit, bounds), np.zeros(cycle.size)
    rest = np.flatnonzero(~proven & (cycle.strips.beta > balance.SLOW))
    if rest.size:
        part = cycle.among(rest)
        proven[rest], spent[rest] = balance.first(kernel, part, orbit.take(rest), *onsets_within(part, bounds.take(rest)))
    return proven, spent


def onsets_within(cycle: Cycle, bounds: OrbitBounds) -> tuple[np.ndarray, np.ndarray]:
    """Phases before which no orbit has its onset, and after which its adhesion does not end."""
    return np.fmax(cycle.centre - cycle.half_d, bounds.x), np.fmin(cycle.centre + TWO_PI - cycle.half_c, bounds.c)


def _falls_from(kernel, cycle: Cycle, known: Orbit, bounds: OrbitBounds) -> np.ndarray:
    """Where R falls strictly from the bound on all onsets to the known one: no zero of r lies in between.

    R falls wherever F exceeds ``steep_margin``, an arc that has to hold both.
    """
    s = cycle.strips
    margin = s.noise() + steep_margin(kernel, cycle, np.fmax(bounds.c, known.c), known)
    sure = np.isfinite(bounds.x) & np.isfinite(margin)
    half = kernel.forcing_arc(s.delta_0 - np.where(sure, margin, 0.0), s.D, s.beta)[1]
    return sure & (np.abs(known.x - cycle.centre) < half) & (cycle.centre - bounds.x <= half)
