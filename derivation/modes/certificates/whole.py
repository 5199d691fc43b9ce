"""What stands beside the zones: the material's modes, whole levels in complete contact, and regimes without edges."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ...certify import Certificate
from ...model import Series
from ...symbols import D, K, V, alpha, beta, delta_0, h, l, p_0, p_nominal
from ..derive import ModesDerivation
from ..material import series_of
from ..saturated import R_LOSS, R
from ..symbols import J_0, J, S, enter, eta, leave, m, share
from .inputs import Inputs
from .material import measure_material
from .reference import DIGITS, Reference
from .worst import Worst

POINTS = 60
MATERIAL_MODES = "material_modes"
kV = sp.Symbol("kV", nonnegative=True)


@dataclass(frozen=True)
class Whole:
    """A function, its arguments, and its exact value in symbols of the generic mode."""

    name: str
    args: tuple[sp.Symbol, ...]
    exact: Any
    springs: bool = False  # has a value only where every branch has a spring, and moves


def whole_names(derivation: ModesDerivation) -> list[str]:
    """Names of the functions that :func:`measure_whole` measures.

    Not among them is material_modes of a model given by operators, whose times are roots of polynomials as badly conditioned
    as the user's parameters make them; nor prony of a bare dashpot, whose modulus is infinite.
    """
    stated = [MATERIAL_MODES] if isinstance(series_of(derivation.model), Series) else []
    return [*stated, *(each.name for each in _functions(derivation))]


def measure_whole(derivation: ModesDerivation, solver: Any, points: int = POINTS) -> Iterator[Certificate]:
    if isinstance(series_of(derivation.model), Series):
        yield measure_material(MATERIAL_MODES, derivation, solver, points)
    for each in _functions(derivation):
        yield _measure(each, derivation, solver, points)


def _functions(derivation: ModesDerivation) -> list[Whole]:
    complete = derivation.complete
    exact = {kernel.formula.name: kernel.exact for kernel in complete.kernels}
    passing = {symbol: symbol * 2 * sp.pi * V / l for symbol in (alpha, beta, eta)}  # a level's wave, times in seconds
    of_level = {
        symbol: value.subs(passing, simultaneous=True) for symbol, value in ((R, exact["modulus_ratio"]), (R_LOSS, exact["loss"]))
    }
    level = (K, m, p_0, l, h, V)
    springs = derivation.model.P[-1] != 0
    return [
        Whole("at_speed", (m, kV), (*(kV * time for time in (alpha, beta, eta)), S, J, J_0, enter, leave, share)),
        *([Whole("prony", (K, m), (K / S, alpha), springs=True)] if springs else []),
        Whole("retardation", (K, m), (J_0 / K, J / K, beta)),
        Whole("level_saturation_penetration", level, complete.penetration.value.subs(of_level)),
        Whole("level_saturation_pressure", level, complete.pressure.value.subs(of_level)),
        Whole("level_saturation_friction", (K, m, l, h, V), complete.friction.value.subs(of_level)),
        Whole("saturated_stack_friction", (K, m, l, h, V, p_nominal), complete.stack.value.subs(of_level)),
        Whole("means_c", (m, p_0, delta_0, D), _of_complete_contact(complete.means.value, exact["loss"])),
        *(Whole(f"means_{r.sequence}", (m, p_0, delta_0, D), (r.zones[0].pressure, sp.Integer(0))) for r in _at_rest(derivation)),
    ]


def _of_complete_contact(means: tuple[sp.Expr, ...], loss: sp.Expr) -> tuple[sp.Expr, ...]:
    return tuple(mean.subs(sp.Symbol("loss", real=True), loss) for mean in means)


def _at_rest(derivation: ModesDerivation) -> Iterator[Any]:
    return (regime for regime in derivation.regimes if regime.sequence in ("a", "f"))


def _measure(each: Whole, derivation: ModesDerivation, solver: Any, points: int) -> Certificate:
    law, worst = derivation.law, Worst(each.name)
    called: Callable[..., Any] = getattr(solver, each.name)
    with mpmath.workdps(DIGITS):
        reference = Reference(each.exact, law.modes)
        for index in range(points):
            inputs = Inputs(law, each.args, f"{each.name} {index}", moving=each.springs, dashpots=not each.springs)
            given = [inputs.argument(symbol, solver) for symbol in each.args]
            with np.errstate(all="raise", under="ignore"):
                computed = called(*given)
            worst.see(computed, reference(inputs.exact), inputs.shown())
    return worst.certificate()
