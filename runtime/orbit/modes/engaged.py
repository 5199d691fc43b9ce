"""The one orbit of a strip that is never released, by Newton's method on its period map.

Without release ``w = u + max(z - u - J_0 p_0, 0)`` is a convex function of the state, so the period map is convex and
monotone: each Newton step from below lands below the fixed point again, higher up. It cannot miss, and near the orbit
it converges quadratically.
"""

import numpy as np

from .extremal import AGREE, lowest_state
from .fields import greatest_gap, state_at
from .forced import Forced
from .march import TWO_PI, march
from .polish import certified
from .problem import ModeStrips


def engaged(kernel, strips: ModeStrips, met: np.ndarray | None = None):
    """The same orbits by Newton's method on their edges, from those (4, N) that marches ``met`` or else those of orbits forced by
    windows of no length, each checked by a march.

    Returns states, edges b and a (2, N), which are known, which are orbits of the strip itself, as their gaps stay within its
    reach."""
    s, left = strips.raised(), np.arange(strips.size)
    z, edges = np.full((s.modes, s.size), np.nan), np.full((2, s.size), np.nan)
    known, within = np.zeros((2, s.size), bool)
    for forced in (False, True):
        here = s.take(left)
        if forced or met is None:
            met = march(kernel, here, np.ones(left.size, bool), lowest_state(kernel, here), here.start).edges
        guess = engaged_edges(met)
        if forced:
            middle = 0.5 * (guess.sum(axis=0) + TWO_PI)  # of the adhesion
            guess = Forced.settled(kernel, here, np.stack((middle - TWO_PI, *guess, middle)))[0].edges[1:3]
        edges[:, left], good = certified(kernel, here, "ac", np.nan_to_num(guess))
        k = left[good]
        here = s.take(k)
        z[:, k], _ = state_at(kernel, "ac", here, edges[:, k], here.start)
        turn = march(kernel, here, np.ones(k.size, bool), z[:, k], here.start)
        apart = np.abs(np.mod(engaged_edges(turn.edges) - edges[:, k] + np.pi, TWO_PI) - np.pi).max(axis=0, initial=0.0)
        k = k[(apart <= AGREE) & (turn.contacts == 1) & ~turn.lost]
        known[k] = True
        # seen from -p_0: where that is large against the gap, rounding would decide
        within[k] = strips.bare or greatest_gap(kernel, edges[:, k], s.take(k)) <= strips.delta_0[k]
        left = np.flatnonzero(~known)
        if not left.size:
            break
    return z - strips.m.J * strips.p_0, edges, known, within


def engaged_edges(met):
    """Edges b, a of an always engaged orbit, b first, of those (4, N) that a march met; b in the valley where it met none."""
    b, a = np.where(np.isnan(met[1]), np.pi, met[1]), met[2]
    b = np.where(b > a, b - TWO_PI, b)
    return np.array([b, a]) - TWO_PI * np.floor((a + 0.5 * np.pi) / TWO_PI)
