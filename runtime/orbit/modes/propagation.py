"""Derivative of the period map along a march, in the coordinates of the order (dashpot displacements e), and lower bounds of it.

Between events a deviation of e is carried by ``diag exp(-length/alpha_i)`` in contact and by the relaxation of the gap
elsewhere, which is the larger of the two in every entry. At an onset and at a release w steps, and an event met earlier
or later adds

    gain (1/alpha_i) g^T,    gain = step of w/|slope of the gap|,    z = g^T e,

a matrix without negative entries. So the longest contact and the least gains of a range of states bound the derivative
from below.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .march import ADHESION, CONTACT, FREE, TWO_PI, Period
from .problem import ModeStrips, pick, rates

#: how much earlier or later than in the two marches contact may begin, as a share of the time from onset to contact: a wider
#: range costs digits of the bound
_SHARES = (1e-5, 1e-2, 0.5)


@dataclass(slots=True)
class Order:
    """Coordinates of the order for a batch: ``z = share e``, ``e = back z`` (n, n, N or 1), ``g`` (n, N or 1):
    ``sum_j z_j = g . e``.

    ``rate``: ``1/alpha_i``, capped. ``gamma = sum g_i/alpha_i``.
    """

    share: np.ndarray
    back: np.ndarray
    g: np.ndarray
    rate: np.ndarray

    @classmethod
    def of(cls, kernel, s: ModeStrips) -> Order:
        m = s.m
        n = s.modes
        unit = np.eye(n)[:, :, None]
        back = np.stack([kernel.dashpots(unit[:, j], 0.0, m) for j in range(n)], axis=1)
        return cls(m.share, back, m.share.sum(axis=0), rates(m.alpha))

    def take(self, index) -> Order:
        return Order(*(pick(a, index) for a in (self.share, self.back, self.g, self.rate)))

    @property
    def gamma(self) -> np.ndarray:
        return (self.g * self.rate).sum(axis=0)

    def to_z(self, e):
        return np.einsum("ij...,j...->i...", self.share, e)

    def to_e(self, z):
        return np.einsum("ij...,j...->i...", self.back, z)


@dataclass(slots=True)
class Monodromy:
    """Rank-one terms at the onset and the release, each ``gain (column . rate) (row . g)^T``: gain (N,), column and row
    (n, N) or 1.

    ``by_modes``: terms of ``across`` in place of these, where those hold.
    """

    onset: np.ndarray
    onset_column: np.ndarray
    onset_row: np.ndarray
    release: np.ndarray
    release_column: np.ndarray
    release_row: np.ndarray
    by_modes: tuple[Saltation, Saltation] | None = None


@dataclass(slots=True)
class Saltation:
    """A gain that acts on the state at the start of the gap zone that its event ends, and is felt at the end of the one
    it begins.

    ``gain`` (N,), 0 where it does not hold; ``row``, ``column`` (n, N): lower bounds over all phases that the event may have.
    """

    gain: np.ndarray
    row: np.ndarray
    column: np.ndarray


def exact_monodromy(s: ModeStrips, period: Period) -> Monodromy:
    """Gains at the events of a march that meets each at most once."""
    one = np.ones((1, 1))
    onset = _ratio(s.jump_on, -period.slope_onset)
    release = _ratio(s.step, period.slope_release)
    return Monodromy(onset, one, one, release, one, one)


def least_monodromy(s: ModeStrips, order: Order, lower: Period, upper: Period, alike: np.ndarray) -> Monodromy:
    """Lower bounds of the gains of every state between those of two marches; 0 but where these are ``alike`` and meet
    each event once.

    Onsets lie between those of the two, releases too (the other way round). Placed where ``lower`` meets them: moving
    an event by ``delta`` multiplies its terms by no less than ``exp(-delta rate)`` componentwise or, against the flow,
    ``exp(-delta gamma)``.
    """
    late, early = _width(lower.onset, upper.onset), _width(upper.release, lower.release)
    gamma = np.broadcast_to(order.gamma, late.shape)
    fading = lambda width: np.exp(-width * order.rate)  # noqa: E731
    shrink = lambda width: np.exp(-width * gamma)[None]  # noqa: E731
    steep_on, steep_off = (slopes_by_modes(s, order, lower, upper, onset)[1] for onset in (True, False))
    onset, release = (np.where(alike, gain, 0.0) for gain in (_ratio(s.jump_on, steep_on), _ratio(s.step, steep_off)))
    pair = _saltation(s, order, lower, upper, onset, True), _saltation(s, order, lower, upper, release, False)
    taken = [each.gain > 0 for each in pair]
    return Monodromy(np.where(taken[0], 0.0, onset), shrink(late), fading(late),
                 np.where(taken[1], 0.0, release), fading(early), shrink(early), pair)  # fmt: skip


def _saltation(s: ModeStrips, order: Order, lower: Period, upper: Period, gain, onset: bool) -> Saltation:
    name = "onset" if onset else "release"
    event = np.sort(np.stack([getattr(lower, name), getattr(upper, name)]), axis=0)
    start, end, smooth = getattr(lower, f"from_{name}"), getattr(lower, f"until_{name}"), getattr(lower, f"smooth_{name}")
    holds = smooth & (event[0] >= start) & (gain > 0)
    inside = holds & (event[1] <= end)
    after = np.where(inside, end - event[::-1], 0.0)
    if onset:
        closing, closes = closing_times(s, order, lower, upper)
        after, inside = np.where(holds & closes, closing, after), inside | holds & closes
    before = np.where(inside, event - start, 0.0)
    row = _least_sums(np.swapaxes(order.share, 0, 1), np.ones((s.modes, s.size)), s, *before)
    column = _least_sums(order.back, _kick(s), s, *after)
    return Saltation(np.where(inside, gain, 0.0), np.maximum(row, 0.0), np.maximum(column, 0.0))


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
    known = lower.smooth_onset & (lower.until_onset == lower.entry) & (upper.until_onset == upper.entry) & ~s.snaps
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


def _kick(s: ModeStrips):
    """Rates of the gap's modes (n, N) where w steps by one."""
    return np.broadcast_to(s.m.J * rates(s.m.beta) / s.m.J_0, (s.modes, s.size))


def _least_sums(matrix, amplitudes, s: ModeStrips, short, long):
    """Lower bounds of ``sum_j matrix_ij amplitude_j exp(-t/beta_j)`` for t from ``short`` to ``long``."""
    rate = rates(s.m.beta)
    rising, falling = np.maximum(matrix, 0.0), np.minimum(matrix, 0.0)
    sums = [np.einsum("ij...,j...->i...", part, amplitudes * np.exp(-t * rate)) for part, t in ((rising, long), (falling, short))]
    return sums[0] + sums[1]


def propagation(s: ModeStrips, order: Order, period: Period, gains: Monodromy | None, along=None) -> np.ndarray:
    """Derivative of the period map less the identity, (N, n, n), with the given gains or none; ``along`` deviations (n, N) alone
    (N, n, 1)."""
    n, N = s.modes, period.dz.shape[1]
    ahead = np.broadcast_to(np.eye(n), (N, n, n)) if along is None else along.T[:, :, None]
    change = np.zeros(ahead.shape)
    share, back = np.moveaxis(order.share, -1, 0), np.moveaxis(order.back, -1, 0)
    pending = [np.zeros((N, change.shape[2])) for _ in range(2)]  # rows of the gains by modes whose second zone has not ended
    waiting = [np.zeros(N, bool), np.zeros(N, bool)]
    for zone in period.zones:
        i, length = zone.index, zone.end - zone.start
        X = ahead[i] + change[i]
        ripe = [each[i] for each in waiting]
        contact = zone.letter == CONTACT
        times = np.where(contact, pick(s.m.alpha, i), pick(s.m.beta, i))
        loss = np.expm1(-np.divide(length, times, out=np.full((n, i.size), 800.0), where=times > 0)).T
        step = loss[:, :, None] * X
        gap = np.flatnonzero(~contact)
        if gap.size:
            here = i[gap]
            S, B = (a if a.shape[0] == 1 else a[here] for a in (share, back))
            step[gap] = B @ (loss[gap][:, :, None] * (S @ X[gap]))
        change[i] += step
        if gains is not None and gains.by_modes is not None:
            ends = (zone.letter == FREE) & (zone.following >= 0), (zone.letter == ADHESION) & (zone.following == FREE)
            for k, across in enumerate(gains.by_modes):
                new = np.flatnonzero(ends[k] & (across.gain[i] > 0))
                at = i[new]
                row = (across.row[:, at].T[:, None, :] @ X[new])[:, 0]
                pending[k][at], waiting[k][at] = row, True
            for k, across in enumerate(gains.by_modes):
                at = i[ripe[k]]
                change[at] += (across.gain[at] * across.column[:, at]).T[:, :, None] * pending[k][at][:, None, :]
                waiting[k][at] = False
        if gains is not None:
            onset = np.flatnonzero((zone.letter == FREE) & (zone.following >= 0))
            release = np.flatnonzero((zone.letter == ADHESION) & (zone.following == FREE))
            _gain(change, ahead, order, i[onset], gains.onset, gains.onset_column, gains.onset_row)
            _gain(change, ahead, order, i[release], gains.release, gains.release_column, gains.release_row)
    return change


def _gain(change, ahead, order: Order, i, gain, column, row):
    if not i.size:
        return
    left = (gain[i] * pick(column, i) * pick(order.rate, i)).T
    right = (pick(row, i) * pick(order.g, i)).T
    change[i] += left[:, :, None] * (right[:, None, :] @ (ahead[i] + change[i]))


def solve_order(change: np.ndarray, r: np.ndarray) -> np.ndarray:
    """``(I - M)^-1 r`` for ``M = I + change``; r and the result (n, N). NaN where singular."""
    rows = -change
    scale = np.abs(rows).max(axis=2)
    bad = ~(np.isfinite(scale).all(axis=1) & (scale > 0).all(axis=1)) | ~np.isfinite(r).all(axis=0)
    scale[bad] = 1.0
    rows = rows / scale[:, :, None]
    rows[bad] = np.eye(rows.shape[1])
    try:
        v = np.linalg.solve(rows, (r.T / scale)[:, :, None])[:, :, 0].T
    except np.linalg.LinAlgError:
        v = np.full(r.shape, np.nan)
        for k in range(r.shape[1]):  # one singular matrix spoils the batch: rare
            if np.linalg.cond(rows[k]) < 1e14:
                v[:, k] = np.linalg.solve(rows[k], r[:, k] / scale[k])
    v[:, bad] = np.nan
    return v


def _ratio(step, slope):
    """``step/slope`` for a slope that bounds from above; 0 where that says nothing."""
    return np.divide(
        step, slope, out=np.zeros(np.shape(step)), where=np.isfinite(slope) & (slope > 1e-290 + 1e-290 * np.abs(step))
    )


def _width(first, second):
    """Distance from an event to a later one; 0 where either is missing (the gain is 0 there)."""
    return np.nan_to_num(np.maximum(second - first, 0.0))


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
    name = "onset" if onset else "release"
    (z_low, from_low), (z_up, from_up) = ((getattr(p, f"z_from_{name}"), getattr(p, f"from_{name}")) for p in (lower, upper))
    first, last = np.minimum(from_low, from_up), np.maximum(from_low, from_up)
    floor, ceiling = -s.p_0, np.maximum(s.D, 0.0)
    kept = np.exp(-(last - first) * order.rate)
    low = _extreme(order.to_e(z_low), floor, ceiling, kept, from_low >= from_up, -1.0)
    high = _extreme(order.to_e(z_up), floor, ceiling, kept, from_up >= from_low, 1.0)
    rising, falling = np.maximum(order.share, 0.0), np.minimum(order.share, 0.0)
    times = lambda matrix, e: np.einsum("ij...,j...->i...", matrix, e)  # noqa: E731
    rest = s.m.J * (0.0 if onset else -s.p_0)
    least, most = times(rising, low) + times(falling, high) - rest, times(rising, high) + times(falling, low) - rest
    event = np.sort(np.stack([getattr(lower, name), getattr(upper, name)]), axis=0)
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
    after = (upper.from_release == ends[0]) & (lower.from_release == ends[1]) & (ends[0] <= ends[1])
    ends = np.where(after, ends, 0.0)
    with np.errstate(invalid="ignore"):
        response = m.eta / (1 + m.alpha**2)
        below = []
        for end, period in zip(ends, (upper, lower), strict=True):
            f = -np.einsum("ij...,j...->i...", m.enter, period.z_from_release + m.J * s.p_0)
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
