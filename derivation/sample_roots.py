"""Roots of the boundary equations, in numbers: the inequalities of a regime say of each whether it is a solution.

Whether a root is a solution is seen from the fields alone: in adhesion the gap must stay in (0, delta_0], beyond it
above delta_0, in contact the pressure must not fall below -p_0, and the edges must follow one another. The fields are
the derived flows between the edges, sampled; the inequalities take no part in that. Every inequality is needed by a
root that is a solution (reversed, it would refuse it), and roots that are none are refused. The roots of
``sample_roots.toml`` were found once from random starts; here they are refined and verified.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import mpmath
import sympy as sp

from .check import Derived, derived, holds
from .functions import written_out
from .inequality import Inequality, Relation
from .regime import Regime
from .sequences import ADHESION, CONTACT
from .stable import SATURATED_PRESSURE
from .symbols import PARAMETERS, alpha, beta, chi, delta_0, p_0, s, s_1

NAME = "inequalities of admissibility"
SAMPLES, DIGITS, SLACK = 48, 20, mpmath.mpf("1e-9")
ROOTS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
Point = dict[sp.Symbol, mpmath.mpf]


def sample_roots(regimes: Sequence[Regime]) -> Derived:
    r"""Solutions and roots that are none, :math:`0 < g \le \delta_0,\ q \ge 0,\ g > \delta_0`, against the inequalities."""
    with mpmath.workdps(DIGITS):
        return compared(sample_roots, regimes, ROOTS["one_time"], _judged)


def compared(by: Callable[..., Derived], regimes: Sequence[Any], roots: Mapping[str, Sequence[Any]], judged: Callable) -> Derived:
    """What ``by`` found at the roots; ``judged``: whether the fields of a root fit, and what the inequalities say of it."""
    checks = []
    for regime in regimes:
        for number, (groups, start, solution) in enumerate(roots[regime.sequence], start=1):
            fits, admitted = judged(regime, groups, start)
            root, kind = f"{regime.sequence}, root {number}", "a solution" if solution else "no solution"
            checks.append(holds(f"{root}: the fields show {kind}", fits is solution))
            checks.append(holds(f"{root}: so do the inequalities", admitted is solution))
    return derived(
        by,
        None,
        checks,
        NAME,
        statement="At roots of the boundary equations in numbers, solutions and others, inequalities say what the fields show.",
        latex=r"\text{inequalities} \iff 0 < g \le \delta_0\ \text{in adhesion},\quad g > \delta_0\ \text{beyond},\quad "
        r"p \ge -p_0\ \text{in contact}",
    )


def allowed(kind: str, traction: Any, reach: Any) -> tuple[Any, Any]:
    """Between what the gap, in contact the pressure above -p_0, must lie; without traction the reach plays no part."""
    if kind == CONTACT or not traction > 0:
        return 0, mpmath.inf
    return (0, reach) if kind == ADHESION else (reach, mpmath.inf)


def _judged(regime: Regime, groups: Sequence[str], start: Sequence[str]) -> tuple[bool, bool]:
    point = _refined(regime, groups, start)
    return _fields_fit(regime, point), all(_satisfied(regime, inequality, point) for inequality in regime.admissible)


def _refined(regime: Regime, groups: Sequence[str], start: Sequence[str]) -> Point:
    ratio, slow, *rest = map(mpmath.mpf, groups)
    values = dict(zip(PARAMETERS, (ratio * slow, slow, ratio, 1 - ratio, *rest), strict=True))
    if not regime.edges:
        return values
    equations = [written_out(term) for _, term in regime.equations]
    residual = sp.lambdify((*regime.edges, *PARAMETERS), equations, "mpmath")
    found = mpmath.findroot(lambda *edges: residual(*edges, *values.values()), tuple(map(mpmath.mpf, start)))
    return dict(zip(regime.edges, found, strict=True)) | values


def _value(expression: sp.Expr, point: Point) -> mpmath.mpf:
    return mpmath.mpf(_evaluator(expression, tuple(point))(*point.values()))


@lru_cache
def _evaluator(expression: sp.Expr, symbols: tuple[sp.Symbol, ...]) -> Callable[..., mpmath.mpf]:
    return sp.lambdify(symbols, written_out(sp.sympify(expression)), "mpmath")


def _fields_fit(regime: Regime, point: Point) -> bool:
    if not regime.edges:
        return _steady_field_fits(regime, point)
    places = [point[edge] for edge in regime.edges]
    if any(later < earlier for earlier, later in pairwise([*places, places[0] + 2 * mpmath.pi])):
        return False
    if regime.closures == (1,) and (point[chi] != 1 or point[delta_0] > point[p_0] * point[alpha] / point[beta]):
        return False
    for zone, first, last in zip(regime.zones, places, [*places[1:], places[0] + 2 * mpmath.pi], strict=True):
        state = _evaluator(replace(zone, last=s_1).after(), (s_1, *point))
        low, high = allowed(zone.kind, point[p_0], point[delta_0])
        for n in range(SAMPLES):
            value = state(first + (last - first) * (n + mpmath.mpf(0.5)) / SAMPLES, *point.values())
            if not low - SLACK <= value <= high + SLACK:
                return False
    return True


def _steady_field_fits(regime: Regime, point: Point) -> bool:
    """Complete contact by its field, the gap of a foundation at rest by the profile, over a period."""
    (zone,) = regime.zones
    phases = [2 * mpmath.pi * n / SAMPLES for n in range(SAMPLES)]
    if zone.kind == CONTACT:
        seen = SATURATED_PRESSURE.written_out(SATURATED_PRESSURE.args) + p_0
    else:
        seen = zone.load - (zone.displacement - zone.entry).subs(zone.first, s)
    low, high = allowed(zone.kind, point[p_0], point[delta_0])
    return all(low - SLACK <= _value(seen, {**point, s: phase}) <= high + SLACK for phase in phases)


def _satisfied(regime: Regime, inequality: Inequality, point: Point) -> bool:
    first, *rest = inequality.relations
    unknown = {symbol for relation in inequality.relations for side in relation.sides for symbol in sp.sympify(side).free_symbols}
    turns = unknown - set(point) - {s}
    if turns:  # at the end of every arc in which the second relation holds, unless the third
        (turn,) = turns
        return any(true(other, point) for other in rest[1:]) or all(
            true(first, {**point, turn: place}) for place in _ends_of_arcs(regime, rest[0], point)
        )
    if len(inequality.relations) == 3:  # the first if the second, else the third
        return true(first if true(rest[0], point) else rest[1], point)
    return all(true(relation, point) for relation in inequality.relations)


def _ends_of_arcs(regime: Regime, condition: Relation, point: Point) -> list[mpmath.mpf]:
    """Where the condition ceases to hold, within the gap zone of the regime that is in adhesion."""
    (zone,) = [zone for zone in regime.zones if zone.kind == ADHESION]
    first, last = (_value(edge, point) for edge in (zone.first, zone.last))
    places = [first + (last - first) * n / (4 * SAMPLES) for n in range(4 * SAMPLES + 1)]
    holding = [true(condition, {**point, s: place}) for place in places]
    ends = [place for place, now, after in zip(places, holding, [*holding[1:], False], strict=True) if now and not after]
    return ends


def true(relation: Relation, point: Point) -> bool:
    values = [_value(side, point) for side in relation.sides]
    compare = {
        "<=": lambda a, b: a <= b, ">=": lambda a, b: a >= b, "<": lambda a, b: a < b, ">": lambda a, b: a > b,
        "==": lambda a, b: a == b,
    }[relation.sign]  # fmt: skip
    return all(compare(a, b) for a, b in pairwise(values))
