"""Integrals by SymPy, of every term by itself and without what does not depend on the variable: few differ."""

from functools import cache
from typing import Any

import sympy as sp


def integral(body: Any, variable: sp.Symbol, *ends: Any) -> sp.Expr:
    """The integral of ``body`` over the ``variable`` between two ``ends``; without these a primitive."""
    total = sp.Integer(0)
    for term in sp.Add.make_args(sp.expand(body)):
        constant, varying = term.as_independent(variable, as_Add=False)
        total += constant * _of_one_term(varying, (variable, *ends) if ends else variable)
    return total


@cache
def _of_one_term(varying: sp.Expr, over: Any) -> sp.Expr:
    return sp.integrate(varying, over)
