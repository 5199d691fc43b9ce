"""Exact proof that an expression is identically zero.

The expressions of this derivation are rational in the parameters, in sines and cosines of phases, and in
exponentials of phases over relaxation times. Phases are written as ``s_0`` plus widths ``2 h``, everything is expanded
to ``sin s_0, cos s_0, sin h, cos h`` and to powers of ``exp(h/T)``, brought over one denominator, and the numerator is
reduced by ``sin^2 = 1 - cos^2``. What is left is a polynomial in algebraically independent quantities: it vanishes
identically if and only if it is the zero polynomial. No heuristic simplification takes part.
"""

import functools
import math
import operator
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

from .functions import written_out
from .symbols import J, L, alpha, beta

RELATIONS: Mapping[sp.Symbol, sp.Expr] = {J: alpha / beta, L: 1 - alpha / beta}
"""Compliance ratio and its complement, in terms of the two dimensionless times."""


def widths(phases: Sequence[sp.Symbol]) -> dict[sp.Symbol, sp.Expr]:
    """Substitution that writes each phase after the first as the one before plus ``2 h``."""
    result: dict[sp.Symbol, sp.Expr] = {}
    position: sp.Expr = phases[0]
    for first, second in zip(phases, phases[1:], strict=False):
        position = position + 2 * sp.Symbol(f"h_{first}_{second}", positive=True)
        result[second] = position
    return result


def independent(expression: Any, phases: Sequence[sp.Symbol]) -> sp.Expr:
    """The expression with everything written out in the independent quantities named above."""
    expression = written_out(sp.sympify(expression)).doit()
    expression = expression.subs(RELATIONS)
    expression = expression.subs(widths(phases)) if phases else expression
    expression = expression.replace(lambda e: isinstance(e, (sp.exp, sp.sin, sp.cos)), lambda e: e.func(sp.expand(e.args[0])))
    expression = sp.expand_trig(expression)
    expression = expression.replace(sp.exp, lambda a: sp.expand(sp.exp(a), power_exp=True))
    return expression.replace(sp.exp, _power_of_token)


def _power_of_token(argument: sp.Expr) -> sp.Expr:
    factor, rest = argument.as_coeff_Mul()
    token = sp.Symbol(f"exp<{rest}>", positive=True)
    return token**factor


def in_half_angles(expression: sp.Expr, *angles: sp.Symbol) -> sp.Expr:
    """The same identity with every angle written as twice another, so that only multiples of them occur."""
    return expression.subs({angle: 2 * angle for angle in angles}, simultaneous=True)


def is_zero(expression: Any, phases: Sequence[sp.Symbol] = ()) -> bool:
    """Whether the expression vanishes identically; ``phases`` in the order met."""
    return vanishes(independent(expression, phases))


def vanishes(expression: sp.Expr) -> bool:
    """Whether the numerator is the zero polynomial once no sine and no square root in it stands to a power above one, and
    nothing that it is divided by is."""
    squares: dict[sp.Symbol, sp.Expr] = {}  # what is within a root before the root

    def named(kind: str, of: sp.Expr, square: sp.Expr) -> sp.Symbol:
        name = sp.Symbol(f"{kind}<{of}>")
        squares[name] = square
        return name

    plain = expression.replace(sp.sin, lambda angle: named("sin", angle, 1 - sp.cos(angle) ** 2))
    halves = lambda e: e.is_Pow and e.exp.is_Rational and e.exp.q == 2  # noqa: E731
    plain = plain.replace(halves, lambda e: named("sqrt", e.base, e.base) ** (2 * e.exp))
    generators = set().union(*map(_generators, (plain, *squares.values())))
    ring = sp.ring(sorted(generators, key=str) or "x", sp.QQ)[0]
    divisors: set[Any] = set()
    fraction = lambda of: _fraction(of, ring, divisors)  # noqa: E731
    relations = [(ring.symbols.index(name), *fraction(squares[name])) for name in squares if name in generators]

    def left(polynomial: Any) -> Any:
        for index, upper, lower in reversed(relations):
            polynomial = _without_squares(ring, polynomial, index, upper, _product(ring, lower))
        return polynomial

    return not left(fraction(plain)[0]) and all(map(left, divisors))


def _fraction(expression: sp.Expr, ring: Any, divisors: set[Any]) -> tuple[Any, Counter]:
    """Numerator, and what it is divided by: polynomials with their powers; ``divisors``: all that is divided by in it."""
    if expression.is_Add:
        parts = [_fraction(part, ring, divisors) for part in expression.args]
        common = functools.reduce(operator.or_, (below for _, below in parts))
        return sum((above * _product(ring, common - below) for above, below in parts), ring.zero), common
    if expression.is_Mul:
        parts = [_fraction(part, ring, divisors) for part in expression.args]
        return math.prod((above for above, _ in parts), start=ring.one), sum((below for _, below in parts), Counter())
    if expression.is_Pow and expression.exp.is_Integer:
        (above, below), power = _fraction(expression.base, ring, divisors), int(expression.exp)
        if power < 0:
            divisors.add(above)
            return _product(ring, below) ** -power, Counter({above: -power})
        return above**power, Counter({each: n * power for each, n in below.items()})
    return ring.from_expr(expression), Counter()


def _product(ring: Any, powers: Counter) -> Any:
    return math.prod((each**n for each, n in powers.items()), start=ring.one)


def _generators(expression: sp.Expr) -> set[sp.Expr]:
    """What is left when sums, products and whole powers are taken apart."""
    if expression.is_Add or expression.is_Mul or expression.is_Pow and expression.exp.is_Integer:
        return set().union(*map(_generators, expression.args))
    return set() if expression.is_Rational else {expression}


def _without_squares(ring: Any, polynomial: Any, index: int, upper: Any, lower: Any) -> Any:
    """The polynomial with every square of one generator replaced by upper/lower, times what that is divided by."""
    by_power: dict[int, Any] = {}
    for monomial, coefficient in polynomial.terms():
        part = by_power.setdefault(monomial[index], ring.zero.copy())
        part[(*monomial[:index], 0, *monomial[index + 1 :])] = coefficient
    highest = max(by_power, default=0) // 2
    replaced = ((n % 2, part * upper ** (n // 2) * lower ** (highest - n // 2)) for n, part in by_power.items())
    return sum((part * ring.gens[index] ** odd for odd, part in replaced), ring.zero)
