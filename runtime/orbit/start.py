"""Rough edges to start Newton from. A start that leads astray costs a search, never a wrong orbit.

Mostly they are where the edges typically lie in their arcs, by how slow the foundation is: medians over random
strips, nothing more. If nothing relaxes within a period, the foundation stands still at w = W in every gap and
contact is glassy: the edges lie alike about the crest, ``cos a = 1 - D + W``, ``cos c = cos a - delta_0``, and the
means of p and w are the same where

    -pi (D - 1 + cos a) - p_0 c + (beta - alpha)/alpha (sin a - a cos a) = 0.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .chain import EDGES, TWO_PI
from .groups import Cycle, Strips

if TYPE_CHECKING:
    from .orbit_bounds import OrbitBounds

#: log10 of beta
DECADES = (-2.0, -1.0, 0.0, 1.0, 2.0, 3.0)
#: place of the onset in its arc, -1 to 1: with adhesion, without, and where adhesion never leads to contact
ONSET = {"adhesive": (-0.99, -0.9, -0.4, -0.05, -0.1, -0.15), "bare": (-0.99, -0.95, -0.7, -0.4, -0.25, -0.15), "af": (0.9,) * 6}
#: share of its arc that the end of contact lies behind the start of it, long after the forcing turned
CONTACT_END, SLOW = 0.45, 60.0
RELEASE = 0.1
#: contact all but complete, in parts of the pressure's amplitude; by how much the width of its gap is more than where the
#: saturated field pulls, in parts of that squared, and on a foundation that relaxes at once
_NEARLY, _WIDER, _QUICKLY = 0.6, 0.27, 0.8
_LEAST = 1e-9
#: alpha above which the edges are those of a foundation that stands still; rounds of Newton for them, from a long contact,
#: and the shortest
_SLOWLY, _ROUNDS, _LONG, _SHORT = 1.4, 4, 2.0, 0.02


def onset_guess(cycle: Cycle, kind: str = "adhesive") -> np.ndarray:
    """Onset phases, (n,)."""
    return cycle.centre + np.interp(np.log10(np.maximum(cycle.strips.beta, _LEAST)), DECADES, ONSET[kind]) * cycle.half_d


def start(kernel, cycle: Cycle, sequence: str, bounds: OrbitBounds | None = None) -> np.ndarray:
    """Edges (k, n) in the order of ``chain.EDGES`` for cycles taken to follow ``sequence``; the ``bounds`` on all orbits where
    known."""
    s = cycle.strips
    centre, turned = cycle.centre, cycle.centre + TWO_PI
    x = onset_guess(cycle, "bare" if sequence in ("ac", "cf") else sequence if sequence == "af" else "adhesive")
    if bounds is not None:
        x = np.where(np.isnan(bounds.x), x, bounds.x)
    edges = {"x": x}
    last = x
    if "b" in EDGES[sequence]:
        end = np.maximum(centre + cycle.half_b, x)
        closing = np.maximum(kernel.forcing(x, s.D, s.beta) + s.p_0 + cycle.gap_on, _LEAST)
        edges["b"] = last = x + np.minimum(cycle.gap_on * np.maximum(s.beta, _LEAST) / closing, 0.5 * (end - x))
    if "a" in EDGES[sequence]:
        share = CONTACT_END * s.beta / (s.beta + SLOW) + 1e-3
        edges["a"] = last = np.maximum(centre + cycle.half_b + share * (TWO_PI - 2 * cycle.half_b), last)
        if bounds is not None:
            edges["a"] = last = np.where(np.isnan(bounds.x), last, np.maximum(bounds.a, last))
    if sequence in ("ac", "cf"):
        _nearly_complete(kernel, cycle, edges)
    if "c" in EDGES[sequence]:
        low = np.maximum(last, centre + cycle.half_c)
        edges["c"] = low + RELEASE * np.maximum(turned - cycle.half_c - low, 0.0)
        if bounds is not None:
            edges["c"] = np.where(np.isnan(bounds.x), edges["c"], np.maximum(bounds.c, last))
    starts = np.array([edges[edge] for edge in EDGES[sequence]])
    slow = np.flatnonzero(s.alpha > _SLOWLY) if sequence == "acaf" else ()
    if len(slow):
        starts[:, slow] = _standing_still(s.take(slow))
    return starts


def _standing_still(s: Strips) -> np.ndarray:
    """Edges (4, n) of strips in which nothing relaxes within a period."""
    glassy = s.L * s.beta / s.alpha
    longest = np.arccos(np.clip(s.delta_0 - 1, -1.0, 1.0))
    a = np.minimum(_LONG, 0.9 * longest)
    for _ in range(_ROUNDS):
        cosine, sine = np.cos(a), np.sin(a)
        c = np.arccos(np.maximum(cosine - s.delta_0, -1.0))
        balance = glassy * (sine - a * cosine) - np.pi * (s.D - 1 + cosine) - s.p_0 * c
        slope = sine * (np.pi + glassy * a - s.p_0 / np.maximum(np.sin(c), _LEAST))
        rising = slope > 0
        step = np.divide(balance, slope, out=np.zeros_like(a), where=rising)
        a = np.clip(np.where(rising, a - step, 0.5 * (a + longest)), _SHORT, 0.98 * longest)
    c = np.arccos(np.maximum(np.cos(a) - s.delta_0, -1.0))
    return np.array([-c, -a, a, c])


def _nearly_complete(kernel, cycle: Cycle, edges: dict[str, np.ndarray]) -> None:
    """Where the saturated field hardly pulls, contact ends as it begins to and is closed again soon after."""
    s = cycle.strips
    ratio = kernel.modulus_ratio(s.alpha, s.beta)
    pull = 1 - (s.D - 1) / ratio
    near = pull < _NEARLY
    half = 2 * np.arcsin(np.sqrt(np.clip(pull / 2, 0.0, 1.0)))
    a = np.pi - np.arctan(s.beta) + np.arctan(s.alpha) - half
    edges["a"] = np.where(near, a, edges["a"])
    edges["x"] = np.where(near, a - TWO_PI + (2 + _WIDER * half + _QUICKLY / (1 + s.alpha) ** 3) * half, edges["x"])
