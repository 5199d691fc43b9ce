"""Extremal orbits by Newton's method on their edges, proven by the windows that bound those of all orbits (``windows``)."""

import numpy as np

from ...numerics.linear import solve_each
from ...numerics.rounding import EPS
from ..certificate import STABLE
from ..chain import CONVERGED
from ..groups import ROUNDING, TWO_PI
from ..regimes import CODE, EDGES, SEQUENCES
from .forced import AGREE, SETTLING, Forced
from .march import march
from .problem import ModeStrips
from .windows import alone, balanced, linearised, links, newton

#: where a strip is given up; steps of Newton's method: far from a narrow contact each shrinks it by a third only
STEPS, _ITERATIONS = 300, 40
#: a chain of windows leads to an orbit or to where orbits have vanished: each goes such a share of what is left, at most
_SHARE = 0.35
#: so many windows, and from that step on more: as many past there, and farther ones; fewer first are a third faster with 14 times
_FEW, _FULL, _WINDOWS, _FARTHER = 5, 4, 16, (3, 5, 9, 17)
#: a step expected to be this small is not taken; steps that hardly shrink after so many lead nowhere
_SETTLED, _LOST_AFTER, _SHRINKS = 2 * EPS, 4, 0.7
#: beside ``CONVERGED`` the last step of an orbit is so many times what rounding leaves of its edges; more is a correction
_ROUNDINGS = 8
#: edges of each sequence, by their rows in the order d, b, a, c
ROWS = {sequence: tuple("dbac".index(edge) for edge in EDGES[sequence]) for sequence in ("acaf", "afc", "af")}
ENGAGED, FREE, ORBIT, UNRESOLVED = 0, 1, 2, -1


class Search:
    """Search for the first orbits above (``rising``) or below the states ``z`` (n, N), with their ``kind`` (ENGAGED, FREE, ORBIT,
    UNRESOLVED), ``edges`` (4, N) in the order d, b, a, c, those that are missing like d, and regime ``sequence`` (place in
    ``SEQUENCES``); or the edges of marches that were engaged all along: from below, only the first one may end the search so.

    ``z``, ``engaged``: states at the start that bound all orbits; ``edges``: also of orbits that may not be the first."""

    def __init__(self, kernel, s: ModeStrips, z, rising: bool):
        self.kernel, self.s, self.rising, self.active = kernel, s, rising, np.arange(s.size)
        self.z, self.engaged, self.steps = z, np.full(s.size, rising), 0
        self.kind, self.edges, self.known = np.full(s.size, UNRESOLVED), np.full((4, s.size), np.nan), np.zeros(s.size)
        self.sequence, self.share, self.states = np.zeros(s.size, int), np.full(s.size, _SHARE), np.empty((4, s.modes, s.size))
        # states and shares a round of trials ago
        self.before = np.full((s.modes + 1, s.size), np.nan)

    def run(self, steps: int = STEPS) -> None:
        """Search until all strips are decided, or given up, or so many ``steps`` are done."""
        while self.active.size and self.steps < steps:
            self.step(self.steps)
            self.steps += 1

    def resume(self, i, z) -> None:
        """Search on for the strips ``i``, found to be engaged all along, from the states ``z`` of their engaged orbits."""
        self.z[:, i], self.kind[i], self.edges[:, i] = z, UNRESOLVED, np.nan
        self.active = np.union1d(self.active, i)

    def step(self, number: int) -> None:
        """March from the bounding states, decide what that decides, and move the others."""
        i = self.active
        s = self.s.take(i)
        near = march(self.kernel, s, self.engaged[i], self.z[:, i], s.start)
        # from above: nothing but engaged orbits; from below: to be seen from the engaged orbit
        held = near.never_free & (not self.rising or number == 0)
        lets = near.never_engaged & self.rising & (s.D <= -s.delta_0)
        self.kind[i[held]], self.kind[i[lets]] = ENGAGED, FREE
        self.edges[:, i[held]] = near.edges[:, held]
        going = ~(held | lets | near.lost)
        once = going & (near.onsets == 1) & (near.releases == 1) & (near.contacts <= 1) & (near.engaged == self.engaged[i])
        # a march that begins in contact does not meet its entry
        k = np.flatnonzero(once & (np.isnan(near.edges[1]) == np.isnan(near.edges[2])))
        edges = in_order(near.edges[:, k])
        edges[1:3] = np.where(np.isnan(edges[1:3]).any(axis=0), edges[0], edges[1:3])
        if number < 2 or number % 4 == 3:
            seek = np.isnan(self.edges[0, i[k]]) | (number > 3)
            self._newton(i[k[seek]], edges[:, seek])
        self.z[:, i] += near.dz
        self.engaged[i] = near.engaged
        left = np.flatnonzero(~self._proven(i[k], edges) & ((number > 0) | np.isnan(self.edges[0, i[k]])))
        if left.size:
            self._move(i[k[left]], edges[:, left], number)
        self.active = i[going & (self.kind[i] != ORBIT) & ~self._stays(i, number)]

    def _stays(self, i, number: int) -> np.ndarray:
        """Which strips ``i`` get nowhere: a whole round of trials leaves them where they were, but for rounding, or the links of
        their chains have become none."""
        still = self.share[i] < EPS
        if number % 4 == 3:
            now = np.concatenate((self.z[:, i], self.share[None, i]))
            moved, self.before[:, i] = np.abs(now - self.before[:, i]), now
            still |= (moved[:-1].max(axis=0) <= ROUNDING * np.abs(now[:-1]).max(axis=0)) & (moved[-1] == 0)
        return still

    def _proven(self, i, edges) -> np.ndarray:
        """Which strips ``i`` have an orbit that is alone in the windows of the ``edges``, the first one, or fills them."""
        proven, k = np.zeros(i.size, bool), np.flatnonzero(~np.isnan(self.edges[0, i]))
        if k.size:
            orbit = Forced(self.kernel, self.s.take(i[k]), self.edges[:, i[k]], self.states[..., i[k]])
            d, b, a, c = edges[:, k]
            apart = np.abs(edges[[0, 3]][:, k] - orbit.edges[[0, 3]]).max(axis=0)
            proven[k] = alone(orbit, (d, c), (b, a), self.rising, AGREE) | (apart <= AGREE + self.known[i[k]])
            # windows so close to an orbit's tell it from others by rounding: of that it is asked to be stable, too
            narrow = proven[k] & (apart <= STABLE + self.known[i[k]])
            proven[k[narrow]] = self._stable(i[k[narrow]])
            self.kind[i[proven]] = ORBIT
        return proven

    def _stable(self, i) -> np.ndarray:
        """Where the spectral radius of the return map is at most one, as is true of both extremal orbits."""
        good = np.zeros(i.size, bool)
        for sequence in {SEQUENCES[code] for code in self.sequence[i]}:
            k = np.flatnonzero(self.sequence[i] == CODE[sequence])
            s, edges = self.s.take(i[k]), self.edges[np.array(ROWS[sequence])[:, None], i[k]]
            matrix = np.moveaxis(getattr(self.kernel, f"return_map_{sequence}")(*edges, *s.arguments), -1, 0)
            finite = np.isfinite(matrix).all(axis=(1, 2))
            radius = np.abs(np.linalg.eigvals(np.where(finite[:, None, None], matrix, 0.0))).max(axis=1)
            good[k] = finite & (radius <= 1 + STABLE)
        return good

    def _move(self, i, edges, number: int) -> None:
        """To the orbits forced by the windows of the ``edges``, or to the last of a chain of them; at first to the orbits: slow
        modes stand still in a march, and its edges may be far from those of any orbit."""
        s = self.s.take(i)
        if number:
            with np.errstate(all="ignore"):
                chain, clear, good = self._chain(i, Forced(self.kernel, s, edges), number >= _FULL)
            reached = np.cumprod(clear, axis=0).sum(axis=0)
            # shorter links where few hold, longer ones where all do
            factor = np.select((reached == 0, reached < 4, reached >= _WINDOWS - 1), (0.125, 0.5, 4.0), 1.0)
            self.share[i] = np.minimum(self.share[i] * factor, _SHARE)
            orbit = chain.take(reached * i.size + np.arange(i.size))
        else:
            orbit, good = Forced.settled(self.kernel, s, edges, 1 if self.rising else SETTLING)
        i, orbit = i[good], orbit.take(np.flatnonzero(good))
        self.z[:, i], self.engaged[i] = orbit.at(self.s.start[i])
        self._proven(i, orbit.edges)

    def _chain(self, i, orbit: Forced, full: bool):
        """Orbits forced by windows that grow from those of ``orbit``; which links hold between them; which first ones settle."""
        sign = 1.0 if self.rising else -1.0
        d, _, a, c = orbit.edges
        # towards the orbit that is known, or past where one has vanished: Newton's step is half as long as the way there
        way = sign * np.stack((c - self.edges[3, i], self.edges[0, i] - d))
        way = np.where((way > 0).all(axis=0), way, 2 * newton(*linearised(orbit, self.rising)))
        way[:, ~np.isfinite(way).all(axis=0)] = 0.0
        room = np.minimum((c - a) / way[0], (c - d) / way.sum(axis=0)) if self.rising else (d + TWO_PI - c) / way.sum(axis=0)
        shares = 1 - (1 - self.share[i]) ** np.arange(_WINDOWS if full else _FEW)[:, None]
        if full:
            shares = np.concatenate((shares, 2 - shares[::-1], np.outer(_FARTHER, np.ones(i.size))))
        growth = np.minimum(shares, np.maximum(0.9 * np.nan_to_num(room), 0.0))[:, None] * way  # not all the room
        many = np.tile(np.arange(i.size), len(shares))
        s, first = orbit.s.take(many), (way[0] < way[1])[many]
        contact = orbit.edges[1:3, many]
        for last in (False, True) if full else (True,):
            growth = np.maximum.accumulate(np.maximum(growth, 0.0), axis=0)
            u, v = sign * growth.swapaxes(0, 1).reshape(2, -1)
            d_1, c_1 = d[many] + v, c[many] - u
            guess = np.stack((d_1, *np.clip(contact, d_1, c_1), c_1))
            if not last:
                chain, _ = Forced.settled(self.kernel, s, guess, 1)
                contact = chain.edges[1:3]
                here = balanced(growth.swapaxes(0, 1).reshape(2, -1), *linearised(chain, self.rising), first)
                # at once only if the links are as long as they may be: else the first one would be no shorter than this
                part = 1 - (1 - self.share[i] / _SHARE) ** np.arange(len(shares))[:, None, None]
                growth += part * (here.reshape(2, -1, i.size).swapaxes(0, 1) - growth)
        # a few windows that settle late would cost as many turns of all: they end their chains
        turns = (0 if full else 1) if self.rising else SETTLING // 2
        chain, settles = Forced.settled(self.kernel, s, guess, turns)
        near, far, settles = chain.take(slice(-i.size)), chain.take(slice(i.size, None)), settles.reshape(-1, i.size)
        return chain, links(near, far, self.rising).reshape(-1, i.size) & settles[1:] & settles[:-1], settles[0]

    def _newton(self, i, edges) -> None:
        """Orbits from the ``edges`` that the marches of the strips ``i`` met."""
        contact, snaps = edges[2] > edges[1], self.s.snaps[i]
        for sequence, kind in (("acaf", contact & ~snaps), ("afc", contact & snaps), ("af", ~contact & ~snaps)):
            if not kind.any():
                continue
            rows, index = list(ROWS[sequence]), i[kind]
            s = self.s.take(index)
            found, good, known = certified(self.kernel, s, sequence, np.maximum.accumulate(edges[rows][:, kind], axis=0))
            k = np.flatnonzero(good)
            orbit = Forced(self.kernel, s.take(k), found[[rows.index(row) if row in rows else 0 for row in range(4)]][:, k])
            z, engaged = orbit.at(orbit.s.start)
            period = march(self.kernel, orbit.s, engaged, z, orbit.s.start)
            # a turn meets these edges, each once, and nothing else
            ok = (period.onsets == 1) & (period.releases == 1) & (period.contacts == sequence.count("c")) & ~period.lost
            ok &= (period.engaged == period.engaged_before) & agrees(period.edges[rows], orbit.edges[rows], known[k])
            index, known = index[k[ok]], known[k[ok]]
            self.sequence[index], self.known[index] = CODE[sequence], known
            self.edges[:, index], self.states[..., index] = orbit.edges[:, ok], orbit.states[..., ok]


def agrees(met, edges, known):
    """Where the edges (k, N) that marches met are these, as far as they can be ``known``."""
    return np.abs(np.mod(met - edges + np.pi, TWO_PI) - np.pi).max(axis=0) <= AGREE + known


def in_order(edges):
    """Edges d, b, a, c in one period that ends with c in (0, pi): the gap can only grow while the profile falls."""
    c = edges[-1]
    return np.where(edges > c, edges - TWO_PI, edges) - TWO_PI * np.floor(c / TWO_PI)


def certified(kernel, strips: ModeStrips, sequence: str, edges: np.ndarray):
    """Orbits in the regime ``sequence`` from ``edges`` (k, N); which converged, in order; how well their edges are known."""
    with np.errstate(all="ignore"):
        edges, last, known = _converging(kernel, strips, sequence, edges)
    good = last <= CONVERGED + _ROUNDINGS * known
    good &= np.all(np.diff(edges, axis=0) >= -ROUNDING, axis=0) & (edges[-1] - edges[0] <= TWO_PI + ROUNDING)
    return edges, good, known


def _converging(kernel, strips: ModeStrips, sequence: str, edges: np.ndarray):
    """Edges, kept in order; the last steps; how well rounding lets the edges be known."""
    linearised = getattr(kernel, f"residual_and_jacobian_{sequence}")
    edges, N = edges.copy(), strips.size
    last, attainable = np.full(N, np.inf), np.full(N, np.inf)
    active = np.arange(N)
    for iteration in range(_ITERATIONS):
        s, before = strips.among(active), last[active]
        here = edges[:, active]
        residual, rows = map(np.array, linearised(*here, *s.arguments))
        matrix = rows.transpose(2, 0, 1)
        inverted = solve_each(matrix, np.broadcast_to(np.eye(len(here)), matrix.shape))
        step = -np.einsum("Nij,jN->iN", inverted, residual)
        size = np.abs(step).max(axis=0)
        # at the limit of rounding a step no longer shrinks: it is the uncertainty, not a correction
        better = np.isfinite(size) & ((size < 0.5 * last[active]) | (size > STABLE))
        moved = active[better]
        edges[:, moved] = np.maximum.accumulate(here[:, better] + step[:, better], axis=0)
        last[moved] = size[better]
        # pressures come from displacements over J_0; edges are rounded, too, and some change a pressure within 1e-8
        noise = (1 + np.abs(s.D) + s.delta_0) / s.m.J_0 + s.p_0
        noise = EPS * (noise[:, None] + np.pi * np.abs(matrix).sum(axis=2))
        attainable[moved] = np.einsum("Nij,Nj->Ni", np.abs(inverted), noise).max(axis=1)[better]
        # Newton's next step is this one times the square of the last ratio: it need not be taken
        ahead = size * np.divide(size, before, out=np.ones_like(size), where=(size < before) & np.isfinite(before)) ** 2
        settled = ahead <= _SETTLED
        last[active[better & settled]] = ahead[better & settled]
        on = (size < _SHRINKS * before) | (size < STABLE) | (iteration < _LOST_AFTER)
        active = active[better & ~settled & on]
        if not active.size:
            break
    return edges, last, np.minimum(attainable, STABLE)
