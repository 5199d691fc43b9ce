"""First crossings, bracketed in closed form, found for a whole batch at once.

Every event of a strip (gap closes, gap reaches delta_0, pressure falls to -p_0) is a zero of a function F with
``F + T F' = one harmonic of the phase``. At a zero the slope of F has the sign of that harmonic, so F crosses zero at
most once inside the arc where the harmonic keeps its sign: the arc is a bracket, and safeguarded Newton inside it
cannot find the wrong zero.
"""

from collections.abc import Callable

import numpy as np

_EPS = np.finfo(float).eps
_MAX_ITERATIONS = 200


def crossing(
    event: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]],
    low: np.ndarray,
    high: np.ndarray,
    guess: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Zero of ``event`` between ``low`` (where it is positive) and ``high`` (where it is not), elementwise.

    ``event(x, index)`` returns value and slope at ``x`` for the elements ``index`` of the batch. The caller
    guarantees the signs at the ends; they are not evaluated. Returns the zeros and the evaluations each took, both of
    the shape of ``low``.
    """
    low, high = low.copy(), high.copy()
    x = np.clip(guess, low, high) if guess is not None else 0.5 * (low + high)
    result = x.copy()
    active = np.flatnonzero(high > low)
    result[high <= low] = high[high <= low]
    width = high - low
    spent = np.zeros(low.shape)
    for _ in range(_MAX_ITERATIONS):
        if active.size == 0:
            break
        xa, lo, hi = x[active], low[active], high[active]
        value, slope = event(xa, active)
        spent[active] += 1
        positive = value > 0
        lo = np.where(positive, xa, lo)
        hi = np.where(positive, hi, xa)
        # a slope of the wrong sign, or none, sends Newton outside the bracket: bisection then
        step = np.divide(-value, slope, out=np.full_like(value, np.inf), where=slope < 0)
        newton = xa + step
        slow = np.abs(step) > 0.5 * width[active]
        outside = ~((newton >= lo) & (newton <= hi)) | slow
        new = np.where(outside, 0.5 * (lo + hi), newton)
        width[active] = np.where(outside, hi - lo, np.abs(step))
        tolerance = 2 * _EPS * np.maximum(np.abs(lo), np.abs(hi))
        done = (value == 0) | (hi - lo <= tolerance) | (~outside & (np.abs(step) <= tolerance))
        result[active] = np.where(value == 0, xa, new)
        x[active], low[active], high[active] = new, lo, hi
        active = active[~done]
    return result, spent
