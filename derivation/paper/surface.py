"""Eq. 4, 6 and 8: the shape of a level, its boundary conditions, the penetration of a strip."""

import re

import sympy as sp

from ..check import zero
from ..latex import rows, statements
from ..sequences import ADHESION, FREE, Span
from ..surface import AMPLITUDE, HEIGHT, PENETRATION, WAVE
from ..symbols import D_level, h, l, p_0, s, x, y
from .record import CORRECTIONS, PRINTED, Comparison, compared, refuted
from .words import level, surface, y_j


def shape() -> Comparison:
    r"""Eq. 4."""
    (printed,) = statements(PRINTED[4], level("i"))
    stated = printed.sides[1]
    checks = [
        zero("as printed it is the surface of the derivation", stated - surface()),
        zero(
            "it stands back by nothing at the crest, by h in the valley",
            [stated.subs({x: 0, y: 0}), stated.subs({x: l / 2, y: 0}) - h],
        ),
    ]
    return compared(4, checks, ("strip profile",), ("f(x, y) = " + sp.latex(HEIGHT.subs(WAVE)),))


def penetration() -> Comparison:
    r"""Eq. 8."""
    names = level("i", **{"D_i^j": _crest_of_the_strip()})
    (printed,) = statements(PRINTED[8], names)
    checks = [
        zero("as printed it is D - f at x = 0 of the strip, by Eq. 4 as printed", printed.sides[1] - printed.sides[0]),
        zero("and the D_j of the derivation", printed.sides[1] - PENETRATION.subs(WAVE).subs(y, y_j)),
        refuted("it is f + D at x = 0, as Eq. 6 would have it", printed.sides[1] - surface(sp.Integer(0), y_j) - D_level),
    ]
    derived = ("D_j = " + sp.latex(PENETRATION.subs(WAVE).subs(y, y_j)),)
    return compared(8, checks, ("strip profile", "zone conditions"), derived)


def _crest_of_the_strip() -> sp.Expr:
    return D_level - surface(sp.Integer(0), y_j)


def conditions(derived_gap: sp.Expr) -> Comparison:
    r"""Eq. 6, three conditions. ``derived_gap``: g of the step "zone conditions", with w in units of the strip's amplitude."""
    lines = [re.split(r",\s\s+", row)[0].strip(" ,") for row in rows(PRINTED[6])]
    w, p = sp.Symbol("w", real=True), sp.Symbol("p", real=True)
    names = level("i", w_i=lambda *place: w, p_i=lambda *place: p)
    contact, adhesion, outside = (statement for line in lines for statement in statements(line, names))
    printed = contact.sides[1]
    unknown = sp.Function("w")(s)
    (derived_w,) = sp.solve(derived_gap, unknown)
    height = (AMPLITUDE * derived_w).subs(WAVE)
    loads = [Span(kind, s, s, sp.Integer(0), sp.Integer(0)).load for kind in (ADHESION, FREE)]
    derived = (
        f"w = {sp.latex(sp.expand(height))}" + r"\quad\text{in contact}",
        f"p = {sp.latex(loads[0])}" + r"\quad\text{in adhesion}",
        f"p = {sp.latex(loads[1])}" + r"\quad\text{outside both}",
    )
    checks = [
        refuted("in contact w = f + D, as printed, closes the gap", printed - height),
        zero("with the other sign of f it does: w = D - f", (printed - 2 * surface()) - height),
        zero("in adhesion p = -p_0, as printed", [adhesion.sides[1] - loads[0], loads[0] + p_0]),
        zero("outside both p = 0, as printed", outside.sides[1] - loads[1]),
    ]
    return compared(6, checks, ("zone conditions", "strip profile", "strip problem"), derived, CORRECTIONS[6])
