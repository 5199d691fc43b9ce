"""What a page says in words: ``words.toml``, and the boundary equations of a regime with what they mean."""

import tomllib
from pathlib import Path

import sympy as sp

from ..functions import written_out
from ..modes.regimes import ModeRegime
from ..modes.symbols import J_0
from ..regime import PERIODIC, Regime
from ..sequences import CONTACT, EQUATIONS

WORDS = tomllib.loads(Path(__file__).with_name("words.toml").read_text(encoding="utf-8"))
MEANINGS = dict([*EQUATIONS.values(), PERIODIC])


def plainly(term: sp.Expr) -> str:
    """LaTeX with helpers and calls written out; a fraction far wider above than below as a product, to be cut."""
    return sp.latex(written_out(term), long_frac_ratio=8)


def equations(regime: Regime) -> list[tuple[str, str]]:
    """Meaning and LaTeX of each boundary equation, for one relaxation time."""
    return [(MEANINGS[label], f"{plainly(term)} = 0") for label, term in regime.equations]


def events(regime: ModeRegime) -> list[tuple[str, str]]:
    """Meaning and LaTeX of each boundary equation, for several relaxation times."""
    if not regime.edges:
        return []
    first = sp.latex(regime.edges[0])
    elastic = sp.latex(J_0 * regime.onset_pressure) + " + " if regime.onset_pressure != 0 else ""
    gap = f" - {sp.latex(regime.onset_gap)}" if regime.onset_gap != 0 else ""
    changes = [rf"{elastic}\sum_j z_j({first}) - u({first}){gap} = 0"]
    for zone in regime.zones[:-1]:
        what = "p" if zone.kind == CONTACT else "g"
        missing = "" if zone.missing == 0 else f"{sp.latex(zone.missing)} + "
        changes.append(rf"{missing}[{what}]_{{{sp.latex(zone.first)}}}^{{{sp.latex(zone.last)}}} = 0")
    return [(meaning, latex) for (_, meaning), latex in zip(regime.equations, changes, strict=True)]
