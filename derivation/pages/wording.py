"""What a page says in words: ``words.toml``, and the boundary equations of a regime with what they mean."""

import tomllib
from pathlib import Path

import sympy as sp

from ..functions import written_out
from ..modes.symbols import J_0
from ..regime import PERIODIC
from ..sequences import CONTACT, EQUATIONS, Row

WORDS = tomllib.loads(Path(__file__).with_name("words.toml").read_text(encoding="utf-8"))
MEANINGS = dict([*EQUATIONS.values(), PERIODIC])


def plainly(term: sp.Expr) -> str:
    """LaTeX with helpers and calls written out; a fraction far wider above than below as a product, to be cut."""
    return sp.latex(written_out(term), long_frac_ratio=8)


def equations(regime: Row) -> list[tuple[str, str]]:
    """Meaning and LaTeX of each boundary equation, for one relaxation time."""
    return [(MEANINGS[label], f"{plainly(term)} = 0") for label, term in regime.equations]


def events(regime: Row) -> list[tuple[str, str]]:
    """Meaning and LaTeX of each boundary equation, for several relaxation times."""
    if not regime.edges:
        return []
    first, last = sp.latex(regime.edges[0]), regime.zones[-1]
    elastic = sp.latex(J_0 * last.load) + " + " if last.load != 0 else ""
    gap = f" - {sp.latex(last.exit)}" if last.exit != 0 else ""
    changes = [rf"{elastic}\sum_j z_j({first}) - u({first}){gap} = 0"]
    for zone in regime.zones[:-1]:
        what = "p" if zone.kind == CONTACT else "g"
        missing = "" if zone.missing == 0 else f"{sp.latex(zone.missing)} + "
        changes.append(rf"{missing}[{what}]_{{{sp.latex(zone.first)}}}^{{{sp.latex(zone.last)}}} = 0")
    return [(meaning, latex) for (_, meaning), latex in zip(regime.equations, changes, strict=True)]
