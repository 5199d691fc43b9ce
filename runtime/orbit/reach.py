"""What is known of a strip in closed form: whether it saturates, and proofs that it has no orbit of some kind.

None that is always engaged. Let ``y = w + p_0`` and ``q = p + p_0``, both never negative then, and ``z = y - J q``, so that
``beta z' + z = L q >= 0``: z falls no faster than it fades. In the valley ``z <= y <= S - 2 + delta_0``, ``S = D + p_0``, if the
gap is to stay within reach, which bounds z all along the period before and the mean of it. That mean is ``L`` times the mean of
y, which is at least that of the profile, ``S - 1``. So

    L (S - 1) <= (S - 2 + delta_0) beta (exp(2 pi/beta) - 1)/(2 pi)   and   S - 2 + delta_0 >= 0.

None that meets an onset, where the strip hangs too high for adhesion to draw the foundation up to it. Let the crest hang
``eta = -(D + delta_0) >= 0`` out of reach of the undeformed foundation. Suppose an orbit with an onset x and an end of
adhesion c, engaged over ``E = c - x`` and then free. Let ``v = w`` under the continuous closure, where w is continuous and ``p =
-p_0`` at both ends of contact, and ``v = z = w - J p`` under the constitutive one, where z is. While the strip is engaged ``p >=
-p_0``, so that v is at least what it would be in adhesion all along; while it is free v fades. With ``P = p_0``, or ``L p_0`` for
z, one period gives

    v_c >= -P + (v_x + P) exp(-E/beta),   v_x = v_c exp(-(2 pi - E)/beta),

hence ``v_x >= -P phi`` and ``v_c >= -P psi``, ``psi = (1 - exp(-E/beta))/(1 - exp(-2 pi/beta))``, ``phi = psi exp(-(2 pi -
E)/beta)``. At the onset ``v_x = u(x) + delta_0 = -eta - (1 - cos x)``, at the end ``v_c = -eta - (1 - cos c)``, plus ``J p_0``
for z. So both lie near a crest: ``1 - cos x <= P phi - eta`` and ``1 - cos c <= P psi - eta`` (``+ J p_0``).

Both are ends of the engagement about one crest, x before it and c after. While the strip is free w rises towards 0 up to ``w_x <=
-eta``, and at a crest it would have to be above ``D + delta_0 = -eta``: no crest lies in the free part. After a crest (``u' <
0``) ``H + delta_0 < u + delta_0 <= 0`` is no onset. Before one (``u' > 0``) ``H + p_0 + delta_0 > u + p_0 + delta_0 >= 0``, by
the bound on ``1 - cos c``, is no end of adhesion. Hence E is at most the sum of the two half widths.

That sum grows with E. Starting from ``E = 2 pi`` each evaluation bounds E closer, and there is no orbit once ``P phi < eta``.
"""

import numpy as np

from .groups import TWO_PI, Strips

_EPS = np.finfo(float).eps
_ROUNDINGS = 1
#: evaluations; few strips that have no orbit need more
_ROUNDS = 16


def saturates(kernel, s: Strips) -> np.ndarray:
    """Where saturated contact exists, ``D - 1 + p_0 >= R``, or fails to by less than the terms are rounded to: a gap of that size
    is none."""
    R = kernel.modulus_ratio(s.alpha, s.beta)
    return s.D - 1 + s.p_0 >= R - _ROUNDINGS * _EPS * (1 + np.abs(s.D) + s.p_0 + R)


def may_cling(kernel, s: Strips) -> np.ndarray:
    """Which strips may have an orbit that is always engaged; the others are proven to have none but saturated contact."""
    S, margin = s.D + s.p_0, s.D + s.p_0 - 2 + s.delta_0
    noise = 64 * _EPS * (1 + np.abs(s.D) + s.p_0 + s.delta_0)
    bounded = s.L * (S - 1) * kernel.decay(TWO_PI, s.beta) <= (margin + noise) * kernel.decay_mean(TWO_PI, s.beta)
    return (2 - s.D - s.p_0 <= s.delta_0) & bounded


def out_of_reach(kernel, s: Strips) -> np.ndarray:
    """Which strips are proven to have no orbit with an onset; asked for those with ``D <= -delta_0``."""
    none = np.zeros(s.size, bool)
    jump = s.chi * s.J * s.p_0
    noise = 64 * _EPS * (1 + np.abs(s.D) + s.delta_0 + s.p_0)
    state = np.stack([np.full(s.size, TWO_PI), s.beta, s.p_0 - jump, jump, -(s.D + s.delta_0) - noise])
    index = np.arange(s.size)
    for _ in range(_ROUNDS):
        E, beta, P, jump, eta = state
        late = P * kernel.decay_loss(E, beta) / kernel.decay_loss(TWO_PI, beta)
        early = late * kernel.decay(TWO_PI - E, beta)
        missed = early < eta
        none[index[missed]] = True
        closer = _half_width(early - eta) + _half_width(late + jump - eta)
        index, state = index[~missed], np.stack([np.minimum(E, closer * (1 + 8 * _EPS)), *state[1:]])[:, ~missed]
        if not index.size:
            break
    return none


def _half_width(height):
    """Phase up to which ``1 - cos`` is at most ``height``."""
    return 2 * np.arcsin(np.sqrt(np.clip(0.5 * height, 0.0, 1.0)))
