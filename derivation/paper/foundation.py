"""Eq. 1 to 3 and 5: the law of the foundation, adhesion, and the law in the frame of the surface."""

import re

import sympy as sp

from ..check import zero
from ..latex import Statement, rows, statements
from ..model import Foundation
from ..strip import Strip, traction
from ..symbols import delta_0, p_0, x
from .record import PRINTED, Comparison, compared
from .words import MATERIAL

opening = sp.Symbol("delta", positive=True)
SIGNS = {"<": sp.StrictLessThan, ">": sp.StrictGreaterThan, r"\leq": sp.LessThan, r"\geq": sp.GreaterThan}


def law(foundation: Foundation) -> Comparison:
    r"""Eq. 1."""
    time = sp.Symbol("t", real=True)
    names = MATERIAL | {"w": sp.Function("w")(time), "p": sp.Function("p")(time), "t": time}
    (printed,) = statements(PRINTED[1], names)
    equation = foundation.operators.value
    left = printed.sides[0] - printed.sides[1] - (equation.lhs - equation.rhs)
    return compared(
        1,
        [zero("as printed it is the law of the model, w + T_eps w_t = (p + T_sigma p_t)/K", left.doit())],
        ("foundation law", "relaxed stiffness", "instantaneous compliance"),
    )


def moving(strip: Strip) -> Comparison:
    r"""Eq. 5."""
    names = MATERIAL | {"w_i": sp.Function("w")(x), "p_i": sp.Function("p")(x)}
    (printed,) = statements(PRINTED[5], names)
    equation = strip.moving_frame.value
    left = printed.sides[0] - printed.sides[1] - (equation.lhs - equation.rhs)
    return compared(
        5,
        [zero("as printed it is Eq. 1 for fields that move with the surface", left.doit())],
        ("moving frame", "contact flow", "relaxation flow"),
    )


def adhesion() -> tuple[Comparison, Comparison]:
    r"""Eq. 2 and 3."""
    printed = _printed_traction()
    names = MATERIAL | {"p_a": lambda gap=opening: printed.subs(opening, gap), r"\delta": opening, r"\gamma": p_0 * delta_0}
    (energy,) = statements(PRINTED[3], names)
    first, integral, product = energy.sides
    gaps = (delta_0 / 1000, delta_0 / 2, delta_0, 2 * delta_0)
    positive = {delta_0: sp.Symbol("delta_0", positive=True)}
    work = integral.subs(positive).doit().subs({new: old for old, new in positive.items()})
    return (
        compared(
            2,
            [
                zero(
                    "the pressure in a gap is -p_a of the print, within delta_0, at it and beyond",
                    [_at(printed, gap) + _at(traction(opening), gap) for gap in gaps],
                )
            ],
            ("adhesion law",),
            (r"p = -p_a(g) = " + sp.latex(traction(sp.Symbol("g", positive=True))),),
        ),
        compared(
            3,
            [zero("both sides of the print, and the derived work of separation, are one", [work - first, product - first])],
            ("adhesion law",),
            (r"\gamma = " + sp.latex(work),),
        ),
    )


def _printed_traction() -> sp.Piecewise:
    cases = []
    for row in rows(PRINTED[2].partition("=")[2]):
        value, condition = (part.strip(" ,") for part in re.split(r",\s\s+", row, maxsplit=1))
        (value,), (bounds,) = statements(value, MATERIAL), statements(condition, MATERIAL | {r"\delta": opening})
        cases.append((value.sides[0], _condition(bounds)))
    return sp.Piecewise(*cases)


def _condition(bounds: Statement) -> sp.Basic:
    sides = bounds.sides
    return sp.And(*(SIGNS[sign](a, b) for sign, a, b in zip(bounds.signs, sides, sides[1:], strict=False)))


def _at(traction: sp.Piecewise, gap: sp.Expr) -> sp.Expr:
    unit = sp.Symbol("delta_0", positive=True)
    return sp.simplify(traction.subs(delta_0, unit).subs(opening, gap.subs(delta_0, unit)))
