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

from .coordinates import Order
from .event_bounds import closing_times, slopes_by_modes
from .march import ADHESION, CONTACT, FREE, Period
from .problem import ModeStrips, pick, rates


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
