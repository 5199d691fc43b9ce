"""Symbols of a generic mode.

A formula is derived and emitted for a *generic* mode: ``alpha``, ``eta``, ``z_0``, ... stand for arrays along the mode axis,
in the order ``alpha_1 <= beta_1 <= alpha_2 <= ...``. Identities between modes are those of :mod:`.states`.
"""

from __future__ import annotations

import sympy as sp

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
