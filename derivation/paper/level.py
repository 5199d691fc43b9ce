"""Eq. 7 and 9 to 11: load, contact area, local stress and means of one level."""

from collections.abc import Mapping
from typing import Any

import sympy as sp

from ..check import zero
from ..multilevel import yielding
from ..surface import WAVE, mean_over_cell
from ..symbols import V, k, l, x, y
from .record import Comparison, compared, read, refuted
from .words import field, level, strips, surface, y_j


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
