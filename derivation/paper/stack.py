"""Eq. 12 to 16: levels that carry one another, and complete contact."""

from __future__ import annotations

from typing import Any

import sympy as sp

from ..check import zero
from ..latex.reader import statements
from ..latex.tokens import joined
from ..level import MISPRINT
from ..multilevel import CONTACT_ALONE, pressure, slope_x, tau_below
from ..strip import Strip
from ..symbols import D_level, K, T_sigma, V, h, l, p_nominal, x, y
from .level import over_cell
from .printed import PRINTED
from .record import Comparison, compared, read_back, refuted
from .words import CELL, field, level, strips, surface, y_j

law = sp.Function("tau_M")
lower = {h: sp.Symbol("h_2", positive=True), l: sp.Symbol("l_2", positive=True)}
NOTHING = "a level that touches nowhere, p = 0, has no friction, as in the paper's Fig. 5"


def shear(derived_shear: sp.Expr) -> Comparison:
    r"""Eq. 12. ``derived_shear``: p f_x + tau_M, of the step "local shear"."""
    (printed,) = statements(PRINTED[12], _carrying("M-1", r"\bar\tau_M", lambda *place: pressure))
    here = printed.sides[1].doit()
    ours = derived_shear.subs({slope_x: sp.diff(surface(x, y_j), x), tau_below: law(pressure)})
    derived = (
        r"\tau_{M-1} = p\,\frac{\partial f}{\partial x} + \tau_M[p]\quad\text{in contact}",
        r"\tau_{M-1} = p\,\frac{\partial f}{\partial x}\quad\text{outside it}",
    )
    own = CELL | {"f": surface(x, y_j), "p": pressure, r"\tau_M": law}
    checks = [
        zero("in contact it is, as printed, the stress of the derivation", here - ours),
        read_back(derived[:1], own | {r"\tau_M-1": ours}),
        read_back(derived[1:], own | {r"\tau_M-1": derived_shear.subs({slope_x: sp.diff(surface(x, y_j), x), tau_below: 0})}),
        refuted(NOTHING, here.subs(pressure, 0)),
    ]
    return compared(12, derived, checks, ("local shear",), CONTACT_ALONE)


def carried(complete: sp.Expr, one_level: sp.Expr) -> Comparison:
    r"""Eq. 13. ``complete``: Eq. 15 in SI; ``one_level``: tau_sat."""
    names = _carrying("M-1", r"\bar\tau_M", field(complete), one_level.subs(lower)) | strips(2)
    free = _carrying("M-1", r"\bar\tau_M", lambda *place: sp.Integer(0)) | strips(2)
    (full,), (nothing,) = (statements(PRINTED[13], words) for words in (names, free))
    derived = (
        r"\bar\tau_{M-1} = \frac{1}{l^2} \iint p\,\frac{\partial f}{\partial x}\,dx\,dy "
        r"+ \frac{1}{l^2} \iint_{\Omega^c} \tau_M[p]\,dx\,dy",
    )
    both = one_level + one_level.subs(lower)
    cell = lambda body, *variables: over_cell(body.doit())  # noqa: E731
    own = {"f": surface(), "p": complete, r"\tau_M": lambda local: one_level.subs(lower), "iint": cell, r"iint \Omega^c": cell}
    checks = [
        read_back(derived, CELL | own | {r"\bar\tau_M-1": both}),
        zero("in complete contact it is, as printed, the level's own tau_sat and the law below", full.sides[1] - both),
        refuted(NOTHING, nothing.sides[1]),
    ]
    return compared(13, derived, checks, ("carried friction",), CONTACT_ALONE)


def coefficient(complete: sp.Expr, one_level: sp.Expr) -> Comparison:
    r"""Eq. 14, in complete contact against Eq. 16, corrected, whose terms are ``one_level`` over the load."""
    load = over_cell(complete) / l**2
    mu, tau_1 = sp.symbols("mu tau_1", real=True)
    more = {r"\mu": mu, r"\bar\tau_1": tau_1, r"\barp_1": load}
    names = _carrying("1", r"\bar\tau_2", field(complete), one_level.subs(lower)) | more | strips(2)
    free = _carrying("1", r"\bar\tau_2", lambda *place: sp.Integer(0)) | more | strips(2)
    (full,), (nothing,) = (statements(PRINTED[14], words) for words in (names, free))
    both = (one_level + one_level.subs(lower)) / load
    derived = (r"\mu = \frac{\bar\tau_1}{\bar p_1}\quad\text{with Eq. 13 over the contact}",)
    checks = [
        read_back(derived, {r"\mu": both, r"\bar\tau_1": one_level + one_level.subs(lower), r"\barp_1": load}),
        zero("its second side is tau_1/p_1", full.sides[1] - tau_1 / load),
        zero("two levels in complete contact: as printed it is Eq. 16, corrected", full.sides[2] - both),
        refuted(NOTHING, nothing.sides[2]),
    ]
    return compared(14, derived, checks, ("friction coefficient",), CONTACT_ALONE)


def complete_contact(strip: Strip, complete: sp.Expr) -> Comparison:
    r"""Eq. 15, in its printed SI form. ``complete``: the derived field in SI."""
    (statement,) = statements(joined(PRINTED[15]), level("i", p_i=lambda *place: sp.Symbol("p"), D=D_level))
    printed = statement.sides[1].subs(y_j, y)
    checks = [
        zero("as printed it satisfies Eq. 5 with w = D - f", strip.misses(D_level - surface(), printed)),
        refuted("as printed it satisfies Eq. 5 with w = f + D, the print of Eq. 6", strip.misses(surface() + D_level, printed)),
        zero("and it is the derived field, in SI", printed - complete),
    ]
    return compared(
        15,
        ("p(x, y) = " + sp.latex(_arranged(complete)),),
        checks,
        ("saturated_pressure", "contact flow", "excess_event"),
    )


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


def all_complete(one_level: sp.Expr) -> Comparison:
    r"""Eq. 16."""
    names = level(
        "i", **{r"\mu": sp.Symbol("mu"), r"\barp_1": p_nominal, "N": sp.Symbol("N"), "sum over i": lambda term, *ends: term}
    )
    (statement,) = statements(PRINTED[16], names)
    printed, true = statement.sides[1], one_level / p_nominal
    unit = sp.Symbol("lambda", positive=True)
    other = {h: unit * h, l: unit * l, V: unit * V, K: K / unit}  # lengths in a unit smaller by lambda
    indexed = {symbol: sp.Symbol(f"{symbol}_i", positive=True) for symbol in (h, l)}
    checks = [
        refuted("a printed term is what Eq. 15 gives in Eq. 10 and 11", printed - true),
        zero("it is that times 16/(3 h_i): pi^2 for 3 pi^2/16, and h_i for its square", printed / true - 16 / (3 * h)),
        refuted("a printed term is a number, whatever the unit of "
        "length", printed.subs(other, simultaneous=True) - printed),
        zero("the derived term is", true.subs(other, simultaneous=True) - true),
    ]  # fmt: skip
    derived = (r"\mu = \sum_{i=1}^{M} " + sp.latex(sp.factor(true.subs(indexed))),)
    steps = (
        "saturated_stack_friction",
        "Eq. 16 as printed",
        "levels in complete contact together",
        "least pressure in complete contact",
    )
    return compared(16, derived, checks, steps, MISPRINT + " The sum runs over the levels, up to M; N counts strips.")


def _carrying(index: str, below: str, pressed: Any, constant: sp.Expr | None = None) -> dict[str, Any]:
    """Words for a level that carries another; ``constant``: the law below, where it does not depend on p."""
    carried = law if constant is None else lambda local: constant
    own = sp.Symbol("tau", real=True)
    return level(index, **{f"p_{index}": pressed, below: carried, rf"\tau_{index}": own, rf"\bar\tau_{index}": own})
