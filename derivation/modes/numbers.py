"""Expressions over modes in numbers: at a random point with three modes, every index an axis of an array.

Axis 0 is that of the branches, i; axis 1 that of the retardation modes, j; axis 2 that of another branch, k.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from functools import cache, reduce
from operator import add, mul
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..symbols import alpha, beta
from .states import alpha_i, alpha_k, beta_i, beta_j, beta_k, eta_i, exact_modes
from .symbols import J_0, J, S, enter, eta, f, f_0, leave, share, z, z_0
from .tensor import across, back, sandwich, total

MODES, DIGITS = 3, 60
BRANCHES, RETARDATION, OTHER = range(3)
STEP = mpmath.mpf(10) ** -25  # of a difference; an error of its square remains
DEGREE = 5  # of Gauss-Legendre quadrature, as mpmath counts it: 48 nodes
Sample = Mapping[sp.Symbol, Any]


class along(sp.Function):
    """Sum over one axis."""

    nargs = 2


class product_along(sp.Function):
    """Product over one axis; over k, all but i."""

    nargs = 2


class slope(sp.Function):
    """Derivative by a symbol."""

    nargs = 2


def sample(seed: str) -> Sample:
    """Random values of everything that belongs to modes, three of them, whose times are interlaced."""
    draw = random.Random(seed)
    times = np.cumsum([mpmath.mpf(draw.randint(20, 120)) / 100 for _ in range(2 * MODES)])
    modes = exact_modes(list(times[::2]), list(times[1::2]))
    found: dict[sp.Symbol, Any] = {J_0: modes[J_0], enter: modes[enter], leave: modes[leave].T, share: modes[share].T}
    found |= {symbol: _on(modes[symbol], BRANCHES) for symbol in (alpha, eta, S)}
    found |= {symbol: _on(modes[symbol], RETARDATION) for symbol in (beta, J)}
    states = {symbol: np.array([mpmath.mpf(draw.randint(20, 120)) / 100 for _ in range(MODES)]) for symbol in (z, z_0, f, f_0)}
    found |= {symbol: _on(states[symbol], BRANCHES if symbol in (f, f_0) else RETARDATION) for symbol in states}
    others = np.array([[modes[alpha][k] + (i == k) for k in range(MODES)] for i in range(MODES)], dtype=object)
    found |= {alpha_i: found[alpha], eta_i: found[eta], beta_j: found[beta], beta_i: _on(modes[beta], BRANCHES)}
    return found | {alpha_k: others[:, None, :], beta_k: _on(modes[beta], OTHER)}


def _on(vector: np.ndarray, axis: int) -> np.ndarray:
    return np.reshape(vector, tuple(-1 if n == axis else 1 for n in range(3)))


def value(e: Any, point: Sample) -> Any:
    """A number, or an array over the indices that the expression has; a symbol that is no mode's is ``point``'s too."""
    if e in point:
        found = point[e]
        return found[:, :, None] if np.ndim(found) == 2 else found
    if isinstance(e, sp.Add):
        return reduce(add, (value(term, point) for term in e.args))
    if isinstance(e, sp.Mul):
        return reduce(mul, (value(factor, point) for factor in e.args))
    if isinstance(e, sp.Pow):
        return value(e.base, point) ** value(e.exp, point)
    if isinstance(e, (sp.NumberSymbol, sp.Number)):
        return e._to_mpmath(mpmath.mp.prec)
    if e == sp.I:
        return mpmath.mpc(0, 1)
    if isinstance(e, total):
        terms = value(e.args[0], point)
        if np.size(terms) != MODES:
            raise ValueError(f"a sum over the modes of {e.args[0]}")
        return np.sum(terms)
    if isinstance(e, (across, back)):
        vector = value(e.args[1] if isinstance(e, across) else e.args[0], point)
        matrix = value(e.args[0] if isinstance(e, across) else e.args[1], point)
        return np.sum(matrix * vector, axis=int(np.argmax(np.shape(vector))), keepdims=True)
    if isinstance(e, sandwich):  # a matrix stands for what it makes of z_0
        return value(applied(e, z_0), point)
    if isinstance(e, along):
        return np.sum(value(e.args[0], point), axis=int(e.args[1]), keepdims=True)
    if isinstance(e, product_along):
        factors, axis = np.asarray(value(e.args[0], point), dtype=object), int(e.args[1])
        if axis == OTHER:
            factors = np.where(np.eye(MODES, dtype=bool)[:, None, :], mpmath.mpf(1), factors)
        return np.prod(factors, axis=axis, keepdims=True)
    if isinstance(e, slope):
        return _slope(*e.args, point)
    if isinstance(e, sp.Max):
        return max(value(part, point) for part in e.args)
    if isinstance(e, sp.Integral):
        return _integral(*e.args, point)
    if isinstance(e, sp.Function):
        of = getattr(mpmath, FUNCTIONS[type(e)])
        return np.frompyfunc(of, 1, 1)(value(e.args[0], point))
    raise ValueError(f"{e} has no value here")


FUNCTIONS = {each: each.__name__ for each in (sp.exp, sp.sin, sp.cos, sp.tan, sp.atan, sp.acos, sp.re, sp.im)} | {sp.Abs: "fabs"}


def _slope(body: sp.Expr, by: sp.Symbol, point: Sample) -> Any:
    """By a number, or by each entry of a state in turn."""
    start = point[by]
    if not np.ndim(start):
        moves = [STEP]
    else:
        moves = [np.reshape(np.array([STEP * (n == k) for n in range(MODES)]), np.shape(start)) for k in range(MODES)]
    slopes = [
        (value(body, {**point, by: start + move}) - value(body, {**point, by: start - move})) / (2 * STEP) for move in moves
    ]
    return np.reshape(np.array(slopes, dtype=object), np.shape(start)) if np.ndim(start) else slopes[0]


def _integral(body: sp.Expr, over: sp.Tuple, point: Sample) -> Any:
    variable, low, high = over
    start, end = value(low, point), value(high, point)
    middle, half = (start + end) / 2, (end - start) / 2
    return sum(half * weight * value(body, {**point, variable: middle + half * at}) for at, weight in _nodes(mpmath.mp.prec))


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
