"""Sums, products, powers and functions in LaTeX, and what the names in them mean."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from .tokens import CLOSE, OPEN, RELATIONS, SPACES, Cursor, Unreadable

ACCENTS = {r"\bar", r"\mathrm", r"\text", r"\operatorname", r"\dot", r"\mathit"}
FUNCTIONS: dict[str, Callable[..., sp.Expr]] = {
    r"\sin": sp.sin, r"\cos": sp.cos, r"\tan": sp.tan, r"\arctan": sp.atan, r"\arccos": sp.acos, r"\exp": sp.exp, r"\log": sp.log,
}  # fmt: skip
FRACTIONS = {r"\frac", r"\tfrac", r"\dfrac"}
INTEGRALS = {r"\int": 1, r"\iint": 2, r"\oint": 1}
STOPS = {"+", "-", ",", "/", "&", "|", *RELATIONS, *SPACES, *CLOSE, r"\Rightarrow", r"\cdot", r"\times"}

ATOMS = {  # by the token that begins it, the method that reads it
    **dict.fromkeys(OPEN, "group"),
    **dict.fromkeys(FRACTIONS, "fraction"),
    **dict.fromkeys(INTEGRALS, "integral"),
    **dict.fromkeys(FUNCTIONS, "function"),
    **dict.fromkeys((r"\sum", r"\prod"), "summed"),
    "[": "bracket",
    "|": "modulus",
    r"\sqrt": "root",
    r"\max": "greatest",
    r"\partial": "partial",
    r"\lim": "limit",
}


@dataclass(frozen=True)
class Of:
    """A function by its expression in one variable; ``reader`` applies, differentiates and integrates it."""

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


class Terms(Cursor):
    """An expression; what is written with a sign of analysis is left to ``Analysis``."""

    def sum(self) -> sp.Expr:
        total = self._signed()
        while self.peek() in ("+", "-"):
            total += self._signed()
        return total

    def _signed(self) -> sp.Expr:
        sign = -1 if self.takes("-") else 1
        self.takes("+")
        return sign * self.product()

    def product(self) -> sp.Expr:
        value = self.factor()
        while True:
            if self.takes("/"):
                value /= self.factor()
            elif self.takes(r"\cdot") or self.takes(r"\times") or self.begins():
                value *= self.factor()
            else:
                return value

    def begins(self) -> bool:
        token = self.peek()
        return bool(token) and token not in STOPS and not self.differential()

    def differential(self) -> bool:
        return bool(self.differentials) and self.peek() == "d" and bool(re.fullmatch(r"[a-z]|\\[a-z]+", self.peek(1)))

    def factor(self) -> sp.Expr:
        value = self.atom()
        while self.takes("^"):
            value = value ** self.script()
        return value

    def script(self) -> sp.Expr:
        """What stands above or below: a group or one token."""
        if self.peek() == "{":
            return self.group()
        token = self.take()
        if token.isdigit() and len(token) > 1:  # one digit, as TeX reads it: \frac12
            self.at -= 1
            self.tokens[self.at : self.at + 1] = [token[0], token[1:]]
            token = self.take()
        return type(self)([token], self.names).sum()

    def group(self) -> sp.Expr:
        opening = self.take()
        outer, self.differentials = self.differentials, []
        value = self.sum()
        self.differentials = outer
        self.take(OPEN[opening])
        return value

    def atom(self) -> sp.Expr:
        token = self.peek()
        if token.isdigit():
            return sp.Integer(self.take())
        if token in ATOMS:
            return getattr(self, ATOMS[token])()
        if token == "e" and self.peek(1) == "^":
            self.at += 2
            return sp.exp(self.script())
        return self.name()

    def root(self) -> sp.Expr:
        self.take()
        return sp.sqrt(self.script())

    def greatest(self) -> sp.Expr:
        self.take()
        return sp.Max(*self.arguments())

    def modulus(self) -> sp.Expr:
        """``|K|``."""
        self.take("|")
        value = self.sum()
        self.take("|")
        return sp.Abs(value)

    def arguments(self) -> list[sp.Expr]:
        opening = self.take()
        found = [self.sum()]
        while self.takes(","):
            found.append(self.sum())
        self.take(OPEN[opening])
        return found

    def function(self) -> sp.Expr:
        function = FUNCTIONS[self.take()]
        power = self.script() if self.takes("^") else sp.Integer(1)
        return function(self.argument()) ** power

    def argument(self) -> sp.Expr:
        """A bracket, or the factors up to a sign or another function."""
        if self.peek() == "(" or self.peek() == "{" and self.peek(1) == "(":  # \sin{\left(s \right)}
            return self.group()
        value = self.factor()
        while self.begins() and self.peek() not in FUNCTIONS and self.peek() not in OPEN:
            value *= self.factor()
        return value

    def callable(self) -> Callable[..., sp.Expr]:
        key = self.key()
        value = self.names.get(key)
        if not callable(value) or isinstance(value, sp.Expr):
            raise Unreadable(f"{' '.join(self.tokens)!r}: {key!r} is no function here")
        return value

    def name(self) -> sp.Expr:
        return self.indexed(self.key())

    def indexed(self, key: str) -> sp.Expr:
        while self.peek() == "_" and key.startswith("["):
            self.take()
            key += "_" + "".join(self.inside())
        primes = 0
        while self.takes("'"):
            primes += 1
        if key + "'" * primes in self.names:
            key, primes = key + "'" * primes, 0
        if key not in self.names:
            raise Unreadable(f"{' '.join(self.tokens)!r}: {key!r} has no meaning here")
        value = self.names[key]
        if isinstance(value, Prefix):
            return value.function(self.factor())
        if isinstance(value, sp.Basic) and not isinstance(value, sp.FunctionClass):
            if primes:
                raise Unreadable(f"{' '.join(self.tokens)!r}: {key!r} is no function here")
            return value
        if primes:
            value = value.derivative(primes)
        brace = self.peek() == "{" and self.peek(1) == "("  # w{\left(t \right)}
        if brace:
            self.take()
        value = value(*(self.arguments() if self.peek() in ("(", "[") else ()))
        if brace:
            self.take("}")
        return value

    def key(self) -> str:
        base = self.take()
        if base in ACCENTS:
            base += "".join(self.inside())
        elif base == r"\Delta" and any(name.startswith(base + (self.peek() or " ")) for name in self.names):
            base += self.take()
        elif not re.fullmatch(r"[A-Za-z]|\\[A-Za-z]+", base):
            raise Unreadable(f"{' '.join(self.tokens)!r}: {base!r} is not understood")
        if self.peek() == "^" and self.peek(1) == "*":
            self.at += 2
            base += "*"
        if self.peek() == "_":
            self.take()
            base += "_" + "".join(self.inside())
            if self.peek() == "^" and f"{base}^{self.peek(1)}" in self.names:
                self.at += 2
                base += "^" + self.peek(-1)
        return base
