"""LaTeX read back as SymPy, so that what is displayed, and what the paper prints, can be compared with what was derived.

The grammar is ``latex.lark``. What a name means is given by the caller; a name without a meaning, and anything else that is not
understood, is an error.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import lark
import sympy as sp

Names = Mapping[str, Any]
SINES = {rf"\{each}": each for each in (sp.sin, sp.cos, sp.tan, sp.exp, sp.log)} | {r"\arctan": sp.atan, r"\arccos": sp.acos}


class Unreadable(ValueError):
    """LaTeX with something in it that has no meaning here."""


@dataclass(frozen=True)
class Of:
    """A function by its expression in one variable."""

    variable: sp.Symbol
    expression: sp.Expr

    def __call__(self, *places: sp.Expr) -> sp.Expr:
        (place,) = places or (self.variable,)
        return self.expression.subs(self.variable, place)

    def derivative(self, order: int) -> Of:
        return Of(self.variable, sp.diff(self.expression, self.variable, order))


@dataclass(frozen=True)
class Prefix:
    """A function that is written before its argument without a bracket, such as Im."""

    function: Callable[[sp.Expr], sp.Expr]


@dataclass(frozen=True)
class Statement:
    """Sides with the signs between them; one side alone is a value."""

    sides: tuple[sp.Expr, ...]
    signs: tuple[str, ...]


def statements(latex: str, names: Names) -> tuple[Statement, ...]:
    """The equations and values of a display, in order."""
    _meaning.names = names
    try:
        return _parser.parse(latex)
    except (lark.exceptions.LarkError, KeyError) as problem:
        raise Unreadable(f"{latex!r}: {problem}") from problem


def rows(latex: str) -> list[str]:
    """The lines of an environment such as ``aligned`` or ``cases``, each with its columns joined by a space."""
    inside = re.sub(r"\\(?:begin|end)\{\w+\}", "", latex)
    return [line.replace("&", " ").strip() for line in inside.split(r"\\") if line.strip()]


def joined(latex: str) -> str:
    """A formula set in several lines, as one."""
    return " ".join(rows(re.sub(r"\\(?:left|right)\s*\.", "", latex)))


@lark.v_args(inline=True)
class Meaning(lark.Transformer):
    """What the rules of the grammar mean, by their names."""

    names: Names

    negative, plus, minus = map(staticmethod, (operator.neg, operator.add, operator.sub))
    times, over, power = map(staticmethod, (operator.mul, operator.truediv, operator.pow))
    number, exponential, root, modulus, greatest = map(staticmethod, (sp.Integer, sp.exp, sp.sqrt, sp.Abs, sp.Max))

    def meant(self, token: lark.Token) -> lark.Token:
        """A name with its meaning as the value, and a type that says what it is."""
        key = re.sub(r"[\s{}]", "", token).replace("^*", "*")
        plain = key if key in self.names else key.rstrip("'")
        order = len(key) - len(plain)
        if plain not in self.names:
            raise Unreadable(f"{plain!r} has no meaning here")
        value = self.names[plain]
        single = isinstance(value, sp.Basic) and not isinstance(value, sp.FunctionClass)
        if single and order:
            raise Unreadable(f"{plain!r} is no function here")
        token.type = "SYMBOL" if single else "PREFIX" if isinstance(value, Prefix) else "FUNCTION"
        token.value = value.derivative(order) if order else value
        return token

    def statement(self, *parts: Any) -> Statement:
        return Statement(parts[::2], tuple(map(str, parts[1::2])))

    def symbol(self, token: lark.Token) -> sp.Expr:
        return token.value

    def called(self, function: lark.Token, arguments: tuple[sp.Expr, ...] = ()) -> sp.Expr:
        return function.value(*arguments)

    def prefixed(self, function: lark.Token, argument: sp.Expr) -> sp.Expr:
        return function.value.function(argument)

    def arguments(self, *parts: Any) -> tuple[Any, ...]:
        return parts

    start = arguments

    def sine(self, function: lark.Token, argument: sp.Expr) -> sp.Expr:
        return SINES[function](argument)

    def limit(self, variable: lark.Token, target: sp.Expr, of: sp.Expr) -> sp.Expr:
        return sp.limit(of, variable.value, target)

    def derivative(self, function: sp.Expr, variable: lark.Token) -> sp.Expr:
        return sp.Derivative(function, variable.value)

    def derivative_of(self, variable: lark.Token, function: sp.Expr) -> sp.Expr:
        return sp.Derivative(function, variable.value)

    def operator(self, variable: lark.Token) -> sp.Expr:
        """One that stands for itself."""
        return self.names[f"d/d{variable}"]

    def at_the_end(self, function: lark.Token, variable: lark.Token) -> sp.Expr:
        r"""``\partial g/\partial s_0``: a function is taken at the phase that ``names["end"]`` gives."""
        value = function.value if function.type == "SYMBOL" else function.value(self.names["end"])
        return self.differentiated(variable.value, value)

    def differentiated(self, variable: sp.Expr, function: sp.Expr) -> sp.Expr:
        return self.names.get("partial", sp.diff)(function, variable)

    def rise(self, function: lark.Token, low: sp.Expr, high: sp.Expr) -> sp.Expr:
        return function.value(high) - function.value(low)

    def summed(self, sign: lark.Token, body: sp.Expr, *limits: sp.Expr) -> sp.Expr:
        kind, index = re.findall(r"[a-z]+", sign)[:2]
        return self.names[f"{kind} over {index}"](body, *(limits or (None, None)))

    def summed_from(self, sign: lark.Token, first: sp.Expr, last: sp.Expr, body: sp.Expr) -> sp.Expr:
        return self.summed(sign, body, first, last)

    def integral(self, low: sp.Expr, high: sp.Expr, body: sp.Expr, variable: sp.Expr) -> sp.Expr:
        return sp.Integral(body, (variable, low, high))

    def integral_over(self, sign: lark.Token, body: sp.Expr, *variables: sp.Expr) -> sp.Expr:
        key = re.sub(r"[\s{}]", "", sign).removeprefix("\\").replace("_", " ", 1)
        return self.names[key](body, *variables)


_meaning = Meaning()
_grammar = Path(__file__).with_suffix(".lark").read_text(encoding="utf-8")
_of_names = dict.fromkeys(("SYMBOL", "FUNCTION", "PREFIX", "STEP"), _meaning.meant)
_parser = lark.Lark(_grammar, parser="lalr", transformer=_meaning, lexer_callbacks=_of_names)
