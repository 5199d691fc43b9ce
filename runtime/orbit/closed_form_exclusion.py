"""What is known of a strip in closed form: whether it saturates, and proofs that it has no orbit of some kind.

None that is always engaged. Let ``y = w + p_0`` and ``q = p + p_0``, both never negative then, and ``z = y - J q``, so that
``beta z' + z = L q >= 0``: z falls no faster than it fades. In the valley ``z <= y <= S - 2 + delta_0``, ``S = D + p_0``, if the
gap is to stay within reach, which bounds z all along the period before and the mean of it. That mean is ``L`` times the mean of
y, which is at least that of the profile, ``S - 1``. So

    L (S - 1) <= (S - 2 + delta_0) beta (exp(2 pi/beta) - 1)/(2 pi)   and   S - 2 + delta_0 >= 0.
"""

import numpy as np

from ..numerics.rounding import EPS
from .groups import TWO_PI, Strips


def saturates(kernel, s: Strips) -> np.ndarray:
    """Where saturated contact exists, ``D - 1 + p_0 >= R``, or fails to by less than the terms are rounded to: a gap of that size
    is none."""
    R = kernel.modulus_ratio(s.alpha, s.beta)
    return s.D - 1 + s.p_0 >= R - EPS * (1 + np.abs(s.D) + s.p_0 + R)


def may_cling(kernel, s: Strips) -> np.ndarray:
    """Which strips may have an orbit that is always engaged; the others are proven to have none but saturated contact."""
    S, margin = s.D + s.p_0, s.D + s.p_0 - 2 + s.delta_0
    bounded = s.L * (S - 1) * kernel.decay(TWO_PI, s.beta) <= (margin + s.noise()) * kernel.decay_mean(TWO_PI, s.beta)
    return (2 - s.D - s.p_0 <= s.delta_0) & bounded
