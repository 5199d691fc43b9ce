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
past them in a few steps. From above all is mirrored. The first orbit lies before the first state that is mapped inwards.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .contraction import alike
from .coordinates import Order
from .march import Period, march
from .problem import ModeStrips
from .propagation import exact_gains, least_gains, propagation, solve_order

#: states of a chain, in Newton's steps: those end short of a simple orbit, and half-way to a double one, where orbits are about
#: to appear. Beyond that the map moves states ever further, so that they may lie ever further apart
_CHAIN = np.append(np.linspace(0, 2, 17), 2 + 2.0 ** np.arange(-1, 6))
#: least distance of states, in units of the strip's lengths: what rounding leaves of the sign of P(y) - y
_LEAST = 1e-12


@dataclass(slots=True)
class Bound:
    """States that bound all orbits of N strips from below (``sign`` 1) or above (-1): ``z`` (n, N), whether they are ``engaged``,
    and the period ``near`` from there; ``beyond``: displacements e (n, N) of an orbit, or of a state
    beyond all."""

    s: ModeStrips
    order: Order
    sign: float
    engaged: np.ndarray
    z: np.ndarray
    near: Period
    beyond: np.ndarray

    def take(self, i) -> Bound:
        return Bound(self.s.take(i), self.order.take(i), self.sign, self.engaged[i], self.z[:, i],
                     self.near.take(i), self.beyond[:, i])  # fmt: skip

    @property
    def room(self) -> np.ndarray:
        """Distance to what is known to lie beyond, in e."""
        return np.maximum(self.sign * (self.beyond - self.order.to_e(self.z)), 0.0)

    def ends(self, near: Period, far: Period) -> tuple[Period, Period]:
        """Two marches, the lower one first."""
        return (near, far) if self.sign > 0 else (far, near)

    def slope(self, near: Period, far: Period, along=None) -> np.ndarray:
        """Lower bound of the map's derivative less the identity between the states of two marches."""
        lower, upper = self.ends(near, far)
        same = alike(lower, upper)
        least = least_gains(self.s, self.order, lower, upper, same) if same.any() else None
        return propagation(self.s, self.order, lower, least, along)

    def towards(self, far: Period, distance: np.ndarray) -> np.ndarray:
        """How far the states may move, e (n, N), by what the bound between them and those in the ``distance`` tells of a part of
        that way."""
        gone = np.maximum(self.sign * self.order.to_e(self.near.dz), 0.0)
        inner = np.where(far.lost, 0.0, valid(solve_order(self.slope(self.near, far), gone)))
        wanted = np.max(np.divide(inner, distance, out=np.zeros_like(inner), where=distance > 0), axis=0)
        return np.maximum(inner / np.maximum(wanted, 1.0), np.minimum(gone, self.room))


def climb(kernel, bound: Bound):
    """How far the states may move along chains.

    Returns the ways (n, N) in e, and the marches from their ends, but where the first link is known only in part: these strips;
    which chains end beyond the orbit, the first displacements e (n, N) there and the marches from them.
    """
    N, every = bound.z.shape[1], np.arange(bound.z.shape[1])
    distance = _chain(bound)
    count = distance.shape[1]
    many = np.tile(every, count)
    away = distance.reshape(len(distance), -1)
    s, order, engaged, room = bound.s.take(many), bound.order.take(many), bound.engaged[many], bound.room[:, many]
    z = bound.z[:, many] + bound.sign * order.to_z(away)
    marches = march(kernel, s, engaged, z, s.start)
    moves = bound.sign * order.to_e(marches.dz)
    stays = (marches.engaged == engaged) & ~marches.lost
    grow = (stays & np.all(moves >= 0, axis=0)).reshape(count, N)
    link = np.flatnonzero(np.cumprod(grow[:-1] & grow[1:], axis=0).ravel())
    clear = np.zeros((count - 1) * N, bool)
    if link.size:
        step = away[:, link + N] - away[:, link]
        here = Bound(s, order, bound.sign, engaged, z, marches, z).take(link)
        left = moves[:, link] + here.slope(here.near, marches.take(link + N), step)[:, :, 0].T
        clear[link] = np.all((left > 0) | (step == 0), axis=0)
    reached = np.cumprod(clear.reshape(count - 1, N), axis=0).sum(axis=0)
    last = reached * N + every
    moved = away[:, last]
    short = np.flatnonzero(reached == 0)
    if short.size:
        moved[:, short] = bound.take(short).towards(marches.take(short + N), away[:, short + N])
    # the first state that is mapped inwards, or is known to lie beyond the orbit
    beyond = stays & np.all(moves <= 0, axis=0) | np.all(away >= room, axis=0)
    beyond = beyond.reshape(count, N) & (np.arange(count)[:, None] > reached)
    first = beyond.argmax(axis=0) * N + every
    e = bound.order.to_e(bound.z) + bound.sign * away[:, first]
    return moved, marches.take(last), reached == 0, beyond.any(axis=0), e, marches.take(first)


def _chain(bound: Bound) -> np.ndarray:
    """Distances (n, count, N) of the states of a chain from the bounding ones, ascending from 0."""
    r = np.maximum(bound.sign * bound.order.to_e(bound.near.dz), 0.0)
    room = bound.room
    exact = propagation(bound.s, bound.order, bound.near, exact_gains(bound.s, bound.order, bound.near))
    newton = solve_order(exact, r)
    ahead = np.all((newton >= 0) & (newton <= room), axis=0)
    direction = np.where(ahead | np.all(newton >= 0, axis=0), newton, np.where(np.all(newton <= 0, axis=0), -newton, r))
    farthest = np.divide(room, direction, out=np.full(r.shape, np.inf), where=direction > 0).min(axis=0)
    chain = _CHAIN[:, None] * np.where(ahead, 1.0, np.minimum(1.0, farthest / _CHAIN[-1])) * direction[:, None]
    chain[:, 1:] = np.maximum(chain[:, 1:], _LEAST * bound.s.size_of_lengths)
    return np.minimum(chain, room[:, None])


def valid(v):
    """Steps that are defined and not negative; zero otherwise."""
    good = np.all(np.isfinite(v) & (v >= 0), axis=0)
    return np.where(good, v, 0.0)
