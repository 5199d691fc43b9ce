"""What the page of a model with n relaxation times says in words."""

from __future__ import annotations

from typing import Any

import sympy as sp

from ..check import Derived
from ..model import Roots
from ..modes.displays import unread
from ..modes.regimes import ModeRegime
from ..modes.symbols import J_0
from ..outcome import Derivation
from ..sequences import CONTACT
from . import misprints
from .wording import Wording

PARAMETERS = (
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


def wording(derivation: Derivation) -> Wording:
    return Wording(
        PARAMETERS,
        _misprints(derivation.steps),
        unread(isinstance(derivation.model.series, Roots)),
        ("state", "residual", "jacobian", "means", "return_map"),
        _conditions,
        parts={f"passages_{regime.sequence}": regime.derived.name for regime in derivation.composed},
    )


def _misprints(steps: tuple[Derived, ...]) -> list[dict[str, Any]]:
    """Misprints and silences that bear on every model; what concerns one relaxation time alone is on the paper's own page."""
    by_name = {step.name: step for step in steps}
    law, closures, stack = (by_name[name] for name in ("jump law", "closures", "saturated_stack_friction"))
    own = "In numbers for Fig. 7, and with its dimensions: page of the standard linear solid, the paper's own foundation."
    return [
        misprints.sign_of_equation_6(by_name["zone conditions"]),
        misprints.stiffness(by_name["relaxed stiffness"]),
        misprints.row(misprints.JUMPS, misprints.SILENT, closures, why=law.statement, steps=[law.name, closures.name]),
        misprints.row("Eq. 16: power of h, factor, upper limit", misprints.PRINTED_16, stack, (16,), shown=own),
    ]


def _conditions(regime: ModeRegime) -> list[list[str]]:
    if not regime.edges:
        return []
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
