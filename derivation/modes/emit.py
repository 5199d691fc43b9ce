"""Emission for n modes: verified kernels and regimes in, values for the template out. Nothing is derived here.

The zones of a regime are data. Its functions are those of the generated ``modes``: loops over the zones and products of matrices,
which hold no physics. The boundary equations are the zones' own, what entry and exit leave for the change over each; the state at
the first edge is the one that a period returns, which the step "period map" composes; derivatives go by the chain rule.
"""

import re
from dataclasses import replace
from typing import Any

import sympy as sp

from ..check import Derived
from ..functions import Formula, mapped
from ..kernel import Kernel
from ..model import Model, Parameter, Roots, Series
from ..outcome import Derivation
from ..printing import functions_of, helpers_used, results, source
from ..sequences import ADHESION, CONTACT, FREE, Row, Span
from .symbols import MATERIAL, OF_STRIP, SUMS, at_speed, m

kV = sp.Symbol("kV", nonnegative=True)
ZONES = {ADHESION: sp.Function("Adhesion"), FREE: sp.Function("Free"), CONTACT: sp.Function("Contact")}
OF_THE_STRIP = {symbol: sp.Symbol(f"m.{symbol.name}", real=True) for symbol in MATERIAL}
KINDS = ("state", "passages", "residual", "residual_and_jacobian", "return_map", "means")
"""Functions of a regime that the generated ``modes`` makes of its zones."""
# Used by the template itself, beside what the formulas call.
FROM_MODES = ("Modes", "Zone", "for_batch", "regime_functions", "scaled")


def template_values(derivation: Derivation) -> dict[str, Any]:
    """What the template of a model with n modes is rendered with beside what every model has."""
    model, series = derivation.model, derivation.model.series
    arrays = [] if isinstance(series, Roots) else [source(symbol) for symbol in series.arrays]
    formulas = [kernel.formula for kernel in derivation.kernels]
    sums = functions_of(formulas, SUMS)
    checked = [_checked(parameter, arrays, model.modes is None) for parameter in model.parameters]
    material = _modes_of_material(model, series)
    called = [text.partition("(")[0] for _, text in checked] + re.findall(r"(?<![.\w])(\w+)\(", material)
    return {
        "n": model.modes,
        "closures": derivation.regimes[0].closures,
        "arrays": arrays,
        "checked": checked,
        "modes_of_material": material,
        "series": next(step for step in derivation.steps if step.name == "Prony series"),
        "sums": sorted({*sums, *FROM_MODES, *called}, key=lambda n: (n.islower(), n)),
        "helpers": helpers_used(formulas),
        "kinds": KINDS,
        "zones": {regime.sequence: zones_function(regime) for regime in derivation.composed},
    }


def whole_kernels() -> tuple[Kernel, ...]:
    """What the template's modes of a strip come to."""
    passing = tuple(part.xreplace(at_speed(m, kV).scaled()) for part in MATERIAL)
    return (Kernel(Formula("at_speed", (m, kV), passing), passing, None),)


def zones_function(regime: Row) -> tuple[Formula, Derived]:
    """The zones of a regime with edges, from which the generated ``modes`` has all its functions."""
    zones = Formula(f"zones_{regime.sequence}", (*regime.edges, *OF_STRIP), tuple(_zone(regime, zone) for zone in regime.zones))
    record = replace(
        regime.derived,
        statement=f"{regime.derived.statement} Of a zone: ends, pressure on entry, and what is missing in its boundary equation. "
        f"{'; '.join(meaning for _, meaning in (*regime.equations[1:], regime.equations[0])).capitalize()}.",
        latex=r"R z = c,\quad \text{missing} + \Delta = 0,\quad \Delta\ \text{of the gap or of the pressure}",
    )
    return zones, record


def _zone(regime: Row, zone: Span) -> sp.Expr:
    """The zone as the generated ``modes`` has it; the equation of the last is the onset, w - u - gap = 0 at the first edge."""
    missing = -zone.exit if zone is regime.zones[-1] else zone.missing
    return ZONES[zone.kind](zone.first, zone.last, zone.pressure, missing)


def _checked(parameter: Parameter, arrays: list[str], any_number: bool) -> tuple[str, str]:
    """A parameter's name and the call that checks it, by what its symbol assumes."""
    name = parameter.name
    if name in arrays:
        if any_number and name != arrays[0]:
            return name, f'per_mode("{name}", {name}, len({arrays[0]}))'
        return name, f'per_mode("{name}", {name}, MODES)'
    positive, nonnegative = parameter.symbol.is_positive and name == "K", parameter.symbol.is_nonnegative
    bound = "positive" if positive else "nonnegative" if nonnegative else "finite"
    return name, f'{bound}("{name}", {name})'


def _modes_of_material(model: Model, series: Series | Roots) -> str:
    """The expression that turns the parameters into (K, modes)."""
    if isinstance(series, Roots):
        return f"of_operators({results(model.Q)}, {results(model.P)})"
    stated = [source(series.viscosity), source(series.time)]
    if series.arrays:
        return f"{source(series.K)}, spectrum({', '.join(stated)})"
    return f"{source(series.K)}, spectrum({', '.join(f'first_mode({part})' for part in stated)})"


def of_material(formula: Formula) -> Formula:
    """A formula in which what is no argument is a field of the material m."""
    inside = {symbol: named for symbol, named in OF_THE_STRIP.items() if symbol not in formula.args}
    steps = tuple((label, sp.sympify(term).xreplace(inside)) for label, term in formula.steps)
    result = mapped(formula.result, lambda part: part.xreplace(inside))
    return Formula(formula.name, formula.args, result, steps)
