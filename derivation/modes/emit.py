"""Emission for n modes: verified kernels and regimes in, values for the template out. Nothing is derived here."""

import re
from typing import Any

import sympy as sp

from ..functions import Formula, mapped
from ..model import Model, Parameter, Roots, Series
from ..outcome import Derivation
from ..printing import functions_of, helpers_used, results, source
from .functions import zones_function
from .symbols import MATERIAL as FIELDS
from .symbols import SUMS

OF_THE_STRIP = {symbol: sp.Symbol(f"m.{symbol.name}", real=True) for symbol in FIELDS}
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
