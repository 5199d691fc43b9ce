"""Eq. 4, 6 and 8: the shape of a level, its boundary conditions, the penetration of a strip."""

import re

import sympy as sp

from ..check import zero
from ..latex import rows, statements
from ..sequences import ADHESION, FREE, Span
from ..surface import AMPLITUDE, HEIGHT, PENETRATION, WAVE
from ..symbols import D_level, h, l, p_0, s, x, y
from .record import PRINTED, Comparison, compared, read, refuted
from .words import level, surface, y_j


def shape() -> Comparison:
    r"""Eq. 4."""
    stated = read(4, level("i"))[0].sides[1]
    back = [stated.subs({x: 0, y: 0}), stated.subs({x: l / 2, y: 0}) - h]
    checks = [
        zero("as printed it is the surface of the derivation", stated - surface()),
        zero("it stands back by nothing at the crest, by h in the valley", back),
    ]
    return compared(4, checks, ["f(x, y) = " + sp.latex(HEIGHT.subs(WAVE))])


def penetration() -> Comparison:
    r"""Eq. 8."""
    crest, own = surface(sp.Integer(0), y_j), PENETRATION.subs(WAVE).subs(y, y_j)
    printed = read(8, level("i", **{"D_i^j": D_level - crest}))[0]
    checks = [
        zero("as printed it is D - f at x = 0 of the strip, by Eq. 4 as printed", printed.sides[1] - printed.sides[0]),
        zero("and the D_j of the derivation", printed.sides[1] - own),
        refuted("it is f + D at x = 0, as Eq. 6 would have it", printed.sides[1] - crest - D_level),
    ]
    return compared(8, checks, ["D_j = " + sp.latex(own)])


def conditions(derived_gap: sp.Expr) -> Comparison:
    r"""Eq. 6, three conditions. ``derived_gap``: g of the step "zone conditions", with w in units of the strip's amplitude."""
    lines = [re.split(r",\s\s+", row)[0].strip(" ,") for row in rows(PRINTED[6])]
    w, p = sp.Symbol("w", real=True), sp.Symbol("p", real=True)
    names = level("i", w_i=lambda *place: w, p_i=lambda *place: p)
    printed, in_adhesion, outside = (statements(line, names)[0].sides[1] for line in lines)
    (derived_w,) = sp.solve(derived_gap, sp.Function("w")(s))
    height = (AMPLITUDE * derived_w).subs(WAVE)
    traction, nothing = (Span(kind, s, s, sp.Integer(0), sp.Integer(0)).load for kind in (ADHESION, FREE))
    derived = [
        f"w = {sp.latex(sp.expand(height))}" + r"\quad\text{in contact}",
        f"p = {sp.latex(traction)}" + r"\quad\text{in adhesion}",
        f"p = {sp.latex(nothing)}" + r"\quad\text{outside both}",
    ]
    checks = [
        refuted("in contact w = f + D, as printed, closes the gap", printed - height),
        zero("with the other sign of f it does: w = D - f", (printed - 2 * surface()) - height),
        zero("in adhesion p = -p_0, as printed", [in_adhesion - traction, traction + p_0]),
        zero("outside both p = 0, as printed", outside - nothing),
    ]
    return compared(6, checks, derived, corrected_as=6)
