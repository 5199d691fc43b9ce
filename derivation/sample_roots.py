"""Roots of the boundary equations, in numbers: the inequalities of a regime say of each whether it is a solution.

Whether a root is a solution is seen from the fields alone: in adhesion the gap must stay in (0, delta_0], beyond it
above delta_0, in contact the pressure must not fall below -p_0, and the edges must follow one another. The fields are
the derived flows between the edges, sampled; the inequalities take no part in that. Every inequality is needed by a
root that is a solution (reversed, it would refuse it), and roots that are none are refused. The roots were found once
from random starts; here they are refined and verified.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
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
# alpha/beta, beta, p_0, delta_0, D, chi; edges to start from; whether the root is a solution
ROOTS: dict[str, tuple[tuple[tuple[str, ...], tuple[str, ...], bool], ...]] = {
    "acaf": (
        (("0.121", "3.431", "0.242", "0.498", "0.324", "0"), ("-1.353", "-0.831", "0.51", "1.28"), True),
        (("0.559", "1.653", "0.069", "0.626", "0.078", "1"), ("-1.271", "-0.512", "0.473", "1.319"), True),
        (("0.516", "0.446", "1.098", "0.069", "0.07", "1"), ("-0.533", "-1.199", "1.535", "1.651"), False),
        (("0.332", "2.27", "0.189", "0.054", "0.327", "0"), ("1.184", "1.125", "4.445", "4.388"), False),
    ),
    "afc": (
        (("0.586", "3.611", "0.352", "0.146", "0.48", "1"), ("-1.16", "1.166", "1.33"), True),
        (("0.24", "0.362", "0.118", "0.022", "-0.005", "1"), ("-0.185", "0.318", "0.421"), True),
        (("0.057", "4.015", "0.728", "0.045", "1.202", "1"), ("-1.467", "0.702", "0.858"), False),
        (("0.078", "0.117", "0.29", "0.025", "0.666", "1"), ("1.256", "1.42", "1.497"), False),
    ),
    "af": (
        (("0.159", "0.28", "0.473", "0.949", "-0.742", "1"), ("-0.654", "1.244"), True),
        (("0.524", "0.387", "0.067", "1.757", "-1.207", "0"), ("-1.105", "1.178"), True),
        (("0.537", "0.513", "1.276", "0.354", "0.11", "1"), ("-1.008", "2.402"), False),
        (("0.591", "4.152", "0.139", "0.052", "1.073", "0"), ("-1.749", "1.799"), False),
        (("0.055", "0.12", "0.186", "0.071", "0.515", "0"), ("-1.143", "1.34"), False),
    ),
    "ac": (
        (("0.339", "1.06", "0.543", "0.126", "1.704", "0"), ("-3.069", "2.243"), True),
        (("0.159", "0.217", "0.374", "1.609", "0.306", "0"), ("-1.245", "1.073"), True),
        (("0.168", "3.305", "0.508", "0.196", "0.812", "0"), ("-1.591", "0.898"), False),
        (("0.456", "0.135", "0.378", "0.042", "1.391", "0"), ("-2.448", "2.367"), False),
        (("0.259", "2.992", "0.07", "0.33", "1.913", "0"), ("-2.119", "1.382"), False),
    ),
    "c": ((("0.3", "2", "0.5", "0.4", "4", "0"), (), True), (("0.3", "2", "0.5", "0.4", "1.5", "0"), (), False)),
    "a": (
        (("0.3", "2", "0.5", "2.5", "-0.7", "0"), (), True),
        (("0.3", "2", "0.5", "2.5", "-0.2", "0"), (), False),
        (("0.3", "2", "0.5", "1.5", "-0.7", "0"), (), False),
    ),
    "f": (
        (("0.3", "2", "0.5", "0.4", "-0.7", "0"), (), True),
        (("0.3", "2", "0.5", "0.4", "-0.2", "0"), (), False),
        (("0.3", "2", "0", "0.4", "-0.2", "0"), (), True),
        (("0.3", "2", "0", "0.4", "0.2", "0"), (), False),
    ),
}
Point = dict[sp.Symbol, mpmath.mpf]


def sample_roots(regimes: Sequence[Regime]) -> Derived:
    r"""Solutions and roots that are none, :math:`0 < g \le \delta_0,\ q \ge 0,\ g > \delta_0`, against the inequalities."""
    with mpmath.workdps(DIGITS):
        return compared(sample_roots, regimes, ROOTS, _judged)


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


def _judged(regime: Regime, groups: tuple[str, ...], start: tuple[str, ...]) -> tuple[bool, bool]:
    point = _refined(regime, groups, start)
    return _fields_fit(regime, point), all(_satisfied(regime, inequality, point) for inequality in regime.admissible)


def _refined(regime: Regime, groups: tuple[str, ...], start: tuple[str, ...]) -> Point:
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
