"""Eq. 4 and 6 to 11: one level, its shape, its strips and its edge conditions, load, contact area, local stress and means."""

import re
from collections.abc import Mapping
from typing import Any

import sympy as sp

from ..check import zero
from ..latex import rows, statements
from ..multilevel import yielding
from ..sequences import ADHESION, FREE, Span
from ..surface import AMPLITUDE, HEIGHT, PENETRATION, WAVE, mean_over_cell
from ..symbols import D_level, V, h, k, l, p_0, s, x, y
from .record import PRINTED, Comparison, compared, read, refuted
from .words import field, level, strips, surface, y_j


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


def load(pressure: sp.Expr) -> Comparison:
    r"""Eq. 7. ``pressure``: Eq. 15 in SI, of complete contact, where the integral can be done."""
    names = level("i", **{r"\barp_i": mean(pressure), "p_i": field(pressure), r"iint \Omega_i": _integral})
    one, other = read(7, names)[0].sides
    return compared(7, [zero("as printed, with Eq. 15 for p, it is the mean over x and y", one - other)])


def area() -> Comparison:
    r"""Eq. 9."""
    length = sp.Function("length")

    def printed(number: int, ahead: sp.Expr, behind: sp.Expr) -> sp.Expr:
        return read(9, level("i", A_i=l**2, **{"a_i^j": ahead, "b_i^j": behind}) | strips(number))[0].sides[1]

    whole = {n: printed(n, l / 3, 2 * l / 3) - l**2 for n in (1, 3)}
    checks = [zero(f"N = {n}: strips all in contact, a + b = l, make the whole cell", rest) for n, rest in whole.items()]
    half = [length(place * l) for place in (sp.Rational(1, 8), sp.Rational(3, 8))]
    claim = "N = 2: as printed it is the area of all four strips of the cell, the same at y and -y"
    checks.append(zero(claim, printed(2, length(y_j), sp.Integer(0)) - 2 * sum(half) * l / 4))
    return compared(9, checks)


def stress(derived_stress: sp.Expr) -> Comparison:
    r"""Eq. 10. ``derived_stress``: that of the step "local stress"."""
    pressure = sp.Symbol("p", real=True)
    tau, power = (part.subs(WAVE).subs(y, y_j) for part in (derived_stress, pressure * yielding() / V))
    one, other = read(10, level("i", **{r"\tau_i": lambda *place: tau, "p_i": lambda *place: pressure}))[0].sides
    checks = [
        zero("as printed it is the stress of the derivation", (one - other).doit()),
        zero("and the power p w_t of the pressure over V", (other - power).doit()),
    ]
    return compared(10, checks, [r"\tau(x, y) = " + sp.latex(tau.subs(y_j, y))])


def means(pressure: sp.Expr) -> Comparison:
    r"""Eq. 11, as sums over N strips. ``pressure``: Eq. 15 in SI."""
    at_middles = "strips at their middles: the printed sum for {} is the mean over the cell, in complete contact"
    numbers, checks = (2, 3), []
    for n in numbers:
        sums = zip(("p", "tau"), _sums(pressure, strips(n)), strict=True)
        checks += [zero(f"N = {n}, {at_middles.format(what)}", printed - exact) for what, (printed, exact) in sums]
    at_edges = [_sums(pressure, strips(n, place=lambda j, wide: (sp.Integer(j) - 1) * wide))[1] for n in numbers]
    claim = "so it is for strips at their lower edges, y_1 = 0, which the print does not exclude"
    checks.append(refuted(claim, at_edges[0][0] - at_edges[0][1]))
    excess = [printed - exact * (1 + sp.Rational(4, 3 * n)) for n, (printed, exact) in zip(numbers, at_edges, strict=True)]
    checks.append(zero("their friction is too large by 4/(3 N): 1.3 % with the paper's N = 100", excess))
    return compared(11, checks)


def _sums(pressure: sp.Expr, cell: Mapping[str, Any]) -> list[tuple[sp.Expr, sp.Expr]]:
    """(as printed, the mean over the cell) of pressure and friction."""
    parts = (pressure, pressure * sp.diff(surface(), x))
    fields = {"p_i": field(parts[0]), r"\tau_i": field(parts[1])}
    unnamed = dict.fromkeys((r"\barp_i", r"\bar\tau_i"), sp.Symbol("mean", real=True))
    printed = read(11, level("i", **fields, **unnamed, **cell))
    return [(statement.sides[1], mean(part)) for statement, part in zip(printed, parts, strict=True)]


def _integral(body: sp.Expr, *variables: sp.Symbol) -> sp.Expr:
    for variable in variables:
        body = sp.integrate(sp.expand(body), (variable, -l / 2, l / 2))
    return body


def mean(body: sp.Expr) -> sp.Expr:
    """Mean over the cell, of what may hold its wavelength."""
    return mean_over_cell(body.subs(l, 2 * sp.pi / k)).subs(WAVE)
