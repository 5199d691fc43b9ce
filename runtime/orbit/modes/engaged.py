"""The one orbit of a strip that is never released, by Newton's method on its period map.

Without release ``w = u + max(z - u - J_0 p_0, 0)`` is a convex function of the state, so the period map is convex and
monotone: each Newton step from below lands below the fixed point again, higher up. It cannot miss, and near the orbit
it converges quadratically.
"""

from __future__ import annotations

import numpy as np

from ...numerics.rounding import EPS
from .coordinates import Order
from .extremal import AGREE, certified, lowest_state
from .fields import state_at
from .march import TWO_PI, Period, march
from .problem import ModeStrips
from .propagation import propagation, solve_order

_STEPS = 80
#: slow modes leave their displacements less certain than the edges; the state serves as a bound and as a start for ``polish``
_COARSEST = 1e-7


def engaged_orbit(kernel, strips: ModeStrips, start) -> tuple[np.ndarray, Period, np.ndarray, np.ndarray]:
    """State at the phases ``start``, the period from there, the derivative of its map less the identity, and which did converge.

    ``evaluations`` of the period count all the work.
    """
    s = strips.raised()
    N = s.size
    z = np.broadcast_to(s.m.J, (s.modes, N)) * (s.D - 1)
    yes = np.ones(N, bool)
    order = Order.of(kernel, s)
    last = np.full(N, np.inf)
    spent = np.zeros(N)
    active = np.arange(N)
    for _ in range(_STEPS):
        sub = s.take(active)
        here = order.take(active)
        period = march(kernel, sub, yes[active], z[:, active], start[active])
        spent[active] += period.evaluations
        step = solve_order(propagation(sub, here, period, None), here.to_e(period.dz))
        size = np.abs(step).max(axis=0)
        usable = np.isfinite(size)
        z[:, active[usable]] += here.to_z(step)[:, usable]
        done = usable & (
            (size <= 64 * EPS * sub.size_of_lengths) | ((size < 1e-10 * sub.size_of_lengths) & (size >= 0.5 * last[active]))
        )
        last[active] = size
        active = active[~done & usable]
        if not active.size:
            break
    converged = last <= _COARSEST * s.size_of_lengths
    period = march(kernel, s, yes, z, start)
    period.evaluations += spent
    return z - s.m.J * strips.p_0, period, propagation(s, order, period, None), converged & ~period.lost


def engaged(kernel, strips: ModeStrips, start, near: Period | None = None):
    """The same orbits by Newton's method on their edges, from those that marches ``near`` met, each checked by a march.

    Returns states at the phases ``start``, edges b and a (2, N), which are known, which are orbits of the strip itself, as
    their gaps stay within its reach, and the evaluations."""
    s, yes, spent = strips.raised(), np.ones(strips.size, bool), np.zeros(strips.size)
    if near is None:
        near = march(kernel, s, yes, lowest_state(kernel, s, start), start)
        spent += near.evaluations
    edges, known, used = certified(kernel, s, "ac", np.nan_to_num(engaged_edges(near)))
    spent += used
    z, within = np.full((s.modes, s.size), np.nan), np.zeros(s.size, bool)
    k = np.flatnonzero(known)
    z[:, k], _ = state_at(kernel, "ac", s.take(k), edges[:, k], start[k])
    # a march that is never released checks both; where it is, one in which release is put out of action
    for part, lowered in ((strips, strips.m.J * strips.p_0), (s, 0.0)):
        turn = march(kernel, part.take(k), yes[k], (z - lowered)[:, k], start[k])
        spent[k] += turn.evaluations
        apart = np.abs(np.mod(engaged_edges(turn) - edges[:, k] + np.pi, TWO_PI) - np.pi).max(axis=0)
        good = (apart <= AGREE) & (turn.contacts == 1) & turn.never_free
        known[k], within[k] = good, good & (part is strips)
        k = k[~good]
        if not k.size or strips.bare:
            break
    rest = np.flatnonzero(~known)
    if rest.size:
        part = strips.take(rest)
        z[:, rest], turn, _, good = engaged_orbit(kernel, part, start[rest])
        again, converged, used = certified(kernel, s.take(rest), "ac", np.nan_to_num(engaged_edges(turn)))
        edges[:, rest], known[rest] = again, good & converged
        turn = march(kernel, part, yes[rest], z[:, rest], start[rest])
        within[rest] = known[rest] & turn.never_free
        z[:, rest] += part.m.J * part.p_0
        spent[rest] += turn.evaluations + used
    return z - strips.m.J * strips.p_0, edges, known, within, spent


def engaged_edges(period: Period):
    """Edges b, a of an always engaged orbit, b first."""
    b, a = period.entry, period.exit
    b = np.where(b > a, b - TWO_PI, b)
    return np.array([b, a]) - TWO_PI * np.floor((a + 0.5 * np.pi) / TWO_PI)
