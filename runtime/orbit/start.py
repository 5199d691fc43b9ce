"""Rough edges to start Newton from. A start that leads astray costs a search, never a wrong orbit.

Mostly they are where the edges typically lie in their arcs, by how slow the foundation is: medians over random
strips, nothing more. If nothing relaxes within a period, the foundation stands still at w = W in every gap and
contact is glassy: the edges lie alike about the crest, ``cos a = 1 - D + W``, ``cos c = cos a - delta_0``, and the
means of p and w are the same where

    -pi (D - 1 + cos a) - p_0 c + (beta - alpha)/alpha (sin a - a cos a) = 0.

Where it snaps into contact w steps by J p_0 and it is z = w - J p that stands still, at Z = D - 1 + y: ``cos x = y - delta_0``,
``cos a = y - J p_0``, ``cos c = cos a - delta_0``, and

    L ((sin a + sin x - y (a + x))/J - p_0 (c - a)) = 2 pi (D - 1 + y).
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
#: where the balance of a strip that snaps into contact is steepest, as a share of the way between its folds
_UPWARD = 0.4
#: the same where the whole gap adheres, up to where the saturated field hardly pulls; by how much contact is turned, over alpha
_SLOWER, _HARDLY, _MIDDLE, _TURNED = 8.0, 0.03, 1.9, 0.8


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
    slow = np.flatnonzero(s.alpha > _SLOWLY) if sequence in ("acaf", "afc") else ()
    if len(slow):
        starts[:, slow] = (_standing_still if sequence == "acaf" else _standing_still_snapped)(s.take(slow))
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


def _standing_still_snapped(s: Strips) -> np.ndarray:
    """Edges (3, n) of strips that snap into contact and in which nothing relaxes within a period.

    The balance falls along y between the folds of the most and the least engaged orbit, where Newton starts."""
    step = s.J * s.p_0
    low, high = step + s.delta_0 - 1, 1 + s.delta_0
    edges = lambda y: [np.arccos(np.clip(v, -1.0, 1.0)) for v in (y - s.delta_0, y - step, y - step - s.delta_0)]  # noqa: E731
    y = low + _UPWARD * (high - low)
    for _ in range(_ROUNDS + 2):
        x, a, c = edges(y)
        balance = s.L * ((np.sin(a) + np.sin(x) - y * (a + x)) / s.J - s.p_0 * (c - a)) - 2 * np.pi * (s.D - 1 + y)
        grazed = s.delta_0 / (s.J * np.maximum(np.sin(x), _LEAST)) + s.p_0 / np.maximum(np.sin(c), _LEAST)
        slope = s.L * (grazed - (a + x) / s.J) - 2 * np.pi
        falling = slope < 0
        new = y - np.divide(balance, slope, out=np.zeros_like(y), where=falling)
        y = np.clip(np.where(falling, new, 0.5 * (y + low + _UPWARD * (high - low))), 0.9 * low + 0.1 * y, 0.9 * high + 0.1 * y)
    x, a, c = edges(y)
    return np.array([-x, a, c])


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
    slow = np.flatnonzero((s.alpha > _SLOWER) & (pull > _HARDLY))
    if slow.size:
        a, turned = _always_adhering(s.take(slow)), _TURNED / s.alpha[slow]
        edges["x"][slow], edges["a"][slow] = -a - turned, a - turned


def _always_adhering(s: Strips) -> np.ndarray:
    """Where contact ends if nothing relaxes within a period and the whole gap adheres: the balance grows with a."""
    weight = s.L * s.beta / (np.pi * s.alpha)
    a = np.full(s.size, _MIDDLE)
    for _ in range(_ROUNDS):
        cosine, sine = np.cos(a), np.sin(a)
        balance = weight * (sine - a * cosine) - (s.D - 1 + cosine)
        a = np.clip(a - balance / (sine * (1 + weight * a)), 0.5 * a, 0.5 * (a + np.pi))
    return a
