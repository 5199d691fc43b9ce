"""Where the pressure of saturated contact, one harmonic of the phase, passes a given value."""

import numpy as np


def passages(level, mean, amplitude, centre):
    """Phases at which ``mean + amplitude cos(phase - centre)`` passes ``level`` upward and downward, about its peak ``centre``.

    Where it is above all along they are a period apart; all arguments of one shape, ``level`` nowhere above the peak.
    """
    cosine = np.divide(level - mean, amplitude, out=np.full(level.shape, -1.0), where=amplitude > 0)
    half = np.arccos(np.clip(cosine, -1, 1))
    return centre - half, centre + half
