"""A model given by its operators: ``Q(d/dt) w = P(d/dt) p`` in parameters of its own."""

from collections.abc import Sequence

import sympy as sp

from ..check import DerivationError
from ..model import Model, Parameter, Roots


def operator_model(
    name: str, parameters: Sequence[Parameter], Q: Sequence[sp.Expr], P: Sequence[sp.Expr], title: str = ""
) -> Model:
    """The model whose operators have the coefficients ``Q`` and ``P``, of the powers 0, 1, ..., n of d/dt.

    Its relaxation and retardation times are found by the solver once the parameters are numbers; numbers that make no passive,
    stable solid are refused there. Raises :class:`DerivationError` for operators that do not belong together.
    """
    Q, P = (tuple(map(sp.sympify, operator)) for operator in (Q, P))
    if len(Q) != len(P) or len(Q) < 2:
        raise DerivationError(
            name, f"Q and P have coefficients of the same powers 0 .. n, n >= 1; these have {len(Q)} and {len(P)}"
        )
    known = {parameter.symbol for parameter in parameters}
    unknown = sorted(str(symbol) for coefficient in (*Q, *P) for symbol in coefficient.free_symbols - known)
    if unknown:
        raise DerivationError(name, f"every symbol of the operators is among the parameters; {', '.join(unknown)} is not")
    return Model(name, title or name, tuple(parameters), Q, P, series=Roots(sp.cancel(Q[0] / P[0])))
