"""Eq. 7 and 9 to 11: load, contact area, local stress and means of one level."""

from collections.abc import Mapping
from typing import Any

import sympy as sp

from ..check import Claim, zero
from ..latex import statements
from ..multilevel import yielding
from ..surface import WAVE, mean_over_cell
from ..symbols import V, k, l, x, y
from .record import PRINTED, Comparison, compared, refuted
from .words import field, level, strips, surface


def load(pressure: sp.Expr) -> Comparison:
    r"""Eq. 7. ``pressure``: Eq. 15 in SI, of complete contact, where the integral can be done."""
    names = level("i", **{r"\barp_i": over_cell(pressure) / l**2, "p_i": field(pressure), r"iint \Omega_i": _integral})
    (printed,) = statements(PRINTED[7], names)
    claim = zero("as printed, with Eq. 15 for p, it is the mean over x and y", printed.sides[0] - printed.sides[1])
    return compared(7, [claim], ("equilibrium",))


def area() -> Comparison:
    r"""Eq. 9."""
    length = sp.Function("length")
    checks: list[Claim] = []
    for number in (1, 3):
        names = level("i", A_i=l**2, **{"a_i^j": l / 3, "b_i^j": 2 * l / 3}) | strips(number)
        (printed,) = statements(PRINTED[9], names)
        checks.append(zero(f"N = {number}: strips all in contact, a + b = l, make the whole cell", printed.sides[1] - l**2))
    y_j = sp.Symbol("y_j", real=True)
    names = level("i", A_i=l**2, **{"a_i^j": length(y_j), "b_i^j": sp.Integer(0)}) | strips(2)
    (printed,) = statements(PRINTED[9], names)
    both = [length(sign * place * l) for place in (sp.Rational(1, 8), sp.Rational(3, 8)) for sign in (1, -1)]
    even = {length(-place * l): length(place * l) for place in (sp.Rational(1, 8), sp.Rational(3, 8))}
    whole = sum(part * l / 4 for part in both)
    checks.append(
        zero(
            "N = 2: as printed it is the area of all four strips of the cell, the same at y and -y",
            printed.sides[1] - whole.subs(even),
        )
    )
    return compared(9, checks, ("contact area",))


def stress(derived_stress: sp.Expr) -> Comparison:
    r"""Eq. 10. ``derived_stress``: that of the step "local stress"."""
    pressure = sp.Symbol("p", real=True)
    y_j = sp.Symbol("y_j", real=True)
    tau = derived_stress.subs(WAVE).subs(y, y_j)
    names = level("i", **{r"\tau_i": lambda *place: tau, "p_i": lambda *place: pressure})
    (printed,) = statements(PRINTED[10], names)
    power = (pressure * yielding() / V).subs(WAVE).subs(y, y_j)
    checks = [
        zero("as printed it is the stress of the derivation", (printed.sides[0] - printed.sides[1]).doit()),
        zero("and the power p w_t of the pressure over V", (printed.sides[1] - power).doit()),
    ]
    return compared(10, checks, ("local stress",), (r"\tau(x, y) = " + sp.latex(tau.subs(y_j, y)),))


def means(pressure: sp.Expr) -> Comparison:
    r"""Eq. 11, as sums over N strips. ``pressure``: Eq. 15 in SI."""
    shear = pressure * sp.diff(surface(), x)
    checks: list[Claim] = []
    for number in (2, 3):
        for mean, (printed, exact) in zip(("p", "tau"), _sums(pressure, shear, strips(number)), strict=True):
            claim = (
                f"N = {number}, strips at their middles: the printed sum for {mean} is the mean over the cell, in "
                f"complete contact"
            )
            checks.append(zero(claim, printed - exact))
    friction = [_sums(pressure, shear, _edges(number))[1] for number in (2, 3)]
    printed, exact = friction[0]
    checks.append(refuted("so it is for strips at their lower edges, y_1 = 0, which the print does not exclude", printed - exact))
    claim = "their friction is too large by 4/(3 N): 1.3 % with the paper's N = 100"
    excess = [printed - exact * (1 + sp.Rational(4, 3 * n)) for n, (printed, exact) in zip((2, 3), friction, strict=True)]
    checks.append(zero(claim, excess))
    return compared(
        11,
        checks,
        ("means over a level", "means_c", "means_acaf", "means_afc", "means_af", "means_ac", "means_a", "means_f"),
    )


def _edges(number: int) -> dict[str, Any]:
    return strips(number, place=lambda j, wide: (sp.Integer(j) - 1) * wide)


def _sums(pressure: sp.Expr, shear: sp.Expr, cell: Mapping[str, Any]) -> list[tuple[sp.Expr, sp.Expr]]:
    """(as printed, the mean over the cell) of pressure and friction."""
    nothing = sp.Symbol("mean", real=True)
    names = level("i", **{r"\barp_i": nothing, r"\bar\tau_i": nothing, "p_i": field(pressure), r"\tau_i": field(shear)}) | dict(
        cell
    )
    printed = statements(PRINTED[11], names)
    return [(statement.sides[1], over_cell(part) / l**2) for statement, part in zip(printed, (pressure, shear), strict=True)]


def _integral(body: sp.Expr, *variables: sp.Symbol) -> sp.Expr:
    for variable in variables:
        body = sp.integrate(sp.expand(body), (variable, -l / 2, l / 2))
    return body


def over_cell(body: sp.Expr) -> sp.Expr:
    """Integral over the cell, by means over both waves."""
    waves = body.subs(l, 2 * sp.pi / k)
    return mean_over_cell(waves).subs(WAVE) * l**2
