"""Eq. 12 to 16: levels that carry one another, and complete contact."""

from typing import Any

import sympy as sp

from ..check import Claim, zero
from ..latex import joined, statements
from ..multilevel import pressure, slope_x, tau_below
from ..strip import Strip
from ..symbols import D_level, T_sigma, V, h, l, p_nominal, x, y
from .level import mean
from .record import PRINTED, Comparison, compared, read, refuted
from .words import field, level, strips, surface, y_j

law = sp.Function("tau_M")
lower = {h: sp.Symbol("h_2", positive=True), l: sp.Symbol("l_2", positive=True)}


def shear(derived_shear: sp.Expr) -> Comparison:
    r"""Eq. 12. ``derived_shear``: p f_x + tau_M, of the step "local shear"."""
    here = read(12, _carrying("M-1", r"\bar\tau_M", lambda *place: pressure, law))[0].sides[1].doit()
    ours = derived_shear.subs({slope_x: sp.diff(surface(x, y_j), x), tau_below: law(pressure)})
    checks = [zero("in contact it is, as printed, the stress of the derivation", here - ours)]
    return compared(12, [*checks, _nothing(here.subs(pressure, 0))], corrected_as=12)


def carried(complete: sp.Expr, one_level: sp.Expr) -> Comparison:
    r"""Eq. 13. ``complete``: Eq. 15 in SI; ``one_level``: tau_sat."""
    full, nothing = (
        read(13, _carrying("M-1", r"\bar\tau_M", field(pressed), lambda local: one_level.subs(lower)) | strips(2))[0].sides[1]
        for pressed in (complete, sp.Integer(0))
    )
    claim = "in complete contact it is, as printed, the level's own tau_sat and the law below"
    return compared(13, [zero(claim, full - _both(one_level)), _nothing(nothing)], corrected_as=12)


def coefficient(complete: sp.Expr, one_level: sp.Expr) -> Comparison:
    r"""Eq. 14, in complete contact against Eq. 16, corrected, whose terms are ``one_level`` over the load."""
    load = mean(complete)
    mu, tau_1 = sp.symbols("mu tau_1", real=True)
    own = {r"\mu": mu, r"\bar\tau_1": tau_1, r"\barp_1": load} | strips(2)
    (_, ratio, full), (*_, nothing) = (
        read(14, _carrying("1", r"\bar\tau_2", field(pressed), lambda local: one_level.subs(lower)) | own)[0].sides
        for pressed in (complete, sp.Integer(0))
    )
    checks = [
        zero("its second side is tau_1/p_1", ratio - tau_1 / load),
        zero("two levels in complete contact: as printed it is Eq. 16, corrected", full - _both(one_level) / load),
    ]
    return compared(14, [*checks, _nothing(nothing)], corrected_as=12)


def _carrying(index: str, below: str, pressed: Any, friction: Any) -> dict[str, Any]:
    """Words for a level under the pressure ``pressed`` that carries another, whose ``friction`` is a function of it."""
    own = sp.Symbol("tau", real=True)
    return level(index, **{f"p_{index}": pressed, below: friction, rf"\tau_{index}": own, rf"\bar\tau_{index}": own})


def _both(one_level: sp.Expr) -> sp.Expr:
    return one_level + one_level.subs(lower)


def _nothing(friction: sp.Expr) -> Claim:
    """``friction``: that of the printed form where p = 0."""
    return refuted("a level that touches nowhere, p = 0, has no friction, as in the paper's Fig. 5", friction)


def complete_contact(strip: Strip, complete: sp.Expr) -> Comparison:
    r"""Eq. 15, in its printed SI form. ``complete``: the derived field in SI."""
    names = level("i", p_i=lambda *place: sp.Symbol("p"), D=D_level)
    printed = statements(joined(PRINTED[15]), names)[0].sides[1].subs(y_j, y)
    checks = [
        zero("as printed it satisfies Eq. 5 with w = D - f", strip.misses(D_level - surface(), printed)),
        refuted("as printed it satisfies Eq. 5 with w = f + D, the print of Eq. 6", strip.misses(surface() + D_level, printed)),
        zero("and it is the derived field, in SI", printed - complete),
    ]
    return compared(15, checks, ["p(x, y) = " + sp.latex(_arranged(complete))])


def _arranged(complete: sp.Expr) -> sp.Expr:
    """The field as its mean and one harmonic in x over one denominator; the same expression."""
    below = l**2 + 4 * sp.pi**2 * T_sigma**2 * V**2
    waves = [wave(2 * sp.pi * x / l) for wave in (sp.cos, sp.sin)]
    names = dict(zip(waves, sp.symbols("cosine sine"), strict=True))
    turned = sp.expand(complete).subs(names)
    parts = [sp.factor(turned.diff(name) * below) * wave for wave, name in names.items()]
    arranged = sp.factor(turned.subs(dict.fromkeys(names.values(), 0))) + sum(parts) / below
    zero("the derived field, arranged", arranged - complete).verified("print of Eq. 15")
    return arranged


def all_complete(of_the_step: tuple[sp.Expr, sp.Expr]) -> Comparison:
    r"""Eq. 16. ``of_the_step`` "Eq. 16 as printed": a term as derived and as printed, with what is wrong in it."""
    names = {r"\mu": sp.Symbol("mu"), r"\barp_1": p_nominal, "N": sp.Symbol("N"), "sum over i": lambda term, *ends: term}
    printed, (true, named) = read(16, level("i", **names))[0].sides[1], of_the_step
    checks = [
        refuted("a printed term is what Eq. 15 gives in Eq. 10 and 11", printed - true),
        zero("it is that times 16/(3 h_i): pi^2 for 3 pi^2/16, and h_i for its square", printed / true - 16 / (3 * h)),
        zero("it is the printed form whose unit and peaks the step shows to be wrong", printed - named),
    ]
    return compared(16, checks, corrected_as=16)
