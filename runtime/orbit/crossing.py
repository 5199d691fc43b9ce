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
    x = np.clip(guess, low, high) if guess is not None else 0.5 * (low + high)
    result, spent = np.where(high > low, x, high), np.zeros(low.shape)
    active = np.flatnonzero(high > low)
    x, lo, hi = x[active], low[active], high[active]
    before = hi - lo  # last step taken, or the bracket
    correction = np.zeros(active.size)  # Newton's step before, 0 if that was none
    for _ in range(_MAX_ITERATIONS):
        if not active.size:
            break
        value, slope = event(x, active)
        spent[active] += 1
        positive = value > 0
        lo, hi = np.where(positive, x, lo), np.where(positive, hi, x)
        # a slope of the wrong sign, or one too small to divide by, sends the step outside the bracket: bisection then
        usable = (slope < 0) & (np.abs(slope) > 1e-290 * np.abs(value))
        step = np.divide(-value, slope, out=np.full_like(value, np.inf), where=usable)
        new, size = x + step, np.abs(step)
        bisected = ~((new >= lo) & (new <= hi)) | (size > 0.5 * before)
        new = np.where(bisected, 0.5 * (lo + hi), new)
        tolerance = 2 * _EPS * np.maximum(np.abs(lo), np.abs(hi))
        # two steps in a row that shrink this fast do so quadratically: the next one need not be taken
        ratio = np.divide(size, correction, out=np.ones_like(size), where=correction > size)
        exact = value == 0
        done = exact | (hi - lo <= tolerance) | (~bisected & (size * ratio * ratio <= tolerance))
        x = np.where(exact, x, new)
        before, correction = np.where(bisected, hi - lo, size), np.where(bisected, 0.0, size)
        if done.any():
            result[active[done]] = x[done]
            going = np.flatnonzero(~done)
            active, x, lo, hi = active[going], x[going], lo[going], hi[going]
            before, correction = before[going], correction[going]
    result[active] = x
    return result, spent
