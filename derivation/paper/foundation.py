"""Eq. 1 to 3 and 5: the law of the foundation, adhesion, and the law in the frame of the surface."""

import re

import sympy as sp

from ..check import zero
from ..latex import Statement, rows, statements
from ..model import Foundation
from ..strip import Strip, traction
from ..symbols import delta_0, p_0, x
from .record import PRINTED, Comparison, compared, read
from .words import MATERIAL

opening = sp.Symbol("delta", positive=True)
reach = sp.Symbol("delta_0", positive=True)
WORDS = MATERIAL | {r"\delta": opening, r"\delta_0": reach}
SIGNS = {"<": sp.StrictLessThan, ">": sp.StrictGreaterThan, r"\leq": sp.LessThan, r"\geq": sp.GreaterThan}


def law(foundation: Foundation) -> Comparison:
    r"""Eq. 1."""
    time = sp.Symbol("t", real=True)
    names = MATERIAL | {"w": sp.Function("w")(time), "p": sp.Function("p")(time), "t": time}
    claim = "as printed it is the law of the model, w + T_eps w_t = (p + T_sigma p_t)/K"
    return compared(1, [zero(claim, _beside(read(1, names), foundation.operators.value))])


def moving(strip: Strip) -> Comparison:
    r"""Eq. 5."""
    names = MATERIAL | {"w_i": sp.Function("w")(x), "p_i": sp.Function("p")(x)}
    claim = "as printed it is Eq. 1 for fields that move with the surface"
    return compared(5, [zero(claim, _beside(read(5, names), strip.moving_frame.value))])


def _beside(printed: tuple[Statement, ...], equation: sp.Eq) -> sp.Expr:
    """What the one side of the printed law leaves of the other, beyond what the derived one does."""
    left, right = printed[0].sides
    return (left - right - (equation.lhs - equation.rhs)).doit()


def adhesion() -> tuple[Comparison, Comparison]:
    r"""Eq. 2 and 3."""
    printed, derived = _printed_traction(), traction(opening).subs(delta_0, reach)
    gaps = (reach / 1000, reach / 2, reach, 2 * reach)
    claim = "the pressure in a gap is -p_a of the print, within delta_0, at it and beyond"
    law = zero(claim, [(printed + derived).subs(opening, gap) for gap in gaps])
    names = WORDS | {"p_a": lambda gap=opening: printed.subs(opening, gap), r"\gamma": p_0 * reach}
    first, integral, product = read(3, names)[0].sides
    work = integral.doit()
    energy = zero("both sides of the print, and the derived work of separation, are one", [work - first, product - first])
    return (
        compared(2, [law], [r"p = -p_a(g) = " + sp.latex(traction(sp.Symbol("g", positive=True)))]),
        compared(3, [energy], [r"\gamma = " + sp.latex(work)]),
    )


def _printed_traction() -> sp.Piecewise:
    cases = []
    for row in rows(PRINTED[2].partition("=")[2]):
        value, condition = (statements(part.strip(" ,"), WORDS)[0] for part in re.split(r",\s\s+", row, maxsplit=1))
        bounds = zip(condition.signs, condition.sides, condition.sides[1:], strict=False)
        cases.append((value.sides[0], sp.And(*(SIGNS[sign](one, other) for sign, one, other in bounds))))
    return sp.Piecewise(*cases)
