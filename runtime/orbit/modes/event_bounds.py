"""Bounds over all states between those of two marches: how steeply the gap falls to an onset or grows to a release, and how long
it takes from an onset to contact."""

import numpy as np

from .coordinates import Order
from .march import TWO_PI, Period
from .problem import ModeStrips, rates

#: how much earlier or later than in the two marches contact may begin, as a share of the time from onset to contact: a wider
#: range costs digits of the bound, a narrower one holds less often (two levels with 14 times: 0.1 takes an eighth more calls)
_SHARE = 0.03


def event_bounds(s: ModeStrips, order: Order, lower: Period, upper: Period):
    """Of all states between those of two marches, the least and the greatest value (2, N) of the rate at which the gap falls to
    the onset, of that at which it grows to the release, and of the time from onset to contact; and where the last holds."""
    before, after = (_modes_before(s, order, lower, upper, onset) for onset in (True, False))
    closing, closes = _closing_times(s, lower, upper, *before)
    slow, fast = _growing_after_contact(s, lower, upper, *after[2:])
    grows = -_falling(s, *after)[::-1]
    return _falling(s, *before), np.stack((np.fmax(grows[0], slow), np.fmin(grows[1], fast))), closing, closes


def _closing_times(s: ModeStrips, lower: Period, upper: Period, least, most, times, event):
    """Fast modes draw the point into contact at once, in a time that hardly depends on where the onset is; the onset may move by
    many times as much. From onset on the gap is ``delta_0 - J_0 p_0 + (rise of the profile) - sum_j (z_j + J_j p_0)(1 -
    exp(-t/beta_j))`` with z_j as it was at the onset: at a time proposed, its greatest value is negative, or its least positive.
    From contact on a deviation is kept no less than along the longest contact, which is that of ``lower``.
    """
    rate, kick = rates(s.m.beta), s.m.J * s.p_0
    low, high = (kick + each for each in _faded(least, most, times, rate))
    known = lower.smooth_onset & (lower.until[0] == lower.entry) & (upper.until[0] == upper.entry) & ~s.snaps
    one, two = (np.where(known, p.entry - p.onset, 0.0) for p in (lower, upper))
    gap = s.delta_0 - s.step
    late, early = np.maximum(one, two) * (1 + _SHARE), np.minimum(one, two) * (1 - _SHARE)
    lost_late, lost_early = -np.expm1(-late * rate), -np.expm1(-early * rate)
    rise = late * sine_range(event[0], event[1] + late)[1]
    fall = early * np.minimum(sine_range(event[0], event[1] + early)[0], 0.0)
    # in contact by then, and not released before
    by = gap + rise < (low * lost_late).sum(axis=0)
    by &= gap + np.maximum(rise, 0.0) - (np.minimum(low, 0.0) * lost_late).sum(axis=0) < s.delta_0
    not_before = gap + fall > (np.maximum(high, 0.0) * lost_early).sum(axis=0)
    # a time of nothing is before any contact
    closing = np.stack((np.where(not_before, early, 0.0), late))
    return closing, known & by & np.isfinite(closing).all(axis=0)


def _falling(s: ModeStrips, least, most, times, event):
    """Rate at which the gap falls, all along from the earlier event to the later: fast modes have died out by then."""
    rate, (low, high) = rates(s.m.beta), sine_range(*event)
    sums = [each.sum(axis=0) for each in _faded(rate * least, rate * most, times, rate)]
    return np.stack((sums[0] - high, sums[1] - low))


def _faded(least, most, times, rate):
    """Least and greatest value of modes after ``times`` (2, N) in a gap zone."""
    much, little = np.exp(-times[0] * rate), np.exp(-times[1] * rate)
    return least * np.where(least > 0, little, much), most * np.where(most > 0, much, little)


def _modes_before(s: ModeStrips, order: Order, lower: Period, upper: Period, onset: bool):
    """Least and greatest ``z - J p`` (n, N) as the gap zone began that the event ends, the least and the greatest time since, and
    the phases (2, N) between which the event is.

    The state there lies between those of the two marches, whatever the phase at which the zone began, and between the bounds of
    all orbits."""
    edge, k = (0, 0) if onset else (3, 1)
    (z_low, from_low), (z_up, from_up) = ((p.z_since[k], p.since[k]) for p in (lower, upper))
    first, last = np.minimum(from_low, from_up), np.maximum(from_low, from_up)
    floor, ceiling = -s.p_0, np.maximum(s.D, 0.0)
    kept = np.exp(-(last - first) * order.rate)
    low = _extreme(order.to_e(z_low), floor, ceiling, kept, from_low >= from_up, -1.0)
    high = _extreme(order.to_e(z_up), floor, ceiling, kept, from_up >= from_low, 1.0)
    rising, falling = np.maximum(order.share, 0.0), np.minimum(order.share, 0.0)
    across = lambda matrix, e: np.einsum("ij...,j...->i...", matrix, e)  # noqa: E731
    rest = s.m.J * (0.0 if onset else -s.p_0)
    least, most = across(rising, low) + across(falling, high) - rest, across(rising, high) + across(falling, low) - rest
    event = np.sort(np.stack([lower.edges[edge], upper.edges[edge]]), axis=0)
    return least, most, np.stack((np.maximum(event[0] - last, 0.0), event[1] - first)), event


def _growing_after_contact(s: ModeStrips, lower: Period, upper: Period, times, event):
    """Least and greatest rate at which the gap grows, ``times`` after contacts that end between those of two marches; -inf and
    inf where there is none.

    As contact ends every mode moves at the rate ``sum_i J_j/(beta_j - alpha_i) f_i``, and the overstresses f_i of fast branches
    are those of saturated contact. The others are lower by what fades in contact: it is least at the last end, greatest at
    the first.
    """
    m, ends = s.m, np.stack((upper.exit, lower.exit))
    after = (upper.since[1] == ends[0]) & (lower.since[1] == ends[1]) & (ends[0] <= ends[1])
    ends = np.where(after, ends, 0.0)
    with np.errstate(invalid="ignore"):
        response = m.eta / (1 + m.alpha**2)
        below = []
        for end, period in zip(ends, (upper, lower), strict=True):
            f = -np.einsum("ij...,j...->i...", m.enter, period.z_since[1] + m.J * s.p_0)
            below.append(response * (m.alpha * np.cos(end) - np.sin(end)) - f)
        width = response * np.hypot(m.alpha, 1.0) * (ends[1] - ends[0])
        top = response * (m.alpha * np.cos(ends[0]) - np.sin(ends[0]))
        low, high = top - width - np.maximum(*below), top + width - np.minimum(*below)
        rate = rates(m.beta)
        # an overstress by itself moves w one way only, at all times, as the flow is cooperative (``order``): w moves no less than
        # with the least of each, whatever the signs of the modes that they make up
        least, most = (np.einsum("ij...,j...->i...", m.leave * rate[:, None], f) for f in (low, high))
        least, most = (each.sum(axis=0) for each in _faded(least, most, times, rate))
    low, high = sine_range(*event)
    return np.where(after, low + least, -np.inf), np.where(after, high + most, np.inf)


def _extreme(e, floor, ceiling, kept, at_end, sign):
    """Largest (``sign`` 1) or least (-1) value over a range of phases of displacements known at its end or at its start.

    They tend to w, which lies between ``floor`` and ``ceiling`` like themselves; ``kept``: what is left of a deviation
    after the range.
    """
    toward, away = (ceiling, floor) if sign > 0 else (floor, ceiling)
    after = np.where(sign * (toward - e) > 0, e + (toward - e) * (1 - kept), e)
    before = np.divide(e - away * (1 - kept), kept, out=np.full(e.shape, sign * np.inf), where=kept > 1e-290)
    before = np.where(sign * (away - e) >= 0, e, before)
    value = np.where(at_end, before, after)
    return np.clip(value, np.minimum(floor, e), np.maximum(ceiling, e))


def sine_range(low, high):
    """Least and greatest value of ``sin s`` on [low, high], elementwise."""
    ends = np.sin(low), np.sin(high)
    holds = lambda phase: np.ceil((low - phase) / TWO_PI) * TWO_PI + phase <= high  # noqa: E731
    return np.where(holds(-0.5 * np.pi), -1.0, np.minimum(*ends)), np.where(holds(0.5 * np.pi), 1.0, np.maximum(*ends))
