"""Derivative of the period map along a march, in the coordinates of the order (dashpot displacements e), and lower bounds of it.

Between events a deviation of e is carried by ``diag exp(-length/alpha_i)`` in contact and by the relaxation of the gap
elsewhere, which is the larger of the two in every entry. At an onset and at a release w steps, and an event met earlier
or later adds

    gain (1/alpha_i) g^T,    gain = step of w/|slope of the gap|,    z = g^T e,

a matrix without negative entries. So the longest contact and the least gains of a range of states bound the derivative
from below.
"""

from dataclasses import dataclass

import numpy as np

from ...numerics.linear import solved
from .coordinates import Order
from .event_bounds import event_bounds
from .march import ADHESION, CONTACT, FREE, Period
from .problem import ModeStrips, pick, rates


@dataclass(slots=True)
class Saltation:
    """The gain of an onset or a release: it acts on the state at the start of the zone that its event ends, and is felt at the
    end of the one it begins.

    ``gain`` (N,), 0 where it does not hold; ``row``, ``column`` (n, N), and ``between`` (N,), how much it sees of a step of w at
    the start of the zone: lower bounds over all phases that the event may have.
    """

    gain: np.ndarray
    row: np.ndarray
    column: np.ndarray
    between: np.ndarray


def exact_gains(s: ModeStrips, order: Order, period: Period) -> tuple[Saltation, Saltation]:
    """Gains at the onset and the release of a march that meets each at most once."""
    return _saltation(s, order, period, period, -period.slope[0], True), _saltation(
        s, order, period, period, period.slope[1], False
    )


def least_gains(s: ModeStrips, order: Order, lower: Period, upper: Period, alike: np.ndarray) -> tuple[Saltation, Saltation]:
    """Lower bounds of the gains of every state between those of two marches; 0 but where these are ``alike`` and meet
    each event once. Onsets lie between those of the two, releases too (the other way round)."""
    (_, fall), (_, growth), *closing = event_bounds(s, order, lower, upper)
    fall, growth = (np.where(alike, steepest, np.inf) for steepest in (fall, growth))
    return _saltation(s, order, lower, upper, fall, True, closing), _saltation(s, order, lower, upper, growth, False)


def _saltation(s: ModeStrips, order: Order, lower: Period, upper: Period, slope, onset: bool, closing=None) -> Saltation:
    """Of events at which the gap moves no faster than at ``slope``."""
    edge, k = (0, 0) if onset else (3, 1)
    step = s.jump_on if onset else s.step
    steep = np.isfinite(slope) & (slope > 1e-290 * (1 + step))
    gain = np.divide(step, slope, out=np.zeros(s.size), where=steep)
    event = np.sort(np.stack([lower.edges[edge], upper.edges[edge]]), axis=0)
    start, end, smooth = lower.since[k], lower.until[k], lower.smooth_onset | (not onset)
    holds = (event[0] >= start) & (gain > 0)
    inside = holds & (event[1] <= end)
    after = np.where(inside, end - event[::-1], 0.0)
    if closing:
        times, closes = closing
        after, inside = np.where(holds & closes, times, after), inside | holds & closes
    before = np.where(inside, event - start, 0.0)
    row = least_sums(np.swapaxes(order.share, 0, 1), np.ones((s.modes, s.size)), s, *before)
    column = least_sums(order.back, kick(s), s, *after)
    # a contact that an onset begins at once ends nowhere later than that of the lower march, and a gap keeps more
    column = np.where(smooth, column, order.rate * np.exp(-after[1] * order.rate))
    longest = event[1] - np.minimum(start, upper.since[k])
    between = (kick(s) * np.exp(-np.where(inside, longest, 0.0) * rates(s.m.beta))).sum(axis=0)
    return Saltation(np.where(inside, gain, 0.0), np.maximum(row, 0.0), np.maximum(column, 0.0), between)


def kick(s: ModeStrips):
    """Rates of the gap's modes (n, N) where w steps by one."""
    return np.broadcast_to(s.m.J * rates(s.m.beta) / s.m.J_0, (s.modes, s.size))


def least_sums(matrix, amplitudes, s: ModeStrips, short, long):
    """Lower bounds of ``sum_j matrix_ij amplitude_j exp(-t/beta_j)`` for t from ``short`` to ``long``."""
    rate = rates(s.m.beta)
    rising, falling = np.maximum(matrix, 0.0), np.minimum(matrix, 0.0)
    sums = [np.einsum("ij...,j...->i...", part, amplitudes * np.exp(-t * rate)) for part, t in ((rising, long), (falling, short))]
    return sums[0] + sums[1]


def propagation(s: ModeStrips, order: Order, period: Period, gains: tuple[Saltation, Saltation] | None, along=None) -> np.ndarray:
    """Derivative of the period map less the identity, (N, n, n), with the given gains or none; ``along`` deviations (n, N) alone
    (N, n, 1)."""
    n, N = s.modes, period.dz.shape[1]
    ahead = np.broadcast_to(np.eye(n), (N, n, n)) if along is None else along.T[:, :, None]
    change = np.zeros(ahead.shape)
    share, back = np.moveaxis(order.share, -1, 0), np.moveaxis(order.back, -1, 0)
    # of each gain: how much w steps more at its event, 0 but while the zone after that lasts
    pending = [np.zeros((N, change.shape[2])) for _ in gains or ()]
    for number, letters in enumerate(period.letters):
        i = np.flatnonzero(letters >= 0)
        if not i.size:
            break
        letter, following = letters[i], period.letters[number + 1, i] if number + 1 < len(period.letters) else np.full(i.size, -1)
        length = period.ends[number + 1, i] - period.ends[number, i]
        X = ahead[i] + change[i]
        ripe = [each[i] for each in pending]
        contact = letter == CONTACT
        times = np.where(contact, pick(s.m.alpha, i), pick(s.m.beta, i))
        loss = np.expm1(-np.divide(length, times, out=np.full((n, i.size), 800.0), where=times > 0)).T
        step = loss[:, :, None] * X
        gap = np.flatnonzero(~contact)
        if gap.size:
            here = i[gap]
            S, B = (a if a.shape[0] == 1 else a[here] for a in (share, back))
            step[gap] = B @ (loss[gap][:, :, None] * (S @ X[gap]))
        change[i] += step
        ends = (letter == FREE) & (following >= 0), (letter == ADHESION) & (following == FREE)
        for waiting, own, other, each, end in zip(pending, ripe, ripe[::-1], gains or (), ends, strict=False):
            change[i] += each.column[:, i].T[:, :, None] * own[:, None, :]
            seen = (each.row[:, i].T[:, None, :] @ X)[:, 0] + each.between[i, None] * other
            waiting[i] = np.where(end[:, None], each.gain[i, None] * seen, 0.0)
    return change


def solve_order(change: np.ndarray, r: np.ndarray) -> np.ndarray:
    """``(I - M)^-1 r`` for ``M = I + change``; r and the result (n, N). NaN where singular."""
    return solved(-change, r.T[:, :, None])[:, :, 0].T
