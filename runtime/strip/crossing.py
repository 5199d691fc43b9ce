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
    result = np.where(high > low, x, high)
    active = np.flatnonzero(high > low)
    before = high - low  # last step taken, or the bracket
    correction = np.zeros(low.shape)  # Newton's step before, 0 if that was none
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
        # a slope of the wrong sign, or one too small to divide by, sends the step outside the bracket: bisection then
        usable = (slope < 0) & (np.abs(slope) > 1e-290 * np.abs(value))
        step = np.divide(-value, slope, out=np.full_like(value, np.inf), where=usable)
        new = xa + step
        size, then = np.abs(step), correction[active]
        bisected = ~((new >= lo) & (new <= hi)) | (size > 0.5 * before[active])
        new = np.where(bisected, 0.5 * (lo + hi), new)
        tolerance = 2 * _EPS * np.maximum(np.abs(lo), np.abs(hi))
        # two steps in a row that shrink this fast do so quadratically: the next one need not be taken
        ratio = np.divide(size, then, out=np.ones_like(size), where=then > size)
        done = (value == 0) | (hi - lo <= tolerance) | (~bisected & (size * ratio * ratio <= tolerance))
        new = np.where(value == 0, xa, new)
        result[active], x[active], low[active], high[active] = new, new, lo, hi
        before[active] = np.where(bisected, hi - lo, size)
        correction[active] = np.where(bisected, 0.0, size)
        active = active[~done]
    return result, spent
