"""Functions that stand for themselves in an emitted formula: the stable helpers, and the emitted formulas.

A stable helper is written by hand in ``templates/stable.py.jinja`` because its floating-point form matters; what it
*means* is given here, and every proof goes by the meaning. An emitted :class:`Formula` is a list of labelled
intermediate terms and a result. It is only a way of computing: :func:`.kernel.same` proves that it equals the expression
that SymPy derived.
"""

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import sympy as sp


class Helper(sp.Function):
    """A function that stands for itself in a formula. ``meaning`` is its mathematical definition, where it has one."""

    @staticmethod
    def meaning(*args: sp.Expr) -> sp.Expr:
        raise NotImplementedError


class Scaling(Helper):
    """An argument whose parts stand in a formula under names of their own: ``scaled`` says what each is."""

    def scaled(self) -> dict[sp.Symbol, sp.Expr]:
        raise NotImplementedError


def helper(name: str, meaning: Callable[..., sp.Expr]) -> type[Helper]:
    """The helper of a name that has the arguments of its ``meaning``."""
    inside = {"nargs": len(inspect.signature(meaning).parameters), "meaning": staticmethod(meaning), "__module__": __name__}
    return type(name, (Helper,), inside)


# tau is a time since a zone was entered, T a relaxation time
decay = helper("decay", lambda tau, T: sp.exp(-tau / T))
decay_loss = helper("decay_loss", lambda tau, T: sp.exp(-tau / T) - 1)
decay_rate = helper("decay_rate", lambda tau, T: sp.exp(-tau / T) / T)
decay_mean = helper("decay_mean", lambda tau, T: T / tau * (1 - sp.exp(-tau / T)))
loss_mean = helper("loss_mean", lambda tau, T: 1 - T / tau * (1 - sp.exp(-tau / T)))
loss_mean_twice = helper("loss_mean_twice", lambda tau, T: 1 - 2 * T / tau * (1 - T / tau * (1 - sp.exp(-tau / T))))
expm1 = helper("expm1", lambda x: sp.exp(x) - 1)  # NumPy's own
divisible = helper("divisible", lambda T: T)  # also where it vanishes
per_time = helper("per_time", lambda x, T: x / T)  # 0 where T = 0
sine_deficit = helper("sine_deficit", lambda angle: angle - sp.sin(angle))
# sin(tau) less its lag over the same time, the integral of exp(-t/T)
sine_lag = helper("sine_lag", lambda tau, T: sp.sin(tau) - T * (1 - sp.exp(-tau / T)))
# a form for short zones and one for wide ones, proven to be the same by whoever has both
either = helper("either", lambda width, short, wide: short)
versine = helper("versine", lambda angle: 1 - sp.cos(angle))
hypot = helper("hypot", lambda one, other: sp.sqrt(one**2 + other**2))
# half width of the arc where a cosine is above a level, from twice its distances to 1 and to -1 (times any scale)
arc_half = helper("arc_half", lambda to_top, to_bottom: sp.acos((to_bottom - to_top) / (to_bottom + to_top)))

HELPERS = tuple(
    each for each in vars().values() if isinstance(each, type) and (Helper,) == each.__bases__ and each is not Scaling
)
"""In the order of their definitions."""


@dataclass(frozen=True)
class Formula:
    """How a generated function computes a quantity: labelled intermediate terms, then the result(s).

    ``result`` is an expression, or a tuple of results (nested for a matrix).
    """

    name: str
    args: tuple[sp.Symbol, ...]
    result: Any
    steps: tuple[tuple[sp.Symbol, sp.Expr], ...] = ()

    def __call__(self, *args: Any) -> sp.Expr:
        """The formula applied to arguments, as one SymPy node."""
        return _node(self)(*args)

    def written_out(self, args: Sequence[Any] | None = None) -> Any:
        """Result with labels and calls replaced by what they stand for, of ``args`` or of the formula's own."""
        labels: dict[sp.Symbol, sp.Expr] = {}
        for label, term in self.steps:
            labels[label] = written_out(term.xreplace(labels))
        binding = dict(zip(self.args, map(sp.sympify, self.args if args is None else args), strict=True))

        def bound(e: sp.Expr) -> sp.Expr:
            e = written_out(e.xreplace(labels)).subs(binding, simultaneous=True)
            for scaling in (value for value in binding.values() if isinstance(value, Scaling)):
                e = e.subs(scaling.scaled(), simultaneous=True)
            return e

        return mapped(self.result, bound)


class Call(sp.Function):
    """Base of the nodes made by calling a :class:`Formula`."""

    formula: Formula


@cache
def _node(formula: Formula) -> type:
    return type(formula.name, (Call,), {"formula": formula, "nargs": len(formula.args)})


def written_out(expression: sp.Expr) -> sp.Expr:
    """Replace every helper and every formula call by what it means."""
    expression = expression.replace(lambda e: isinstance(e, Call), lambda e: e.formula.written_out(e.args))
    return expression.replace(lambda e: isinstance(e, Helper), lambda e: e.meaning(*e.args))


@cache
def evaluator(expression: Any, module: str) -> tuple[list[sp.Symbol], Callable[..., Any]]:
    """The symbols of an expression, and the function of them that computes it by ``module``."""
    plain = written_out(sp.sympify(expression))
    symbols = sorted(plain.free_symbols, key=str)
    return symbols, sp.lambdify(symbols, plain, module)


def flat(value: Any) -> list[Any]:
    """What nested tuples hold, in order; of anything else, itself."""
    return [part for item in value for part in flat(item)] if isinstance(value, (tuple, list)) else [value]


def mapped(result: Any, function: Callable[[sp.Expr], sp.Expr]) -> Any:
    """Nested tuples with a function of each part."""
    if isinstance(result, tuple):
        return tuple(mapped(part, function) for part in result)
    return function(sp.sympify(result))
