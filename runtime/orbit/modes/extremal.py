"""Extremal orbits by Newton's method on their edges, proven by states that bound all orbits from one side.

Marches from states below (``unloading``) or above (``loading``) every orbit move towards the first one. Their edges are a start
for Newton's method; what that finds is the first orbit if the period map contracts between the bounding state and it
(``contraction``). While it does not the state is moved closer: with a lower bound of the map's derivative it may go further
than one period takes it, and by a chain of states past places where orbits are about to appear (``order``). Where foundations are
so slow that it hardly moves, orbits that are periodic in all relaxation times bound the first one (``forced``).
"""

from dataclasses import dataclass

import numpy as np

from ..certificate import STABLE
from ..regimes import EDGES
from .contraction import contracts
from .coordinates import Order
from .fields import state_at
from .forced import rise
from .march import TWO_PI, Period, march
from .order import Bound, climb
from .polish import certified
from .problem import ModeStrips

#: the step in which Newton's method starts from the marches: after one period a bounding state is free where the orbits are,
#: before that nothing can be proven; the one from which on chains are marched; from which on orbits are forced in
#: every other step (earlier it takes longer, and next to folds chains of states go further); and where a strip is given up
_START, _CHAINS, _FORCED, _STEPS = 1, 6, 24, 188
#: strips in chains of states at a time: 32 states each
_CHAINED = 512
#: agreement of the edges with a march of the period
AGREE = 1e-7
#: an orbit between states whose edges are so close, and that is stable, is the first one; between those that are less close it is
#: so where the map contracts
_NARROW, _NEAR = 1e-6, 1e-3
#: edges of each sequence, by their rows in the order d, b, a, c
ROWS = {sequence: tuple("dbac".index(edge) for edge in EDGES[sequence]) for sequence in ("acaf", "afc", "af")}
SEQUENCES = ("", "acaf", "afc", "af")
ENGAGED, FREE, ORBIT, UNRESOLVED = 0, 1, 2, -1


@dataclass(slots=True)
class Extremal:
    """Outcome for N strips: ``kind`` (ENGAGED, FREE, ORBIT, UNRESOLVED); orbits by ``edges`` (4, N) in the order d, b, a, c, of
    the regime ``sequence`` (place in ``SEQUENCES``), or the edges of marches that were engaged all along."""

    kind: np.ndarray
    edges: np.ndarray
    sequence: np.ndarray


def lowest_state(kernel, s: ModeStrips) -> np.ndarray:
    """State below every orbit: displacements are nowhere below the profile, nor below ``-p_0``."""
    overstress = kernel.saturated_overstress(s.start, s.m)
    order = Order.of(kernel, s)
    e = kernel.profile(s.start, s.D) - s.m.S * overstress
    return order.to_z(np.maximum(e, -s.p_0))


def highest_state(kernel, s: ModeStrips) -> np.ndarray:
    """State above every orbit, free."""
    return Order.of(kernel, s).to_z(np.broadcast_to(np.maximum(s.D, 0.0), (s.modes, s.size)))


def extremal(kernel, s: ModeStrips, z, engaged, rising: bool, released: bool) -> Extremal:
    """The first orbit above (``rising``) or below the states ``z`` (n, N); ``released``: none is engaged
    all along."""
    search = _Search(kernel, s, z.copy(), engaged.copy(), rising)
    for step in range(_STEPS):
        if not search.active.size:
            break
        search.step(step, rising and not released)
    return search.out


class _Search:
    def __init__(self, kernel, s: ModeStrips, z, engaged, rising: bool):
        self.kernel, self.rising, self.active = kernel, rising, np.arange(s.size)
        nothing = np.full((4, s.size), np.nan)
        self.out = Extremal(np.full(s.size, UNRESOLVED), nothing, np.zeros(s.size, int))
        beyond = np.broadcast_to(np.maximum(s.D, 0.0) if rising else -s.p_0, z.shape).copy()
        near, self.orbit = (Period.blank(s.modes, s.size) for _ in range(2))
        if not rising:  # contacts from there are the longest of all
            self.orbit = march(kernel, s, np.ones(s.size, bool), lowest_state(kernel, s), s.start)
        self.bound = Bound(s, Order.of(kernel, s), 1.0 if rising else -1.0, engaged, z, near, beyond)
        self.found = np.zeros(s.size, bool)
        self._march(self.active)

    def _march(self, i) -> None:
        b = self.bound
        s = b.s.take(i)
        b.near.put(i, march(self.kernel, s, b.engaged[i], b.z[:, i], s.start))

    def step(self, number: int, ends_held: bool) -> None:
        """Decide what the marches from the bounding states decide, and move the others."""
        i, out, b = self.active, self.out, self.bound
        near, s = b.near.among(i), b.s.among(i)
        # from above: nothing but engaged orbits; from below: to be seen from the engaged orbit
        held = near.never_free & (ends_held | (not self.rising))
        lets = near.never_engaged & self.rising & (s.D <= -s.delta_0)
        out.kind[i[held]], out.kind[i[lets]] = ENGAGED, FREE
        out.edges[:, i[held]] = near.edges[:, held]
        going = ~(held | lets | near.lost)
        forced = number >= _FORCED and number % 2 == 1 and self.rising
        if number == _START or forced:
            self._newton(i[going & ~self.found[i]], np.inf)
        going[going] = ~self._proven(i[going])
        if forced:
            k = i[going & self.found[i]]
            k = k[_apart(b.near.take(k), self.orbit.take(k)) <= _NARROW]
            out.kind[k[self._stable(k)]] = ORBIT
            going &= out.kind[i] != ORBIT
        turned = going & (near.engaged != b.engaged[i])
        b.z[:, i[turned]] += near.dz[:, turned]
        b.engaged[i[turned]] = near.engaged[turned]
        on = i[going & ~turned]
        marched = on[:0]
        if number < _CHAINS and not forced:
            self._move(on)
        elif forced:
            self._rise(on)
        elif on.size:
            parts = [self._climb(few) for few in np.split(on, range(_CHAINED, on.size, _CHAINED))]
            marched, ended = (np.concatenate(each) for each in zip(*parts, strict=True))
            going &= ~np.isin(i, ended)
        self.active = i[going]
        self._march(np.setdiff1d(self.active, marched))

    def _proven(self, i) -> np.ndarray:
        """Which of the strips ``i`` have an orbit, and the period map contracts between the bounding state and that."""
        proven, k = np.zeros(i.size, bool), np.flatnonzero(self.found[i])
        if k.size:
            b = self.bound.take(i[k])
            proven[k] = contracts(b.s, b.order, *b.ends(b.near, self.orbit.take(i[k])))
        self.out.kind[i[proven]] = ORBIT
        return proven

    def _stable(self, i) -> np.ndarray:
        """Where the spectral radius of the return map is at most one, as is true of both extremal orbits."""
        good = np.zeros(i.size, bool)
        for number in range(1, len(SEQUENCES)):
            k = np.flatnonzero(self.out.sequence[i] == number)
            if not k.size:
                continue
            s, sequence = self.bound.s.take(i[k]), SEQUENCES[number]
            edges = self.out.edges[np.array(ROWS[sequence])[:, None], i[k]]
            matrix = getattr(self.kernel, f"return_map_{sequence}")(*edges, *s.arguments)
            matrix = np.moveaxis(np.broadcast_to(matrix, (s.modes, s.modes, s.size)), -1, 0)
            finite = np.isfinite(matrix).all(axis=(1, 2))
            radius = np.abs(np.linalg.eigvals(np.where(finite[:, None, None], matrix, 0.0))).max(axis=1)
            good[k] = finite & (radius <= 1 + STABLE)
        return good

    def _move(self, i) -> None:
        """By a period, or further where an orbit is known."""
        b = self.bound.take(i)
        self.bound.z[:, i] += b.sign * b.order.to_z(b.towards(self.orbit.take(i), b.room))

    def _rise(self, i) -> None:
        """To the end of a chain of forced orbits."""
        b = self.bound.take(i)
        near = b.near
        z, engaged = b.z + near.dz, near.engaged.copy()
        k = np.flatnonzero((near.onsets == 1) & (near.releases == 1) & (near.contacts <= 1))
        if k.size:
            edges = in_order(near.edges[:, k])
            edges[1:3] = np.where(np.isnan(edges[1:3]), edges[0], edges[1:3])  # no contact
            risen, held = rise(self.kernel, b.s.take(k), edges)
            known = np.isfinite(risen).all(axis=0)
            z[:, k[known]], engaged[k[known]] = risen[:, known], held[known]
        self.bound.z[:, i], self.bound.engaged[i] = z, engaged

    def _climb(self, i) -> tuple[np.ndarray, np.ndarray]:
        """By a chain; returns which strips are marched already, and which have ended."""
        b = self.bound.take(i)
        moved, ends, in_part, inside, e, far = climb(self.kernel, b)
        self.bound.z[:, i] += b.sign * b.order.to_z(moved)
        clear = ~in_part
        self.bound.near.put(i[clear], ends.take(np.flatnonzero(clear)))
        self.bound.beyond[:, i[inside]] = e[:, inside]
        window = np.where(inside, _apart(ends, far), np.inf)
        k = np.flatnonzero(window <= _NEAR)
        near, far, window = ends.take(k), far.take(k), window[k]
        alone = (window <= _NARROW) | contracts(b.s.take(k), b.order.take(k), *b.ends(near, far))
        self._newton(i[k], window + _NARROW)
        k = k[alone & self.found[i[k]] & (_apart(self.orbit.take(i[k]), far) <= window + 2 * _NARROW)]
        self.out.kind[i[k[self._stable(i[k])]]] = ORBIT
        return i[clear], i[self.out.kind[i] == ORBIT]

    def _newton(self, i, reach) -> None:
        """Orbits from the edges that the marches of the strips ``i`` met, no edge further away than ``reach``."""
        reach = np.broadcast_to(reach, i.shape)
        met, snaps = self.bound.near.take(i), self.bound.s.snaps[i]
        edges = in_order(met.edges)
        usable = np.isfinite(edges[0]) & np.isfinite(edges[3])
        contact = usable & np.isfinite(edges[1]) & np.isfinite(edges[2])
        for number, kind in ((1, contact & ~snaps), (2, contact & snaps), (3, usable & ~contact & ~snaps)):
            k = np.flatnonzero(kind)
            if k.size:
                self._from(i[k], number, edges[list(ROWS[SEQUENCES[number]])][:, k], reach[k])

    def _from(self, index, number: int, edges, reach) -> None:
        sequence, s = SEQUENCES[number], self.bound.s.take(index)
        solved, good = certified(self.kernel, s, sequence, np.maximum.accumulate(edges, axis=0), reach)
        k = np.flatnonzero(good)
        if not k.size:
            return
        part = s.take(k)
        z, engaged = state_at(self.kernel, sequence, part, solved[:, k], part.start)
        period = march(self.kernel, part, engaged, z, part.start)
        ok = agrees(sequence, part, solved[:, k], period)
        index, k = index[k[ok]], k[ok]
        self.found[index] = True
        self.bound.beyond[:, index] = self.bound.order.take(index).to_e(z[:, ok])
        self.out.sequence[index] = number
        self.out.edges[np.array(ROWS[sequence])[:, None], index] = solved[:, k]
        self.orbit.put(index, period.take(np.flatnonzero(ok)))


def _apart(one: Period, two: Period) -> np.ndarray:
    """Largest distance between the edges of two marches; infinite where they did not meet the same ones."""
    one, two = one.edges, two.edges
    same = np.all(np.isnan(one) == np.isnan(two), axis=0)
    return np.where(same, np.nan_to_num(np.abs(one - two)).max(axis=0), np.inf)


def agrees(sequence: str, s: ModeStrips, edges, period: Period) -> np.ndarray:
    """Whether a turn from a state of the orbit met the edges (k, N) of ``sequence``, each once, and nothing else."""
    row = dict(zip(EDGES[sequence], edges, strict=True))
    near = lambda met, edge: np.abs(np.mod(met - edge + np.pi, TWO_PI) - np.pi) <= AGREE  # noqa: E731
    ok = ~period.lost & (period.onsets == 1) & (period.releases == 1) & (period.engaged == period.engaged_before)
    ok &= near(period.onset, row["d"]) & near(period.release, row["c"])
    if sequence == "af":
        return ok & (period.contacts == 0)
    ok &= near(period.exit, row["a"])
    return ok & (period.contacts == 1) & near(period.entry, row["b"] if sequence == "acaf" else row["d"])


def in_order(edges):
    """Edges d, b, a, c in one period that ends with c in (0, pi): the gap can only grow while the profile falls."""
    d, b, a, c = edges
    shifted = [np.where(e > c, e - TWO_PI, e) for e in (d, b, a)]
    turns = TWO_PI * np.floor(c / TWO_PI)
    return np.array([*shifted, c]) - turns
