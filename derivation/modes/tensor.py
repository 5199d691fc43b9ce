"""Sums over modes in a formula, and a formula written out for the modes of an actual model."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp

from ..functions import Helper, written_out
from .symbols import MATRICES, VECTORS, numbered


class total(Helper):
    """Sum over the modes."""

    nargs = 1

    def _latex(self, printer, exp=None):
        of_all = rf"\sum \left({printer.doprint(self.args[0])}\right)"
        return of_all if exp is None else rf"\left({of_all}\right)^{{{exp}}}"

    @classmethod
    def meaning(cls, term):
        return cls(term)


class across(Helper):
    """A matrix times a vector, both along the mode axis."""

    nargs = 2

    @classmethod
    def meaning(cls, matrix, vector):
        return cls(matrix, vector)


class back(Helper):
    """A vector times a matrix: across with the transposed matrix."""

    nargs = 2

    @classmethod
    def meaning(cls, matrix, vector):
        return cls(matrix, vector)


class sandwich(Helper):
    """matrix diag(vector) matrix."""

    nargs = 3

    @classmethod
    def meaning(cls, left, vector, right):
        return cls(left, vector, right)


class diagonal(Helper):
    """The matrix with a vector on its diagonal."""

    nargs = 1

    @classmethod
    def meaning(cls, vector):
        return cls(vector)


SUMS = (total, across, back, sandwich, diagonal)
Values = Mapping[Any, sp.Expr]
"""What a numbered quantity of an actual model stands for: by (symbol, mode) and (matrix, row, column)."""


def component(expression: sp.Expr, n: int, values: Values, row: int | None = None) -> sp.Expr:
    """Component ``row`` of ``expression`` for a model of ``n`` modes; of a scalar, the scalar itself.

    ``values`` replaces numbered quantities; those it does not name stay symbols.
    """
    if expression in VECTORS:
        if row is None:
            raise ValueError(f"{expression} has one component per mode")
        return values.get((expression, row), numbered(expression, row))
    if isinstance(expression, (total, across, back)):
        return sp.Add(*_terms(expression, n, values, row))
    if not expression.args:
        return values.get(expression, expression)
    return expression.func(*(component(argument, n, values, row) for argument in expression.args))


def _terms(summed: sp.Expr, n: int, values: Values, row: int | None) -> list[sp.Expr]:
    """The term of every mode in a sum over modes."""
    vector = [component(summed.args[-1], n, values, mode) for mode in range(n)]
    if isinstance(summed, total):
        return vector
    matrix = summed.args[0]
    if isinstance(summed, across):
        return [entry(matrix, row, mode, n, values) * vector[mode] for mode in range(n)]
    return [vector[mode] * entry(matrix, mode, row, n, values) for mode in range(n)]


def entry(matrix: sp.Expr, row: int, column: int, n: int, values: Values) -> sp.Expr:
    """One entry of a matrix."""
    if isinstance(matrix, sp.Mul) and matrix.could_extract_minus_sign():
        return -entry(-matrix, row, column, n, values)
    if isinstance(matrix, sandwich):
        left, vector, right = matrix.args
        return sp.Add(
            *(
                entry(left, row, mode, n, values) * component(vector, n, values, mode) * entry(right, mode, column, n, values)
                for mode in range(n)
            )
        )
    if isinstance(matrix, diagonal):
        return component(matrix.args[0], n, values, row) if row == column else sp.Integer(0)
    if matrix not in MATRICES:
        raise ValueError(f"{matrix} is no matrix")
    return values[(matrix, row, column)]


def generic(expression: sp.Expr) -> sp.Expr:
    """The expression with every sum as a factor: equal terms under the same sum make equal sums."""
    under = sp.Symbol("total", positive=True)

    def factor(node: sp.Expr) -> sp.Expr:
        if isinstance(node, (total, diagonal)):
            return under * node.args[0]
        return sp.Mul(*node.args)

    return expression.replace(lambda e: isinstance(e, SUMS), factor)


def is_matrix(expression: Any) -> bool:
    plain = -expression if isinstance(expression, sp.Mul) and expression.could_extract_minus_sign() else expression
    return plain in MATRICES or isinstance(plain, (sandwich, diagonal))


def is_vector(expression: Any) -> bool:
    """Whether the expression has one component per mode: a mode's symbol outside of any sum, or a matrix product."""
    expression = sp.sympify(expression)
    if isinstance(expression, total):
        return False
    return isinstance(expression, (across, back)) or expression in VECTORS or any(map(is_vector, expression.args))


def components(result: Any, n: int, values: Values) -> list[list[sp.Expr]]:
    """Every component of a result, nested as it may be, in the order in which NumPy lays it out; each as the parts it sums.

    A part is one mode's term of a sum over modes, or everything outside such sums together.
    """
    if isinstance(result, tuple):
        return [part for item in result for part in components(item, n, values)]
    result = written_out(sp.sympify(result))
    if is_matrix(result):
        return [[entry(result, row, column, n, values)] for row in range(n) for column in range(n)]
    rows = range(n) if is_vector(result) else (None,)
    return [_parts(result, n, values, row) for row in rows]


def _parts(expression: sp.Expr, n: int, values: Values, row: int | None) -> list[sp.Expr]:
    parts, outside = [], []
    for term in sp.Add.make_args(expression):
        sums = [factor for factor in sp.Mul.make_args(term) if isinstance(factor, (total, across, back))]
        if len(sums) != 1:
            outside.append(component(term, n, values, row))
            continue
        others = component(term / sums[0], n, values, row)
        parts += [others * part for part in _terms(sums[0], n, values, row)]
    return [*parts, *([sp.Add(*outside)] if outside else [])] or [sp.Integer(0)]
