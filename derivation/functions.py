"""Functions that stand for themselves in an emitted formula: the stable helpers, and the emitted formulas.

A stable helper is written by hand in ``templates/stable.py.jinja`` because its floating-point form matters; what it
*means* is given here, and every proof goes by the meaning. An emitted :class:`Formula` is a list of labelled
intermediate terms and a result. It is only a way of computing: :func:`.kernel.same` proves that it equals the expression
that SymPy derived.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import sympy as sp


class Helper(sp.Function):
    """A stable helper function. ``meaning`` is its mathematical definition."""

    @classmethod
    def meaning(cls, *args: sp.Expr) -> sp.Expr:
        raise NotImplementedError


class decay(Helper):
    nargs = 2

    @classmethod
    def meaning(cls, tau, T):
        return sp.exp(-tau / T)


class decay_loss(Helper):
    nargs = 2

    @classmethod
    def meaning(cls, tau, T):
        return sp.exp(-tau / T) - 1


class decay_rate(Helper):
    nargs = 2

    @classmethod
    def meaning(cls, tau, T):
        return sp.exp(-tau / T) / T


class decay_mean(Helper):
    nargs = 2

    @classmethod
    def meaning(cls, tau, T):
        return T / tau * (1 - sp.exp(-tau / T))


class loss_mean(Helper):
    nargs = 2

    @classmethod
    def meaning(cls, tau, T):
        return 1 - T / tau * (1 - sp.exp(-tau / T))


class loss_mean_twice(Helper):
    nargs = 2

    @classmethod
    def meaning(cls, tau, T):
        return 1 - 2 * T / tau * (1 - T / tau * (1 - sp.exp(-tau / T)))


class expm1(Helper):
    """exp(x) - 1; NumPy's own."""

    nargs = 1

    @classmethod
    def meaning(cls, x):
        return sp.exp(x) - 1


class divisible(Helper):
    """A relaxation time that can be divided by, also where it vanishes."""

    nargs = 1

    @classmethod
    def meaning(cls, T):
        return T


class per_time(Helper):
    """x/T; 0 where T = 0."""

    nargs = 2

    @classmethod
    def meaning(cls, x, T):
        return x / T


class sine_deficit(Helper):
    nargs = 1

    @classmethod
    def meaning(cls, angle):
        return angle - sp.sin(angle)


class sine_lag(Helper):
    """sin(tau) less its lag over the same time, the integral of exp(-t/T)."""

    nargs = 2

    @classmethod
    def meaning(cls, tau, T):
        return sp.sin(tau) - T * (1 - sp.exp(-tau / T))


class either(Helper):
    """A form for short zones and one for wide ones, proven to be the same by whoever has both."""

    nargs = 3

    @classmethod
    def meaning(cls, width, short, wide):
        return short


class versine(Helper):
    nargs = 1

    @classmethod
    def meaning(cls, angle):
        return 1 - sp.cos(angle)


class hypot(Helper):
    nargs = 2

    @classmethod
    def meaning(cls, one, other):
        return sp.sqrt(one**2 + other**2)


class quotient(Helper):
    """A ratio whose denominator may vanish: infinite there."""

    nargs = 2

    @classmethod
    def meaning(cls, upper, lower):
        return upper / lower


class arc_half(Helper):
    """Half width of the arc where a cosine is above a level, from twice its distances to 1 and to -1 (times any scale)."""

    nargs = 2

    @classmethod
    def meaning(cls, to_top, to_bottom):
        return sp.acos((to_bottom - to_top) / (to_bottom + to_top))


class stack_sum(Helper):
    """Sum over the levels, which lie along the last axis."""

    nargs = 1

    @classmethod
    def meaning(cls, term):
        return cls(term)


HELPERS = (
    decay,
    decay_loss,
    decay_rate,
    decay_mean,
    loss_mean,
    loss_mean_twice,
    expm1,
    divisible,
    per_time,
    sine_deficit,
    sine_lag,
    either,
    versine,
    hypot,
    quotient,
    arc_half,
    stack_sum,
)


@dataclass(frozen=True)
class Formula:
    """How a generated function computes a quantity: labelled intermediate terms, then the result(s).

    ``result`` is an expression, or a tuple of results (nested for a matrix). ``partials`` gives the derivative by an
    argument, by position, where another formula may need it.
    """

    name: str
    args: tuple[sp.Symbol, ...]
    result: Any
    steps: tuple[tuple[sp.Symbol, sp.Expr], ...] = ()
    doc: str = ""
    latex: str = ""
    partials: dict[int, Callable[..., sp.Expr]] = field(default_factory=dict, compare=False)

    def __call__(self, *args: Any) -> sp.Expr:
        """The formula applied to arguments, as one SymPy node."""
        return _node(self)(*args)

    def written_out(self, args: Sequence[Any]) -> Any:
        """Result with labels and calls replaced by what they stand for."""
        labels: dict[sp.Symbol, sp.Expr] = {}
        for label, term in self.steps:
            labels[label] = written_out(term.xreplace(labels))
        binding = dict(zip(self.args, map(sp.sympify, args), strict=True))
        return _map(self.result, lambda e: written_out(e.xreplace(labels)).subs(binding, simultaneous=True))


class Call(sp.Function):
    """Base of the nodes made by calling a :class:`Formula`."""

    formula: Formula

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        try:
            partial = self.formula.partials[argindex - 1]
        except KeyError:
            argument = self.formula.args[argindex - 1]
            raise ValueError(f"{self.formula.name} has no derivative by {argument}") from None
        return partial(*self.args)


_nodes: dict[int, tuple[Formula, type]] = {}


def _node(formula: Formula) -> type:
    if id(formula) not in _nodes:
        node = type(formula.name, (Call,), {"formula": formula, "nargs": len(formula.args)})
        _nodes[id(formula)] = (formula, node)
    return _nodes[id(formula)][1]


def written_out(expression: sp.Expr) -> sp.Expr:
    """Replace every helper and every formula call by what it means."""
    expression = expression.replace(lambda e: isinstance(e, Call), lambda e: e.formula.written_out(e.args))
    return expression.replace(lambda e: isinstance(e, Helper), lambda e: e.meaning(*e.args))


def _map(result: Any, function: Callable[[sp.Expr], sp.Expr]) -> Any:
    if isinstance(result, tuple):
        return tuple(_map(part, function) for part in result)
    return function(sp.sympify(result))
