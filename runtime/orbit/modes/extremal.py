"""Extremal orbits by Newton's method on their edges, proven by states that bound all orbits from one side.

Marches from states below (``unloading``) or above (``loading``) every orbit move towards the first one. Their edges are a start
for Newton's method; what that finds is the first orbit if the period map contracts between the bounding state and it
(``contraction``). While it does not the state is moved closer: with a lower bound of the map's derivative it may go further
than one period takes it (``order``). What is left after a few rounds goes on with ``order.approach``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...numerics.rounding import EPS
from ..regimes import EDGES
from .contraction import alike, contracts
from .coordinates import Order
from .fields import state_at
from .march import TWO_PI, Period, march
from .order import ENGAGED, FREE, ORBIT, UNRESOLVED
from .polish import polish
from .problem import ModeStrips
from .propagation import least_monodromy, propagation, solve_order

#: rounds of bounding states, and the one in which Newton's method starts from them: after one period a bounding state is free
#: where the orbits are, before that nothing can be proven
_ROUNDS, _START = 6, 1
#: how far Newton's method may take an edge from where it starts, radians: further away other regimes begin
_FURTHEST = 1.5
_CONVERGED, _ROUNDINGS, _COARSEST = 1e-13, 64, 1e-6
#: agreement of the edges with a march of the period
_AGREE = 1e-7
#: edges of each sequence, by their rows in the order d, b, a, c
ROWS = {sequence: tuple("dbac".index(edge) for edge in EDGES[sequence]) for sequence in ("acaf", "afc", "af")}
SEQUENCES = ("", "acaf", "afc", "af")


@dataclass(slots=True)
class Extremal:
    """Outcome for N strips: ``kind`` (see ``order``); orbits by ``edges`` (4, N) in the order d, b, a, c, of the regime
    ``sequence`` (place in ``SEQUENCES``); of strips unresolved the bounding state ``z``, whether it is ``engaged``, and
    displacements e of an orbit or ``beyond`` all, (n, N); evaluations; the marches that were ``held`` engaged all along."""

    kind: np.ndarray
    edges: np.ndarray
    sequence: np.ndarray
    z: np.ndarray
    engaged: np.ndarray
    beyond: np.ndarray
    evaluations: np.ndarray
    held: Period


def lowest_state(kernel, s: ModeStrips, phase) -> np.ndarray:
    """State below every orbit: displacements are nowhere below the profile, nor below ``-p_0``."""
    overstress = kernel.saturated_overstress(phase, s.m)
    order = Order.of(kernel, s)
    e = kernel.profile(phase, s.D) - s.m.S * overstress
    return order.to_z(np.maximum(e, -s.p_0))


def highest_state(kernel, s: ModeStrips) -> np.ndarray:
    """State above every orbit, free."""
    return Order.of(kernel, s).to_z(np.broadcast_to(np.maximum(s.D, 0.0), (s.modes, s.size)))


def extremal(kernel, s: ModeStrips, start, z, engaged, rising: bool) -> Extremal:
    """The first orbit above (``rising``) or below the states ``z`` (n, N) at the phases ``start``."""
    beyond = np.broadcast_to(np.maximum(s.D, 0.0) if rising else -s.p_0, z.shape).copy()
    out = Extremal(np.full(s.size, UNRESOLVED), np.full((4, s.size), np.nan), np.zeros(s.size, int), z.copy(), engaged.copy(),
                   beyond, np.zeros(s.size), Period.blank(s.modes, s.size))  # fmt: skip
    work = _Rounds(kernel, s, np.array(start, float), out, rising)
    for number in range(_ROUNDS):
        if not work.active.size:
            break
        work.round(number)
    return out


class _Rounds:
    def __init__(self, kernel, s: ModeStrips, start, out: Extremal, rising: bool):
        self.kernel, self.s, self.start, self.out, self.rising = kernel, s, start, out, rising
        self.sign = 1.0 if rising else -1.0
        self.order = Order.of(kernel, s)
        self.active = np.arange(s.size)
        self.found = np.zeros(s.size, bool)
        self.period, self.low = (Period.blank(s.modes, s.size) for _ in range(2))
        self.marched = np.zeros(s.size, bool)

    def round(self, number: int) -> None:
        """March once from every bounding state; decide what that decides, and move the others."""
        i, out = self.active, self.out
        s, order = self.s.take(i), self.order.take(i)
        near = march(self.kernel, s, out.engaged[i], out.z[:, i], self.start[i])
        out.evaluations[i] += near.evaluations
        # from above: nothing but engaged orbits; from below: to be seen from the engaged orbit
        held = near.never_free
        lets = near.never_engaged & self.rising & (s.D <= -s.delta_0)
        out.kind[i[held]], out.kind[i[lets]] = ENGAGED, FREE
        k = np.flatnonzero(held)
        out.held.put(i[k], near.take(k))
        ended = held | lets | near.lost
        changed = (near.engaged != out.engaged[i]) & ~ended
        if number == _START:
            self._newton(i, s, near, np.flatnonzero(~ended))
        known = np.flatnonzero(self.found[i] & ~ended)
        r = np.maximum(self.sign * order.to_e(near.dz), 0.0)
        move = r.copy()
        if known.size:
            part, there, here = s.take(known), order.take(known), near.take(known)
            other = self.period.take(i[known])
            lower, upper = (here, other) if self.rising else (other, here)
            proven = contracts(part, there, lower, upper)
            out.kind[i[known[proven]]] = ORBIT
            ended[known[proven]] = True
            bound = propagation(part, there, lower, least_monodromy(part, there, lower, upper, alike(lower, upper)))
            move[:, known] = np.maximum(move[:, known], _valid(solve_order(bound, r[:, known])))
            room = np.maximum(self.sign * (out.beyond[:, i[known]] - there.to_e(out.z[:, i[known]])), 0.0)
            move[:, known] = np.minimum(move[:, known], room)
        alone = np.flatnonzero(~self.found[i] & ~ended & ~changed)
        if alone.size:
            part, there = s.take(alone), order.take(alone)
            plain = propagation(part, there, self._deepest(i[alone], part, near.take(alone)), None)
            move[:, alone] = np.maximum(move[:, alone], _valid(solve_order(plain, r[:, alone])))
        go = np.flatnonzero(~ended)
        stay, flip = go[~changed[go]], np.flatnonzero(changed)
        out.z[:, i[stay]] += self.sign * order.take(stay).to_z(move[:, stay])
        out.z[:, i[flip]] += near.dz[:, flip]
        out.engaged[i[flip]] = near.engaged[flip]
        self.active = i[go]

    def _deepest(self, index, s: ModeStrips, near: Period) -> Period:
        """Marches with contacts at least as long as any that states between the bounding ones and the orbits meet."""
        if self.rising:
            return near
        fresh = np.flatnonzero(~self.marched[index])
        if fresh.size:
            part, start = s.take(fresh), self.start[index[fresh]]
            low = march(self.kernel, part, np.ones(fresh.size, bool), lowest_state(self.kernel, part, start), start)
            self.out.evaluations[index[fresh]] += low.evaluations
            self.low.put(index[fresh], low)
            self.marched[index[fresh]] = True
        return self.low.take(index)

    def _newton(self, i, s: ModeStrips, near: Period, pick) -> None:
        """Orbits from the edges that the marches of ``pick`` met."""
        met = near.take(pick)
        edges = in_order(np.array([met.onset, met.entry, met.exit, met.release]))
        usable = np.isfinite(edges[0]) & np.isfinite(edges[3])
        contact = usable & np.isfinite(edges[1]) & np.isfinite(edges[2])
        snaps = s.snaps[pick]
        for number, kind in ((1, contact & ~snaps), (2, contact & snaps), (3, usable & ~contact & ~snaps)):
            k = np.flatnonzero(kind)
            if k.size:
                self._from(i[pick[k]], s.take(pick[k]), number, edges[list(ROWS[SEQUENCES[number]])][:, k])

    def _from(self, index, s: ModeStrips, number: int, edges) -> None:
        sequence = SEQUENCES[number]
        edges = np.maximum.accumulate(edges, axis=0)
        solved, good, spent = certified(self.kernel, s, sequence, edges)
        self.out.evaluations[index] += spent
        k = np.flatnonzero(good)
        if not k.size:
            return
        part = s.take(k)
        start = self.start[index[k]]
        z, engaged = state_at(self.kernel, sequence, part, solved[:, k], start)
        period = march(self.kernel, part, engaged, z, start)
        self.out.evaluations[index[k]] += period.evaluations
        ok = agrees(sequence, part, solved[:, k], period)
        index, k = index[k[ok]], k[ok]
        if not index.size:
            return
        self.found[index] = True
        self.out.beyond[:, index] = self.order.take(index).to_e(z[:, ok])
        self.out.sequence[index] = number
        self.out.edges[np.array(ROWS[sequence])[:, None], index] = solved[:, k]
        self.period.put(index, period.take(np.flatnonzero(ok)))


def agrees(sequence: str, s: ModeStrips, edges, period: Period) -> np.ndarray:
    """Whether a turn from a state of the orbit met the edges (k, N) of ``sequence``, each once, and nothing else."""
    row = dict(zip(EDGES[sequence], edges, strict=True))
    near = lambda met, edge: np.abs(np.mod(met - edge + np.pi, TWO_PI) - np.pi) <= _AGREE  # noqa: E731
    ok = ~period.lost & (period.onsets == 1) & (period.releases == 1) & (period.engaged == period.engaged_before)
    ok &= near(period.onset, row["d"]) & near(period.release, row["c"])
    if sequence == "af":
        return ok & (period.contacts == 0)
    ok &= near(period.exit, row["a"])
    return ok & (period.contacts == 1) & near(period.entry, row["b"] if sequence == "acaf" else row["d"])


def certified(kernel, s: ModeStrips, sequence: str, edges):
    """Orbits by Newton's method from ``edges`` (k, N); which converged, in order within a period; the evaluations spent."""
    with np.errstate(all="ignore"):
        refined = polish(kernel, sequence, s, edges, edges - _FURTHEST, edges + _FURTHEST)
    e = refined.edges
    limit = _CONVERGED + _ROUNDINGS * np.minimum(refined.attainable, _COARSEST)
    good = (refined.correction <= limit) & np.all(np.diff(e, axis=0) >= -64 * EPS, axis=0) & (e[-1] - e[0] <= TWO_PI + 64 * EPS)
    return e, good, refined.evaluations


def in_order(edges):
    """Edges d, b, a, c in one period that ends with c in (0, pi): the gap can only grow while the profile falls."""
    d, b, a, c = edges
    shifted = [np.where(e > c, e - TWO_PI, e) for e in (d, b, a)]
    turns = TWO_PI * np.floor(c / TWO_PI)
    return np.array([*shifted, c]) - turns


def _valid(v):
    """Steps that are defined and not negative; zero otherwise."""
    good = np.all(np.isfinite(v) & (v >= 0), axis=0)
    return np.where(good, v, 0.0)
