"""The generalised model: a spring beside n Maxwell branches, ``p = K w + sum_i K_i (w - e_i)``, ``tau_i e_i' + e_i = w``."""

import sympy as sp

from ..model import Model, Parameter, Series
from ..symbols import K

K_i, tau_i = sp.symbols("K_i tau_i", positive=True)


def prony_model(name: str, modes: int | None = None, title: str = "") -> Model:
    """The model of a Prony series with ``modes`` relaxation times, or any number, given to the solver as arrays K_i and tau_i.

    Raises :class:`ValueError` for fewer than one relaxation time.
    """
    if modes is not None and modes < 1:
        raise ValueError(f"prony_model: modes must be at least 1, not {modes}")
    return Model(
        name=name,
        title=title or f"Generalised model with {modes or 'n'} relaxation times",
        parameters=(
            Parameter(K, "K", "Pa/m", "relaxed stiffness of the foundation per area"),
            Parameter(K_i, "K_i", "Pa/m", "branch moduli, one per relaxation time"),
            Parameter(tau_i, "tau_i", "s", "relaxation times, one per branch"),
        ),
        Q=(),
        P=(),
        series=Series(K, viscosity=K_i * tau_i / K, time=tau_i, arrays=(K_i, tau_i)),
        count=modes,
    )


GENERALISED = prony_model("generalised")
