"""Exact values of derived expressions at a point of the grid, with their natural scales.

The expressions are evaluated by mpmath as SymPy derived them, not in the stable form. A sum over modes, over levels, or over
the parts of a balance is as exact as its terms: its scale is that of each term, added up.
"""

from collections.abc import Callable, Sequence
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..functions import flat, written_out
from ..modes.symbols import SUMS, across, is_matrix, sandwich, total
from .point import STEP, Point
from .scaled import given, scaled

MODULES = [{"acos": lambda cosine: mpmath.acos(max(-1, min(1, cosine)))}, "mpmath"]
Evaluated = Callable[[Point], np.ndarray]


class Reference:
    """An exact result, nested as it may be: at a point, all its numbers in the order in which NumPy lays them out."""

    def __init__(self, exact: Any, parts: Sequence[Sequence[sp.Expr]] = ()):
        components = [written_out(sp.sympify(component)) for component in flat(exact)]
        self.groups: list[Any] = []  # of each component: a matrix, or the positions of its parts in what is evaluated together
        plain: list[sp.Expr] = []
        for number, component in enumerate(components):
            if is_matrix(component):
                self.groups.append(_matrix(component))
                continue
            terms = [written_out(term) for term in parts[number]] if parts else [component]
            self.groups.append(slice(len(plain), len(plain) + len(terms)))
            plain += terms
        self.together = Together(plain)

    def __call__(self, point: Point) -> np.ndarray:
        found = self.together(point)
        return np.concatenate(
            [sum(found[g][1:], found[g][0]) if isinstance(g, slice) else np.ravel(g(point)) for g in self.groups]
        )


class Together:
    """Expressions evaluated together, mode by mode; sums that they hold are evaluated first, as inputs with a scale."""

    def __init__(self, expressions: list[sp.Expr]):
        sums = sorted(set().union(*(_outermost(expression) for expression in expressions)), key=str)
        names = [sp.Symbol(f"sum_{number}") for number in range(len(sums))]
        outer = [expression.xreplace(dict(zip(sums, names, strict=True))) for expression in expressions]
        self.sums = {name: _summed(node) for name, node in zip(names, sums, strict=True)}
        self.free = [sorted(expression.free_symbols, key=str) for expression in outer]
        self.symbols = sorted(set().union(*map(set, self.free)), key=str)
        self.evaluate = sp.lambdify(self.symbols, outer, modules=MODULES, cse=True)

    def __call__(self, point: Point) -> list[np.ndarray]:
        if self.sums:
            point = point.at({name: summed(point) for name, summed in self.sums.items()})
        values = self._at(point.values)
        sizes = abs(values)
        for weight, moved in point.directions(self.symbols):
            sizes = sizes + weight * abs(self._at({**point.values, **moved}) - values) / STEP
        rows = [any(np.ndim(point.values[symbol]) for symbol in free) for free in self.free]
        return [row if several else row[:1] for row, several in zip(scaled(values, sizes), rows, strict=True)]

    def _at(self, values: dict[sp.Symbol, Any]) -> np.ndarray:
        """(expressions, modes)."""
        given = [values[symbol] for symbol in self.symbols]
        count = max([np.size(value) for value in given if np.ndim(value)], default=1)
        columns = [
            [mpmath.mpf(v) for v in self.evaluate(*(value[mode] if np.ndim(value) else value for value in given))]
            for mode in range(count)
        ]
        return np.array(columns, dtype=object).T


def _summed(node: sp.Expr) -> Evaluated:
    """A sum as a function of the point: of one number, or of one for each mode."""
    vector = _along_modes(node.args[-1])
    if isinstance(node, total):
        return lambda point: vector(point).sum()
    matrix = _matrix(node.args[0])
    return lambda point: matrix(point) @ vector(point) if isinstance(node, across) else vector(point) @ matrix(point)


def _along_modes(expression: sp.Expr) -> Evaluated:
    """One value for each mode, also where all are the same."""
    inner = Together([expression])
    return lambda point: np.broadcast_to(inner(point)[0], point.modes or 1)


def _matrix(expression: sp.Expr) -> Evaluated:
    if isinstance(expression, sp.Mul) and expression.could_extract_minus_sign():
        positive = _matrix(-expression)
        return lambda point: -positive(point)
    if isinstance(expression, sandwich):
        left, vector, right = _matrix(expression.args[0]), _along_modes(expression.args[1]), _matrix(expression.args[2])
        return lambda point: (left(point) * vector(point)) @ right(point)
    return lambda point: given(point.values[expression])


def _outermost(expression: sp.Expr) -> set[sp.Expr]:
    """The sums of an expression that stand in no other."""
    if isinstance(expression, SUMS):
        return {expression}
    return set().union(*map(_outermost, expression.args))
