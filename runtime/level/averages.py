"""Means of a level over y.

Between the breakpoints of the integrand Clenshaw-Curtis sums on nested nodes converge geometrically (``quadrature``). Some
breakpoints are known beforehand: thresholds in closed form, and curves of the plane of strips that were located at neighbouring
penetrations (``boundaries``, ``crossings``). Where the nodes of one panel disagree about the regime, or about which breaks of the
law below are passed, the change is located, by its equation if there is one (``changes``), and the panel divided there.

All panels of all columns advance together: one batch of strips per round.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING

import numpy as np

from ..numerics.quadrature import interior_nodes, interleaved, mapped, mapped_weights, sum_errors
from ..numerics.rounding import EPS
from ..orbit.regimes import CODE
from .boundaries import hides_another, located, passed_breaks, theta_of, thresholds
from .changes import Changes, locate_changes
from .effort import AVERAGE_LIMIT
from .zones import Zones, zones_of

if TYPE_CHECKING:
    from .strips import LevelBatch

_FIRST, _LAST = 8, 64
#: nodes of a panel in saturated contact, where strips take no search: its sum may as well be exact
_COSTLESS = 32
#: rounds after which a panel is taken as it is, and panels of a state that may wait for one
_ROUNDS, _CROWD = 40, 150
#: a panel's part of what a state may err, and of that what brackets of changes may
_SHARE, _SLIVER = 0.4, 0.03
#: how far from the valley the strip next to it is, in parts of the accuracy; what does not count is asked for to any accuracy
_VALLEY, _ANY = 0.01, 0.1
#: how far from a threshold a strip is that tells of a narrow zone: narrower ones are of no account at any accuracy worth having
_NEXT = 1e-6
#: share of it below which no panel's error is claimed to be: a layer may be too thin to show at its nodes
_LEAST = 1e-5


@dataclass
class Averages:
    """Means over the cell: values and errors, (columns, q); strips evaluated for each column.

    ``zones``: of each column, by the codes met along y."""

    values: np.ndarray
    errors: np.ndarray
    strips: np.ndarray
    zones: list[Zones] = field(default_factory=list)


@dataclass
class _Panels:
    """Panels of ``state`` between thetas; ``first`` and ``last``: the strip known next to each end, -1: none."""

    state: np.ndarray
    low: np.ndarray
    high: np.ndarray
    first: np.ndarray
    last: np.ndarray

    def take(self, index) -> _Panels:
        return _Panels(*(getattr(self, f.name)[index] for f in fields(self)))

    @classmethod
    def joined(cls, some: list[_Panels]) -> _Panels:
        return cls(*(np.concatenate([getattr(p, f.name) for p in some]) for f in fields(cls)))

    @property
    def size(self) -> int:
        return self.state.size

    @property
    def width(self) -> np.ndarray:
        return self.high - self.low


def average(columns: LevelBatch, rtol: np.ndarray) -> Averages:
    """Means ``(1/pi) int_0^pi`` of the strips of every state to ``rtol (|value| + floor)``, ``rtol`` (n,)."""
    n, q = columns.size, columns.scales.size
    work = _Work(columns, rtol, np.zeros((n, q)), np.zeros((n, q)), np.zeros(n, int))
    panels = work.start(*thresholds(columns), *columns.crossings.expected(columns))
    for _ in range(_ROUNDS):
        crowded = (np.bincount(panels.state, minlength=n)[panels.state] > _CROWD) | (work.strips[panels.state] > AVERAGE_LIMIT)
        if crowded.any():
            work.give_up(panels.take(crowded))
            panels = panels.take(~crowded)
        if not panels.size:
            break
        panels = work.refine(panels)
    else:
        work.give_up(panels)
    return Averages(work.values / np.pi, work.errors / np.pi, work.strips, work.zones())


@dataclass
class _Work:
    columns: LevelBatch
    rtol: np.ndarray
    values: np.ndarray
    errors: np.ndarray
    strips: np.ndarray
    accepted: list[tuple] = field(default_factory=list)
    #: states and thetas of strips next to the ends of the first panels; their codes, values, heights and edges
    beside: tuple[np.ndarray, np.ndarray] = (np.empty(0, int), np.empty(0))
    ends: list[np.ndarray] | None = None

    def start(self, state, theta, expected, A) -> _Panels:
        """Panels between thresholds (k,) and expected crossings (m,) of curves. Next to a curve the strips of a third regime
        may be so few that no node meets them: a strip to either side is looked at, as at the crest and next to the valley."""
        n, crossing = self.rtol.size, theta_of(self.columns, A)
        every, none, valley = np.arange(n), np.full(theta.size, -1), self.valley
        aside = np.pi - valley[expected]
        thetas = np.zeros(n), valley, crossing - aside, crossing + aside
        self.beside = np.concatenate((every, every, expected, expected)), np.clip(np.concatenate(thetas), 0.0, np.pi)
        number = np.arange(expected.size) + 2 * n
        state = np.concatenate((state, every, every, expected))
        theta = np.concatenate((theta, np.zeros(n), np.full(n, np.pi), crossing))
        before = np.concatenate((none, np.full(n, -1), every + n, number))
        after = np.concatenate((none, every, np.full(n, -1), number + expected.size))
        order = np.lexsort((theta, state))
        state, theta, before, after = state[order], theta[order], before[order], after[order]
        inside = np.flatnonzero((state[1:] == state[:-1]) & (np.diff(theta) > 64 * EPS * np.pi))
        return _Panels(state[inside], theta[inside], theta[inside + 1], after[inside], before[inside + 1])

    def zones(self) -> list[Zones]:
        """See ``Averages.zones``."""
        return zones_of(self.strips.size, *(np.concatenate(v) for v in zip(*self.accepted, strict=True)))

    @property
    def valley(self) -> np.ndarray:
        """Theta next to the valley of each column: what lies beyond does not matter at its accuracy."""
        return np.pi * (1 - _VALLEY * np.minimum(self.rtol, _ANY))

    def refine(self, panels: _Panels) -> _Panels:
        """Sum up what converges under doubling; return what has to be divided."""
        later, n = [], _FIRST
        fresh = self.ends is None
        known = self._at_nodes(panels, interior_nodes(n))
        if fresh:
            self._look_beside_thresholds(panels, known[0])
        while panels.size:
            mixed = (known[0] != known[0][:, :1]).any(axis=1)
            if n == _FIRST:
                # what is narrower than the first step shows next to the ends
                mixed |= (self._outer(panels, known)[0][:, [0, -1]] != known[0][:, [0, -1]]).any(axis=1)
            if mixed.any():
                later.append(self._divide(panels.take(mixed), *(v[mixed] for v in known), n))
                panels, known = panels.take(~mixed), [v[~mixed] for v in known]
            done = self._accept(panels, known[0], known[1], n)
            panels, known = panels.take(~done), [v[~done] for v in known]
            if n == _LAST or not panels.size:
                break
            n *= 2
            new = self._at_nodes(panels, interior_nodes(n)[0::2])
            known = [interleaved(a, b) for a, b in zip(new, known, strict=True)]
        middle = 0.5 * (panels.low + panels.high)
        none = np.full(panels.size, -1)
        later.append(_Panels(panels.state, panels.low, middle, panels.first, none))
        later.append(_Panels(panels.state, middle, panels.high, none, panels.last))
        return _Panels.joined(later)

    def _keep(self, panels: _Panels, codes, values, sums) -> None:
        """Of ``panels`` what their zones are told from."""
        self.accepted.append((panels.state, codes[:, 0], panels.low, panels.high, values[:, 0], values[:, -1], sums))

    def give_up(self, panels: _Panels) -> None:
        """Take panels that do not converge as they are, with the spread of their values as error."""
        codes, values, *_ = self._at_nodes(panels, interior_nodes(_FIRST))
        sums = panels.width[:, None] * (mapped_weights(_FIRST) @ values)
        self._keep(panels, codes, values, sums)
        np.add.at(self.values, panels.state, sums)
        width = panels.width[:, None]
        np.add.at(self.errors, panels.state, width * (values.max(axis=1) - values.min(axis=1)))

    def _at_nodes(self, panels: _Panels, t):
        """``Evaluated`` at the parameters ``t``, (panels, nodes, ...)."""
        theta = panels.low[:, None] + panels.width[:, None] * mapped(t)
        answers = self._evaluated(np.repeat(panels.state, t.size), theta.ravel())
        return tuple(answer.reshape(panels.size, t.size, *answer.shape[1:]) for answer in answers)

    def _evaluated(self, state, theta) -> list[np.ndarray]:
        """Codes, values, heights and edges of strips (m,); with them those next to the ends of panels that are not known yet."""
        m = theta.size
        known = 0 if self.ends is None else self.ends[0].size
        state, theta = (np.concatenate((v, beside[known:])) for v, beside in zip((state, theta), self.beside, strict=True))
        np.add.at(self.strips, state, 1)
        answers = self.columns.evaluate(state, theta)
        fresh = [v[m:] for v in answers]
        self.ends = fresh if self.ends is None else [np.concatenate(pair) for pair in zip(self.ends, fresh, strict=True)]
        return [v[:m] for v in answers]

    def _next_to(self, state, theta) -> np.ndarray:
        """Numbers (2, k) of strips next to the places ``theta`` (k,), on both sides: they are solved with whatever is next."""
        aside = np.pi - self.valley[state]
        places = np.tile(state, 2), np.clip(np.concatenate((theta - aside, theta + aside)), 0.0, np.pi)
        number = self.beside[1].size + np.arange(2 * theta.size).reshape(2, -1)
        self.beside = tuple(np.concatenate(pair) for pair in zip(self.beside, places, strict=True))
        return number

    def _look_beside_thresholds(self, panels: _Panels, codes) -> None:
        """Strips to either side of thresholds where the ``codes`` of the panels that meet do not follow one another: a third
        zone may be narrower than the first step."""
        order = np.lexsort((panels.low, panels.state))
        left, right = order[:-1], order[1:]
        unknown = (panels.last[left] < 0) & (panels.first[right] < 0) & (panels.high[left] == panels.low[right])
        doubtful = unknown & (panels.state[left] == panels.state[right]) & hides_another(codes[left, -1], codes[right, 0])
        left, right = left[doubtful], right[doubtful]
        if not left.size:
            return
        state = panels.state[left]
        aside = np.minimum(np.pi - self.valley, _NEXT)[state]
        places = np.tile(state, 2), np.concatenate((panels.high[left] - aside, panels.low[right] + aside))
        panels.last[left], panels.first[right] = self.beside[1].size + np.arange(2 * left.size).reshape(2, -1)
        self.beside = tuple(np.concatenate(pair) for pair in zip(self.beside, places, strict=True))
        self._evaluated(np.empty(0, int), np.empty(0))

    def _outer(self, panels: _Panels, known) -> tuple[np.ndarray, ...]:
        """What is ``known`` at the first nodes of panels, and their thetas, with one more at either end: what is known beyond the
        outermost node, where nothing is what is known there."""
        theta = panels.low[:, None] + panels.width[:, None] * mapped(interior_nodes(_FIRST))
        number, outermost = np.stack((panels.first, panels.last), axis=1), theta[:, [0, -1]]
        place = self.beside[1][number]
        beyond = (number >= 0) & (np.stack((outermost[:, 0] - place[:, 0], place[:, 1] - outermost[:, 1]), axis=1) > 0)
        out = []
        for inner, ends in zip((*known, theta), (*self.ends, self.beside[1]), strict=True):
            outer = inner[:, [0, -1]]
            outer[beyond] = ends[number[beyond]]
            out.append(np.concatenate((outer[:, :1], inner, outer[:, 1:]), axis=1))
        return tuple(out)

    def _by_equation(self, state, changes: Changes) -> tuple[np.ndarray, np.ndarray]:
        """Thetas of the changes between the ends of brackets, where equations tell all of them."""
        each, parent = passed_breaks(changes)
        columns, level = self.columns.at(state[parent], self.columns.D[state[parent]]), self.columns.level
        theta = np.stack((each.low, each.high), axis=1)
        E = np.broadcast_to((columns.D - level.h)[:, None], theta.shape)
        A, found = located(columns, each, level.amplitude(theta), E, "A")
        told = np.bincount(parent[~found], minlength=changes.size)[parent] == 0
        return parent[told], theta_of(columns, A[told])

    def _accept(self, panels: _Panels, codes, values, n) -> np.ndarray:
        width = panels.width[:, None]
        sums = width * (mapped_weights(n) @ values)
        rounding = 4 * EPS * width * np.abs(values).max(axis=1, initial=0.0)
        floors = self.columns.floors
        noise = 0.1 * (self.rtol[:, None] * floors)[panels.state]
        error = width * sum_errors(values, noise) + rounding
        # what is not accepted yet counts for the size of the result, not for the result
        total = self.values.copy()
        np.add.at(total, panels.state, sums)
        goal = (self.rtol[:, None] * (np.abs(total) + np.pi * floors))[panels.state]
        done = (error <= _SHARE * goal + 2 * rounding).all(axis=1)
        if n < _COSTLESS and not self.columns.asked.frictional:
            done &= codes[:, 0] % len(CODE) != CODE["c"]
        self._keep(panels.take(done), codes[done], values[done], sums[done])
        np.add.at(self.values, panels.state[done], sums[done])
        np.add.at(self.errors, panels.state[done], (error + _LEAST * goal * (error > 0))[done])
        return done

    def _divide(self, panels: _Panels, codes, values, heights, edges, n) -> _Panels:
        """Locate the changes between neighbouring nodes; panels end there."""
        if n == _FIRST:
            codes, values, heights, edges, theta = self._outer(panels, (codes, values, heights, edges))
        else:
            theta = panels.low[:, None] + panels.width[:, None] * mapped(interior_nodes(n))
        row, node = np.nonzero(codes[:, 1:] != codes[:, :-1])
        pair = lambda x: np.stack((x[row, node], x[row, node + 1]), axis=1)  # noqa: E731
        ends = pair(theta)
        changes = Changes(row, ends[:, 0].copy(), ends[:, 1].copy(), pair(codes), pair(heights), pair(edges), pair(values))
        total = np.abs(self.values) + np.pi * self.columns.floors
        np.add.at(total, panels.state, panels.width[:, None] * np.abs(values).mean(axis=1))
        state = panels.state[row]
        goal = _SLIVER * _SHARE * self.rtol[state, None] * total[state]
        spread = (values.max(axis=1) - values.min(axis=1))[row]
        width = np.min(np.divide(goal, spread, out=np.full_like(goal, np.pi), where=spread > goal / np.pi), axis=1)

        def probe(line, x):
            code, value, height, edge = self._evaluated(panels.state[line], x)
            return code, height, edge, value

        def equation(changes):
            return self._by_equation(panels.state[changes.line], changes)

        found, halved = locate_changes(probe, equation, changes, width, lambda some: np.zeros(some.size, bool))
        self.columns.work.bisected += halved
        # next to what an equation tells a third zone may be too narrow for nodes
        doubtful = np.flatnonzero((found.low == found.high) & hides_another(*found.codes.T))
        before, after = np.full((2, found.size), -1)
        before[doubtful], after[doubtful] = self._next_to(panels.state[found.line[doubtful]], found.low[doubtful])
        state, sliver = panels.state[found.line], (found.high - found.low)[:, None]
        np.add.at(self.values, state, 0.5 * sliver * found.values.sum(axis=1))
        np.add.at(self.errors, state, 0.5 * sliver * np.abs(found.values[:, 1] - found.values[:, 0]))
        # the parts between the brackets, and the outermost ones
        every = np.arange(panels.size)
        starts, first = np.concatenate((panels.low, found.high)), np.concatenate((panels.first, after))
        stops, last = np.concatenate((found.low, panels.high)), np.concatenate((before, panels.last))
        order_start = np.lexsort((starts, np.concatenate((every, found.line))))
        order_stop = np.lexsort((stops, np.concatenate((found.line, every))))
        line = np.concatenate((every, found.line))[order_start]
        parts = _Panels(panels.state[line], starts[order_start], stops[order_stop], first[order_start], last[order_stop])
        return parts.take(parts.width > 0)
