"""Kelvin-Voigt: a spring and a dashpot side by side, ``p = K (w + T_eps w_t)``; no instantaneous compliance."""

import sympy as sp

from ..model import Model, Parameter, Series
from ..symbols import K, T_eps

KELVIN_VOIGT = Model(
    name="kelvin_voigt",
    title="Kelvin-Voigt solid",
    parameters=(
        Parameter(K, "K", "Pa/m", "relaxed stiffness of the foundation per area"),
        Parameter(T_eps, "T_eps", "s", "retardation time: creep under constant pressure"),
    ),
    Q=(sp.Integer(1), T_eps),
    P=(1 / K, sp.Integer(0)),
    series=Series(K, viscosity=T_eps, time=sp.Integer(0)),
)
