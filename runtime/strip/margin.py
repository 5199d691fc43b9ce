"""How far a strip is from letting go: the inequality that ends saturated adhesion, as a smooth function to find its zeros of."""

import numpy as np

from .certificate import greatest_gap
from .direct import certified
from .problem import Strips, bare_cycle
from .reach import saturates


def cling_margin(kernel, strips: Strips) -> np.ndarray:
    """Reach of adhesion less the greatest gap that the strip has if it stays engaged all along, in units of the amplitude; (n,).

    Positive exactly where the always engaged orbit exists, which then is the unloading orbit (regimes c, ac and a); continuous through
    zero, where that orbit ends by grazing, whatever regime is solved for there. The candidate is unique, so nothing is searched: some six
    evaluations a strip, a tenth of a solution. NaN without adhesion, and where Newton does not find the candidate.
    """
    margin = np.full(strips.size, np.nan)
    adhesive, full = strips.p_0 > 0, saturates(kernel, strips)
    clinging = adhesive & ~full & (strips.D <= -strips.p_0)
    margin[adhesive & full] = strips.delta_0[adhesive & full]
    margin[clinging] = (strips.delta_0 - (2 - strips.D - strips.p_0))[clinging]
    index = np.flatnonzero(adhesive & ~full & ~clinging)
    if index.size:
        part = strips.take(index)
        orbit, found, _ = certified(kernel, bare_cycle(kernel, part), "ac")
        margin[index] = np.where(found, part.delta_0 - greatest_gap(kernel, part, orbit), np.nan)
    return margin
