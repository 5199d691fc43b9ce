"""Means of a level at given penetrations: adaptive panels, or the paper's equal strips."""

import numpy as np

from .averages import Averages, average
from .interior_breaks import Zones
from .nonadhesive.average import average as family_average
from .strips import LevelBatch


def level_means(columns: LevelBatch, rtol: np.ndarray, atol: np.ndarray | None = None) -> Averages:
    """Means of ``strips.QUANTITIES`` for every column, to ``rtol |value| + atol`` each; ``rtol`` of shape (n,), ``atol`` (n, q),
    or what goes with it (``LevelBatch.atol``)."""
    if columns.strips is not None:
        return equal_strips(columns, columns.strips)
    atol = columns.atol(rtol) if atol is None else atol
    return average(columns, rtol, atol) if columns.family is None else family_average(columns, rtol, atol)


def equal_strips(columns: LevelBatch, strips: int) -> Averages:
    """The paper's average over ``2 N`` equal strips of the cell (Eq. 11): midpoints; the halves are mirror images.

    The error estimate is the difference to the sum over every third strip, whose thirds share their midpoints, where N is a
    multiple of 3, and to half the strips' trapezoid otherwise.
    """
    theta = np.pi * (np.arange(strips) + 0.5) / strips
    column = np.repeat(np.arange(columns.size), strips)
    _, values, *_ = columns.evaluate(column, np.tile(theta, columns.size))
    values = values.reshape(columns.size, strips, -1)
    mean = values.mean(axis=1)
    # a jump of the integrand shifts the sum by up to one strip's share of it; a kink by less
    errors = np.abs(np.diff(values, axis=1)).max(axis=1, initial=0.0) / strips
    # no transitions are looked for: one zone for all that is known
    zones = [Zones(np.zeros(1), np.zeros(1), np.full(1, np.pi), *np.zeros((3, 1, mean.shape[1])))] * columns.size
    return Averages(mean, errors, np.full(columns.size, strips), zones=zones)
