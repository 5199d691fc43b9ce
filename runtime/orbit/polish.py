"""Newton on the generated boundary equations of a regime, from an orbit that the search has already isolated.

All but the last boundary equation join neighbouring edges, so the corrections follow one another and a single unknown,
that of the first edge, is left for the closing balance.
"""

from dataclasses import dataclass

import numpy as np

from ..numerics.rounding import EPS
from .certificate import STABLE
from .groups import Strips

_ITERATIONS = 20


@dataclass(slots=True)
class Polished:
    """Edges of shape (k, n); ``correction`` (n,): the last step; ``attainable`` (n,): how well rounding lets the edges be known.

    ``evaluations`` (n,): of the boundary equations and their Jacobian. ``stalled`` (n,): corrections had stopped to shrink.

    ``attainable`` is of the order of rounding in general, and of its square root where an edge is nearly grazed or at a fold.
    """

    edges: np.ndarray
    correction: np.ndarray
    attainable: np.ndarray
    evaluations: np.ndarray
    stalled: np.ndarray


def polish(kernel, sequence: str, strips: Strips, edges: np.ndarray, bounds=(-np.inf, np.inf)) -> Polished:
    """Refine ``edges``, shape (k, n), of strips that all are in the regime ``sequence``, kept within ``bounds`` (arrays (k,
    n))."""
    residual = getattr(kernel, f"residual_{sequence}")
    jacobian = getattr(kernel, f"jacobian_{sequence}")
    arguments = (strips.alpha, strips.beta, strips.J, strips.L, strips.p_0, strips.delta_0, strips.D, strips.chi)
    noise = _noise(kernel, sequence, strips)
    edges = edges.copy()
    n = strips.size
    last, evaluations = np.full(n, np.inf), np.zeros(n)
    low, high = (np.broadcast_to(bound, edges.shape) for bound in bounds)
    stalls = np.zeros(n, int)
    active, here = np.arange(n), arguments
    # of each strip, at the last step that was a correction
    slopes: list[list] = []
    for _ in range(_ITERATIONS):
        current = edges[:, active]
        matrix = jacobian(*current, *here)
        step, _ = newton(residual(*current, *here), matrix)
        evaluations[active] += 1
        size = np.max(np.abs(step), axis=0)
        # at the limit of rounding a step no longer shrinks: it is the uncertainty, not a correction. Once may be chance, and one
        # larger than rounding makes them is a correction, whatever the one before was
        better = (size < last[active]) | (size > STABLE)
        moved = active[better]
        new = np.clip(np.maximum.accumulate(current + step, axis=0), low[:, active], high[:, active])
        edges[:, moved] = new[:, better]
        last[moved] = size[better]
        slopes = _kept(slopes, matrix, moved, better)
        stalls[active[~better]] += 1
        going = np.flatnonzero((stalls[active] < 2) & (size > 4 * EPS * np.max(np.abs(new), axis=0)))
        if not going.size:
            break
        if going.size < active.size:
            active = active[going]
            here = tuple(v[active] for v in arguments)
    return Polished(edges, last, _propagated(noise, slopes), evaluations, stalls > 0)


def _kept(slopes: list[list], matrix, moved, better) -> list[list]:
    """The ``slopes`` with those of ``matrix`` for the strips ``moved``, which are ``better``."""
    if not slopes:  # the first step is a correction, unless it is no number
        return [[entry if np.ndim(entry) == 0 else np.where(better, entry, np.nan) for entry in row] for row in matrix]
    for row, now in zip(slopes, matrix, strict=True):
        for entry, value in zip(row, now, strict=True):
            if np.ndim(entry):
                entry[moved] = value[better]
    return slopes


def newton(residual, jacobian):
    """Newton step (k, n) by elimination along the chain of edges, and the slope of the last equation when they all move with the
    first."""
    k = len(residual)
    constant, linear = [np.zeros_like(residual[0])], _linear(jacobian, residual[0])
    for i in range(k - 1):
        constant.append(-_ratio(residual[i] + jacobian[i][i] * constant[-1], jacobian[i][i + 1]))
    known = residual[-1] + sum(jacobian[-1][j] * constant[j] for j in range(k))
    slope = sum(jacobian[-1][j] * linear[j] for j in range(k))
    first = -_ratio(known, slope)
    return np.array([constant[j] + linear[j] * first for j in range(k)]), slope


def _propagated(noise, jacobian):
    """Greatest uncertainty of an edge that residuals known to ``noise`` leave, by the same elimination with absolute values."""
    k = len(noise)
    constant, linear = [np.zeros_like(noise[0])], _linear(jacobian, noise[0])
    for i in range(k - 1):
        constant.append(_ratio(noise[i] + np.abs(jacobian[i][i]) * constant[-1], np.abs(jacobian[i][i + 1])))
    known = noise[-1] + sum(np.abs(jacobian[-1][j]) * constant[j] for j in range(k))
    first = _ratio(known, np.abs(sum(jacobian[-1][j] * linear[j] for j in range(k))))
    return np.max([constant[j] + np.abs(linear[j]) * first for j in range(k)], axis=0)


def _linear(jacobian, like):
    """Movement of each edge with the first, along the chain."""
    linear = [np.ones_like(like)]
    for i in range(len(jacobian) - 1):
        linear.append(-_ratio(jacobian[i][i] * linear[-1], jacobian[i][i + 1]))
    return linear


def _ratio(upper, lower):
    """``upper/lower``; 0 where the divisor vanishes or is lost (a grazed edge stays where the search put it)."""
    return np.divide(upper, lower, out=np.zeros_like(upper), where=np.abs(lower) > 1e-290 * (1 + np.abs(upper)))


def _noise(kernel, sequence: str, s: Strips):
    """Rounding of each boundary equation of a regime."""
    size = 1 + np.abs(s.D) + s.p_0
    slow = 2 * np.pi / (2 * np.pi + s.beta)
    R = kernel.modulus_ratio(s.alpha, s.beta)
    gap = EPS * (1 + s.delta_0 + (size + s.delta_0) * slow)
    excess = EPS * (R + (size + R) * 2 * np.pi / (2 * np.pi + s.alpha))
    closing = EPS * (size + s.delta_0) * slow
    chain = {"acaf": (gap, excess, gap), "afc": (excess, gap), "af": (gap,), "ac": (excess,)}[sequence]
    return (*chain, closing)
