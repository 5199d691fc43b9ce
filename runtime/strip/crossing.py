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
    older = (x, np.zeros(low.shape), np.zeros(low.shape))  # point, value, slope of the evaluation before (slope 0: none)
    older = tuple(v.copy() for v in older)
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
        earlier = tuple(v[active] for v in older)
        step = _step(xa, value, slope, *earlier)
        new = xa + step
        size, last = np.abs(step), before[active]
        # a slope of the wrong sign, or none, sends the step outside the bracket: bisection then
        bisected = ~((new >= lo) & (new <= hi)) | (size > 0.5 * last)
        new = np.where(bisected, 0.5 * (lo + hi), new)
        size = np.where(bisected, hi - lo, size)
        tolerance = 2 * _EPS * np.maximum(np.abs(lo), np.abs(hi))
        # Newton's corrections at two points that shrink this fast do so quadratically: the next one need not be taken
        now, then = _correction(value, slope), _correction(earlier[1], earlier[2])
        ratio = np.divide(now, then, out=np.ones_like(now), where=then > now)
        done = (value == 0) | (hi - lo <= tolerance) | (~bisected & (np.maximum(now, size) * ratio * ratio <= tolerance))
        new = np.where(value == 0, xa, new)
        result[active] = new
        for array, now in zip((x, low, high, before, *older), (new, lo, hi, size, xa, value, slope), strict=True):
            array[active] = now
        active = active[~done]
    return result, spent


def _correction(value, slope):
    """Size of Newton's correction; 0 where there is no slope to take it from."""
    usable = (slope < 0) & (np.abs(slope) > 1e-290 * np.abs(value))
    return np.divide(np.abs(value), -slope, out=np.zeros_like(value), where=usable)


def _step(x, value, slope, x_old, value_old, slope_old):
    """Step to the zero of the inverse cubic through the last two evaluations and their slopes; Newton's where there is but one."""
    # a step that overflows or is undefined falls outside the bracket, and bisection takes its place
    with np.errstate(over="ignore", invalid="ignore"):
        return _inverse_cubic(x, value, slope, x_old, value_old, slope_old)


def _inverse_cubic(x, value, slope, x_old, value_old, slope_old):
    newton = np.divide(-value, slope, out=np.full_like(value, np.inf), where=slope < 0)
    span = value_old - value
    usable = (slope < 0) & (slope_old < 0) & (np.abs(span) > 1e-3 * np.abs(value)) & np.isfinite(newton)
    if not usable.any():
        return newton
    safe = np.where(usable, span, 1.0)
    s, s_old = np.where(usable, slope, -1.0), np.where(usable, slope_old, -1.0)
    # inverse Hermite interpolation, by divided differences in the values, at value 0
    first = (x_old - x) / safe
    second = (first - 1 / s) / safe
    third = ((1 / s_old - first) / safe - second) / safe
    v = np.where(usable, value, 0.0)
    cubic = -v / s + v * v * (second - third * np.where(usable, value_old, 0.0))
    return np.where(usable, cubic, newton)
