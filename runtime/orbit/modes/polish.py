"""Newton's method on the generated boundary equations of a regime, from edges that marches met."""

import numpy as np

from ...numerics.linear import solved
from ...numerics.rounding import EPS
from ..groups import ROUNDING, TWO_PI
from .problem import ModeStrips

_ITERATIONS = 12
#: a step expected to be this small is not taken; steps as large as that after so many, or that hardly shrink, lead nowhere
_SETTLED, _LOST, _LOST_AFTER, _SHRINKS = 2 * EPS, 0.1, 4, 0.7
#: the last step of an orbit is this small, or the multiple of what rounding lets the edges be known to, which is no more than the
#: last; steps larger than that are corrections, whatever the one before was
_CONVERGED, _ROUNDINGS, _COARSEST = 1e-13, 64, 1e-6


def certified(kernel, strips: ModeStrips, sequence: str, edges: np.ndarray):
    """Orbits of strips in the regime ``sequence`` from ``edges`` (k, N); which converged, in order within a period."""
    with np.errstate(all="ignore"):
        edges, last, attainable = _newton(kernel, strips, sequence, edges)
    good = last <= _CONVERGED + _ROUNDINGS * np.minimum(attainable, _COARSEST)
    good &= np.all(np.diff(edges, axis=0) >= -ROUNDING, axis=0) & (edges[-1] - edges[0] <= TWO_PI + ROUNDING)
    return edges, good


def _newton(kernel, strips: ModeStrips, sequence: str, edges: np.ndarray):
    """Edges, kept in order; the last steps; how well rounding lets the edges be known."""
    linearised = getattr(kernel, f"residual_and_jacobian_{sequence}")
    edges, N = edges.copy(), strips.size
    last, attainable = np.full(N, np.inf), np.full(N, np.inf)
    active = np.arange(N)
    for iteration in range(_ITERATIONS):
        s, before = strips.take(active), last[active]
        here = edges[:, active]
        matrix = np.empty((s.size, len(here), len(here)))
        residual, rows = linearised(*here, *s.arguments)
        for i, row in enumerate(rows):
            for j, entry in enumerate(row):
                matrix[:, i, j] = entry
        inverted = solved(matrix, np.broadcast_to(np.eye(len(here)), matrix.shape))
        step = -np.einsum("Nij,jN->iN", inverted, np.array(np.broadcast_arrays(*residual)))
        size = np.abs(step).max(axis=0)
        # at the limit of rounding a step no longer shrinks: it is the uncertainty, not a correction
        better = np.isfinite(size) & ((size < 0.5 * last[active]) | (size > _COARSEST))
        moved = active[better]
        edges[:, moved] = np.maximum.accumulate(here[:, better] + step[:, better], axis=0)
        last[moved] = size[better]
        # pressures are of the size of the saturated one
        noise = EPS * (s.size_of_lengths + kernel.modulus_ratio(s.m))
        attainable[moved] = (np.abs(inverted).sum(axis=2).max(axis=1) * noise)[better]
        # steps that shrink as fast again: the next one need not be taken
        ahead = size * np.divide(size, before, out=np.ones_like(size), where=(size < before) & np.isfinite(before))
        settled = ahead <= _SETTLED
        last[active[better & settled]] = ahead[better & settled]
        on = (size < _LOST) & ((size < _SHRINKS * before) | (size < _COARSEST)) | (iteration < _LOST_AFTER)
        active = active[better & ~settled & on]
        if not active.size:
            break
    return edges, last, attainable
