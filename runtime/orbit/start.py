"""Rough edges to start Newton from: those of a foundation that stands still while it is out of contact, what all others tend to
as ``beta`` grows, and are near to at any speed. A start that leads astray costs a search, never a wrong orbit.

Then w is the same at the end of contact as at the next onset; from one of a period's edges follow all, and that one from the
balance ``mean(w) = mean(p)``, which holds at any speed (the equation of the foundation, integrated over a period). In
contact, which is short then, p follows w with the glassy modulus: ``p = -p_0 + (u - u(a))/J``. With ``U = u(a)``, or the height
at which w stands where there is no contact, and contact and adhesion as long before the crest as after it (b = -a, x = -c; it is
so but for the step of w):

    cos a = 1 - D + U,  cos c = cos a - delta_0,
    pi (U + chi J p_0) + (1 - chi J) p_0 c = (L/J) (sin a - a cos a).

The left side less the right falls with the edge at a stable orbit; it rises before and after, next to folds. The onset itself is
had from ``cos x = cos c + chi J p_0``; where contact begins at once, b = x.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..numerics.rounding import EPS
from .groups import TWO_PI, Cycle, arc_versine

if TYPE_CHECKING:
    from .march import Orbit

#: rounds of Newton for the edge, and the largest a they begin at: ``a sin a`` has its maximum there; up to it ``sin a - a cos a``
#: is no less than about this part of ``a**3/3``
_ROUNDS, _LONG, _CUBE = 4, 2.03, 0.65


def start(kernel, cycle: Cycle, sequence: str, bounds: Orbit | None = None) -> np.ndarray:
    """Edges (k, n), in the order of ``regimes.ORBIT_EDGES``, for cycles taken to follow ``sequence``: of the stable orbit of a
    foundation that stands still if there is one, else some near its fold. Where adhesion pulls so hard that w moves by more than
    the amplitude in a period, those of the ``bounds`` on all orbits, if there are any."""
    edges = _standing_still(kernel, cycle, sequence)
    if bounds is not None:
        s = cycle.strips
        pulled = np.flatnonzero(~np.isnan(bounds.x) & (TWO_PI * s.p_0 > s.beta))
        if pulled.size:
            edges[:, pulled] = _bounding(kernel, cycle.among(pulled), sequence, bounds.take(pulled))
    return edges


def _bounding(kernel, cycle: Cycle, sequence: str, bounds: Orbit) -> np.ndarray:
    """The edges that bound those of all orbits; contact begins as soon as the gap is closed at the pace it has at the onset."""
    s, x = cycle.strips, bounds.x
    pace = np.maximum(kernel.forcing(x, s.D, s.beta) + s.p_0 + cycle.gap_on, EPS)
    b = x + np.minimum(cycle.gap_on * s.beta / pace, 0.5 * np.maximum(cycle.centre + cycle.half_b - x, 0.0))
    a = np.maximum(b, bounds.a)
    c = np.maximum(a, bounds.c)
    return np.array({"acaf": (x, b, a, c), "afc": (x, a, c), "af": (x, c)}[sequence])


def _standing_still(kernel, cycle: Cycle, sequence: str) -> np.ndarray:
    """The edges at which a foundation that stands still is in balance."""
    if sequence == "af":
        # about half way between crest and valley the balance without its right side
        s, pull = cycle.strips, cycle.strips.p_0 - cycle.jump
        c = np.arccos(np.clip(1 - s.D - s.delta_0 - cycle.jump - 0.5 * pull, -1.0, 1.0))
        return np.array([-_onset(cycle, c), c])
    a = _contact(cycle)
    if sequence in ("ac", "cf"):
        return _nearly_complete(kernel, cycle, -a, a)
    c = _release(cycle, a)
    x = _onset(cycle, c)
    return np.array([-x, -a, a, c] if sequence == "acaf" else [-x, a, c])


def _release(cycle: Cycle, a):
    return np.arccos(np.maximum(np.cos(a) - cycle.strips.delta_0, -1.0))


def _onset(cycle: Cycle, c):
    return np.arccos(np.minimum(np.cos(c) + cycle.jump, 1.0))


def _contact(cycle: Cycle) -> np.ndarray:
    """Phase a of the end of contact, from a longer contact."""
    s = cycle.strips
    pull = s.p_0 - cycle.jump
    # on a foundation without instantaneous compliance contact lasts about beta^-1/2
    glassy = s.L / (s.J + np.maximum(s.beta, EPS) ** -1.5)
    longest = np.arccos(np.clip(s.delta_0 - 1, -1.0, 1.0))
    a = np.minimum(np.cbrt(3 * np.pi * np.maximum(s.D + s.p_0, 0.0) / (_CUBE * glassy + np.pi)), np.minimum(_LONG, 0.9 * longest))
    for _ in range(_ROUNDS):
        cosine, sine = np.cos(a), np.sin(a)
        c = _release(cycle, a)
        value = np.pi * (s.D - 1 + cosine + cycle.jump) + pull * c - glassy * (sine - a * cosine)
        slope = sine * (np.pi + glassy * a - pull / np.maximum(np.sin(c), EPS))
        falls = slope > 0
        step = np.divide(value, slope, out=np.zeros_like(a), where=falls)
        a = np.clip(np.where(falls, a + step, 0.5 * (a + longest)), 1e-3 * a, 0.98 * longest)
    return a


def _nearly_complete(kernel, cycle: Cycle, x, a) -> np.ndarray:
    """Edges (2, n) of strips without adhesion: where the saturated field hardly pulls, contact ends as it begins to and is closed
    again soon after; elsewhere at x and a."""
    s = cycle.strips
    pull = 1 - (s.D - 1) / kernel.modulus_ratio(s.alpha, s.beta)
    near = pull < 1
    half = arc_versine(pull)
    end = np.pi - np.arctan(s.beta) + np.arctan(s.alpha) - half
    # the gap is somewhat wider than where the field pulls
    return np.array([np.where(near, end - TWO_PI + 2.5 * half, x), np.where(near, end, a)])
