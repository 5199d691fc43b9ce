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
the gains at onset and release are not negative.

Chains. Let x lie below all orbits, and P map every point of a path that rises from x strictly upwards. Then all orbits lie
above the path's end: the last point of the path below an orbit e would be mapped below P(e) = e, further up the path. On the
straight piece from x_k to x_(k+1) that is so where

    P(x_k) - x_k + (M_k - I) (x_(k+1) - x_k) > 0

with a lower bound M_k of the derivative between the two; the bracket is linear along the piece, and positive at its start. All
states of a chain are marched at once. So even where orbits are about to appear, and the map next to the identity, the strip is
past them in a few steps. From above all is mirrored. The first orbit lies before the first state that is mapped inwards: it is
left to ``polish`` when the two are near and the map contracts between them, or nearer still.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .contraction import alike, contracts
from .coordinates import Order
from .march import Period, march
from .problem import ModeStrips
from .propagation import exact_monodromy, least_monodromy, propagation, solve_order

#: edges of the two ends of a window that is left to Newton's method agree to this; to that, where the map contracts in it
NARROW, _NEAR = 1e-6, 1e-3
#: steps after which a strip is given up; where rounding decides the signs there is no end
_STEPS = 100
#: least width of a window, in units of the strip's lengths: what rounding leaves of the sign of P(y) - y
_LEAST, _WIDEST = 1e-12, 1e-5
#: states of a chain, in Newton's steps. Those end short of a simple orbit, and half-way to a double one, where orbits are about
#: to appear: the map less the identity is a parabola there, and its tangent stays positive over less than half of the way. Beyond
#: it grows, so that states may lie ever further apart
_NEARER = 2 - 2 * 0.75 ** np.arange(1.0, 17)
_AHEAD = np.sort(np.concatenate(([0.0, 0.125, 0.5, 0.95, 1.0], _NEARER, 4 - _NEARER[::3], 2 + 2.0 ** np.arange(1.0, 6))))
_AWAY = np.append(0.0, 1.6 ** np.arange(-4.0, len(_AHEAD) - 5))

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


@dataclass(slots=True)
class _State:
    """Strips still on their way. ``near``: the period from their states; ``least``: least width of a window; ``room``: distance
    to a state known to lie beyond the orbit, in e; ``beyond``: the one known from the start."""

    index: np.ndarray
    s: ModeStrips
    order: Order
    engaged: np.ndarray
    z: np.ndarray
    start: np.ndarray
    near: Period
    least: np.ndarray
    room: np.ndarray
    beyond: np.ndarray

    def take(self, i) -> _State:
        return _State(self.index[i], self.s.take(i), self.order.take(i), self.engaged[i], self.z[:, i], self.start[i],
                      self.near.take(i), self.least[i], self.room[:, i], self.beyond[:, i])  # fmt: skip

    def march(self, kernel, i, out: Approach) -> None:
        """Follow the states ``i`` for a period."""
        near = march(kernel, self.s.take(i), self.engaged[i], self.z[:, i], self.start[i])
        out.evaluations[self.index[i]] += near.evaluations
        self.near.put(i, near)


def approach(kernel, s: ModeStrips, z, engaged, start, rising: bool, beyond) -> Approach:
    """Iterate from the states ``z`` (n, N) at the phases ``start``, below (``rising``) or above every orbit, to the first one.

    ``beyond``: displacements e of an orbit, or of a state beyond all, (n, N)."""
    N = s.size
    out = Approach(np.full(N, UNRESOLVED), np.full((4, N), np.nan), np.full((4, N), np.nan), np.zeros(N), np.zeros(N, int))
    order = Order.of(kernel, s)
    room = np.maximum((1.0 if rising else -1.0) * (beyond - order.to_e(z)), 0.0)
    st = _State(np.arange(N), s, order, engaged.copy(), z.copy(), np.array(start, float), Period.blank(s.modes, N),
                np.full(N, _LEAST), room, beyond)  # fmt: skip
    st.march(kernel, st.index, out)
    for _ in range(_STEPS):
        if not st.index.size:
            break
        st = _advance(kernel, st, rising, out)
    return out


def _advance(kernel, st: _State, rising: bool, out: Approach) -> _State:
    sign = 1.0 if rising else -1.0
    near = st.near
    out.steps[st.index] += 1
    # the ends of the iteration that need no orbit with both an onset and a release
    held = near.never_free & (not rising)
    lets = near.never_engaged & rising & (st.s.D <= -st.s.delta_0)
    out.kind[st.index[held]], out.kind[st.index[lets]] = ENGAGED, FREE
    ended = near.lost | held | lets
    i = np.flatnonzero((near.engaged != st.engaged) & ~ended)
    st.z[:, i] += near.dz[:, i]
    st.room[:, i] = np.maximum(sign * (st.beyond[:, i] - st.order.take(i).to_e(st.z[:, i])), 0.0)
    on = np.flatnonzero((near.engaged == st.engaged) & ~ended)
    st.engaged[i] = near.engaged[i]
    if on.size:
        ended[on] |= _climb(kernel, st, on, sign, out)
    if i.size:
        st.march(kernel, i, out)
    return st.take(np.flatnonzero(~ended))


def _climb(kernel, st: _State, i, sign: float, out: Approach):
    """Move the states ``i`` (not engaged anew or released at the section) along a chain; returns which have ended."""
    sub, N = st.take(i), i.size
    s, order, every = sub.s, sub.order, np.arange(N)
    distance = _chain(sub, sign)
    count = distance.shape[1]
    many = np.tile(every, count)
    strips, there, away = s.take(many), order.take(many), distance.reshape(len(distance), -1)
    marches = march(kernel, strips, sub.engaged[many], sub.z[:, many] + sign * there.to_z(away), sub.start[many])
    np.add.at(out.evaluations, sub.index[many], marches.evaluations)
    moves = sign * there.to_e(marches.dz)
    stays = (marches.engaged == sub.engaged[many]) & ~marches.lost

    def ends(k, j):
        """Lower and upper ones of the marches ``k`` and of those beyond, ``j``."""
        one, two = marches.take(k), marches.take(j)
        return (one, two) if sign > 0 else (two, one)

    def slope(k, along=None):
        lower, upper = ends(k, k + N)
        least = least_monodromy(strips.take(k), there.take(k), lower, upper, alike(lower, upper))
        return propagation(strips.take(k), there.take(k), lower, least, along)

    grow = (stays & np.all(moves >= 0, axis=0)).reshape(count, N)
    link = np.flatnonzero(np.cumprod(grow[:-1] & grow[1:], axis=0).ravel())
    clear = np.zeros((count - 1) * N, bool)
    if link.size:
        step = away[:, link + N] - away[:, link]
        left = moves[:, link] + slope(link, step)[:, :, 0].T
        clear[link] = np.all((left > 0) | (step == 0), axis=0)
    reached = np.cumprod(clear.reshape(count - 1, N), axis=0).sum(axis=0)
    last = reached * N + every
    moved = away[:, last]
    # where no link is clear: by what the bound over the first one tells of a part of it
    short = np.flatnonzero(reached == 0)
    if short.size:
        width, gone = away[:, short + N], np.maximum(moves[:, short], 0.0)
        inner = np.where(marches.lost[short + N], 0.0, _valid(solve_order(slope(short), gone)))
        wanted = np.max(np.divide(inner, width, out=np.zeros_like(inner), where=width > 0), axis=0)
        moved[:, short] = np.maximum(inner / np.maximum(wanted, 1.0), np.minimum(gone, sub.room[:, short]))
    # the first state that is mapped inwards, or is known to lie beyond the orbit
    beyond = stays & np.all(moves <= 0, axis=0) | np.all(away >= sub.room[:, many], axis=0)
    beyond = beyond.reshape(count, N) & (np.arange(count)[:, None] > reached)
    inside, first = beyond.any(axis=0), beyond.argmax(axis=0) * N + every
    done = np.zeros(N, bool)
    pair = np.flatnonzero(inside)
    lower, upper = ends(last[pair], first[pair])
    edges = _edges(lower), _edges(upper)
    shared = alike(lower, upper) & (lower.contacts == upper.contacts) & (lower.contacts <= 1)
    done[pair] = shared & _close(*edges, NARROW)
    near = np.flatnonzero(shared & ~done[pair] & _close(*edges, _NEAR))
    if near.size:
        k = pair[near]
        done[k] = contracts(s.take(k), order.take(k), lower.take(near), upper.take(near))
    at = sub.index[done]
    out.kind[at] = ORBIT
    out.lower[:, at], out.upper[:, at] = edges[0][:, done[pair]], edges[1][:, done[pair]]
    st.z[:, i] += sign * order.to_z(moved)
    st.room[:, i] = np.maximum(np.where(inside, away[:, first], sub.room) - moved, 0.0)
    st.near.put(i, marches.take(last))
    if short.size:
        st.march(kernel, i[short], out)
    # rounding alone decides the signs here, whatever the width: not to be certified
    small = (reached == 0) & np.all(away[:, every + N] <= 2 * sub.least * s.size_of_lengths, axis=0)
    st.least[i] = np.where(small, 4 * sub.least, sub.least)
    return done | (small & (sub.least >= _WIDEST))


def _chain(st: _State, sign: float) -> np.ndarray:
    """Distances (n, count, N) of the states of a chain from the bounding ones, ascending from 0."""
    r = np.maximum(sign * st.order.to_e(st.near.dz), 0.0)
    exact = propagation(st.s, st.order, st.near, exact_monodromy(st.s, st.near))
    newton = solve_order(exact, r)
    ahead = np.all((newton >= 0) & (newton <= st.room), axis=0)
    direction = np.where(ahead | np.all(newton >= 0, axis=0), newton, np.where(np.all(newton <= 0, axis=0), -newton, r))
    farthest = np.divide(st.room, direction, out=np.full(r.shape, np.inf), where=direction > 0).min(axis=0)
    chain = np.where(ahead, _AHEAD[:, None], _AWAY[:, None] * np.minimum(1.0, farthest / _AWAY[-1])) * direction[:, None]
    least = st.least * st.s.size_of_lengths * _inward(exact)
    chain[:, 1:] = np.maximum(chain[:, 1:], least[:, None])
    return np.minimum(chain, st.room[:, None])


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


def _close(one, two, apart):
    """Edges of the two ends agree, NaN with NaN."""
    return np.all((np.abs(one - two) <= apart) | (np.isnan(one) & np.isnan(two)), axis=0)
