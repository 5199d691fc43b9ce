"""Exact values of a derived expression with sums over modes, and their natural scales."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ...certify import STEP
from ...symbols import s_0, s_1
from ..symbols import MATERIAL, MATRICES, STATES, numbered
from ..tensor import components
from .scaled import Scaled

DIGITS = 320
PHASES = ("s", "s_0", "s_1")
Point = dict[sp.Symbol, mpmath.mpf]


class Reference:
    """Values of an exact expression, and their natural scales, part by part of every sum."""

    def __init__(self, exact: Any, n: int):
        names = {(symbol, mode): numbered(symbol, mode) for symbol in (*MATERIAL, *STATES) for mode in range(n)}
        names |= {key: matrix_symbol(*key) for matrix in MATRICES for key in _keys(matrix, n)}
        values = components(exact, n, names)
        self.owner = [k for k, parts in enumerate(values) for _ in parts]
        parts = [part for parts in values for part in parts]
        self.count = len(values)
        self.symbols = sorted(set().union(*(part.free_symbols for part in parts)), key=str)
        self.evaluate = sp.lambdify(self.symbols, parts, modules="mpmath", cse=True)

    def __call__(self, point: Point, scales: Point | None = None) -> Scaled:
        """Values and natural scales at a point. ``scales``: of inputs that are themselves computed, their natural scales."""
        values = self._at(point)
        sizes = [abs(value) for value in self._summed(values)]
        for weight, moved_point in perturbed(point, self.symbols, scales or {}):
            for k, (value, moved) in enumerate(zip(values, self._at(moved_point), strict=True)):
                sizes[self.owner[k]] += weight * abs(moved - value) / STEP
        return Scaled(np.array(self._summed(values), object), np.array(sizes, object))

    def value(self, point: Point) -> Scaled:
        """Values alone, which is much less work; the scales are 0."""
        found = np.array(self._summed(self._at(point)), object)
        return Scaled(found, 0 * found)

    def _at(self, point: Point) -> list[mpmath.mpf]:
        return [mpmath.mpf(value) for value in self.evaluate(*(point[symbol] for symbol in self.symbols))]

    def _summed(self, parts: list[mpmath.mpf]) -> list[mpmath.mpf]:
        sums = [mpmath.mpf(0)] * self.count
        for k, part in zip(self.owner, parts, strict=True):
            sums[k] += part
        return sums


def _keys(matrix: sp.Symbol, n: int) -> Iterator[tuple[sp.Symbol, int, int]]:
    return ((matrix, row, column) for row in range(n) for column in range(n))


def matrix_symbol(matrix: sp.Symbol, row: int, column: int) -> sp.Symbol:
    return sp.Symbol(f"{matrix.name}_{row + 1}_{column + 1}", real=True)


def perturbed(point: Point, symbols: list[sp.Symbol], scales: Point) -> Iterator[tuple[mpmath.mpf, Point]]:
    """(weight, inputs) with one input at a time moved by a relative STEP; phases: the first one, then the width."""
    for symbol in symbols:
        value = point[symbol]
        if symbol in scales:
            if scales[symbol]:
                yield scales[symbol], {**point, symbol: value + STEP}
        elif symbol == s_1 and s_0 in point:
            yield abs(value - point[s_0]), {**point, symbol: value + STEP}
        elif str(symbol) in PHASES:
            moved = {phase: point[phase] + STEP for phase in (symbol, *((s_1,) if s_1 in point else ()))}
            yield max(mpmath.mpf(1), abs(value)), {**point, **moved}
        elif value != 0:
            yield mpmath.mpf(1), {**point, symbol: value * (1 + STEP)}
