"""What a page says in words: ``words.toml``, the same for every model, and what belongs to its own."""

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import sympy as sp

from ..displays import STATED
from ..emit import PARAMETER_MEANINGS
from ..functions import written_out
from ..modes.several_times import unread
from ..modes.symbols import J_0
from ..outcome import Derivation
from ..regime import PERIODIC
from ..sequences import CONTACT, EQUATIONS, Row

WORDS = tomllib.loads(Path(__file__).with_name("words.toml").read_text(encoding="utf-8"))
MEANINGS = dict([*EQUATIONS.values(), PERIODIC])


@dataclass(frozen=True)
class Wording:
    """``unread``: steps whose displays have nothing to compare, and what they are. ``kinds``: of functions of a regime."""

    parameters: list[tuple[str, str]]
    unread: Mapping[str, str]
    kinds: tuple[str, ...]
    conditions: Callable[[Any], list[list[str]]]  # of a regime: meaning and LaTeX of each boundary equation
    parts: Mapping[str, str] = field(default_factory=dict)  # functions that name what others of a step are made of, and that step


def one_time(derivation: Derivation) -> Wording:
    """The page of the paper's own foundation."""
    return Wording(PARAMETER_MEANINGS, STATED["one_time"], ("residual", "means", "onset_slope"), _equations)


def several_times(derivation: Derivation) -> Wording:
    return Wording(
        WORDS["several_times"]["parameters"],
        unread(derivation.model),
        ("state", "residual", "residual_and_jacobian", "means", "return_map"),
        _events,
        {f"{kind}_{each.sequence}": each.derived.name for each in derivation.composed for kind in ("zones", "passages")},
    )


WORDING = {"one_time": one_time, "several_times": several_times}


def plainly(term: sp.Expr) -> str:
    """LaTeX with helpers and calls written out; a fraction far wider above than below as a product, to be cut."""
    return sp.latex(written_out(term), long_frac_ratio=8)


def _equations(regime: Row) -> list[list[str]]:
    return [[MEANINGS[label], f"{plainly(term)} = 0"] for label, term in regime.equations]


def _events(regime: Row) -> list[list[str]]:
    if not regime.edges:
        return []
    first = sp.latex(regime.edges[0])
    last = regime.zones[-1]
    elastic = sp.latex(J_0 * last.load) + " + " if last.load != 0 else ""
    gap = f" - {sp.latex(last.exit)}" if last.exit != 0 else ""
    onset = rf"{elastic}\sum_j z_j({first}) - u({first}){gap} = 0"
    changes = []
    for zone in regime.zones[:-1]:
        what = "p" if zone.kind == CONTACT else "g"
        missing = "" if zone.missing == 0 else f"{sp.latex(zone.missing)} + "
        changes.append(rf"{missing}[{what}]_{{{sp.latex(zone.first)}}}^{{{sp.latex(zone.last)}}} = 0")
    return [[meaning, latex] for (_, meaning), latex in zip(regime.equations, [onset, *changes], strict=True)]
