"""LaTeX read back as SymPy, so that what is displayed, and what the paper prints, can be compared with what was derived.

The part of LaTeX that the displays and the paper's equations use: sums, products, fractions, powers, roots, functions, primes,
indices, integrals, sums over an index, ``[u]_a^b``, and chains of ``=``. What a name means is given by the caller; a name
without a meaning, and anything else that is not understood, is an error.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

TOKEN = re.compile(r"\\\\|\\[A-Za-z]+|\\[,;!: {}|]|\d+|\S")
SKIPPED = {r"\,", r"\;", r"\!", r"\:", r"\ ", r"\left", r"\right", r"\displaystyle", "&"}
OPEN, CLOSE = {"(": ")", "[": "]", "{": "}", r"\{": r"\}"}, {")", "]", "}", r"\}"}
RELATIONS = {"=", r"\le", r"\ge", r"\leq", r"\geq", "<", ">", r"\to"}
SPACES = {r"\quad", r"\qquad", r"\\"}
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


class Unreadable(ValueError):
    """LaTeX with something in it that has no meaning here."""


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


@dataclass(frozen=True)
class Statement:
    """Sides with the signs between them; one side alone is a value."""

    sides: tuple[sp.Expr, ...]
    signs: tuple[str, ...]


Names = Mapping[str, Any]


def read(latex: str, names: Names) -> sp.Expr:
    """One expression."""
    (statement,) = statements(latex, names)
    if len(statement.sides) != 1:
        raise Unreadable(f"{latex!r} is no single expression")
    return statement.sides[0]


def statements(latex: str, names: Names) -> tuple[Statement, ...]:
    """The equations and values of a display, in order."""
    found = []
    for part in _split(_tokens(latex)):
        reader = _Reader(part, names)
        sides, signs = [reader.sum()], []
        while reader.peek() in RELATIONS:
            signs.append(reader.take())
            sides.append(reader.sum())
        if reader.peek():
            raise Unreadable(f"{' '.join(part)!r}: {reader.peek()!r} is not understood")
        found.append(Statement(tuple(sides), tuple(signs)))
    return tuple(found)


def rows(latex: str) -> list[str]:
    """The lines of an environment such as ``aligned`` or ``cases``, each with its columns joined by a space."""
    inside = re.sub(r"\\(?:begin|end)\{\w+\}", "", latex)
    return [line.replace("&", " ").strip() for line in inside.split(r"\\") if line.strip()]


def joined(latex: str) -> str:
    """A formula set in several lines, as one."""
    return " ".join(rows(re.sub(r"\\(?:left|right)\s*\.", "", latex)))


def _tokens(latex: str) -> list[str]:
    return [token for token in TOKEN.findall(latex) if token not in SKIPPED]


def _split(tokens: list[str]) -> list[list[str]]:
    """The statements: parted by a comma before a space, a wide space, a line break or an arrow, outside all brackets."""
    parts: list[list[str]] = [[]]
    depth = 0
    for n, token in enumerate(tokens):
        depth += (token in OPEN) - (token in CLOSE)
        comma = token == "," and n + 1 < len(tokens) and tokens[n + 1] in SPACES
        if depth == 0 and (comma or token in SPACES or token == r"\Rightarrow"):
            parts.append([])
        else:
            parts[-1].append(token)
    return [part[:-1] if part and part[-1] == "," else part for part in parts if part]


class _Reader:
    def __init__(self, tokens: list[str], names: Names):
        self.tokens, self.names, self.at = tokens, names, 0
        self.differentials: list[bool] = []

    def peek(self, ahead: int = 0) -> str:
        place = self.at + ahead
        return self.tokens[place] if place < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        token = self.peek()
        if not token or wanted and token != wanted:
            raise Unreadable(f"{' '.join(self.tokens)!r}: {wanted or 'something'!r} is missing at {token!r}")
        self.at += 1
        return token

    def sum(self) -> sp.Expr:
        total = self._signed()
        while self.peek() in ("+", "-"):
            total += self._signed()
        return total

    def _signed(self) -> sp.Expr:
        sign = -1 if self._takes("-") else 1
        self._takes("+")
        return sign * self.product()

    def product(self) -> sp.Expr:
        value = self.factor()
        while True:
            if self._takes("/"):
                value /= self.factor()
            elif self._takes(r"\cdot") or self._takes(r"\times") or self._begins():
                value *= self.factor()
            else:
                return value

    def _begins(self) -> bool:
        token = self.peek()
        return bool(token) and token not in STOPS and not self._differential()

    def _differential(self) -> bool:
        return bool(self.differentials) and self.peek() == "d" and bool(re.fullmatch(r"[a-z]|\\[a-z]+", self.peek(1)))

    def _takes(self, token: str) -> bool:
        if self.peek() == token:
            self.at += 1
            return True
        return False

    def factor(self) -> sp.Expr:
        value = self.atom()
        while self._takes("^"):
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
        return _Reader([token], self.names).sum()

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

    def partial(self) -> sp.Expr:
        r"""``\partial g/\partial s_0`` or ``\partial_{s_0} g``; a function is taken at the phase that ``names["end"]`` gives."""
        self.take()
        differentiated = self.names.get("partial", sp.diff)
        if self._takes("_"):
            variable = self.script()
            return differentiated(self.name(), variable)
        key = self._key()
        function = self.names.get(key)
        if function is None:
            raise Unreadable(f"{' '.join(self.tokens)!r}: {key!r} has no meaning here")
        value = function if isinstance(function, sp.Expr) else function(self.names["end"])
        self.take("/")
        self.take(r"\partial")
        return differentiated(value, self.name())

    def limit(self) -> sp.Expr:
        self.take()
        self.take("_")
        self.take("{")
        variable = self.name()
        self.take(r"\to")
        target = self.sum()
        self.take("}")
        return sp.limit(self.factor(), variable, target)

    def arguments(self) -> list[sp.Expr]:
        opening = self.take()
        found = [self.sum()]
        while self._takes(","):
            found.append(self.sum())
        self.take(OPEN[opening])
        return found

    def bracket(self) -> sp.Expr:
        """``[w]``, a step with a name of its own; ``[u]_a^b``, a rise; or a plain bracket."""
        end = self._matching()
        inside = "".join(self.tokens[self.at + 1 : end])
        if f"[{inside}]" in self.names:
            self.at = end + 1
            return self._indexed(f"[{inside}]")
        if end + 1 < len(self.tokens) and self.tokens[end + 1] == "_":
            self.take()
            function = self.callable()
            self.take("]")
            low, high = self.limits()
            return function(high) - function(low)
        return self.group()

    def _matching(self) -> int:
        depth = 0
        for n in range(self.at, len(self.tokens)):
            depth += (self.tokens[n] in OPEN) - (self.tokens[n] in CLOSE)
            if depth == 0:
                return n
        raise Unreadable(f"{' '.join(self.tokens)!r}: a bracket is not closed")

    def limits(self) -> tuple[sp.Expr, sp.Expr]:
        self.take("_")
        low = self.script()
        self.take("^")
        return low, self.script()

    def fraction(self) -> sp.Expr:
        self.take()
        derivative = self._derivative()
        if derivative is not None:
            return derivative
        upper = self.script()
        return upper / self.script()

    def _derivative(self) -> sp.Expr | None:
        r"""``\frac{\partial w}{\partial t}``, ``\frac{\partial}{\partial x} f`` and with d; None for a plain fraction."""
        if self.peek() != "{" or self.peek(1) not in (r"\partial", "d") or self.peek(1) == "d" and self.peek(2).isdigit():
            return None
        mark = self.peek(1)
        end = self._matching()
        if self.tokens[end + 1 : end + 3] != ["{", mark]:
            return None
        of = self.tokens[self.at + 2 : end]
        if "/" in of:
            return None
        self.at = end + 3
        if not of and f"d/d{self.peek()}" in self.names:  # stands for itself, in an operator
            key = f"d/d{self.take()}"
            self.take("}")
            return self.names[key]
        variable = self.name()
        self.take("}")
        function = _Reader(of, self.names).sum() if of else self.factor()
        return sp.Derivative(function, variable)

    def summed(self) -> sp.Expr:
        kind = self.take().lstrip("\\")
        self.take("_")
        index, first, last = self._range()
        body = self.factor() if kind == "prod" else self.product()
        over = self.names[f"{kind} over {index}"]
        return over(body, first, last)

    def _range(self) -> tuple[str, sp.Expr | None, sp.Expr | None]:
        inside = self._inside()
        if "=" not in inside:
            return inside[0], None, None
        first = _Reader(inside[2:], self.names).sum()
        self.take("^")
        return inside[0], first, self.script()

    def integral(self) -> sp.Expr:
        kind = self.take()
        domain = limits = None
        if self.peek() == "_" and kind == r"\iint":
            self.take()
            domain = "".join(self._inside())
        elif self.peek() == "_":
            limits = self.limits()
        self.differentials.append(True)
        body = self.product()
        variables = []
        while self._differential():
            self.take()
            variables.append(self.name())
        self.differentials.pop()
        if kind == r"\oint":
            return self.names["oint"](body, *variables)
        if kind == r"\iint":
            return self.names[f"iint {domain or ''}".strip()](body, *variables)
        if limits is None or len(variables) != 1:
            raise Unreadable(f"{' '.join(self.tokens)!r}: an integral without limits or differential")
        return sp.Integral(body, (variables[0], *limits))

    def _inside(self) -> list[str]:
        """The tokens of a group, or a single one."""
        if self.peek() != "{":
            return [self.take()]
        start, self.at = self.at + 1, self._matching() + 1
        return self.tokens[start : self.at - 1]

    def function(self) -> sp.Expr:
        function = FUNCTIONS[self.take()]
        power = self.script() if self._takes("^") else sp.Integer(1)
        return function(self.argument()) ** power

    def argument(self) -> sp.Expr:
        """A bracket, or the factors up to a sign or another function."""
        if self.peek() == "(" or self.peek() == "{" and self.peek(1) == "(":  # \sin{\left(s \right)}
            return self.group()
        value = self.factor()
        while self._begins() and self.peek() not in FUNCTIONS and self.peek() not in OPEN:
            value *= self.factor()
        return value

    def callable(self) -> Callable[..., sp.Expr]:
        key = self._key()
        value = self.names.get(key)
        if not callable(value) or isinstance(value, sp.Expr):
            raise Unreadable(f"{' '.join(self.tokens)!r}: {key!r} is no function here")
        return value

    def name(self) -> sp.Expr:
        return self._indexed(self._key())

    def _indexed(self, key: str) -> sp.Expr:
        while self.peek() == "_" and key.startswith("["):
            self.take()
            key += "_" + "".join(self._inside())
        primes = 0
        while self._takes("'"):
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

    def _key(self) -> str:
        base = self.take()
        if base in ACCENTS:
            base += "".join(self._inside())
        elif base == r"\Delta" and any(name.startswith(base + (self.peek() or " ")) for name in self.names):
            base += self.take()
        elif not re.fullmatch(r"[A-Za-z]|\\[A-Za-z]+", base):
            raise Unreadable(f"{' '.join(self.tokens)!r}: {base!r} is not understood")
        if self.peek() == "^" and self.peek(1) == "*":
            self.at += 2
            base += "*"
        if self.peek() == "_":
            self.take()
            base += "_" + "".join(self._inside())
            if self.peek() == "^" and f"{base}^{self.peek(1)}" in self.names:
                self.at += 2
                base += "^" + self.peek(-1)
        return base
