"""Bracketed roots of many functions of one variable at once: Newton's method, or the secant's, that cannot leave its bracket.

Each step is Newton's where the function gives its slope, and else that of the secant through the last two points; it is
replaced by bisection where it would leave the bracket or is no half as long as the step before. This is Dekker's safeguard (in
"Constructive Aspects of the Fundamental Theorem of Algebra", 1969) in the form of ``rtsafe`` (Press et al., "Numerical
Recipes", section 9.4): it ends for every function, and like Newton's method or the secant's next to a simple root.
"""

from collections.abc import Callable

import numpy as np

from .rounding import EPS

#: bisection alone ends within 1,100 steps, from the largest number to the smallest, and every other step at least halves
_MOST = 2200


def falling_root(
    function: Callable[[np.ndarray, np.ndarray], np.ndarray | tuple[np.ndarray, np.ndarray]],
    low: np.ndarray,
    high: np.ndarray,
    guess: np.ndarray | None = None,
    tolerance: float = 0.0,
) -> np.ndarray:
    """Where functions fall through zero, each between ``low`` (m,), where it is positive, and ``high`` (m,), where it is not.

    ``function(x, index)`` returns the values at ``x`` of the members ``index``, all (k,), or a tuple of values and slopes. The
    signs at the ends are the caller's word: the ends are not evaluated. Where there are several roots one of them is found.
    Ends at two roundings of x, or at ``tolerance`` in x, whichever is larger. A bracket without width is its own root.
    """
    x = 0.5 * (low + high) if guess is None else np.clip(guess, low, high)
    result = np.where(high > low, x, high)
    live = np.flatnonzero(high > low)
    x, lo, hi = x[live], low[live], high[live]
    before = hi - lo  # the step before, or the bracket
    correction = np.zeros(live.size)  # the step before if it was no bisection, else 0
    last = x, np.full(live.size, np.nan)  # the point before and its value, for the secant: none at first
    for _ in range(_MOST):
        if not live.size:
            break
        found = function(x, live)
        newton = isinstance(found, tuple)
        value, slope = found if newton else (found, None)
        small = np.maximum(2 * EPS * np.abs(x), tolerance)
        # a slope of the wrong sign, or one that over- or underflowed, gives a step out of the bracket, no number, or none
        with np.errstate(all="ignore"):
            step = value / -(slope if newton else (value - last[1]) / (x - last[0]))
            if not newton:
                # a small step may be that of a steep secant: only a narrow bracket tells, and steps not too small make one
                step = np.copysign(np.maximum(np.abs(step), 0.5 * small), step)
            size = np.abs(step)
            # Newton's next step would be this one times the square of the last ratio of steps
            ahead = size * np.minimum(size / correction, 1.0) ** 2
        positive = value > 0
        last, lo, hi = (x, value), np.where(positive, x, lo), np.where(positive, hi, x)
        new, exact, width = x + step, value == 0, hi - lo
        taken = (new >= lo) & (new <= hi) & (size <= 0.5 * before) & (size > 0)
        done = exact | (width <= small)
        if newton:
            done |= taken & (ahead <= small)
        x, before, correction = new, size, size
        if not taken.all():
            x = np.where(taken, new, np.where(exact, last[0], 0.5 * (lo + hi)))
            before, correction = np.where(taken, size, width), np.where(taken, size, 0.0)
        if done.any():
            result[live[done]] = x[done]
            going = np.flatnonzero(~done)
            live, x, lo, hi = live[going], x[going], lo[going], hi[going]
            before, correction, last = before[going], correction[going], tuple(v[going] for v in last)
    result[live] = x
    return result
