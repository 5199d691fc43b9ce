"""A phase that is certain to lie before, or after, the zero of an event: verified by the sign of the event there."""

import numpy as np

#: bounds are sought this far beyond the linear estimate
_BEYOND, _BACK = 1.3, 0.9
_TRIES = 9
#: a bound is good enough when this many tries have been beyond the zero, the later ones closer to it
_LOOSE, _CLOSER = 2, 3


def bound(event, entry, offset, rising, start, far, side, noise, spent, near=None):
    """A phase between ``start`` and ``far`` that is beyond the event's zero, and whether one was found.

    The event function, ``rising`` times (value - offset), is positive before its zero and negative after. ``side`` > 0 seeks a phase
    after it (``start`` lies before), ``side`` < 0 a phase before it. With ``near``, the end of the arc opposite to ``far``, ``start`` may be
    anywhere in between.
    """
    near = start if near is None else near
    result, found, since = start.copy(), np.zeros(start.shape, bool), np.zeros(start.shape, int)
    low, high = np.minimum(near, far), np.maximum(near, far)
    constants = np.stack(np.broadcast_arrays(offset, noise, *entry))
    x, index = start, np.arange(start.size)
    for attempt in range(_TRIES):
        level, blur, *rest = constants
        value, slope = event(x, *rest)
        value, slope = rising * (value - level), rising * slope
        good = side * value < -blur
        better = good & (~found[index] | (side * (result[index] - x) > 0))
        result[index] = np.where(better, x, result[index])
        found[index] |= good
        since[index] += found[index]
        spent[index] += 1
        if attempt >= _LOOSE:
            going = np.flatnonzero(since[index] < _CLOSER)
            if not going.size:
                break
            if going.size < index.size:
                index = index[going]
                x, value, slope, good, blur, constants = (v[..., going] for v in (x, value, slope, good, blur, constants))
        ahead = np.where(slope < 0, -value / slope, np.nan)
        # from the inner side step beyond the estimate and beyond what rounding blurs (where nothing is remembered the bound is the
        # known edge itself), from the outer side not quite back to it
        step = np.where(good, _BACK * ahead, _BEYOND * ahead - side * 4 * blur / slope)
        halfway = 0.5 * (far[index] - x)
        x = x + np.where((np.abs(step) <= np.abs(halfway)) | good, step, halfway)
        x = np.where(np.isfinite(x), np.clip(x, low[index], high[index]), far[index])
    return result, found
