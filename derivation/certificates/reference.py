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
from .point import Point
from .scaled import given, naturally

MODULES = [{"acos": lambda cosine: mpmath.acos(max(-1, min(1, cosine)))}, "mpmath"]
Evaluated = Callable[[Point], np.ndarray]


class Reference:
    """An exact result, nested as it may be: at a point, all its numbers in the order in which NumPy lays them out."""

    def __init__(self, exact: Any, parts: Sequence[Sequence[sp.Expr]] = ()):
        components = [[written_out(sp.sympify(term)) for term in terms] for terms in parts or zip(flat(exact), strict=True)]
        self.together = Together([term for terms in components for term in terms if not is_matrix(term)])
        self.matrices = [[_matrix(term) if is_matrix(term) else None for term in terms] for terms in components]

    def __call__(self, point: Point) -> np.ndarray:
        plain = iter(self.together(point))
        found = [[np.ravel(matrix(point)) if matrix else next(plain) for matrix in terms] for terms in self.matrices]
        return np.concatenate([sum(rest, first) for first, *rest in found])


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
        found = naturally(self._at, point.values, point.directions(self.symbols))
        several = (any(np.ndim(point.values[symbol]) for symbol in free) for free in self.free)
        return [row if of_modes else row[:1] for row, of_modes in zip(found, several, strict=True)]

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
    return lambda point: np.broadcast_to(inner(point)[0], point.modes)


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
