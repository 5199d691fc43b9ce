"""Strips that hang too high for adhesion to draw the foundation up to them: a proof that they are free.

Let the crest hang ``eta = -(D + delta_0) >= 0`` out of reach of the undeformed foundation, and let the valley not adhere even where the
foundation is drawn up all the way (``2 - D - p_0 > delta_0``), so that the strip is engaged over one stretch about the crest, of length E,
or never. Let ``v = w`` under the continuous closure, where w is continuous and ``p = -p_0`` at both ends of contact, and
``v = z = w - J p`` under the constitutive one, where z is. While the strip is engaged ``p >= -p_0``, so that v is at least what it would be
in adhesion all along; while it is free v fades. With ``P = p_0``, or ``L p_0`` for z, one period from the onset x to the end c of
adhesion and on to the next onset gives

    v_c >= -P + (v_x + P) exp(-E/beta),   v_x = v_c exp(-(2 pi - E)/beta),

hence ``v_x >= -P phi`` and ``v_c >= -P psi``, ``psi = (1 - exp(-E/beta))/(1 - exp(-2 pi/beta))``, ``phi = psi exp(-(2 pi - E)/beta)``. At
the onset ``v_x = u(x) + delta_0 = -eta - (1 - cos x)``, at the end ``v_c = -eta - (1 - cos c)``, plus ``J p_0`` for z. So both lie about the
crest, where ``1 - cos x <= P phi - eta`` and ``1 - cos c <= P psi - eta`` (``+ J p_0``), and E is at most the sum of the two half widths.

That sum grows with E. Starting from ``E = 2 pi`` each evaluation bounds E closer, and there is no orbit once ``P phi < eta``.
"""

import numpy as np

from .problem import TWO_PI, Strips

_EPS = np.finfo(float).eps
#: evaluations; few strips that have no orbit need more
_ROUNDS = 16


def out_of_reach(kernel, s: Strips) -> np.ndarray:
    """Which strips are proven to be free; asked for those with ``D <= -delta_0`` and ``2 - D - p_0 > delta_0``."""
    free = np.zeros(s.size, bool)
    jump = s.chi * s.J * s.p_0
    noise = 64 * _EPS * (1 + np.abs(s.D) + s.delta_0 + s.p_0)
    state = np.stack([np.full(s.size, TWO_PI), s.beta, s.p_0 - jump, jump, -(s.D + s.delta_0) - noise])
    index = np.arange(s.size)
    for _ in range(_ROUNDS):
        E, beta, P, jump, eta = state
        late = P * kernel.decay_loss(E, beta) / kernel.decay_loss(TWO_PI, beta)
        early = late * kernel.decay(TWO_PI - E, beta)
        none = early < eta
        free[index[none]] = True
        closer = _half_width(early - eta) + _half_width(late + jump - eta)
        index, state = index[~none], np.stack([np.minimum(E, closer * (1 + 8 * _EPS)), *state[1:]])[:, ~none]
        if not index.size:
            break
    return free


def _half_width(height):
    """Phase up to which ``1 - cos`` is at most ``height``."""
    return 2 * np.arcsin(np.sqrt(np.clip(0.5 * height, 0.0, 1.0)))
