"""Strips across the cell of each column: what local pressures there are, before anything is averaged."""

import numpy as np

from ..orbit.foundation import foundation_of
from .strips import LevelBatch, SolvedStrips

#: strips between crest and valley: shares of the surface are needed to a factor of two or so
STRIPS = 24
#: crest, the middles of so many equal strips, and next to the valley
_THETA = np.pi * np.concatenate(([0.0], (np.arange(STRIPS) + 0.5) / STRIPS, [0.999]))


def strips_across(columns: LevelBatch) -> SolvedStrips:
    """The crest, ``STRIPS`` equal strips and one in the valley of each of the ``columns`` (n,), one column after the other."""
    every = np.arange(columns.size)
    return columns.solve(np.repeat(every, _THETA.size), np.tile(_THETA, every.size))


def peak_pressure(columns: LevelBatch, strips: SolvedStrips) -> np.ndarray:
    """Greatest local pressure of each of the ``columns``, Pa, (n,), -inf without contact, from their ``strips_across``.

    Mostly it is the crest's. But adhesion may hold flatter strips that steeper ones have let go of: before these do, the pressure
    is at most that of complete contact, ``K (E + A (1 + R))`` with ``E = D - h``: contact begins with ``p <= H``, the saturated
    field, and tends to it.
    """
    peak = np.full(strips.p_mean.size, -np.inf)
    index, contact = strips.touching
    if index.size:
        peak[index] = contact.p_peak
    peak = peak.reshape(columns.size, -1)
    level, R = columns.level, foundation_of(columns.material).modulus_ratio(columns.level.k * columns.V)
    steeper = (columns.D - level.h)[:, None] + level.amplitude(_THETA[:-1]) * (1 + np.reshape(R, (-1, 1)))
    rising = peak[:, 1:] > peak[:, :-1]
    # where no strip touches there may be contact between two in different regimes
    code = strips.solved.code.reshape(peak.shape)
    rising |= (peak.max(axis=1) == -np.inf)[:, None] & (code[:, 1:] != code[:, :-1])
    return np.maximum(peak.max(axis=1), np.where(rising, columns.material.K * steeper, -np.inf).max(axis=1))
