"""Panels of strips of a level between which what they carry is not smooth."""

import numpy as np

from ...numerics.gauss import graded_gauss
from ...numerics.roots import false_position
from ...numerics.rounding import LARGEST
from .family import CONTACT, Family
from .span import Span

#: looks at where the greatest pressures of strips pass a break, and steps towards it
_LOOKS, _STEPS = 24, 2


def panels(span: Span, ends: np.ndarray, n: int) -> tuple[np.ndarray, ...]:
    """Panels with n strips each between the ``ends`` (m, e), ascending roots of the distance from the crest, of each column: that
    (k,), the strips' shares u and penetrations s, and their weights in the mean over the cell, (k, n)."""
    column, k = np.nonzero(np.diff(ends, axis=1) > 1e-9 * ends[:, -1:])
    low, high = ends[column, k, None], ends[column, k + 1, None]
    share, weight, _ = graded_gauss(n)
    return column, *span.at(column, low + (high - low) * share, (high - low) * weight)


def ends_of(span: Span, family: Family, group: np.ndarray, breaks: np.ndarray) -> np.ndarray:
    """Ends (m, e) of panels, between which the greatest pressure of strips passes none of ``breaks`` (m, B), K h/2."""
    length = span.high - span.low
    passed = np.maximum(span.high[:, None] - _passed(span, length, family, group, breaks), 0.0)
    return np.sqrt(np.sort(np.column_stack((np.zeros_like(length), passed, length)), axis=1))


def _passed(span, length, family, group, breaks):
    """eta (m, B) at which the greatest pressure of strips is each of the ``breaks``, or the end that is nearest to it."""
    every = np.arange(span.low.size)

    def greatest(eta):
        u, s = span.strips(every, eta)
        share, over, _ = np.moveaxis(family.values(group, s, of=CONTACT), 2, 0)
        return u * share * np.maximum(over, 0.0)

    eta = span.high[:, None] - length[:, None] * np.linspace(1, 0, _LOOKS)
    looks = greatest(eta)
    over = np.clip((looks[:, :, None] < breaks[:, None]).sum(axis=1), 1, _LOOKS - 1)
    (low, high), (f_low, f_high) = ([np.take_along_axis(v, over - side, axis=1) for side in (1, 0)] for v in (eta, looks))
    # what is never saturated is never passed
    breaks = np.minimum(breaks, LARGEST)
    f_low, f_high = f_low - breaks, f_high - breaks
    met = (f_low < 0) & (f_high > 0)
    # what is not met is next to one end: both ends are that
    low, high = np.where(met | (f_low >= 0), low, high), np.where(met | (f_low < 0), high, low)
    return false_position(lambda eta: greatest(eta) - breaks, low, high, f_low, f_high, _STEPS)
