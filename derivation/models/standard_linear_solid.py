"""The paper's foundation, Eq. 1: one relaxation time, ``w + T_eps w_t = (p + T_sigma p_t)/K``."""

import sympy as sp

from ..model import Model, Parameter
from ..symbols import K, T_eps, T_sigma

STANDARD_LINEAR_SOLID = Model(
    name="standard_linear_solid",
    title="Standard linear solid",
    parameters=(
        Parameter(K, "K", "Pa/m", "relaxed stiffness of the foundation per area"),
        Parameter(T_eps, "T_eps", "s", "retardation time: creep under constant pressure"),
        Parameter(T_sigma, "T_sigma", "s", "relaxation time: pressure under constant displacement; at most T_eps"),
    ),
    Q=(sp.Integer(1), T_eps),
    P=(1 / K, T_sigma / K),
    differences=((T_eps, T_sigma + sp.Symbol("T_delta", nonnegative=True)),),
)
