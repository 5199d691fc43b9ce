"""Which foundations belong to the class that is derived: linear, with constant coefficients and finitely many times.

What does not belong is refused with the reason and the way out, before anything is derived.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import sympy as sp
from sympy.core.function import AppliedUndef

from .check import Claim, DerivationError, holds
from .symbols import T_eps, rate

if TYPE_CHECKING:
    from .model import Model

WAY_OUT = (
    "Fit a Prony series to the storage and loss modulus of the element over the frequencies that matter, "
    "hystrip.dma.fit_prony(DynamicModulus(omega, storage, loss), terms=n), and derive prony_model(name, modes=n)."
)
PIPELINE = (
    "Model(...) without a series is taken for the paper's foundation, w + T_eps w' = (p + T_sigma p')/K in the symbols of "
    "hystrip.derivation.symbols. Other operators are given as operator_model(name, parameters, Q, P), which finds the times "
    "from their roots; moduli and times as prony_model(name, modes=n)."
)


def require_member(model: Model) -> None:
    """Raise :class:`DerivationError` for a foundation outside the class."""
    reasons = outside(model)
    if reasons:
        raise DerivationError("model", f"{model.name!r} is outside the class that is derived: {'; '.join(reasons)}. {WAY_OUT}")


def require_constructor(model: Model) -> None:
    """Raise :class:`DerivationError` for a model without a series that is not in the paper's symbols."""
    if model.modes != 1:
        shape = f"its operators are of order {model.modes} and it states no Prony series"
    elif T_eps not in model.Q[1].free_symbols:
        shape = "it has one relaxation time in parameters of its own"
    else:
        return
    raise DerivationError("model", f"{model.name!r} belongs to operator_model: {shape}. {PIPELINE}")


def outside(model: Model) -> list[str]:
    """The reasons why a model is no linear law with constant coefficients and integer derivatives."""
    known = {parameter.symbol for parameter in model.parameters}
    reasons = []
    series = (model.series.K, model.series.viscosity, model.series.time) if model.stated else ()
    for label, operator in (("Q", model.Q), ("P", model.P), ("series", series)):
        for n, coefficient in enumerate(map(sp.sympify, operator)):
            what = f"{label}[{n}] = {coefficient}"
            foreign = sorted(map(str, coefficient.free_symbols - known - {rate}))
            if coefficient.has(rate):
                reasons.append(
                    f"{what} holds d/dt itself, as a fractional element does: it has no finite number of internal states"
                )
            elif coefficient.atoms(AppliedUndef):
                reasons.append(f"{what} depends on the motion, as a nonlinear dashpot does: motions cannot be superposed")
            elif foreign:
                reasons.append(f"{what} depends on {', '.join(foreign)}, which is no parameter of the material")
    return reasons


def constant_coefficients(model: Model) -> Claim:
    """The claim that both operators hold constants of the material alone."""
    claim = "both operators have constant coefficients: nothing in them but parameters of the material"
    return holds(claim, not outside(model))
