"""A point of the grid on which emitted functions are measured: exact inputs, and the float64 inputs that a function is given."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..modes.symbols import MATERIAL, m
from ..symbols import J, L, alpha, beta
from .scaled import sizes, values

ZERO = mpmath.mpf(10) ** -110  # stands for a vanishing speed or time: the derived forms divide by it
VANISHING = ZERO * 10**24  # what is smaller was made from it
STEP = mpmath.mpf(10) ** -60  # relative change of an input
Values = dict[sp.Symbol, Any]


@dataclass(frozen=True)
class Point:
    """Inputs by symbol: numbers, or arrays with one value per mode.

    ``phases`` in order: a move of one moves those after it, since what is given exactly are the widths between them. ``weights``:
    scales of inputs that are themselves computed. ``coupled``: J or L is the independent one of alpha, J and L.
    """

    values: Values
    given: Values
    phases: tuple[sp.Symbol, ...] = ()
    modes: int | None = None
    coupled: sp.Symbol | None = None
    weights: Values = field(default_factory=dict)

    def at(self, computed: dict[sp.Symbol, Any]) -> Point:
        """The same point with computed inputs, each a number or an array of :class:`Scaled` ones."""
        exact, weights = ({symbol: part(each) for symbol, each in computed.items()} for part in (values, sizes))
        return replace(self, values={**self.values, **exact}, weights={**self.weights, **weights})

    def moved(self, inputs: Values, phases: Sequence[sp.Symbol], known_to: Values | None = None) -> Point:
        """The same point with other inputs, of which ``phases`` are phases; ``known_to``: scales of inputs, if not their own."""
        return replace(self, values={**self.values, **inputs}, phases=tuple(phases), weights={**self.weights, **(known_to or {})})

    def directions(self, symbols: Sequence[sp.Symbol]) -> Iterator[tuple[Any, Values]]:
        """(weight, changed inputs) with one independent input of ``symbols`` at a time moved by STEP, relatively."""
        wanted = set(symbols)
        for number, phase in enumerate(self.phases):
            later = [symbol for symbol in self.phases[number:] if symbol in wanted]
            if later:
                value = self.values[phase]
                width = abs(value - self.values[self.phases[number - 1]]) if number else max(mpmath.mpf(1), abs(value))
                yield self.weights.get(phase, width), {symbol: self.values[symbol] + STEP for symbol in later}
        for symbol in self._independent(wanted):
            value = self.values[symbol]
            if symbol in self.weights:
                yield self.weights[symbol], {symbol: value + STEP}
            elif np.any(value):
                yield 1, self._with_coupled({symbol: value * (1 + STEP)})

    def _independent(self, wanted: set[sp.Symbol]) -> list[sp.Symbol]:
        found = wanted - set(self.phases)
        if self.coupled is not None and wanted & {alpha, J, L}:
            found = (found - {alpha, J, L}) | {self.coupled} | ({beta} if alpha in wanted else set())
        return sorted(found, key=str)

    def _with_coupled(self, changed: Values) -> Values:
        if self.coupled is None or not changed.keys() & {beta, self.coupled}:
            return changed
        known = {**self.values, **changed}
        ratio = known[J] if self.coupled is J else 1 - known[L]
        return {**changed, J: ratio, L: 1 - ratio if self.coupled is J else known[L], alpha: ratio * known[beta]}

    def argument(self, symbol: sp.Symbol, solver: Any) -> Any:
        """The float64 value of one argument of an emitted function."""
        return solver.Modes(*(self.given[field] for field in MATERIAL)) if symbol == m else self.given[symbol]

    def shown(self) -> dict[str, float]:
        """Every number given, by name."""
        found = {}
        for symbol, value in self.given.items():
            if np.ndim(value) < 2:
                found |= {f"{symbol}{f'_{k + 1}' * bool(np.ndim(value))}": v for k, v in enumerate(np.ravel(value).tolist())}
        return found


def rounded(value: Any) -> Any:
    """float64 of an exact input; what stands for zero is zero."""
    if np.ndim(value):
        return np.array([rounded(each) for each in np.ravel(value)]).reshape(np.shape(value))
    return 0.0 if 0 < value < VANISHING else float(value)
