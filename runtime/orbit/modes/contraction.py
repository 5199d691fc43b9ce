"""Proof that the period map contracts between two ordered states: at most one orbit lies there.

Between a lower and an upper state every state meets the same events between theirs (``alike``, and slopes of the gap that keep
their sign). Then the derivative of the map is at most

    M = C (G + gains),

entry by entry in the coordinates of the order: C the contact of the upper state, the shortest; G the gap between; and at
release and onset, with ``k = J/(J_0 beta)`` and ``gain = step of w/|slope of the gap|``, the terms
``gain G(after) k 1^T G(before)``.
M has no negative entry, so its spectral radius is below one where ``(I - M) v = r`` has a positive solution for a positive r.
"""

import numpy as np

from .coordinates import Order
from .event_bounds import event_bounds
from .march import TWO_PI, Period
from .problem import ModeStrips, rates
from .propagation import kick, least_sums, solve_order


def alike(lower: Period, upper: Period) -> np.ndarray:
    """Where two marches meet each event once, and the same ones."""
    once = (lower.onsets == 1) & (upper.onsets == 1) & (lower.releases == 1) & (upper.releases == 1)
    return once & (lower.engaged_before == upper.engaged_before) & (lower.engaged == upper.engaged) & ~lower.lost & ~upper.lost


def contracts(s: ModeStrips, order: Order, lower: Period, upper: Period) -> np.ndarray:
    """Where the map contracts between the states that ``lower`` and ``upper`` march from."""
    change, good = upper_bound(s, order, lower, upper)
    forgotten = -np.minimum(np.diagonal(change, axis1=1, axis2=2), 0.0).T
    v = solve_order(change, np.maximum(forgotten, 1e-300))
    return good & np.all(np.isfinite(v) & (v > 0), axis=0)


def upper_bound(s: ModeStrips, order: Order, lower: Period, upper: Period) -> tuple[np.ndarray, np.ndarray]:
    """Upper bound of the map's derivative less the identity, (N, n, n), between two states, and where it holds, (N,)."""
    contact = upper.contacts == 1
    same = alike(lower, upper) & (lower.contacts == upper.contacts) & (upper.contacts <= 1)
    early, late = upper.release, lower.release
    first = np.where(contact, upper.exit, early - 0.5 * np.mod(early - upper.onset, TWO_PI))
    c_1 = np.mod(early - first, TWO_PI)
    c_2 = c_1 + np.maximum(late - early, 0.0)
    x_2 = np.mod(upper.onset - first, TWO_PI)
    x_1 = x_2 - np.maximum(upper.onset - lower.onset, 0.0)
    b = np.where(contact, np.mod(upper.entry - first, TWO_PI), TWO_PI)
    snaps = s.snaps
    b = np.where(contact & snaps, np.maximum(b, x_2), b)
    same &= (c_2 < x_1) & (x_2 <= b)
    (on, steep), (off, _), closing, closes = event_bounds(s, order, lower, upper)
    # a contact that a point snaps into does not end before all have snapped in
    same &= ~snaps | (s.delta_0 + steep * (x_2 - x_1) <= s.step)
    good = same & (on > 0) & (off > 0)
    with np.errstate(all="ignore"):
        onset = np.where(good, s.jump_on / on, 0.0)
        release = np.where(good, s.step / off, 0.0)
        rate, kicks, whole = rates(s.m.beta), kick(s), np.ones((s.modes, s.size))
        column = lambda *times: -least_sums(-order.back, kicks, s, *np.maximum(times, 0.0))  # noqa: E731
        row = lambda *times: -least_sums(-np.swapaxes(order.share, 0, 1), whole, s, *np.maximum(times, 0.0))  # noqa: E731
        between = (kicks * np.exp(-np.maximum(x_1 - c_2, 0.0) * rate)).sum(axis=0)
        # from onset on a state is in the gap until its own contact, and forgets no less in that than in a gap up to b
        closing, closes = np.where(snaps, 0.0, closing), contact & (snaps | closes)
        before, after_x = row(c_1, c_2), column(*np.where(closes, closing, np.stack((b - x_2, b - x_1))))
        terms = (
            (release, column(b - c_2, b - c_1), before),
            (onset, after_x, row(x_1, x_2)),
            (onset * release * between, after_x, before),
        )
        share, back = np.moveaxis(order.share, -1, 0), np.moveaxis(order.back, -1, 0)
        change = back @ (np.expm1(-b * rate).T[:, :, None] * share)
        for gain, left, right in terms:
            change = change + (gain * left).T[:, :, None] * right.T[:, None, :]
        held = np.expm1(-(TWO_PI - b) * rates(s.m.alpha)).T
        change = (1 + held)[:, :, None] * change
        n = s.modes
        change[:, range(n), range(n)] += held
    return change, good
