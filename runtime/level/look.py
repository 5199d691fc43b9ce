"""What a look at a few nodes of the intervals of a curve tells of its pressure between them, and what comes of it on a branch."""

import numpy as np

from ..numerics.quadrature import Stage
from ..numerics.rounding import EPS

#: how much more than its error a pressure keeps from what it is compared with, and than what it bends between two nodes, which
#: are the first ones or twice as many: a parabola keeps within an eighth of that from its chord
DOUBT, BENDS = 2.0, (1.0, 0.25)
#: share of an interval from a break in which a pressure is all but that at the break
_BESIDE = 1e-4


def between_nodes(stage: Stage, D: np.ndarray, bends: float) -> tuple[np.ndarray, np.ndarray]:
    """Pressures of intervals at the nodes and both ends, ``D`` (m, n); how far beyond their range between two, (m, n - 1)."""
    # nodes may coincide
    (p, error), step = (v[:, :, 0] for v in stage.known[:2]), np.maximum(np.diff(D), EPS * (D[:, -1:] - D[:, :1]))
    slopes = np.diff(p) / step[:, 1:-1]
    # on to the ends, which are no nodes: a curve is often least at a break
    p = np.column_stack((p[:, 0] - slopes[:, 0] * step[:, 0], p, p[:, -1] + slopes[:, -1] * step[:, -1]))
    # between evenly spaced nodes these are second differences
    bend = np.abs(np.diff(np.diff(p) / step)) * 2 / (1 / step[:, 1:] + 1 / step[:, :-1])
    error, bend = (np.pad(v, ((0, 0), (1, 1)), mode) for v, mode in ((error, "edge"), (bend, "constant")))
    return p, DOUBT * np.maximum(error[:, 1:], error[:, :-1]) + bends * np.maximum(bend[:, 1:], bend[:, :-1])


def unloading_meets(stage: Stage, D: np.ndarray, bends: float) -> tuple[np.ndarray, np.ndarray]:
    """Between which of the nodes and ends ``D`` (m, n) of intervals of curves unloading may come to the pressure, (m, n - 1): it
    may be below the least one before; and that of all intervals above, (m,), inf where there are none."""
    p, slack = between_nodes(stage, D, bends)
    known, error = (v[:, :, 0] for v in stage.known[:2])
    least, order = np.full(slack.shape, np.inf), np.lexsort((-D[:, 0], stage.parts.column))
    for here in np.split(order, np.flatnonzero(np.diff(stage.parts.column[order])) + 1):
        # in the order of unloading: nothing new at the top of an interval, then one node after another
        met = np.pad((known + error)[here, ::-1], ((0, 0), (1, 0)), constant_values=np.inf)
        least[here] = np.minimum.accumulate(met.ravel()).reshape(met.shape)[:, ::-1]
    # right beside the upper end nothing is told
    resolved = D[:, -1:] - D[:, :-1] > _BESIDE * (D[:, -1:] - D[:, :1])
    meets, ceiling = (np.minimum(p[:, :-1], p[:, 1:]) - slack < least) | ~resolved, least[:, -1]
    # what goes on from the interval above, and rises as it does, comes to nothing new there
    top = np.logical_and.accumulate(meets[:, ::-1], axis=1)[:, ::-1]
    lowest = np.where(top & resolved, (p - DOUBT * np.pad(error, ((0, 0), (1, 1)), "edge"))[:, :-1], np.inf).min(axis=1)
    return meets & ~(top & (lowest > ceiling)[:, None]), ceiling
