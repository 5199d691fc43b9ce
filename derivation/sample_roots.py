"""Roots of the boundary equations, in numbers: the inequalities of a regime say of each whether it is a solution.

Whether a root is a solution is seen from the fields alone: in adhesion the gap must stay in (0, delta_0], beyond it
above delta_0, in contact the pressure must not fall below -p_0, and the edges must follow one another. The fields are
the derived flows of the modes between the edges, sampled; with one relaxation time there is one mode. The state that
returns after a period is found from what a period makes of states, zone after zone. The inequalities take no part in
that. Every inequality is needed by a root that is a solution (reversed, it would refuse it), and roots that are none are
refused. The roots of ``sample_roots.toml`` were found once from random starts.
"""

import tomllib
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import mpmath
import numpy as np
import sympy as sp

from .check import Derived, derived, holds
from .functions import evaluator
from .level import R
from .modes.flows import ModeFlows, u
from .modes.regimes import gap_at, gap_slope, pressure_slope
from .modes.states import exact_modes
from .modes.symbols import J_0, J, enter, eta, f_0, leave, z_0
from .regime import turn
from .sequences import ADHESION, CONTACT, Inequality, Relation, Row, Span
from .symbols import PARAMETERS, D, alpha, beta, chi, delta_0, p, p_0, s, s_0

SAMPLES, SLACK, STEP = 48, 1e-9, 1e-7
LEFT = 1e-11  # of the boundary equations at a root, at most
ROOTS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
Numbers = dict[sp.Symbol, float]
Place = tuple[Span, float, float, np.ndarray]  # a zone, its ends, the state in which it is entered


def sample_roots(kind: str, regimes: Sequence[Row], flows: ModeFlows) -> Derived:
    r"""At roots of the boundary equations in numbers, solutions and others, inequalities say what the fields show.

    .. math:: \text{inequalities} \iff 0 < g \le \delta_0\ \text{in adhesion},\quad g > \delta_0\ \text{beyond},\quad
        p \ge -p_0\ \text{in contact}

    ``kind``: of one time or of several.
    """
    checks = []
    for regime in regimes:
        for number, (times, strip, found, solution) in enumerate(ROOTS[kind][regime.sequence], start=1):
            foundation = Foundation(flows, list(map(float, times)), list(map(float, strip)))
            edges = dict(zip(regime.edges, map(float, found), strict=True))
            admitted = all(foundation.satisfies(regime, inequality, edges) for inequality in regime.admissible)
            root, shown = f"{regime.sequence}, root {number}", "a solution" if solution else "no solution"
            checks.append(holds(f"{root}: the boundary equations hold", foundation.missed(regime, edges) < LEFT))
            checks.append(holds(f"{root}: the fields show {shown}", foundation.fits(regime, edges) is solution))
            checks.append(holds(f"{root}: so do the inequalities", admitted is solution))
    return derived(sample_roots, None, checks, "inequalities of admissibility")


class Foundation:
    """A foundation under a strip: its numbers, and its flows as functions. ``strip``: p_0, delta_0, D, chi."""

    def __init__(self, flows: ModeFlows, times: Sequence[float], strip: Sequence[float]):
        fast, slow, *_ = times  # of one time, all there are
        given = dict(zip(PARAMETERS, (fast, slow, fast / slow, 1 - fast / slow, *strip), strict=True))
        modes = exact_modes(*([mpmath.mpf(time) for time in alternate] for alternate in (times[0::2], times[1::2])))
        self.m = {symbol: np.array(value, dtype=float) for symbol, value in modes.items()}
        ratio = abs(1 + (1j * self.m[eta] / (1 + 1j * self.m[alpha])).sum())
        self.given = {**given, J_0: float(self.m[J_0]), R: float(ratio)}
        self.relaxed = sp.lambdify((s, s_0, z_0, p, J, beta), flows.relaxation.value, "numpy")
        self.lagged = sp.lambdify((s, s_0, f_0, alpha, eta), flows.contact.value, "numpy")
        self.profile = sp.lambdify(s, u.subs(D, given[D]), "numpy")

    def number(self, expression: sp.Expr, more: Numbers | None = None) -> float:
        symbols, evaluate = evaluator(expression, "math")
        values = {**self.given, **(more or {})}
        return float(evaluate(*(values[symbol] for symbol in symbols)))

    def at(self, zone: Span, start: float, state: np.ndarray, phase: float) -> tuple[float, np.ndarray]:
        """(gap, or pressure above -p_0 in contact; z) at a phase of a zone that was entered at ``start`` with z = ``state``."""
        m, load = self.m, self.number(zone.pressure)
        if zone.kind != CONTACT:
            after = self.relaxed(phase, start, state, load, m[J], m[beta])
            return m[J_0] * load + after.sum() - self.profile(phase), after
        overstress = self.lagged(phase, start, -m[enter] @ (state - m[J] * load), m[alpha], m[eta])
        load = self.profile(phase) + overstress.sum()
        return load + self.given[p_0], m[J] * load - m[leave] @ overstress

    def zones(self, regime: Row, edges: Numbers) -> list[Place]:
        """Every zone, its ends and the state in which it is entered, on the orbit that returns; none without edges."""
        if not regime.edges:
            return []
        ends = [(edges[zone.first], self.number(zone.last, edges)) for zone in regime.zones]
        # [z] = [w] - J_0 [p], with [w] = chi J_0 [p]
        steps = [
            (self.given[chi] - 1) * self.m[J_0] * self.number(after.pressure - before.fields(before.last, before.exit)[1])
            for before, after in pairwise([*regime.zones, regime.zones[0]])
        ]

        def through(state: np.ndarray) -> list[np.ndarray]:
            states = [state]
            for zone, (start, end), step in zip(regime.zones, ends, steps, strict=True):
                states.append(self.at(zone, start, states[-1], end)[1] + step)
            return states

        size = len(self.m[J])
        from_rest = through(np.zeros(size))[-1]
        kept = np.column_stack([through(row)[-1] - from_rest for row in np.eye(size)])
        states = through(np.linalg.solve(np.eye(size) - kept, from_rest))
        return [(zone, *span, state) for zone, span, state in zip(regime.zones, ends, states, strict=False)]

    def missed(self, regime: Row, edges: Numbers) -> float:
        """What is left of the boundary equations: what every zone leaves to its exit."""
        places = self.zones(regime, edges)
        left = (self.at(zone, start, state, end)[0] - self.number(zone.exit) for zone, start, end, state in places)
        return max(map(abs, left), default=0.0)

    def fits(self, regime: Row, edges: Numbers) -> bool:
        """Whether the fields are those of a solution."""
        if not regime.edges:
            return self._within(regime.zones[0], self._at_rest(regime.zones[0]))
        places = self.zones(regime, edges)
        if any(end < start for _, start, end, _ in places):
            return False
        if regime.sequence == "afc" and (self.given[chi] != 1 or self.given[delta_0] > self.given[J_0] * self.given[p_0]):
            return False
        return all(
            self._within(zone, [self.at(zone, start, state, phase)[0] for phase in _inside(start, end)])
            for zone, start, end, state in places
        )

    def _within(self, zone: Span, seen: Sequence[float]) -> bool:
        """Whether the gap, in contact the pressure above -p_0, is as it must be; without traction the reach plays no part."""
        low, high = 0.0, np.inf
        if zone.kind != CONTACT and self.given[p_0] > 0:
            low, high = (0.0, self.given[delta_0]) if zone.kind == ADHESION else (self.given[delta_0], np.inf)
        return all(low - SLACK <= value <= high + SLACK for value in seen)

    def _at_rest(self, zone: Span) -> list[float]:
        """What is seen along a period of a regime without edges."""
        phases = 2 * np.pi * np.arange(SAMPLES) / SAMPLES
        if zone.kind != CONTACT:
            return [self.number(zone.pressure) - self.profile(phase) for phase in phases]
        lagging = [self.lagged(phase, -1e3 * self.m[alpha].max(), 0, self.m[alpha], self.m[eta]).sum() for phase in phases]
        return [self.profile(phase) + lag + self.given[p_0] for phase, lag in zip(phases, lagging, strict=True)]

    def satisfies(self, regime: Row, inequality: Inequality, edges: Numbers) -> bool:
        places = self.zones(regime, edges)
        first, *rest = inequality.relations
        if rest and any(side.has(s) for side in rest[0].sides):  # for phases where the second holds, unless the third
            _, start, end, _ = next(place for place in places if place[0].kind == ADHESION)
            held = [(phase, self._true(rest[0], {**edges, s: phase}, places)) for phase in _inside(start, end, 4 * SAMPLES)]
            phases = [phase for phase, holding in held if holding]
            if any(side.has(turn) for side in first.sides):  # at the end of every arc of them
                phases = [phase for (phase, now), (_, after) in pairwise([*held, (end, False)]) if now and not after]
            return any(self._true(other, edges, places) for other in rest[1:]) or all(
                self._true(first, {**edges, s: phase, turn: phase}, places) for phase in phases
            )
        if len(rest) == 2:  # the first if the second, else the third
            return self._true(first if self._true(rest[0], edges, places) else rest[1], edges, places)
        return all(self._true(relation, edges, places) for relation in inequality.relations)

    def _true(self, relation: Relation, point: Numbers, places: Sequence[Place]) -> bool:
        compare = {"<=": np.less_equal, ">=": np.greater_equal, "<": np.less, ">": np.greater, "==": np.equal}[relation.sign]
        return all(compare(a, b) for a, b in pairwise(self._seen(side, point, places) for side in relation.sides))

    def _seen(self, side: sp.Expr, point: Numbers, places: Sequence[Place]) -> float:
        """A side in numbers: the gap at the phase s, and slopes just before an edge, from the fields."""

        def slope(edge: sp.Symbol) -> float:
            zone, start, end, state = next(place for place in places if sp.sympify(place[0].last).has(edge))
            return (self.at(zone, start, state, end)[0] - self.at(zone, start, state, end - STEP)[0]) / STEP

        def gap(_: sp.Symbol) -> float:
            zone, start, _, state = next(each for each in places if each[0].kind != CONTACT and each[1] <= point[s] <= each[2])
            return self.at(zone, start, state, point[s])[0]

        for function, value in ((gap_slope, slope), (pressure_slope, slope), (gap_at, gap)):
            side = side.replace(function, lambda edge, value=value: sp.Float(value(edge)))
        return self.number(side, point)


def _inside(start: float, end: float, samples: int = SAMPLES) -> np.ndarray:
    return start + (end - start) * (np.arange(samples) + 0.5) / samples
