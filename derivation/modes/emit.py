"""Emission for n modes: verified kernels and regimes in, values for the template out. Nothing is derived here."""

from __future__ import annotations

from typing import Any

import sympy as sp

from ..emit import docstring, flat, function_text, helpers_used
from ..functions import Formula
from ..model import Model, Parameter, Roots, Series
from ..printing import results, source
from ..regime import ADHESION, CONTACT, NOTHING
from .derive import ModesDerivation
from .kernel import ModeKernel
from .material import series_of
from .regimes import ModeRegime, ModeZone
from .symbols import J_0
from .symbols import MATERIAL as FIELDS
from .tensor import SUMS

ORDINALS = ("first", "second", "third", "fourth")
OF_THE_STRIP = {symbol: sp.Symbol(f"m.{symbol.name}", real=True) for symbol in FIELDS}
# Used by the template itself, beside what the formulas call.
FROM_MODES = ("Modes", "Passage", "edge_slopes", "for_batch", "monodromy", "periodic", "scaled")
FROM_STABLE = ("quotient", "stack_sum")


def template_values(derivation: ModesDerivation) -> dict[str, Any]:
    """What the template of a model with n modes is rendered with."""
    model, series = derivation.model, series_of(derivation.model)
    arrays = [] if isinstance(series, Roots) else [source(symbol) for symbol in series.arrays]
    formulas = [kernel.formula for kernel in derivation.kernels]
    sums = {type(f).__name__ for f in _functions(formulas) if isinstance(f, SUMS)}
    checked = [_checked(parameter, arrays, model.any_number) for parameter in model.parameters]
    material, builders = _modes_of_material(model, series)
    validators = {text.partition("(")[0] for _, text in checked}
    complete = derivation.complete
    return {
        "title": model.title,
        "model": model.name,
        "n": None if model.any_number else model.modes,
        "closures": derivation.closures.value,
        "material": model.parameters,
        "arrays": arrays,
        "checked": checked,
        "modes_of_material": material,
        "series": next(step for step in derivation.steps if step.name == "Prony series"),
        "sums": sorted({*sums, *FROM_MODES, *validators, *builders}, key=lambda n: (n.islower(), n)),
        "helpers": sorted({*helpers_used(formulas), *FROM_STABLE}),
        "sections": [
            {"title": title, "functions": [_function(kernel) for kernel in kernels]} for title, kernels in derivation.sections
        ],
        "level": {
            "penetration": complete.penetration.function,
            "pressure": complete.pressure.function,
            "friction": complete.friction.function,
            "stack": complete.stack.function,
        },
        "means": derivation.means,
        "regimes": [_regime(regime) for regime in derivation.regimes],
    }


def _checked(parameter: Parameter, arrays: list[str], any_number: bool) -> tuple[str, str]:
    """A parameter's name and the call that checks it, by what its symbol assumes."""
    name = parameter.name
    if name in arrays:
        count = "MODES" if not any_number or name == arrays[0] else f"len({arrays[0]})"
        return name, f'per_mode("{name}", {name}, {count})'
    bound = (
        "positive"
        if parameter.symbol.is_positive and name == "K"
        else "nonnegative"
        if parameter.symbol.is_nonnegative
        else "finite"
    )
    return name, f'{bound}("{name}", {name})'


def _modes_of_material(model: Model, series: Series | Roots) -> tuple[str, tuple[str, ...]]:
    """The expression that turns the parameters into (K, modes), and the functions it calls."""
    if isinstance(series, Roots):
        return f"of_operators({results(model.Q)}, {results(model.P)})", ("of_operators",)
    stated = [source(series.viscosity), source(series.time)]
    if series.arrays:
        return f"{source(series.K)}, spectrum({', '.join(stated)})", ("spectrum",)
    return f"{source(series.K)}, spectrum({', '.join(f'first_mode({part})' for part in stated)})", ("first_mode", "spectrum")


def _function(kernel: ModeKernel) -> Any:
    formula = kernel.formula
    inside = {symbol: named for symbol, named in OF_THE_STRIP.items() if symbol not in formula.args}
    steps = tuple((label, _renamed(term, inside)) for label, term in _needed(formula))
    return function_text(Formula(formula.name, formula.args, _renamed(formula.result, inside), steps), kernel.derived)


def _needed(formula: Formula) -> list[tuple[sp.Symbol, sp.Expr]]:
    """The steps of a formula that its result goes back to."""
    wanted = set().union(*(sp.sympify(part).free_symbols for part in flat(formula.result)))
    kept = []
    for label, term in reversed(formula.steps):
        if label in wanted:
            wanted |= sp.sympify(term).free_symbols
            kept.append((label, term))
    return kept[::-1]


def _renamed(value: Any, names: dict[sp.Symbol, sp.Symbol]) -> Any:
    return tuple(_renamed(part, names) for part in value) if isinstance(value, tuple) else sp.sympify(value).xreplace(names)


def _functions(formulas: list[Formula]) -> set[Any]:
    terms = [term for formula in formulas for term in (*(step for _, step in formula.steps), *flat(formula.result))]
    return {f for term in terms for f in sp.sympify(term).atoms(sp.Function)}


def _regime(regime: ModeRegime) -> dict[str, Any]:
    touches = any(zone.kind == CONTACT for zone in regime.zones)
    # Where nothing is free the traction acts everywhere and does no work over a period: pressures count from -p_0.
    raised = touches and all(zone.kind in (CONTACT, ADHESION) for zone in regime.zones)
    first, rest = docstring(regime.derived.statement)
    meanings = "; ".join(meaning for _, meaning in regime.equations) if regime.edges else ""
    heading, more = docstring(f"Boundary equations: {meanings}. Each is counted from the edge before.")
    return {
        "sequence": regime.sequence,
        "title": regime.title,
        "edges": [str(edge) for edge in regime.edges],
        "statement": [first, *rest],
        "equations": [heading, *more],
        "labels": [label for label, _ in regime.equations] if regime.edges else [],
        "derived_by": regime.derived.function,
        "zones": [_zone(zone, n, raised) for n, zone in enumerate(regime.zones)],
        "onset_pressure": _of_strip(regime.onset_pressure),
        "onset_gap": "" if regime.onset_gap == NOTHING else f" - {_of_strip(regime.onset_gap)}",
        "touches": touches,
        "raised": "D + p_0" if raised else "D",
        "admissible": [inequality.code for inequality in regime.admissible],
    }


def _zone(zone: ModeZone, number: int, raised: bool) -> dict[str, Any]:
    missing = "" if zone.missing == 0 else f"{_of_strip(zone.missing)} + "
    return {
        "kind": zone.kind,
        "flow": "contact" if zone.kind == CONTACT else "relaxation",
        "name": ORDINALS[number],
        "first": source(zone.first),
        "last": source(zone.last),
        "to": str(zone.last).replace("*", " ") if zone.last.has(sp.pi) else str(zone.last),
        "pressure": _of_strip(zone.pressure),
        "missing": missing,
        "work": "0" if raised or zone.kind == CONTACT else _of_strip(zone.pressure),
    }


def _of_strip(expression: sp.Expr) -> str:
    return source(sp.sympify(expression).xreplace({J_0: OF_THE_STRIP[J_0]}))
