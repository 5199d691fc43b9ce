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
    expression = independent(expression, phases)
    numerator, _ = sp.fraction(sp.together(expression))
    return reduced(numerator) == 0


def reduced(numerator: sp.Expr) -> sp.Expr:
    """Polynomial with every square of a sine replaced."""
    numerator = sp.expand(numerator)
    angles = sorted({f.args[0] for f in numerator.atoms(sp.sin)}, key=sp.default_sort_key)
    for angle in angles:
        numerator = sp.expand(numerator.replace(_is_power_of(sp.sin(angle)), _without_squares(angle)))
    return numerator


def _is_power_of(base: sp.Expr) -> Any:
    return lambda e: e.is_Pow and e.base == base and e.exp.is_Integer and e.exp >= 2


def _without_squares(angle: sp.Expr) -> Any:
    def replace(power: sp.Pow) -> sp.Expr:
        squares, odd = divmod(int(power.exp), 2)
        return (1 - sp.cos(angle) ** 2) ** squares * sp.sin(angle) ** odd

    return replace
