"""The generalised model: a spring beside n Maxwell branches, ``p = K w + sum_i K_i (w - e_i)``, ``tau_i e_i' + e_i = w``."""

import sympy as sp

from ..model import Model, Parameter, Series, rate
from ..symbols import K

REPRESENTATIVE = 3  # relaxation times of the operators written out for any number of them
K_i, tau_i = sp.symbols("K_i tau_i", positive=True)


def prony_model(name: str, modes: int | None = None, title: str = "") -> Model:
    """The model of a Prony series with ``modes`` relaxation times, or any number, given to the solver as arrays K_i and tau_i.

    Raises :class:`ValueError` for fewer than one relaxation time.
    """
    given, modes = modes, REPRESENTATIVE if modes is None else modes
    if modes < 1:
        raise ValueError(f"prony_model: modes must be at least 1, not {modes}")
    series = Series(K, viscosity=K_i * tau_i / K, time=tau_i, arrays=(K_i, tau_i))
    branches = [series.of_branch(number) for number in range(1, modes + 1)]
    denominator = sp.Mul(*(1 + time * rate for _, time in branches))
    numerator = denominator + sp.Add(
        *(
            viscosity * rate * sp.Mul(*(1 + other * rate for n, (_, other) in enumerate(branches) if n != mode))
            for mode, (viscosity, _) in enumerate(branches)
        )
    )
    return Model(
        name=name,
        title=title or f"Generalised model with {given or 'n'} relaxation times",
        parameters=(
            Parameter(K, "K", "Pa/m", "relaxed stiffness of the foundation per area"),
            Parameter(K_i, "K_i", "Pa/m", "branch moduli, one per relaxation time"),
            Parameter(tau_i, "tau_i", "s", "relaxation times, one per branch"),
        ),
        Q=_coefficients(numerator, modes),
        P=tuple(c / K for c in _coefficients(denominator, modes)),
        series=series,
        any_number=given is None,
    )


def _coefficients(polynomial: sp.Expr, degree: int) -> tuple[sp.Expr, ...]:
    return tuple(reversed(sp.Poly(polynomial, rate).all_coeffs()))[: degree + 1]


GENERALISED = prony_model("generalised")
