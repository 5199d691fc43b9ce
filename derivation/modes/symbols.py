"""Symbols of a generic mode; sums over modes, and products with matrices between them, in a formula.

A formula is derived and emitted for a *generic* mode: ``alpha``, ``eta``, ``z_0``, ... stand for arrays along the mode axis,
in the order ``alpha_1 <= beta_1 <= alpha_2 <= ...``. Identities between modes are those of :mod:`.states`.
"""

from typing import Any

import sympy as sp

from ..functions import Helper, Scaling, helper
from ..symbols import D, alpha, beta, delta_0, p_0

m = sp.Symbol("m")  # the material of a strip, in the emitted code
z_0, f_0 = sp.symbols("z_0 f_0", real=True)  # state in which a zone is entered, per mode
z, f = sp.symbols("z f", real=True)
eta, S, J = sp.symbols("eta S J", nonnegative=True)  # branch viscosity and compliance, retardation compliance
J_0 = sp.Symbol("J_0", nonnegative=True)  # instantaneous compliance
enter, leave, share = sp.symbols("enter leave share")  # matrices between retardation modes and branches

MATERIAL = (alpha, beta, eta, S, J, J_0, enter, leave, share)
OF_STRIP = (m, p_0, delta_0, D)
MATRICES = (enter, leave, share)
STATES = (z_0, f_0, z, f)


class total(Helper):
    """Sum over the modes."""

    nargs = 1

    def _latex(self, printer, exp=None):
        of_all = rf"\sum \left({printer.doprint(self.args[0])}\right)"
        return of_all if exp is None else rf"\left({of_all}\right)^{{{exp}}}"

    @staticmethod
    def meaning(term):
        return total(term)


# of vectors and matrices along the mode axis
across = helper("across", lambda matrix, vector: across(matrix, vector))  # a matrix times a vector
back = helper("back", lambda vector, matrix: back(vector, matrix))  # a vector times a matrix
sandwich = helper("sandwich", lambda left, vector, right: sandwich(left, vector, right))  # left diag(vector) right


class at_speed(Scaling):
    """The modes of a strip that passes at a rate: their times multiplied by it."""

    def scaled(self) -> dict[sp.Symbol, sp.Expr]:
        return {time: self.args[1] * time for time in (alpha, beta, eta)}


SUMS = (total, across, back, sandwich)


def generic(expression: sp.Expr) -> sp.Expr:
    """The expression with every sum as a factor: equal terms under the same sum make equal sums."""
    under = sp.Symbol("total", positive=True)

    def factor(node: sp.Expr) -> sp.Expr:
        return under * node.args[0] if isinstance(node, total) else sp.Mul(*node.args)

    return expression.replace(lambda e: isinstance(e, SUMS), factor)


def is_matrix(expression: Any) -> bool:
    plain = -expression if isinstance(expression, sp.Mul) and expression.could_extract_minus_sign() else expression
    return plain in MATRICES or isinstance(plain, sandwich)
