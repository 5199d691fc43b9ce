"""Eq. 12 to 16: levels that carry one another, and complete contact."""

from typing import Any

import sympy as sp

from ..check import zero
from ..latex import joined, statements
from ..multilevel import pressure, slope_x, tau_below
from ..strip import Strip
from ..symbols import D_level, T_sigma, V, h, l, p_nominal, x, y
from .level import over_cell
from .record import CORRECTIONS, PRINTED, Comparison, compared, refuted
from .words import field, level, strips, surface, y_j

law = sp.Function("tau_M")
lower = {h: sp.Symbol("h_2", positive=True), l: sp.Symbol("l_2", positive=True)}
NOTHING = "a level that touches nowhere, p = 0, has no friction, as in the paper's Fig. 5"


def shear(derived_shear: sp.Expr) -> Comparison:
    r"""Eq. 12. ``derived_shear``: p f_x + tau_M, of the step "local shear"."""
    (printed,) = statements(PRINTED[12], _carrying("M-1", r"\bar\tau_M", lambda *place: pressure))
    here = printed.sides[1].doit()
    ours = derived_shear.subs({slope_x: sp.diff(surface(x, y_j), x), tau_below: law(pressure)})
    checks = [
        zero("in contact it is, as printed, the stress of the derivation", here - ours),
        refuted(NOTHING, here.subs(pressure, 0)),
    ]
    return compared(12, checks, ("local shear",), correction=CORRECTIONS[12])


def carried(complete: sp.Expr, one_level: sp.Expr) -> Comparison:
    r"""Eq. 13. ``complete``: Eq. 15 in SI; ``one_level``: tau_sat."""
    names = _carrying("M-1", r"\bar\tau_M", field(complete), one_level.subs(lower)) | strips(2)
    free = _carrying("M-1", r"\bar\tau_M", lambda *place: sp.Integer(0)) | strips(2)
    (full,), (nothing,) = (statements(PRINTED[13], words) for words in (names, free))
    both = one_level + one_level.subs(lower)
    checks = [
        zero("in complete contact it is, as printed, the level's own tau_sat and the law below", full.sides[1] - both),
        refuted(NOTHING, nothing.sides[1]),
    ]
    return compared(13, checks, ("carried friction",), correction=CORRECTIONS[12])


def coefficient(complete: sp.Expr, one_level: sp.Expr) -> Comparison:
    r"""Eq. 14, in complete contact against Eq. 16, corrected, whose terms are ``one_level`` over the load."""
    load = over_cell(complete) / l**2
    mu, tau_1 = sp.symbols("mu tau_1", real=True)
    more = {r"\mu": mu, r"\bar\tau_1": tau_1, r"\barp_1": load}
    names = _carrying("1", r"\bar\tau_2", field(complete), one_level.subs(lower)) | more | strips(2)
    free = _carrying("1", r"\bar\tau_2", lambda *place: sp.Integer(0)) | more | strips(2)
    (full,), (nothing,) = (statements(PRINTED[14], words) for words in (names, free))
    both = (one_level + one_level.subs(lower)) / load
    checks = [
        zero("its second side is tau_1/p_1", full.sides[1] - tau_1 / load),
        zero("two levels in complete contact: as printed it is Eq. 16, corrected", full.sides[2] - both),
        refuted(NOTHING, nothing.sides[2]),
    ]
    return compared(14, checks, ("friction coefficient",), correction=CORRECTIONS[12])


def complete_contact(strip: Strip, complete: sp.Expr) -> Comparison:
    r"""Eq. 15, in its printed SI form. ``complete``: the derived field in SI."""
    (statement,) = statements(joined(PRINTED[15]), level("i", p_i=lambda *place: sp.Symbol("p"), D=D_level))
    printed = statement.sides[1].subs(y_j, y)
    checks = [
        zero("as printed it satisfies Eq. 5 with w = D - f", strip.misses(D_level - surface(), printed)),
        refuted("as printed it satisfies Eq. 5 with w = f + D, the print of Eq. 6", strip.misses(surface() + D_level, printed)),
        zero("and it is the derived field, in SI", printed - complete),
    ]
    steps = ("saturated_pressure", "contact flow", "excess_event")
    return compared(15, checks, steps, ("p(x, y) = " + sp.latex(_arranged(complete)),))


def _arranged(complete: sp.Expr) -> sp.Expr:
    """The field as its mean and one harmonic in x over one denominator; the same expression."""
    wave = complete
    below = l**2 + 4 * sp.pi**2 * T_sigma**2 * V**2
    cosine, sine = (sp.Function(name)(x) for name in ("cos", "sin"))
    turned = sp.expand(wave).subs({sp.cos(2 * sp.pi * x / l): cosine, sp.sin(2 * sp.pi * x / l): sine})
    parts = [sp.factor(turned.diff(each) * below) for each in (cosine, sine)]
    rest = sp.factor(turned.subs({cosine: 0, sine: 0}))
    arranged = rest + (parts[0] * sp.cos(2 * sp.pi * x / l) + parts[1] * sp.sin(2 * sp.pi * x / l)) / below
    zero("the derived field, arranged", arranged - wave).verified("print of Eq. 15")
    return arranged


def all_complete(of_the_step: tuple[sp.Expr, sp.Expr]) -> Comparison:
    r"""Eq. 16. ``of_the_step`` "Eq. 16 as printed": a term as derived and as printed, with what is wrong in it."""
    names = level(
        "i", **{r"\mu": sp.Symbol("mu"), r"\barp_1": p_nominal, "N": sp.Symbol("N"), "sum over i": lambda term, *ends: term}
    )
    (statement,) = statements(PRINTED[16], names)
    printed, (true, named) = statement.sides[1], of_the_step
    checks = [
        refuted("a printed term is what Eq. 15 gives in Eq. 10 and 11", printed - true),
        zero("it is that times 16/(3 h_i): pi^2 for 3 pi^2/16, and h_i for its square", printed / true - 16 / (3 * h)),
        zero("it is the printed form whose unit and peaks the step shows to be wrong", printed - named),
    ]
    steps = (
        "stack friction",
        "Eq. 16 as printed",
        "levels in complete contact together",
        "least pressure in complete contact",
    )
    return compared(16, checks, steps, correction=CORRECTIONS[16] + " The sum runs over the levels, up to M; N counts strips.")


def _carrying(index: str, below: str, pressed: Any, constant: sp.Expr | None = None) -> dict[str, Any]:
    """Words for a level that carries another; ``constant``: the law below, where it does not depend on p."""
    carried = law if constant is None else lambda local: constant
    own = sp.Symbol("tau", real=True)
    return level(index, **{f"p_{index}": pressed, below: carried, rf"\tau_{index}": own, rf"\bar\tau_{index}": own})
