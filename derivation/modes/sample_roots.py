"""Roots of the boundary equations with two relaxation times, in numbers, from the flows of the modes.

The state that returns after a period is found from what a period makes of states, zone after zone; what a root is, is seen
from the gap and the pressure along the zones. The inequalities of a regime take no part in that.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache

import mpmath
import numpy as np
import sympy as sp

from ..check import Derived
from ..inequality import Inequality, Relation
from ..level import R
from ..sample_roots import ROOTS, allowed, compared, true
from ..sequences import CONTACT, Span
from ..symbols import D, alpha, beta, delta_0, p, p_0, s, s_0
from .flows import ModeFlows, u
from .regimes import ModeRegime, gap_at, gap_slope, pressure_slope
from .states import exact_modes
from .symbols import J_0, J, enter, eta, f_0, leave, z_0

SAMPLES, SLACK, STEP = 48, 1e-9, 1e-7
Edges = dict[sp.Symbol, float]
Place = tuple[Span, float, float, np.ndarray]  # a zone, its ends, the state in which it is entered


class Foundation:
    """A foundation with two modes under a strip: its numbers, and its flows as functions."""

    def __init__(self, flows: ModeFlows, groups: Sequence[str]):
        *times, traction, reach, depth = map(float, groups)
        modes = exact_modes(list(map(mpmath.mpf, times[0::2])), list(map(mpmath.mpf, times[1::2])))
        self.m = {symbol: np.array(value, dtype=float) for symbol, value in modes.items()}
        self.given = {p_0: traction, delta_0: reach, D: depth, J_0: float(self.m[J_0])}
        self.relaxed = sp.lambdify((s, s_0, z_0, p, J, beta), flows.relaxation.value, "numpy")
        self.lagged = sp.lambdify((s, s_0, f_0, alpha, eta), flows.contact.value, "numpy")
        self.profile = sp.lambdify(s, u.subs(D, depth), "numpy")

    def number(self, expression: sp.Expr, edges: Edges | None = None) -> float:
        values = {**self.given, **(edges or {})}
        expression = sp.sympify(expression)
        wanted = tuple(sorted(expression.free_symbols, key=str))
        return float(_function(expression, wanted)(*(values[symbol] for symbol in wanted)))

    def at(self, zone: Span, start: float, state: np.ndarray, phase: float) -> tuple[float, np.ndarray]:
        """(gap, or pressure above -p_0 in contact; z) at a phase of a zone that was entered at ``start`` with z = ``state``."""
        m, load = self.m, self.number(zone.pressure)
        if zone.kind != CONTACT:
            after = self.relaxed(phase, start, state, load, m[J], m[beta])
            return m[J_0] * load + after.sum() - self.profile(phase), after
        overstress = self.lagged(phase, start, -m[enter] @ (state - m[J] * load), m[alpha], m[eta])
        load = self.profile(phase) + overstress.sum()
        return load + self.given[p_0], m[J] * load - m[leave] @ overstress

    def zones(self, regime: ModeRegime, edges: Edges) -> list[Place]:
        """Every zone, its ends and the state in which it is entered, on the orbit that returns."""
        ends = [(edges[zone.first], self.number(zone.last, edges)) for zone in regime.zones]

        def through(state: np.ndarray) -> list[np.ndarray]:
            states = [state]
            for zone, (start, end) in zip(regime.zones, ends, strict=True):
                states.append(self.at(zone, start, states[-1], end)[1])
            return states

        size = len(self.m[J])
        from_rest = through(np.zeros(size))[-1]
        kept = np.column_stack([through(row)[-1] - from_rest for row in np.eye(size)])
        states = through(np.linalg.solve(np.eye(size) - kept, from_rest))
        return [(zone, *span, state) for zone, span, state in zip(regime.zones, ends, states, strict=False)]

    def missed(self, regime: ModeRegime, edges: Edges) -> np.ndarray:
        """What is left of the boundary equations: the onset, then what every zone but the last leaves to its exit."""
        places = self.zones(regime, edges)
        _, start, _, state = places[0]
        onset = self.m[J_0] * self.number(regime.onset_pressure) + state.sum() - self.profile(start)
        left = [onset - self.number(regime.onset_gap)]
        for zone, start, end, state in places[:-1]:
            entered = self.number(zone.entry) - self.at(zone, start, state, start)[0]  # none, if the orbit is one
            left.append(self.at(zone, start, state, end)[0] + entered - self.number(zone.exit))
        return np.array(left)

    def refined(self, regime: ModeRegime, start: Sequence[float]) -> Edges:
        """The root near ``start``, by Newton; raises :class:`ArithmeticError` if there is none."""
        edges = np.array(start)
        named = lambda values: dict(zip(regime.edges, values, strict=True))  # noqa: E731
        for _ in range(30):
            left = self.missed(regime, named(edges))
            moved = [self.missed(regime, named(edges + STEP * row)) for row in np.eye(len(edges))]
            change = np.linalg.solve(np.column_stack([(each - left) / STEP for each in moved]), left)
            edges = edges - change
            if np.abs(change).max() < 1e-11:
                return named(edges)
        raise ArithmeticError(f"no root of {regime.sequence} near {start}")

    def fits(self, regime: ModeRegime, edges: Edges) -> bool:
        """Whether the fields are those of a solution."""
        if not regime.edges:
            return all(low - SLACK <= value <= high + SLACK for value, low, high in self._at_rest(regime))
        places = self.zones(regime, edges)
        if any(end < start for _, start, end, _ in places) or places[-1][2] > places[0][1] + 2 * np.pi + SLACK:
            return False
        if regime.sequence == "afc" and self.given[delta_0] > self.given[J_0] * self.given[p_0]:
            return False
        for zone, start, end, state in places:
            low, high = allowed(zone.kind, self.given[p_0], self.given[delta_0])
            phases = start + (end - start) * (np.arange(SAMPLES) + 0.5) / SAMPLES
            if not all(low - SLACK <= self.at(zone, start, state, phase)[0] <= high + SLACK for phase in phases):
                return False
        return True

    def _at_rest(self, regime: ModeRegime) -> list[tuple[float, float, float]]:
        """Of a regime without edges, what is seen along a period and what is allowed of it."""
        (zone,) = regime.zones
        phases = 2 * np.pi * np.arange(SAMPLES) / SAMPLES
        if zone.kind == CONTACT:
            lagging = [self.lagged(phase, -1e3 * self.m[alpha].max(), 0, self.m[alpha], self.m[eta]).sum() for phase in phases]
            seen = [self.profile(phase) + lag + self.given[p_0] for phase, lag in zip(phases, lagging, strict=True)]
        else:
            seen = [self.number(zone.pressure) - self.profile(phase) for phase in phases]
        return [(value, *allowed(zone.kind, self.given[p_0], self.given[delta_0])) for value in seen]

    def satisfies(self, regime: ModeRegime, inequality: Inequality, edges: Edges) -> bool:
        first, *rest = inequality.relations
        point = {**self.given, **edges, R: abs(1 + (1j * self.m[eta] / (1 + 1j * self.m[alpha])).sum())}
        if not regime.edges:  # a relation, or one if the second holds and the third if not
            return true(first if not rest or true(rest[0], point) else rest[1], point)
        if any(sp.sympify(side).has(gap_at) for side in first.sides):  # for phases in a range, unless
            low, _, high = (self.number(side, {**edges, s: 0.0}) for side in rest[0].sides)
            phases = low + (high - low) * (np.arange(SAMPLES) + 0.5) / SAMPLES
            return any(true(other, point) for other in rest[1:]) or all(
                true(self._seen(first, regime, edges, phase), point) for phase in phases
            )
        return all(true(self._seen(each, regime, edges, 0.0), point) for each in inequality.relations)

    def _seen(self, relation: Relation, regime: ModeRegime, edges: Edges, phase: float) -> Relation:
        """The relation with the gap, and slopes just before an edge, in numbers."""
        places = self.zones(regime, edges)

        def slope(edge: sp.Symbol) -> float:
            zone, start, _, state = next(place for place in places if sp.sympify(place[0].last).has(edge))
            end = self.number(zone.last, edges)
            return (self.at(zone, start, state, end)[0] - self.at(zone, start, state, end - STEP)[0]) / STEP

        def gap(_: sp.Symbol) -> float:
            zone, start, _, state = next(place for place in places if place[0].kind != CONTACT and place[1] <= phase <= place[2])
            return self.at(zone, start, state, phase)[0]

        seen: dict[type, Callable] = {gap_slope: slope, pressure_slope: slope, gap_at: gap}
        sides = []
        for side in map(sp.sympify, relation.sides):
            for function, value in seen.items():
                side = side.replace(function, lambda edge, value=value: sp.Float(value(edge)))
            sides.append(side)
        return Relation(relation.sign, tuple(sides))


@lru_cache
def _function(expression: sp.Expr, symbols: tuple[sp.Symbol, ...]) -> Callable[..., float]:
    return sp.lambdify(symbols, expression, "math")


def sample_roots(regimes: Sequence[ModeRegime], flows: ModeFlows) -> Derived:
    r"""Solutions and roots that are none, :math:`0 < g \le \delta_0,\ p \ge -p_0,\ g > \delta_0`, against the inequalities."""

    def judged(regime: ModeRegime, groups: Sequence[str], start: Sequence[str]) -> tuple[bool, bool]:
        foundation = Foundation(flows, groups)
        edges = foundation.refined(regime, tuple(map(float, start))) if regime.edges else {}
        admitted = all(foundation.satisfies(regime, inequality, edges) for inequality in regime.admissible)
        return foundation.fits(regime, edges), admitted

    return compared(sample_roots, regimes, ROOTS["several_times"], judged)
