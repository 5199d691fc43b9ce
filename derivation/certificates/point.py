"""A point of the grid on which emitted functions are measured: exact inputs, and the float64 inputs that a function is given."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..functions import evaluator
from ..modes.symbols import MATERIAL, m
from .scaled import STEP, sizes, values

ZERO = mpmath.mpf(10) ** -110  # stands for a vanishing speed or time: the derived forms divide by it
VANISHING = ZERO * 10**24  # what is smaller was made from it
Values = dict[sp.Symbol, Any]


@dataclass(frozen=True)
class Point:
    """Inputs by symbol: numbers, or arrays with one value per mode.

    ``phases`` in order: a move of one moves those after it, since what is given exactly are the widths between them. ``weights``:
    scales of inputs that are themselves computed. ``follow``: inputs that follow from others, by expressions in these.
    """

    values: Values
    given: Values
    phases: tuple[sp.Symbol, ...] = ()
    modes: int = 1
    follow: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    weights: Values = field(default_factory=dict)

    def at(self, computed: Mapping[sp.Symbol, Any]) -> Point:
        """The same point with computed inputs, each a number or an array of :class:`Scaled` ones."""
        exact, weights = ({symbol: part(each) for symbol, each in computed.items()} for part in (values, sizes))
        return replace(self, values=self.values | exact, weights=self.weights | weights)

    def moved(self, inputs: Values, phases: Sequence[sp.Symbol] = ()) -> Point:
        """The same point with other inputs, of which ``phases`` are phases."""
        return replace(self, values=self.values | inputs, phases=tuple(phases))

    def directions(self, symbols: Sequence[sp.Symbol]) -> Iterator[tuple[Any, Values]]:
        """(weight, inputs) with one independent input of ``symbols`` at a time moved by STEP, relatively."""
        wanted = set(symbols)
        for number, phase in enumerate(self.phases):
            later = [symbol for symbol in self.phases[number:] if symbol in wanted]
            if later:
                value = self.values[phase]
                width = abs(value - self.values[self.phases[number - 1]]) if number else max(mpmath.mpf(1), abs(value))
                yield self.weights.get(phase, width), self.values | {symbol: self.values[symbol] + STEP for symbol in later}
        inputs = set().union(*(self.follow.get(symbol, symbol).free_symbols for symbol in wanted - set(self.phases)))
        for symbol in sorted(inputs, key=str):
            value = self.values[symbol]
            if symbol in self.weights:
                yield self.weights[symbol], self.values | {symbol: value + STEP}
            elif np.any(value):
                changed = self.values | {symbol: value * (1 + STEP)}
                yield 1, changed | following(self.follow, changed)

    def value(self, expression: Any) -> mpmath.mpf:
        """An expression in the inputs; a number is itself."""
        return expression if isinstance(expression, mpmath.mpf) else evaluated(expression, self.values)

    def called(self, solver: Any, name: str, symbols: Sequence[sp.Symbol], *more: Any) -> Any:
        """An emitted function of the float64 values of ``symbols``, and of ``more``."""
        given = self.given | ({m: solver.Modes(*(self.given[each] for each in MATERIAL))} if m in symbols else {})
        return getattr(solver, name)(*(given[symbol] for symbol in symbols), *more)

    def shown(self) -> dict[str, float]:
        """Every number given, by name."""
        found = {}
        for symbol, value in self.given.items():
            if np.ndim(value) < 2:
                found |= {f"{symbol}{f'_{k + 1}' * bool(np.ndim(value))}": v for k, v in enumerate(np.ravel(value).tolist())}
        return found


def following(follow: Mapping[sp.Symbol, sp.Expr], values: Values) -> Values:
    """The inputs that follow from the others among ``values``."""
    return {symbol: evaluated(expression, values) for symbol, expression in follow.items()}


def evaluated(expression: Any, values: Values) -> mpmath.mpf:
    symbols, evaluate = evaluator(expression, "mpmath")
    return mpmath.mpf(evaluate(*(values[symbol] for symbol in symbols)))


def rounded(value: Any) -> Any:
    """float64 of an exact input; what stands for zero is zero."""
    if np.ndim(value):
        return np.array([rounded(each) for each in np.ravel(value)]).reshape(np.shape(value))
    return 0.0 if 0 < value < VANISHING else float(value)
