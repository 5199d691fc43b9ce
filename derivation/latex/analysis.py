"""Derivatives, integrals, sums over an index, limits and rises in LaTeX."""

from __future__ import annotations

import sympy as sp

from .terms import Terms
from .tokens import Unreadable


class Analysis(Terms):
    """An expression with everything that the displays use."""

    def partial(self) -> sp.Expr:
        r"""``\partial g/\partial s_0`` or ``\partial_{s_0} g``; a function is taken at the phase that ``names["end"]`` gives."""
        self.take()
        differentiated = self.names.get("partial", sp.diff)
        if self.takes("_"):
            variable = self.script()
            return differentiated(self.name(), variable)
        key = self.key()
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

    def bracket(self) -> sp.Expr:
        """``[w]``, a step with a name of its own; ``[u]_a^b``, a rise; or a plain bracket."""
        end = self.matching()
        inside = "".join(self.tokens[self.at + 1 : end])
        if f"[{inside}]" in self.names:
            self.at = end + 1
            return self.indexed(f"[{inside}]")
        if end + 1 < len(self.tokens) and self.tokens[end + 1] == "_":
            self.take()
            function = self.callable()
            self.take("]")
            low, high = self.limits()
            return function(high) - function(low)
        return self.group()

    def limits(self) -> tuple[sp.Expr, sp.Expr]:
        self.take("_")
        low = self.script()
        self.take("^")
        return low, self.script()

    def fraction(self) -> sp.Expr:
        self.take()
        derivative = self.derivative()
        if derivative is not None:
            return derivative
        upper = self.script()
        return upper / self.script()

    def derivative(self) -> sp.Expr | None:
        r"""``\frac{\partial w}{\partial t}``, ``\frac{\partial}{\partial x} f`` and with d; None for a plain fraction."""
        if self.peek() != "{" or self.peek(1) not in (r"\partial", "d") or self.peek(1) == "d" and self.peek(2).isdigit():
            return None
        mark = self.peek(1)
        end = self.matching()
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
        function = type(self)(of, self.names).sum() if of else self.factor()
        return sp.Derivative(function, variable)

    def summed(self) -> sp.Expr:
        kind = self.take().lstrip("\\")
        self.take("_")
        index, first, last = self._range()
        body = self.factor() if kind == "prod" else self.product()
        over = self.names[f"{kind} over {index}"]
        return over(body, first, last)

    def _range(self) -> tuple[str, sp.Expr | None, sp.Expr | None]:
        inside = self.inside()
        if "=" not in inside:
            return inside[0], None, None
        first = type(self)(inside[2:], self.names).sum()
        self.take("^")
        return inside[0], first, self.script()

    def integral(self) -> sp.Expr:
        kind = self.take()
        domain = limits = None
        if self.peek() == "_" and kind == r"\iint":
            self.take()
            domain = "".join(self.inside())
        elif self.peek() == "_":
            limits = self.limits()
        self.differentials.append(True)
        body = self.product()
        variables = []
        while self.differential():
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
