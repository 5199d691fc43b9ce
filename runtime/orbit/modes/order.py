r"""What is extremal with an n-dimensional state, and the ordered iteration that finds it.

Claim. Under ``constitutive`` the motion of a material point preserves the order "engaged before free, then every
dashpot displacement ascending": ``(h, e) <= (h', e')`` if ``e_i <= e_i'`` for all i and ``h`` is engaged or ``h'``
free.

Proof. Let ``z = J_0 sum K_i e_i`` (in units of K), ``y = z - u``. The dashpots obey ``alpha_i e_i' = w - e_i``,
``w = z + J_0 p``.

1. *The traction is a relay in y.* Free means p = 0, gap = y, and lasts until the gap falls to delta_0: ``y = delta_0``.
   Engaged means contact (``w = u``, p = -y/J_0 >= -p_0, that is ``y <= J_0 p_0``) or adhesion (``p = -p_0``, gap
   ``y - J_0 p_0`` from 0 to delta_0): it lasts until ``y = delta_0 + J_0 p_0``. Contact begins and ends, without
   hysteresis, at ``y = J_0 p_0``; at an onset that lies at or above delta_0 (the snap-in) the point is in contact at
   once. No other memory: the state is (h, e), and e is continuous.
2. *w is nondecreasing in every e_i and in h.* Engaged ``w = u + max(y - J_0 p_0, 0)``, free ``w = u + y``, both
   nondecreasing in y, and y in each e_i. For an engaged state below a free one, ``y <= y'`` and ``y' >= delta_0 >= 0``
   (or y' would have been engaged), so ``u + max(y - J_0 p_0, 0) <= u + y'``. Nothing of this holds for ``continuous``,
   which leaves n - 1 conditions open where p steps.
3. *The flow is cooperative.* Hence the right-hand sides ``w - e_i`` do not fall when another ``e_j`` rises: between
   events ordered states stay ordered (Kamke). At an event: the lower state's y reaches delta_0 no later and
   ``delta_0 + J_0 p_0`` no earlier than the upper's, so it is engaged whenever the upper is. Events are finitely many,
   since the two thresholds are ``J_0 p_0 > 0`` apart and y is Lipschitz.

Consequences. The period map P is monotone, in D too (in the coordinates e - D). Below and above all orbits lie

* the always engaged orbit E of the strip in which release is put out of action: its map never exceeds P, and contracts
  (``w - w'`` is at most ``sum K_i/K_g`` of the largest ``e_i - e_i'``), so E is unique. If its gap stays within delta_0
  it is the most engaged orbit;
* ``e_i = max(D, 0)``, free: no w can exceed ``max(D, (1 - J_0) max e)``.

So iterates from E rise to the most engaged orbit and those from above fall to the least engaged one. For n >= 2
unordered orbits, even of longer periods, are not excluded by monotony alone; all lie between these two. With n = 1 this
is the order of ``orbit.engine``.

Acceleration. Let M be a lower bound of the derivative of P between x and every orbit above it, ``r = P(x) - x >= 0``.
Then every orbit ``e* >= x`` obeys ``e* - x = P(e*) - x >= r + M (e* - x)``, so ``e* >= x + (I - M)^-1 r``, which again
is mapped upwards. Jumps of P are upwards and only add. Such M: the contacts of x itself are the longest there are, and
the gains at onset and release are not negative. Where M holds in a window ``[x, x + Delta]`` only, the step is cut to
stay inside; if ``r + M Delta >= Delta`` the whole window holds no orbit. From above all is mirrored. A window whose far
end is mapped inwards holds the extremal orbit: it is left to ``polish`` when it is narrow.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .march import Period, march
from .problem import ModeStrips
from .propagation import Order, exact_monodromy, least_monodromy, propagation, solve_order

#: edges of the two ends of a window that is left to Newton's method agree to this
NARROW = 1e-6
#: steps after which a strip is given up: 9,600 random strips with 2 and 8 times took 15 at most, levels with 14 times 37; where
#: rounding decides the signs there is no end
_STEPS = 250
_EPS = np.finfo(float).eps
#: least width of a window, in units of the strip's lengths: what rounding leaves of the sign of P(y) - y
_LEAST, _WIDEST = 1e-12, 1e-5

ENGAGED, FREE, ORBIT, UNRESOLVED = 0, 1, 2, -1


@dataclass(slots=True)
class Approach:
    """How the ordered iteration ended for N strips: ``kind`` (ENGAGED, FREE, ORBIT between ``lower`` and ``upper``,
    UNRESOLVED); edges of both ends, (4, N) in the order d, b, a, c; and the work spent."""

    kind: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    evaluations: np.ndarray
    steps: np.ndarray


def approach(kernel, s: ModeStrips, z, engaged, start, rising: bool, floor: np.ndarray | None) -> Approach:
    """Iterate from the states ``z`` (n, N) at the phases ``start``, below (``rising``) or above every orbit, to the first one.

    ``floor``: for falling iterates, a lower bound of the map's derivative less the identity, (N, n, n): that along a contact as
    long as any in between.
    """
    N = s.size
    out = Approach(np.full(N, UNRESOLVED), np.full((4, N), np.nan), np.full((4, N), np.nan), np.zeros(N), np.zeros(N, int))
    order = Order.of(kernel, s)
    other = np.broadcast_to(np.maximum(s.D, 0.0) if rising else -s.p_0, z.shape)
    room = np.maximum((1.0 if rising else -1.0) * (other - order.to_e(z)), 0.0)
    state = _State(np.arange(N), s, order, engaged.copy(), z.copy(), np.array(start, float), floor, np.full(N, 8.0),
                   np.full(N, _LEAST), room, other)  # fmt: skip
    for _ in range(_STEPS):
        if not state.index.size:
            break
        state = _advance(kernel, state, rising, out)
    return out


@dataclass(slots=True)
class _State:
    """Strips still on their way. ``reach``: factor by which a window may exceed the plain step; ``least``: its least
    width; ``room``: distance to a state known to lie beyond the orbit, in e; ``other``: the one known from the
    start."""

    index: np.ndarray
    s: ModeStrips
    order: Order
    engaged: np.ndarray
    z: np.ndarray
    start: np.ndarray
    floor: np.ndarray | None
    reach: np.ndarray
    least: np.ndarray
    room: np.ndarray
    other: np.ndarray

    def take(self, i) -> _State:
        floor = None if self.floor is None else self.floor[i]
        return _State(self.index[i], self.s.take(i), self.order.take(i), self.engaged[i], self.z[:, i], self.start[i], floor,
                      self.reach[i], self.least[i], self.room[:, i], self.other[:, i])  # fmt: skip


def _advance(kernel, st: _State, rising: bool, out: Approach) -> _State:
    sign = 1.0 if rising else -1.0
    near = march(kernel, st.s, st.engaged, st.z, st.start)
    out.evaluations[st.index] += near.evaluations
    out.steps[st.index] += 1
    # the ends of the iteration that need no orbit with both an onset and a release
    out.kind[st.index[near.never_free & (not rising)]] = ENGAGED
    out.kind[st.index[near.never_engaged & rising & (st.s.D <= -st.s.delta_0)]] = FREE
    ended = near.lost | (near.never_free & (not rising)) | (near.never_engaged & rising & (st.s.D <= -st.s.delta_0))
    switched = (near.engaged != st.engaged) & ~ended
    i = np.flatnonzero(switched)
    st.z[:, i] += near.dz[:, i]
    st.engaged[i] = near.engaged[i]
    st.room[:, i] = np.maximum(sign * (st.other[:, i] - st.order.take(i).to_e(st.z[:, i])), 0.0)
    i = np.flatnonzero(~ended & ~switched)
    if i.size:
        ended[i] |= _step(kernel, st, i, near.take(i), sign, out)
    return st.take(np.flatnonzero(~ended))


def _step(kernel, st: _State, i, near: Period, sign: float, out: Approach):
    """Move the states ``i`` (not engaged anew or released at the section); returns which have ended."""
    sub = st.take(i)
    s, order = sub.s, sub.order
    scale = s.size_of_lengths
    r = np.maximum(sign * order.to_e(near.dz), 0.0)
    plain = propagation(s, order, near, None) if sub.floor is None else sub.floor
    sure = _valid(solve_order(plain, r))
    exact = propagation(s, order, near, exact_monodromy(s, near))
    window = np.minimum(_window(sure, solve_order(exact, r), sub.reach), sub.room)
    window = np.maximum(window, np.minimum(sub.least * scale * _inward(exact), sub.room))
    far = march(kernel, s, sub.engaged, sub.z + sign * order.to_z(window), sub.start)
    out.evaluations[sub.index] += far.evaluations
    lower, upper = (near, far) if sign > 0 else (far, near)
    alike = (
        (near.engaged == far.engaged) & (lower.onsets == 1) & (upper.onsets == 1) & (lower.releases == 1) & (upper.releases == 1)
    )
    bound = propagation(s, order, lower, least_monodromy(s, order, lower, upper, alike))
    inner = _valid(solve_order(bound, r))
    wanted = np.max(np.divide(inner, window, out=np.zeros_like(inner), where=window > 0), axis=0)
    inner = inner / np.maximum(wanted, 1.0)
    mapped = r + window + np.einsum("Nij,jN->iN", bound, window)
    clear = np.all(mapped > window, axis=0) & ~far.lost
    step = np.maximum(np.where(far.lost, 0.0, inner), sure)
    step = np.where(clear, np.maximum(step, window), step)
    beyond = sign * order.to_e(far.dz)
    turned = (far.engaged == sub.engaged) & np.all(beyond <= 0, axis=0) & ~far.lost & ~clear
    back = _valid(solve_order(bound, np.maximum(-beyond, 0.0)))
    room = np.where(turned, np.maximum(window - back, step), sub.room)
    ends = _edges(lower), _edges(upper)
    inside = turned | np.all(window >= sub.room, axis=0)
    done = inside & alike & (lower.contacts == upper.contacts) & (lower.contacts <= 1) & _close(*ends)
    at = sub.index[done]
    out.kind[at] = ORBIT
    out.lower[:, at], out.upper[:, at] = ends[0][:, done], ends[1][:, done]
    st.z[:, i] += sign * order.to_z(step)
    st.room[:, i] = np.maximum(room - step, 0.0)
    small = ~turned & np.all(window <= 2 * sub.least * scale, axis=0)
    st.least[i] = np.where(small, np.minimum(4 * sub.least, _WIDEST), sub.least)
    st.reach[i] = np.where(clear | (wanted > 1), 2 * sub.reach, np.maximum(0.5 * sub.reach, 2.0))
    # rounding alone decides the signs here, whatever the width: not to be certified
    return done | (small & (sub.least >= _WIDEST))


def _window(sure, newton, reach):
    """Width of the window to look at: a little more than Newton's step where that makes sense, at most ``reach`` times
    the sure step."""
    widest = reach * sure
    good = np.all(np.isfinite(newton) & (newton >= sure * (1 - 1e-6)), axis=0)
    ratio = np.divide(widest, newton, out=np.full(sure.shape, np.inf), where=(newton > 0) & good)
    factor = np.minimum(1.25, ratio.min(axis=0))
    return np.where(good, np.maximum(factor * np.where(good, newton, 0.0), sure), widest)


def _inward(change):
    """A direction, of largest component one, in which the linearised map shortens every component alike compared with
    what is forgotten anyway."""
    forgotten = -np.minimum(np.diagonal(change, axis1=1, axis2=2), 0.0).T
    v = solve_order(change, np.maximum(forgotten, 1e-300))
    good = np.all(np.isfinite(v) & (v > 0), axis=0)
    v = np.where(good, v, 1.0)
    return v / v.max(axis=0)


def _valid(v):
    """Steps that are defined and not negative; zero otherwise."""
    good = np.all(np.isfinite(v) & (v >= 0), axis=0)
    return np.where(good, v, 0.0)


def _edges(p: Period):
    return np.array([p.onset, p.entry, p.exit, p.release])


def _close(one, two):
    """Edges of the two ends agree, NaN with NaN."""
    return np.all((np.abs(one - two) <= NARROW) | (np.isnan(one) & np.isnan(two)), axis=0)
