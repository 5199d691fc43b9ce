"""A phase that is certain to lie before, or after, the zero of an event: verified by the sign of the event there."""

import numpy as np

#: distance from the zero, as estimated there, at which bounds are close enough: less on foundations slower than this beta, which
#: change less over a period
_CLOSE, _SLOW = 0.05, 6.0
#: bounds are sought beyond the linear estimate by this share of the way to it, or its square where that is less
_BEYOND = 0.3
_TRIES = 12


def close_enough(beta):
    """Distance from the zero at which bounds for strips of these beta are good enough."""
    return _CLOSE * _SLOW / np.maximum(beta, _SLOW)


def rows(size: int, *values) -> np.ndarray:
    """Arrays (size,) and numbers as the rows of one array."""
    out = np.empty((len(values), size))
    for row, value in zip(out, values, strict=True):
        row[:] = value
    return out


def bound(event, entry, offset, rising, start, far, side, noise, close, spent, near=None):
    """A phase between ``start`` and ``far`` that is beyond the event's zero, if possible no further than ``close``; and whether
    one was found.

    The event function, ``rising`` times (value - offset), is positive before its zero and negative after. ``side`` > 0 seeks a
    phase after it (``start`` lies before), ``side`` < 0 a phase before it. With ``near``, the end of the arc opposite to ``far``,
    ``start`` may be anywhere in between.
    """
    near = start if near is None else near
    result, found = start.copy(), np.zeros(start.shape, bool)
    state = rows(start.size, start, near, far, close, offset, noise, *entry)
    index, tries = np.arange(start.size), 0
    while True:
        x, near, far, close, level, blur, *rest = state
        value, slope = event(x, *rest)
        value, slope = rising * (value - level), rising * slope
        tries += 1
        spent[index] += 1
        good = side * value < -blur
        ahead = np.where(slope < 0, -value / slope, np.nan)
        size = np.abs(ahead)
        # what is verified later is closer: what was verified before is where the way back to the zero begins
        here = np.flatnonzero(good)
        result[index[here]], found[index[here]] = x[here], True
        state[1] = np.where(good, near, x)
        state[2] = np.where(good, x, far)
        going = np.flatnonzero(~(good & (size <= close)) & (state[1] != state[2]))
        if not going.size or tries == _TRIES:
            return result, found
        # beyond the estimate, and beyond what rounding blurs (where nothing is remembered the bound is the known edge itself)
        x = x + ahead + side * (np.minimum(_BEYOND * size, size * size + 0.5 * close) - 4 * blur / slope)
        inside = (x > np.minimum(state[1], state[2])) & (x < np.maximum(state[1], state[2]))
        state[0] = np.where(inside, x, 0.5 * (state[1] + state[2]))
        state[0] = np.where(good | inside | (tries < 3), state[0], state[2])
        if going.size < index.size:
            index, state = index[going], state[:, going]
