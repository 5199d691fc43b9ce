"""The symbols of the derivation, named as in the paper where the paper names them.

SI symbols carry the paper's units. Inside a strip everything is dimensionless: lengths in units of the amplitude ``A``,
pressures in units of ``K A``, and the phase ``s = -k x``, which grows in the time of a material point.
"""

import sympy as sp

rate = sp.Symbol("rate")  # stands for d/dt in the operators of a model

# Surface and motion (SI)
x, y, t = sp.symbols("x y t", real=True)
V, k, l, h, A, K = sp.symbols("V k l h A K", positive=True)  # noqa: E741
T_eps, T_sigma = sp.symbols("T_epsilon T_sigma", positive=True)
D_level = sp.Symbol("D", real=True)  # penetration of a level; that of a strip is D_j
D_j = sp.Symbol("D_j", real=True)
p_nominal = sp.Symbol("p_1", positive=True)

# One strip, dimensionless
s, s_0, s_1 = sp.symbols("s s_0 s_1", real=True)
alpha, beta = sp.symbols("alpha beta", positive=True)  # k V T_sigma, k V T_eps
J, L = sp.symbols("J L", positive=True)  # instantaneous compliance times K; L = 1 - J
p_0, delta_0 = sp.symbols("p_0 delta_0", nonnegative=True)
D = sp.Symbol("D", real=True)  # D_j / A
chi = sp.Symbol("chi", nonnegative=True)  # 0: w continuous where p steps; 1: constitutive
p = sp.Symbol("p", real=True)  # a constant pressure: 0 or -p_0
gap_0, q_0, p_in, lag_0, w_0 = sp.symbols("gap_0 q_0 p_in lag_0 w_0", real=True)  # state where a zone begins
excess = sp.Symbol("excess", real=True)

# Edges of the zones, in the order a material point meets them: adhesion begins (d), contact begins (b), contact
# ends (a), adhesion ends (c). At the paper's positions x = d, b, -a, -c.
d, b, a, c = sp.symbols("d b a c", real=True)

PARAMETERS = (alpha, beta, J, L, p_0, delta_0, D, chi)
