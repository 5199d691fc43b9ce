"""Newton on the generated boundary equations of a regime, from edges that the ordered iteration has already enclosed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...numerics.linear import solved
from ...numerics.rounding import EPS
from .problem import ModeStrips

_ITERATIONS = 12
#: steps larger than this are corrections, whatever the one before was
_ROUNDING_LIMITED = 1e-7
#: a step expected to be this small is not taken; steps as large as that after so many, or that hardly shrink, lead nowhere
_SETTLED, _LOST, _LOST_AFTER, _SHRINKS = 2 * EPS, 0.1, 4, 0.7


@dataclass(slots=True)
class Polished:
    """Edges (k, N); ``correction`` (N,): the last step; ``attainable`` (N,): how well rounding lets the edges be known;
    ``evaluations`` (N,)."""

    edges: np.ndarray
    correction: np.ndarray
    attainable: np.ndarray
    evaluations: np.ndarray


def arguments(s: ModeStrips):
    """What every function of a regime takes after the edges."""
    return s.m, s.p_0, s.delta_0, s.D


def polish(kernel, sequence: str, strips: ModeStrips, edges: np.ndarray, low: np.ndarray, high: np.ndarray) -> Polished:
    """Refine ``edges`` (k, N) of strips that all are in the regime ``sequence``, kept between ``low`` and ``high`` and
    in order."""
    residual, jacobian = (getattr(kernel, f"{what}_{sequence}") for what in ("residual", "jacobian"))
    edges = edges.copy()
    N = strips.size
    last, attainable, spent = np.full(N, np.inf), np.full(N, np.inf), np.zeros(N)
    active = np.arange(N)
    for iteration in range(_ITERATIONS):
        s, before = strips.take(active), last[active]
        here = edges[:, active]
        matrix = np.empty((s.size, len(here), len(here)))
        for i, row in enumerate(jacobian(*here, *arguments(s))):
            for j, entry in enumerate(row):
                matrix[:, i, j] = entry
        inverted = solved(matrix, np.broadcast_to(np.eye(len(here)), matrix.shape))
        step = -np.einsum("Nij,jN->iN", inverted, np.array(np.broadcast_arrays(*residual(*here, *arguments(s)))))
        spent[active] += 1
        size = np.abs(step).max(axis=0)
        # at the limit of rounding a step no longer shrinks: it is the uncertainty, not a correction
        better = np.isfinite(size) & ((size < 0.5 * last[active]) | (size > _ROUNDING_LIMITED))
        moved = active[better]
        new = np.maximum.accumulate(here[:, better] + step[:, better], axis=0)
        edges[:, moved] = np.clip(new, low[:, moved], high[:, moved])
        last[moved] = size[better]
        noise = _noise(kernel, len(edges), s)
        attainable[moved] = np.einsum("Nij,jN->iN", np.abs(inverted), noise).max(axis=0)[better]
        # steps that shrink as fast again: the next one need not be taken
        ahead = size * np.divide(size, before, out=np.ones_like(size), where=(size < before) & np.isfinite(before))
        settled = ahead <= _SETTLED
        last[active[better & settled]] = ahead[better & settled]
        on = (size < _LOST) & ((size < _SHRINKS * before) | (size < _ROUNDING_LIMITED)) | (iteration < _LOST_AFTER)
        active = active[better & ~settled & on]
        if not active.size:
            break
    return Polished(edges, last, attainable, spent)


def _noise(kernel, k: int, s: ModeStrips):
    """Rounding of each boundary equation, (k, N): pressures are of the size of the saturated one."""
    return np.broadcast_to(EPS * (s.size_of_lengths + kernel.modulus_ratio(s.m)), (k, s.size))
