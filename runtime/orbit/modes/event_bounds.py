"""Bounds over all states between those of two marches: how steeply the gap falls to an onset or grows to a release, and how long
it takes from an onset to contact."""

from __future__ import annotations

import numpy as np

from .coordinates import Order
from .march import TWO_PI, Period
from .problem import ModeStrips, rates

#: how much earlier or later than in the two marches contact may begin, as a share of the time from onset to contact: a wider
#: range costs digits of the bound
_SHARES = (1e-5, 1e-2, 0.5)


def closing_times(s: ModeStrips, order: Order, lower: Period, upper: Period):
    """Least and greatest time (2, N) from onset to contact of all states between those of two marches, and where these hold.

    Fast modes draw the point into contact at once, in a time that hardly depends on where the onset is; the onset may move by
    many times as much. From onset on the gap is ``delta_0 - J_0 p_0 + (rise of the profile) - sum_j (z_j + J_j p_0)(1 -
    exp(-t/beta_j))`` with z_j as it was at the onset: at a time proposed, its greatest value is negative, or its least positive.
    From contact on a deviation is kept no less than along the longest contact, which is that of ``lower``.
    """
    least, most, short, long, event = _modes_before(s, order, lower, upper, True)
    rate, kick = rates(s.m.beta), s.m.J * s.p_0
    fresh, old = np.exp(-short * rate), np.exp(-long * rate)
    low, high = kick + np.where(least > 0, least * old, least * fresh), kick + np.where(most > 0, most * fresh, most * old)
    known = lower.smooth_onset & (lower.until[0] == lower.entry) & (upper.until[0] == upper.entry) & ~s.snaps
    one, two = (np.where(known, p.entry - p.onset, 0.0) for p in (lower, upper))
    gap = s.delta_0 - s.step
    times, found = np.zeros((2, s.size)), np.zeros((2, s.size), bool)
    for share in _SHARES:
        late, early = np.maximum(one, two) * (1 + share), np.minimum(one, two) * (1 - share)
        lost_late, lost_early = -np.expm1(-late * rate), -np.expm1(-early * rate)
        rise = late * _harmonic_max(0.0, 1.0, event[0], event[1] + late)
        fall = early * np.minimum(-_harmonic_max(0.0, -1.0, event[0], event[1] + early), 0.0)
        # in contact by then, and not released before
        by = gap + rise < (low * lost_late).sum(axis=0)
        by &= gap + np.maximum(rise, 0.0) - (np.minimum(low, 0.0) * lost_late).sum(axis=0) < s.delta_0
        not_before = gap + fall > (np.maximum(high, 0.0) * lost_early).sum(axis=0)
        times = np.where(found, times, np.stack((early, late)))
        found |= np.stack((not_before, by))
    # a time of nothing is before any contact
    times[0] = np.where(found[0], times[0], 0.0)
    return times, known & found[1] & np.isfinite(times).all(axis=0)


def slopes_by_modes(s: ModeStrips, order: Order, lower: Period, upper: Period, onset: bool):
    """Least and greatest rate at which the gap falls to the onset, or grows to the release, from the modes of the gap zone that
    the event ends: fast ones have died out since it began.

    The state there lies between those of the two marches, whatever the phase at which the zone began, and between the
    bounds of all orbits. The rates hold all along, from the earlier of the two events to the later.
    """
    least, most, short, long, event = _modes_before(s, order, lower, upper, onset)
    rate = rates(s.m.beta)
    little, much = rate * np.exp(-long * rate), rate * np.exp(-short * rate)
    sum_least = (least * np.where(least > 0, little, much)).sum(axis=0)
    sum_most = (most * np.where(most > 0, much, little)).sum(axis=0)
    sign = -1.0 if onset else 1.0
    top = _harmonic_max(0.0, sign, event[0], event[1])
    bottom = -_harmonic_max(0.0, -sign, event[0], event[1])
    if onset:
        return bottom + sum_least, top + sum_most
    least, most = _rates_after_contact(s, lower, upper, short, long)
    return np.fmax(bottom - sum_most, bottom + least), np.fmin(top - sum_least, top + most)


def _modes_before(s: ModeStrips, order: Order, lower: Period, upper: Period, onset: bool):
    """Least and greatest ``z - J p`` (n, N) as the gap zone began that the event ends; the least and the greatest time since, and
    the phases (2, N) between which the event is."""
    edge, k = (0, 0) if onset else (3, 1)
    (z_low, from_low), (z_up, from_up) = ((p.z_since[k], p.since[k]) for p in (lower, upper))
    first, last = np.minimum(from_low, from_up), np.maximum(from_low, from_up)
    floor, ceiling = -s.p_0, np.maximum(s.D, 0.0)
    kept = np.exp(-(last - first) * order.rate)
    low = _extreme(order.to_e(z_low), floor, ceiling, kept, from_low >= from_up, -1.0)
    high = _extreme(order.to_e(z_up), floor, ceiling, kept, from_up >= from_low, 1.0)
    rising, falling = np.maximum(order.share, 0.0), np.minimum(order.share, 0.0)
    times = lambda matrix, e: np.einsum("ij...,j...->i...", matrix, e)  # noqa: E731
    rest = s.m.J * (0.0 if onset else -s.p_0)
    least, most = times(rising, low) + times(falling, high) - rest, times(rising, high) + times(falling, low) - rest
    event = np.sort(np.stack([lower.edges[edge], upper.edges[edge]]), axis=0)
    short, long = np.maximum(event[0] - last, 0.0), event[1] - first
    return least, most, short, long, event


def _rates_after_contact(s: ModeStrips, lower: Period, upper: Period, short, long):
    """Least and greatest rate at which w moves, times from ``short`` to ``long`` after contacts that end between those of two
    marches; -inf and inf where there is none.

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
        much, little = np.exp(-short * rate), np.exp(-long * rate)
        least = (least * np.where(least > 0, little, much)).sum(axis=0)
        most = (most * np.where(most > 0, much, little)).sum(axis=0)
    return np.where(after, least, -np.inf), np.where(after, most, np.inf)


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


def _harmonic_max(a, b, low, high):
    """Greatest value of ``a cos s + b sin s`` on [low, high], elementwise."""
    top, peak = np.hypot(a, b), np.arctan2(b, a)
    ends = np.maximum(a * np.cos(low) + b * np.sin(low), a * np.cos(high) + b * np.sin(high))
    inside = np.ceil((low - peak) / TWO_PI) * TWO_PI + peak <= high
    return np.where(inside, top, ends)
