"""Means of a level over y at given penetrations: adaptive panels, or the paper's equal strips.

Between the breakpoints of the integrand Clenshaw-Curtis sums on nested nodes converge geometrically (``quadrature``). Some
breakpoints are known beforehand: thresholds in closed form, and curves of the plane of strips that were located at neighbouring
penetrations (``regime_map``). Where the nodes of one panel disagree about the regime, or about which breaks of the
law below are passed, the change is located, by its equation if there is one (``changes``), and the panel divided there.

All panels of all columns advance together, each on its own number of nodes: one batch of strips per round.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ..numerics.quadrature import Stage, interior_nodes, mapped, mapped_weights, sampled, sum_errors
from ..numerics.rounding import EPS
from ..orbit.batch import Ranges
from ..orbit.foundation import foundation_of
from ..orbit.regimes import CODE
from .breaks import Zones, zones_along_y
from .changes import Changes, locate_changes
from .nonadhesive.average import family_means
from .regime_map import by_equation, hides_another, known_breaks
from .strips import AVERAGE_LIMIT, LevelBatch

#: nodes of a panel at first and at most, and one more; and in saturated contact, where strips take no search: as good as exact
_FIRST, _LAST, _COSTLESS = 8, 64, 32
#: a panel's part of what a state may err, and of that what brackets of changes may
_SHARE, _SLIVER = 0.4, 0.03
#: how far from the valley the strip next to it is, in parts of the accuracy, relative to natural scales, at least and at most
_VALLEY, _NEAREST, _FARTHEST = 10.0, 1e-14, 1e-3
#: how far from a known break strips are that detect a narrow zone, in the same way: narrower ones do not affect the result
_NEXT, _CLOSEST = 0.3, 1e-6
#: how far below a penetration, in heights, it is looked for islands, about, and how roughly
_BELOW, _ROUGH = (0.003, 0.02, 0.1), 1e-2
#: smallest error claimed for a panel, as a share of its tolerance: a layer may be too thin to show at its nodes
_LEAST = 1e-6
#: an outermost value less than this of the next one vanishes at that end; what panels miss of a layer there is up to 4.5 times
#: ``x T (T/W)^2/2 pi``, less where a zone is less than five memories long (600 panels)
_VANISHES, _LAYER, _MEMORIES = 0.4, 4.5, 5.0


@dataclass
class Averages:
    """Means over the cell: values and errors, (columns, q); of each column the strips evaluated, and its ``zones`` along y."""

    values: np.ndarray
    errors: np.ndarray
    strips: np.ndarray
    zones: list[Zones] = field(default_factory=list)


def level_means(columns: LevelBatch, rtol: np.ndarray, atol: np.ndarray | None = None) -> Averages:
    """Means of ``strips.QUANTITIES`` for every column, to ``rtol |value| + atol`` each; ``rtol`` of shape (n,), ``atol`` (n, q),
    or what goes with it (``LevelBatch.atol``)."""
    if columns.strips is not None:
        return equal_strips(columns)
    atol = columns.atol(rtol) if atol is None else atol
    if columns.family is None:
        return average(columns, rtol, atol)
    return Averages(*family_means(columns, rtol, atol), np.zeros(columns.size, int))


def look_below(columns: LevelBatch) -> None:
    """Locate the curves that divide the strips of ``columns`` from a little below, and their turns: as a level is drawn out
    islands of strips that let go appear, too narrow for nodes at first. A look serves all that lie about as far above it."""
    looks: dict[tuple[float, float], int] = {}
    for below in _BELOW if columns.adhesion.p_0 > 0 and columns.strips is None and columns.level.h > 0 else ():
        cell = below * columns.level.h
        seen = {(V, D // cell) for V, D in looks}
        places = enumerate(zip(columns.V.tolist(), (columns.D // cell - 1).tolist(), strict=True))
        looks |= {(V, (k + 0.5) * cell): i for i, (V, k) in places if (V, k) not in seen}
    if looks:
        level_means(columns.at([*looks.values()], np.array([D for _, D in looks])), np.full(len(looks), _ROUGH))
        columns.crossings.turned(columns)


def equal_strips(columns: LevelBatch) -> Averages:
    """The paper's average over ``2 N`` equal strips of the cell (Eq. 11): midpoints; the halves are mirror images.

    The error estimate is the sum of the two largest differences between neighbours over N: so much jumps of the integrand at both
    ends of a zone may shift the sum by, and kinks less. The crest and the valley are neighbours that do not count for the sum.
    """
    theta = np.pi * np.concatenate(([0.0], (np.arange(columns.strips) + 0.5) / columns.strips, [1.0]))
    column = np.repeat(np.arange(columns.size), theta.size)
    around = columns.evaluate(column, np.tile(theta, columns.size))[1].reshape(columns.size, theta.size, -1)
    values = around[:, 1:-1]
    mean = values.mean(axis=1)
    errors = np.sort(np.abs(np.diff(around, axis=1)), axis=1)[:, -2:].sum(axis=1) / columns.strips
    # no transitions are looked for: one zone for all that is known
    zones = [Zones(np.zeros(1), np.zeros(1), np.full(1, np.pi), *np.zeros((3, 1, mean.shape[1])))] * columns.size
    return Averages(mean, errors, np.full(columns.size, theta.size), zones=zones)


def average(columns: LevelBatch, rtol: np.ndarray, atol: np.ndarray) -> Averages:
    """Means ``(1/pi) int_0^pi`` of the strips of every state to ``rtol |value| + atol``, ``rtol`` (n,) and ``atol`` (n, q)."""
    n, q = columns.size, columns.scales.size
    share = (np.where(atol > 0, atol, np.inf) / columns.scales).min(axis=1)
    work = _Work(columns, rtol, atol, share, np.zeros((n, q)), np.zeros((n, q)), np.zeros(n, int))
    stages = [Stage(work.start(*known_breaks(columns)), _FIRST)]
    while stages:
        stages = work.refine(stages)
    zones = zones_along_y(n, *(np.concatenate(v) for v in zip(*work.accepted, strict=True)))
    return Averages(work.values / np.pi, work.errors / np.pi, work.strips, zones)


@dataclass
class Panels(Ranges):
    """Panels of ``state`` between thetas; ``first`` and ``last``: the strip known next to each end, -1: none."""

    state: np.ndarray
    first: np.ndarray
    last: np.ndarray

    @classmethod
    def between(cls, *ends: tuple[np.ndarray, np.ndarray, np.ndarray]) -> Panels:
        """Panels from each start to the next stop; ``ends``: states, thetas and strips beside them, of starts, then of stops."""
        (state, low, first), (_, high, last) = ([v[np.lexsort((each[1], each[0]))] for v in each] for each in ends)
        return cls(low, high, state, first, last)

    def split(self, middle: np.ndarray) -> Panels:
        """Parts of each below and above the ``middle`` (m,): all lower ones, then all upper ones."""
        none = np.full(self.size, -1)
        return Panels.joined([replace(self, high=middle, last=none), replace(self, low=middle, first=none)])

    def at(self, t: np.ndarray) -> np.ndarray:
        """Thetas at the parameters ``t`` of every panel, (panels, t)."""
        return self.evenly(mapped(t))

    def sums(self, values: np.ndarray) -> np.ndarray:
        """Integrals (panels, q) of what has the ``values`` (panels, n - 1, q) at the interior ones of n nodes."""
        return self.width[:, None] * (mapped_weights(values.shape[1] + 1) @ values)


@dataclass
class _Work:
    columns: LevelBatch
    rtol: np.ndarray
    atol: np.ndarray
    #: the least that a quantity may err by, relative to natural scales
    share: np.ndarray
    values: np.ndarray
    errors: np.ndarray
    strips: np.ndarray
    accepted: list[list[np.ndarray]] = field(default_factory=list)
    #: states and thetas of strips next to the ends of panels; and of those solved codes, values, pressures over breaks and edges
    beside: tuple[np.ndarray, np.ndarray] = (np.empty(0, int), np.empty(0))
    ends: list[np.ndarray] | None = None

    def start(self, state: np.ndarray, theta: np.ndarray) -> Panels:
        """Panels between the breaks (k,) that are known. Strips are looked at beside each, at the crest and next to the valley:
        of a third regime there may be so few that no node meets them."""
        n, every = self.rtol.size, np.arange(self.rtol.size)
        # what lies beyond the last strip before the valley does not matter at a column's accuracy
        near_valley = np.pi * (1 - np.clip(_VALLEY * self.share, _NEAREST, _FARTHEST))
        crest, valley = self._later(every, np.zeros(n)), self._later(every, near_valley)
        before, after = self._beside(state, theta)
        state = np.concatenate((state, every))
        starts = state, np.concatenate((theta, np.zeros(n))), np.concatenate((after, crest))
        panels = Panels.between(starts, (state, np.concatenate((theta, np.full(n, np.pi))), np.concatenate((before, valley))))
        return panels.take(panels.width > 64 * EPS * np.pi)

    def refine(self, stages: list[Stage]) -> list[Stage]:
        """Sum up what converges under doubling; return what is left, divided where regimes change."""
        stages = sampled(stages, Panels.at, lambda panels, theta: self._evaluated(panels.state, theta))
        # what is not accepted yet counts for the size of the result, not for the result
        total = self.values.copy()
        for stage in stages:
            np.add.at(total, stage.parts.state, stage.parts.sums(stage.known[1]))
        goal = self.rtol[:, None] * np.abs(total) + np.pi * self.atol
        mixed, doubled, parts = [], [], []
        for stage in stages:
            codes, *_ = known = self._outer(stage)
            changed = (codes != codes[:, :1]).any(axis=1)
            done = self._accept(stage, goal, ~changed)
            left = changed & ~done
            mixed.append((stage.parts.take(left), [v[left] for v in known]))
            stage = stage.take(~changed & ~done)
            middle = self._middle(stage)
            parted = ~np.isnan(middle)
            doubled.append(stage.take(~parted))
            parts.append(stage.parts.take(parted).split(middle[parted]))
        left = [Stage(Panels.joined([self._divide(mixed, goal), *parts]), _FIRST), *doubled]
        return [stage for stage in left if stage.parts.size]

    def _middle(self, stage: Stage) -> np.ndarray:
        """Where panels (m,) are to be divided that twice the first nodes are not enough for; NaN: more nodes may do."""
        panels = stage.parts
        if stage.n == _FIRST:
            return np.full(panels.size, np.nan)
        theta = panels.at(interior_nodes(_FIRST))
        state = np.repeat(panels.state, theta.shape[1])
        kinks = self.columns.at(state, self.columns.D[state]).kinks(theta.ravel(), theta)
        return np.where(np.isnan(kinks) & (stage.n >= _LAST), 0.5 * (panels.low + panels.high), kinks)

    def _accept(self, stage: Stage, goal: np.ndarray, usable: np.ndarray) -> np.ndarray:
        """Add up the ``usable`` panels (m,) whose sums have converged, and with the spread of their values as error those of
        states with too many strips and others so narrow that it is of no account; which they were, (m,)."""
        panels, (codes, values, *_) = stage.parts, stage.known
        sums = panels.sums(values)
        width, state = panels.width[:, None], panels.state
        rounding = 4 * EPS * width * np.abs(values).max(axis=1, initial=0.0)
        # fractions may be layers next to where a zone ends, across which pressure, K mean(w), and friction go on smoothly
        error = width * (sum_errors(values, 0.1 * self.atol[state], self.columns.fractions) + self._layers(stage)) + rounding
        goal = goal[state]
        done = usable & (error <= _SHARE * goal + 2 * rounding).all(axis=1)
        if stage.n < _COSTLESS:
            # laws, whose fractions hardly count, are no more accurate than they have to be
            done &= (codes[:, 0] % len(CODE) != CODE["c"]) | (self.atol[state, 2] >= self.rtol[state])
        spread = width * np.ptp(values, axis=1)
        narrow = ~usable & (width[:, 0] < _CLOSEST) & (spread <= _SLIVER * _SHARE * goal).all(axis=1)
        ended = narrow | (~done & (self.strips[state] > AVERAGE_LIMIT))
        error[ended] = spread[ended]
        done |= ended
        known = state, codes[:, 0], panels.low, panels.high, values[:, 0], values[:, -1], sums
        self.accepted.append([v[done] for v in known])
        np.add.at(self.values, state[done], sums[done])
        np.add.at(self.errors, state[done], (error + _LEAST * goal * (error > 0))[done])
        return done

    def _layers(self, stage: Stage) -> np.ndarray:
        """What sums of fractions miss of layers next to ends of panels where contact or adhesion vanishes, per width, (p, q).

        A zone sets in like a square root of the distance, as on a glassy foundation while short against a memory T, later as on a
        relaxed one. If it is W > T long (phases) at the outermost node, a share x of the panel away, the layer is x (T/W)^2 wide.
        """
        columns, times, values = self.columns, foundation_of(self.columns.material).times, stage.known[1][:, :, 2:4]
        W = 2 * np.pi * np.where(values[:, [0, -1]] < _VANISHES * values[:, [1, -2]], values[:, [0, -1]], 0.0)
        T = np.outer(columns.level.k * np.ravel(times), columns.V[stage.parts.state])[..., None, None]
        T = np.where(T < W, T, 0.0)
        missed = (T**3 / np.maximum(W, _MEMORIES * T + EPS) ** 2).sum(axis=(0, 2, 3))
        return _LAYER / (2 * np.pi) * mapped(interior_nodes(stage.n)[0]) * missed[:, None] * columns.fractions

    def _evaluated(self, state, theta) -> list[np.ndarray]:
        """Codes, values, pressures over breaks and edges of strips (m,); with them all that ``_later`` numbered are solved."""
        m = theta.size
        known = 0 if self.ends is None else self.ends[0].size
        state, theta = (np.concatenate((v, beside[known:])) for v, beside in zip((state, theta), self.beside, strict=True))
        np.add.at(self.strips, state, 1)
        answers = self.columns.evaluate(state, theta)
        fresh = [v[m:] for v in answers]
        self.ends = fresh if self.ends is None else [np.concatenate(pair) for pair in zip(self.ends, fresh, strict=True)]
        return [v[:m] for v in answers]

    def _later(self, state, theta) -> np.ndarray:
        """Numbers (k,) of strips at ``theta`` (k,) that are solved with whatever is next."""
        number = self.beside[1].size + np.arange(theta.size)
        self.beside = tuple(np.concatenate(pair) for pair in zip(self.beside, (state, theta), strict=True))
        return number

    def _beside(self, state, theta) -> tuple[np.ndarray, np.ndarray]:
        """``_later`` on both sides of the places ``theta`` (k,)."""
        near = np.clip(_NEXT * self.share[state], _CLOSEST, _FARTHEST)
        return self._later(state, np.maximum(theta - near, 0.0)), self._later(state, np.minimum(theta + near, np.pi))

    def _outer(self, stage: Stage) -> tuple[np.ndarray, ...]:
        """What is known at the nodes of panels, and their thetas, with one more at either end: the strip known beyond the
        outermost node, or that node again where there is none."""
        panels, theta = stage.parts, stage.parts.at(interior_nodes(stage.n))
        number, outermost = np.stack((panels.first, panels.last), axis=1), theta[:, [0, -1]]
        place = self.beside[1][number]
        beyond = (number >= 0) & (np.stack((outermost[:, 0] - place[:, 0], place[:, 1] - outermost[:, 1]), axis=1) > 0)
        out = []
        for inner, ends in zip((*stage.known, theta), (*self.ends, self.beside[1]), strict=True):
            outer = inner[:, [0, -1]]
            outer[beyond] = ends[number[beyond]]
            out.append(np.concatenate((outer[:, :1], inner, outer[:, 1:]), axis=1))
        return tuple(out)

    def _divide(self, mixed: list[tuple[Panels, list[np.ndarray]]], goal: np.ndarray) -> Panels:
        """Locate the changes between neighbouring nodes of panels, of which ``_outer`` is known; panels end there."""
        panels, brackets, spreads, before = Panels.joined([parts for parts, _ in mixed]), [], [], 0
        for parts, (*known, theta) in mixed:
            some, row, _ = Changes.between(before + np.arange(parts.size), theta, known)
            brackets.append(some)
            spreads.append(np.ptp(known[1], axis=1)[row])
            before += parts.size
        changes, spread = Changes.joined(brackets), np.concatenate(spreads)
        if not changes.size:
            return panels
        state = panels.state[changes.line]
        goal = _SLIVER * _SHARE * goal[state]
        width = np.min(np.divide(goal, spread, out=np.full_like(goal, np.pi), where=spread > goal / np.pi), axis=1)

        def probe(line, x):
            return self._evaluated(panels.state[line], x)

        def equation(changes):
            at = panels.state[changes.line]
            parent, theta = by_equation(self.columns.at(at, self.columns.D[at]), changes, "A")
            return parent, theta, np.zeros(parent.size, bool)

        found, halved = locate_changes(probe, equation, changes, width)
        self.columns.work.bisected += halved
        # next to what an equation tells a third zone may be too narrow for nodes
        doubtful = np.flatnonzero((found.low == found.high) & hides_another(*found.codes.T))
        before, after = np.full((2, found.size), -1)
        before[doubtful], after[doubtful] = self._beside(panels.state[found.line[doubtful]], found.low[doubtful])
        state, sliver = panels.state[found.line], found.width[:, None]
        np.add.at(self.values, state, 0.5 * sliver * found.values.sum(axis=1))
        np.add.at(self.errors, state, 0.5 * sliver * np.abs(found.values[:, 1] - found.values[:, 0]))
        # the parts between the brackets, and the outermost ones
        every = np.arange(panels.size)
        starts = (every, found.line), (panels.low, found.high), (panels.first, after)
        stops = (found.line, every), (found.low, panels.high), (before, panels.last)
        parts = Panels.between(*([np.concatenate(pair) for pair in ends] for ends in (starts, stops)))
        parts.state = panels.state[parts.state]
        return parts.take(parts.width > 0)
