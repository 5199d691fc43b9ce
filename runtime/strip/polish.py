"""Newton on the generated boundary equations of a regime, from an orbit that the search has already isolated.

All but the last boundary equation join neighbouring edges, so the corrections follow one another and a single unknown,
that of the first edge, is left for the closing balance.
"""

from dataclasses import dataclass

import numpy as np

from .problem import Strips

_ITERATIONS = 4
_EPS = np.finfo(float).eps


@dataclass(slots=True)
class Polished:
    """Edges of shape (k, n), the size of the last correction (n,), and how well posed the closing balance is (n,).

    ``margin`` is the net sensitivity of the closing balance to the first edge over the sum of the absolute values of its
    parts: of order one in general, near zero at a fold, where an edge is known to about ``sqrt(eps)`` only.
    """

    edges: np.ndarray
    correction: np.ndarray
    margin: np.ndarray


def polish(kernel, sequence: str, strips: Strips, edges: np.ndarray) -> Polished:
    """Refine ``edges``, shape (k, n), of strips that all are in the regime ``sequence``."""
    residual = getattr(kernel, f"residual_{sequence}")
    jacobian = getattr(kernel, f"jacobian_{sequence}")
    arguments = (strips.alpha, strips.beta, strips.J, strips.L, strips.p_0, strips.delta_0, strips.D, strips.chi)
    edges = edges.copy()
    last = np.full(strips.size, np.inf)
    margin = np.zeros(strips.size)
    for _ in range(_ITERATIONS):
        step, margin = _step(residual(*edges, *arguments), jacobian(*edges, *arguments))
        size = np.max(np.abs(step), axis=0)
        # at the limit of rounding a step no longer shrinks: it is the uncertainty, not a correction
        better = size < last
        edges = np.where(better, np.maximum.accumulate(edges + step, axis=0), edges)
        last = np.where(better, size, last)
        if not np.any(better & (size > 4 * _EPS)):
            break
    return Polished(edges, last, margin)


def _step(residual, jacobian):
    """Newton step by elimination along the chain of edges."""
    k = len(residual)
    constant, linear = [np.zeros_like(residual[0])], [np.ones_like(residual[0])]
    for i in range(k - 1):
        pivot = np.broadcast_to(jacobian[i][i + 1], residual[i].shape)
        ok = pivot != 0
        for part, right in ((constant, residual[i]), (linear, 0.0)):
            value = -(right + jacobian[i][i] * part[-1])
            part.append(np.divide(value, pivot, out=np.zeros_like(value), where=ok))
    known, slope, size = residual[-1].copy(), np.zeros_like(residual[-1]), np.zeros_like(residual[-1])
    for j in range(k):
        known = known + jacobian[-1][j] * constant[j]
        slope = slope + jacobian[-1][j] * linear[j]
        size = size + np.abs(jacobian[-1][j] * linear[j])
    first = np.divide(-known, slope, out=np.zeros_like(known), where=slope != 0)
    margin = np.divide(np.abs(slope), size, out=np.zeros_like(slope), where=size > 0)
    return np.array([constant[j] + linear[j] * first for j in range(k)]), margin
