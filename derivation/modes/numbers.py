"""Expressions over modes in numbers: at a random point with three modes, every index an axis of an array.

Axis 0 is that of the branches, i; axis 1 that of the retardation modes, j; axis 2 that of another branch, k.
"""

import random
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..functions import helper
from ..symbols import alpha, beta
from .states import alpha_i, alpha_k, beta_i, beta_j, beta_k, eta_i, exact_modes
from .symbols import J_0, J, S, across, enter, eta, f, f_0, leave, sandwich, share, z, z_0

MODES, DIGITS = 3, 60
BRANCHES, RETARDATION, OTHER = range(3)
STEP = sp.Rational(1, 10**25)  # of a difference; an error of its square remains
DEGREE = 5  # of Gauss-Legendre quadrature, as mpmath counts it: 48 nodes
UNITS = sp.symbols(f"unit_:{MODES}")  # of a state: one of its entries
Sample = Mapping[sp.Symbol, Any]


along = helper("along", lambda terms, axis: along(terms, axis))  # sum over one axis
product_along = helper("product_along", lambda factors, axis: product_along(factors, axis))  # over k, all but i
slope = helper("slope", lambda body, by: slope(body, by))  # derivative by a symbol


def sample(seed: str) -> Sample:
    """Random values of everything that belongs to modes, three of them, whose times are interlaced."""
    draw = random.Random(seed)
    times = np.cumsum([mpmath.mpf(draw.randint(20, 120)) / 100 for _ in range(2 * MODES)])
    modes = exact_modes(list(times[::2]), list(times[1::2]))
    found: dict[sp.Symbol, Any] = {J_0: modes[J_0]}
    found |= {enter: modes[enter][:, :, None], leave: modes[leave].T[:, :, None], share: modes[share].T[:, :, None]}
    found |= {symbol: _on(modes[symbol], BRANCHES) for symbol in (alpha, eta, S)}
    found |= {symbol: _on(modes[symbol], RETARDATION) for symbol in (beta, J)}
    states = {symbol: np.array([mpmath.mpf(draw.randint(20, 120)) / 100 for _ in range(MODES)]) for symbol in (z, z_0, f, f_0)}
    found |= {symbol: _on(states[symbol], BRANCHES if symbol in (f, f_0) else RETARDATION) for symbol in states}
    found |= {unit: _on(np.eye(MODES, dtype=object)[n], RETARDATION) for n, unit in enumerate(UNITS)}
    others = np.array([[modes[alpha][k] + (i == k) for k in range(MODES)] for i in range(MODES)], dtype=object)
    found |= {alpha_i: found[alpha], eta_i: found[eta], beta_j: found[beta], beta_i: _on(modes[beta], BRANCHES)}
    return found | {alpha_k: others[:, None, :], beta_k: _on(modes[beta], OTHER)}


def _on(vector: np.ndarray, axis: int) -> np.ndarray:
    return np.reshape(vector, tuple(-1 if n == axis else 1 for n in range(3)))


def value(e: sp.Expr, point: Sample) -> Any:
    """A number, or an array over the indices that the expression has; a symbol that is no mode's is ``point``'s too."""
    symbols, evaluate = _evaluator(sp.sympify(e))
    return evaluate(*(point[symbol] for symbol in symbols))


@cache
def _evaluator(e: sp.Expr) -> tuple[list[sp.Symbol], Callable[..., Any]]:
    plain = e.replace(sandwich, lambda *parts: applied(sandwich(*parts), z_0)).replace(slope, _difference)
    symbols = sorted(plain.free_symbols, key=str)
    return symbols, sp.lambdify(symbols, plain, [ON_ARRAYS, "mpmath"])


def _difference(body: sp.Expr, by: sp.Symbol) -> sp.Expr:
    """The derivative by a number, or by each entry of a state in turn, as a difference."""
    moves = UNITS if by in (z, z_0) else (sp.Integer(1),)
    return sum(unit * (body.subs(by, by + STEP * unit) - body.subs(by, by - STEP * unit)) for unit in moves) / (2 * STEP)


def _total(terms: Any) -> Any:
    if np.size(terms) != MODES:
        raise ValueError("a sum over the modes of what has not one value for each")
    return np.sum(terms)


def _across(matrix: Any, vector: Any) -> Any:
    return np.sum(matrix * vector, axis=int(np.argmax(np.shape(vector))), keepdims=True)


def _product_along(factors: Any, axis: int) -> Any:
    if axis == OTHER:
        factors = np.where(np.eye(MODES, dtype=bool)[:, None, :], mpmath.mpf(1), factors)
    return np.prod(factors, axis=axis, keepdims=True)


def _quad(body: Callable[[Any], Any], limits: tuple[Any, Any]) -> Any:
    middle, half = (limits[0] + limits[1]) / 2, (limits[1] - limits[0]) / 2
    return sum(half * weight * body(middle + half * at) for at, weight in _nodes(mpmath.mp.prec))


ON_ARRAYS = {
    **{
        name: np.frompyfunc(getattr(mpmath, name), 1, 1)
        for name in ("exp", "sin", "cos", "tan", "atan", "acos", "sqrt", "re", "im")
    },
    "total": _total,
    "across": _across,
    "back": lambda vector, matrix: _across(matrix, vector),
    "along": lambda terms, axis: np.sum(terms, axis=int(axis), keepdims=True),
    "product_along": _product_along,
    "quad": _quad,
}
"""What functions of an expression do with an axis for each index."""


@cache
def _nodes(precision: int) -> list[tuple[mpmath.mpf, mpmath.mpf]]:
    return mpmath.calculus.quadrature.GaussLegendre(mpmath.mp).get_nodes(-1, 1, DEGREE, precision)


def applied(matrix: sp.Expr, vector: sp.Expr) -> sp.Expr:
    """A matrix of the derivation times a vector."""
    if isinstance(matrix, sp.Mul) and matrix.could_extract_minus_sign():
        return -applied(-matrix, vector)
    if isinstance(matrix, sandwich):
        return across(matrix.args[0], matrix.args[1] * across(matrix.args[2], vector))
    return across(matrix, vector)
