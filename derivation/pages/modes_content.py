"""What the audit says of a model with n relaxation times: the same plain data as for one, from its own objects."""

from __future__ import annotations

from typing import Any

import sympy as sp

from ..certificates import WORDS
from ..check import Derived
from ..model import Roots
from ..modes import displays
from ..modes.derive import ModesDerivation
from ..modes.regimes import ModeRegime
from ..modes.symbols import J_0
from ..sequences import CONTACT
from . import content, misprints, paper, sources

FIELDS = (
    ("alpha", "k V tau_i, relaxation times"),
    ("beta", "k V lambda_j, retardation times, between and above them"),
    ("eta", "k V K_i tau_i/K, branch viscosities"),
    ("S", "K/K_i, branch compliances"),
    ("J", "retardation compliances times K"),
    ("J_0", "instantaneous compliance times K"),
    ("enter, leave, share", "matrices between the states: f = -enter (z - J p), its inverse, z = share e"),
    ("p_0", "p_0/(K A), the traction of adhesion"),
    ("delta_0", "delta_0/A, its reach"),
    ("D", "D_j/A, the penetration of the strip"),
)


def modes_content(derivation: ModesDerivation, files: dict[str, str], certificates: dict[str, Any]) -> dict[str, Any]:
    """Everything on a model's page but what is measured."""
    module = f"{derivation.model.name}.py"
    computed = sources.generated(module, files[module])
    helpers = sources.generated("stable.py", files["stable.py"])
    functions = {step.function for step in derivation.steps}
    passages = {f"passages_{regime.sequence}": regime.derived.name for regime in derivation.regimes if regime.edges}
    unread = displays.unread(isinstance(derivation.model.series, Roots))
    return {
        "model": derivation.model.name,
        "title": derivation.model.title,
        "paper": paper.TITLE,
        "identity": content.identity(files),
        "fields": [],
        "parameters": [list(row) for row in FIELDS],
        "material": [[p.name, p.unit, p.meaning] for p in derivation.model.parameters],
        "equations": paper.equations(derivation.steps),
        "misprints": _misprints(derivation.steps),
        "small": [],
        "stages": content.stages(derivation.steps, computed, content.displayed(derivation, unread)),
        "regimes": [_regime(regime, computed, derivation.closures.value) for regime in derivation.regimes],
        "domains": [list(row) for row in WORDS.items()],
        "functions": content.functions_table(computed, derivation.steps, certificates, passages),
        "certificates": {name: dict(sorted(row.items())) for name, row in sorted(certificates.items())},
        "method": [list(row) for row in content.METHOD],
        "sources": {
            name: content.text(sources.deriving(name)) for name in sorted({*functions, *(name for name, _ in content.METHOD)})
        },
        "generated": {name: content.text(source) for name, source in (computed | helpers).items()},
        "helpers": content.helpers_table(helpers),
        "measured": "measured.json",
    }


def _misprints(steps: tuple[Derived, ...]) -> list[dict[str, Any]]:
    """Misprints and silences that bear on every model; what concerns one relaxation time alone is on the paper's own page."""
    by_name = {step.name: step for step in steps}
    closures, stack = by_name["closures"], by_name["saturated_stack_friction"]
    own = "In numbers for Fig. 7, and with its dimensions: page of the standard linear solid, the paper's own foundation."
    return [
        misprints.sign_of_equation_6(by_name["zone conditions"]),
        misprints.stiffness(by_name["relaxed stiffness"]),
        _row(
            [], "What w does where p steps", misprints.SILENT, closures, by_name["jump law"].statement, ["jump law", "closures"]
        ),
        _row([16], "Eq. 16: power of h, factor, upper limit", misprints.PRINTED_16, stack, stack.correction, [stack.name], own),
    ]


def _row(
    equations: list[int], what: str, printed: str, step: Derived, why: str, steps: list[str], shown: str = ""
) -> dict[str, Any]:
    return {
        "equations": equations,
        "what": what,
        "printed": printed,
        "here": step.statement,
        "shown": shown,
        "latex": step.latex,
        "why": why,
        "steps": steps,
        "table": None,
        "measured": "",
    }


def _regime(regime: ModeRegime, computed: dict[str, sources.Source], closures: tuple[int, ...]) -> dict[str, Any]:
    equations = _conditions(regime) if regime.edges else []
    kinds = ("state", "residual", "jacobian", "means", "return_map")
    return content.regime_entry(regime, closures, equations, kinds, computed)


def _conditions(regime: ModeRegime) -> list[list[str]]:
    first = sp.latex(regime.edges[0])
    elastic = sp.latex(J_0 * regime.onset_pressure) + " + " if regime.onset_pressure != 0 else ""
    gap = f" - {sp.latex(regime.onset_gap)}" if regime.onset_gap != 0 else ""
    onset = rf"{elastic}\sum_j z_j({first}) - u({first}){gap} = 0"
    changes = []
    for zone in regime.zones[:-1]:
        what = "p" if zone.kind == CONTACT else "g"
        missing = "" if zone.missing == 0 else f"{sp.latex(zone.missing)} + "
        changes.append(rf"{missing}[{what}]_{{{sp.latex(zone.first)}}}^{{{sp.latex(zone.last)}}} = 0")
    return [[meaning, latex] for (_, meaning), latex in zip(regime.equations, [onset, *changes], strict=True)]
