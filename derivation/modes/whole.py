"""What stands beside the zones: the material's modes, whole levels in complete contact, and regimes without edges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from ..functions import Formula
from ..kernel import Kernel
from ..level import R
from ..symbols import D, K, V, alpha, beta, delta_0, h, l, p_0, p_nominal
from .regimes import ModeRegime
from .saturated import R_LOSS, Complete
from .symbols import J_0, J, S, enter, eta, leave, m, share

kV = sp.Symbol("kV", nonnegative=True)


def whole_kernels(complete: Complete, regimes: Sequence[ModeRegime], springs: bool) -> tuple[Kernel, ...]:
    """Their exact values. ``springs``: every branch has one."""
    exact = {kernel.formula.name: kernel.exact for kernel in complete.kernels}
    passing = {symbol: symbol * 2 * sp.pi * V / l for symbol in (alpha, beta, eta)}  # a level's wave, times in seconds
    of_level = {
        symbol: value.subs(passing, simultaneous=True) for symbol, value in ((R, exact["modulus_ratio"]), (R_LOSS, exact["loss"]))
    }
    level = (K, m, p_0, l, h, V)
    means = tuple(mean.subs(R_LOSS, exact["loss"]) for mean in complete.means.value)
    at_rest = (regime for regime in regimes if regime.sequence in ("a", "f"))
    return (
        _kernel("at_speed", (m, kV), (*(kV * time for time in (alpha, beta, eta)), S, J, J_0, enter, leave, share)),
        *([_kernel("prony", (K, m), (K / S, alpha), springs=True)] if springs else []),
        _kernel("retardation", (K, m), (J_0 / K, J / K, beta)),
        _kernel("level_saturation_penetration", level, complete.penetration.value.subs(of_level), moving=True),
        _kernel("level_saturation_pressure", level, complete.pressure.value.subs(of_level), moving=True),
        _kernel("level_saturation_friction", (K, m, l, h, V), complete.friction.value.subs(of_level), moving=True),
        _kernel("saturated_stack_friction", (K, m, l, h, V, p_nominal), complete.stack.value.subs(of_level), moving=True),
        _kernel("means_c", (m, p_0, delta_0, D), means),
        *(_kernel(f"means_{r.sequence}", (m, p_0, delta_0, D), (r.zones[0].pressure, sp.Integer(0))) for r in at_rest),
    )


def _kernel(name: str, args: tuple[sp.Symbol, ...], exact: Any, moving: bool = False, springs: bool = False) -> Kernel:
    return Kernel(Formula(name, args, exact), exact, None, moving=moving or springs, springs=springs)
