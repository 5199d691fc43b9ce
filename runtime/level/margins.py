"""How far a strip is from the end of its regime: quantities that vanish there, from which the place of a transition is foretold.

An orbit with a free part ends at a fold, where ``1 - T'`` vanishes like the square root of the distance; its contact ends at no
length, which vanishes likewise. A foundation with little memory folds next to where onset or release grazes: T' is small until F
or M (``sensitivity``) all but vanishes, so ``F M (1 - T')`` tells it in either case. A gap that adheres throughout ends where it
comes to exceed delta_0, a gap without contact where it closes, and thresholds are passed: all in proportion to the distance. None
of this decides anything: where a transition lies is told by codes alone (``transitions``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..orbit.groups import adhesive_cycle
from ..orbit.march import TWO_PI, Orbit
from ..orbit.regimes import CODE
from ..orbit.sensitivity import onset_margin, slope_excess

if TYPE_CHECKING:
    from .strips import SolvedStrips

#: the margins of a strip, in this order, and with which root of the distance to their transition they vanish
FOLD, CONTACT, GRAZE, CLOSING, SATURATION, REACH, CLING, SPAN = range(8)
POWERS = np.array([2, 2, 1, 1, 1, 1, 1, 1])
#: pairs of regimes that mostly meet where a threshold is passed
_THRESHOLDS = {
    ("c", "ac"): SATURATION,
    ("c", "cf"): SATURATION,
    ("a", "ac"): CLING,
    ("a", "acaf"): SPAN,
    ("a", "afc"): SPAN,
    ("a", "af"): SPAN,
    ("f", "cf"): REACH,
}


def margins(kernel, strips: SolvedStrips) -> np.ndarray:
    """Margins of every strip, (m, 8), NaN where its regime does not end that way (or nothing is known: several times)."""
    solved = strips.solved
    out = np.full((solved.code.size, POWERS.size), np.nan)
    if hasattr(kernel, "MODES"):
        return out
    s = strips.strips
    out[:, CONTACT] = solved.a - solved.b
    out[:, SATURATION] = s.D - 1 + s.p_0 - kernel.modulus_ratio(s.alpha, s.beta)
    out[:, REACH] = s.D + np.where(s.p_0 > 0, s.delta_0, 0.0)
    out[:, CLING] = s.D + s.p_0
    out[:, SPAN] = s.D + s.p_0 + s.delta_0 - 2
    onsets = np.flatnonzero(np.isin(solved.code, (CODE["acaf"], CODE["afc"], CODE["af"])))
    if onsets.size:
        s = strips.strips.take(onsets)
        cycle = adhesive_cycle(kernel, s)
        direct = solved.code[onsets] == CODE["afc"]
        x = np.where(direct, solved.b[onsets], solved.d[onsets])
        none = np.zeros(onsets.size)
        orbit = Orbit(x, solved.b[onsets], solved.a[onsets], solved.c[onsets], none.astype(bool), none, none)
        slope = np.expm1(np.minimum(slope_excess(kernel, cycle, orbit)[0], 1.0))
        release = kernel.forcing(orbit.c, s.D, s.beta) + s.delta_0 + s.p_0
        out[onsets, FOLD] = onset_margin(kernel, cycle, x) * release * slope
        end = cycle.centre + cycle.half_b
        waiting = np.isnan(orbit.b) & (end > x)
        closest = kernel.gap_after(x, np.maximum(end, x), cycle.gap_on, -s.p_0, s.D, s.beta)
        out[onsets[waiting], CLOSING] = closest[waiting]
    clinging = np.flatnonzero(solved.code == CODE["ac"])
    if clinging.size:
        s, a = strips.strips.take(clinging), solved.a[clinging]
        centre, half = kernel.forcing_arc(s.p_0 + s.delta_0, s.D, s.beta)
        end = centre + TWO_PI - half
        widest = kernel.gap_after(a, np.maximum(end, a), np.zeros(a.size), -s.p_0, s.D, s.beta)
        out[clinging, GRAZE] = np.where((half < np.pi) & (end > a), s.delta_0 - widest, np.nan)
    return out


def decisive(code, other) -> np.ndarray:
    """Which margin of a strip with regime ``code`` vanishes where it becomes ``other``, (m,); -1: none is known."""
    out = np.full(code.shape, -1)
    free = np.isin(code, (CODE["acaf"], CODE["afc"], CODE["af"]))
    out[free] = FOLD
    out[(code == CODE["acaf"]) & (other == CODE["af"])] = CONTACT
    out[(code == CODE["af"]) & (other == CODE["acaf"])] = CLOSING
    out[code == CODE["ac"]] = GRAZE
    for (one, two), margin in _THRESHOLDS.items():
        out[(code == CODE[one]) & (other == CODE[two]) | (code == CODE[two]) & (other == CODE[one])] = margin
    out[code == other] = -1
    return out
