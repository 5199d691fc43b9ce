"""Exact proof that an expression is identically zero.

The expressions of this derivation are rational in the parameters, in sines and cosines of phases, and in
exponentials of phases over relaxation times. Phases are written as ``s_0`` plus widths ``2 h``, everything is expanded
to ``sin s_0, cos s_0, sin h, cos h`` and to powers of ``exp(h/T)``, brought over one denominator, and the numerator is
reduced by ``sin^2 = 1 - cos^2``. What is left is a polynomial in algebraically independent quantities: it vanishes
identically if and only if it is the zero polynomial. No heuristic simplification takes part.
"""

from __future__ import annotations

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


def independent(expression: Any, phases: Sequence[sp.Symbol] = ()) -> sp.Expr:
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
    return Numerator(independent(expression, phases)).vanishes


class Numerator:
    """An expression over one denominator, as a polynomial with rational coefficients.

    Its generators are what is left when sums, products and whole powers are taken apart: symbols, sines, cosines, tokens, square
    roots, and the inverse of every sum that is divided by, which is multiplied out in the end.
    """

    def __init__(self, expression: sp.Expr):
        self.inverses: dict[sp.Expr, sp.Symbol] = {}  # by the sum that is divided by
        self.roots: dict[sp.Expr, sp.Expr] = {}  # what each is the root of
        self.indices: dict[sp.Expr, int] = {}
        plain = self._named(expression)
        bases: dict[sp.Expr, sp.Expr] = {}
        while bases.keys() != self.inverses.keys():
            bases |= {base: self._named(base) for base in list(self.inverses) if base not in bases}
        self.ring = sp.ring([f"x{number}" for number in range(max(1, len(self.indices)))], sp.QQ)[0]
        self.read: dict[sp.Expr, Any] = {}
        self.polynomial = self._polynomial(plain)
        for base in sorted(bases, key=sp.count_ops, reverse=True):  # a sum before those that it is itself divided by
            self.polynomial = self._cleared(self.polynomial, self.indices[self.inverses[base]], self._polynomial(bases[base]))

    @property
    def vanishes(self) -> bool:
        polynomial = self.polynomial
        for root, square in self.roots.items():
            polynomial = self._without_squares(polynomial, self.indices[root], self._polynomial(square))
        for sine, index in self.indices.items():
            cosine = self.indices.get(sp.cos(sine.args[0])) if isinstance(sine, sp.sin) else None
            if cosine is not None:
                polynomial = self._without_squares(polynomial, index, 1 - self.ring.gens[cosine] ** 2)
        return not polynomial

    def _named(self, expression: sp.Expr) -> sp.Expr:
        """Inverses of sums as symbols; whatever is no sum, product, whole power or number gets an index."""
        if expression.is_Rational:
            return expression
        if expression.is_Add or expression.is_Mul:
            return expression.func(*map(self._named, expression.args), evaluate=False)
        if expression.is_Pow and expression.exp.is_Integer:
            base, exponent = expression.args
            if exponent > 0:
                return sp.Pow(self._named(base), exponent, evaluate=False)
            inverse = self.inverses.get(base)
            if inverse is None:
                inverse = self.inverses[base] = sp.Dummy("inverse")
                self.indices[inverse] = len(self.indices)
            return sp.Pow(inverse, -exponent, evaluate=False)
        if expression.is_Pow and expression.exp.is_Rational and expression.exp.q == 2:
            base, exponent = expression.args
            root, half = sp.sqrt(base, evaluate=False), int(exponent.p)
            if root not in self.roots:
                self.roots[root] = self._named(base)
            self.indices.setdefault(root, len(self.indices))
            power = sp.Pow(root, abs(half), evaluate=False)
            return power if half > 0 else sp.Mul(power, self._named(sp.Pow(base, half, evaluate=False)), evaluate=False)
        self.indices.setdefault(expression, len(self.indices))
        return expression

    def _polynomial(self, expression: sp.Expr) -> Any:
        found = self.read.get(expression)
        if found is None:
            found = self.read[expression] = self._taken_apart(expression)
        return found

    def _taken_apart(self, expression: sp.Expr) -> Any:
        if expression.is_Rational:
            return self.ring.from_expr(expression)
        if expression.is_Add:
            return sum(map(self._polynomial, expression.args), self.ring.zero)
        if expression.is_Mul:
            product = self.ring.one
            for part in map(self._polynomial, expression.args):
                product *= part
            return product
        if expression.is_Pow and expression.exp.is_Integer:
            return self._polynomial(expression.base) ** int(expression.exp)
        return self.ring.gens[self.indices[expression]]

    def _cleared(self, polynomial: Any, inverse: int, base: Any) -> Any:
        """The polynomial times the highest power of ``base`` that it is divided by."""
        by_power = self._by_power(polynomial, inverse)
        highest = max(by_power, default=0)
        return sum((part * base ** (highest - power) for power, part in by_power.items()), self.ring.zero)

    def _without_squares(self, polynomial: Any, generator: int, square: Any) -> Any:
        """With every square of a generator replaced."""
        once = self.ring.gens[generator]
        parts = self._by_power(polynomial, generator).items()
        return sum((part * square ** (power // 2) * once ** (power % 2) for power, part in parts), self.ring.zero)

    def _by_power(self, polynomial: Any, index: int) -> dict[int, Any]:
        """Coefficients of the powers of one generator."""
        found: dict[int, Any] = {}
        for monomial, coefficient in polynomial.terms():
            part = found.setdefault(monomial[index], self.ring.zero.copy())
            part[(*monomial[:index], 0, *monomial[index + 1 :])] = coefficient
        return found
