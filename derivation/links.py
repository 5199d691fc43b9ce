"""Links: how the state at one edge depends on this edge and the one before, for Newton on the chain of edges.

The same functions as ``gap_after`` and ``excess_after`` with both their derivatives, sharing what these have in common. One
link for every zone of a regime gives its boundary equations and their Jacobian along the chain.
"""

from __future__ import annotations

import sympy as sp

from . import stable
from .check import derived, zero
from .exact import in_half_angles
from .flows import Flows
from .functions import Formula
from .kernel import Kernel
from .symbols import p_0, s, s_0, s_1


def links(flows: Flows) -> tuple[Kernel, Kernel]:
    r""":math:`(g, \partial g/\partial s_0, \partial g/\partial s_1)` over a gap and the same of q over contact."""
    gap = flows.gap.value.subs(s, s_1)
    excess = flows.contact.value.subs(s, s_1) + p_0
    return (
        _link(
            stable.GAP_LINK,
            gap,
            "Gap at s_1 when it was gap_0 at s_0 and the pressure is p since, with its derivatives by s_0 and s_1. Same as "
            "gap_after, gap_after_start and gap_after_slope; s_1 must not be before s_0.",
            r"g,\quad \partial g/\partial s_0,\quad \partial g/\partial s_1",
        ),
        _link(
            stable.EXCESS_LINK,
            excess,
            "Pressure above -p_0 at s_1 in contact entered at s_0 with q_0, with its derivatives by s_0 and s_1. Same "
            "as excess_after, excess_after_start and excess_after_slope; s_1 must not be before s_0.",
            r"q,\quad \partial q/\partial s_0,\quad \partial q/\partial s_1",
        ),
    )


def _link(formula: Formula, value: sp.Expr, statement: str, latex: str) -> Kernel:
    name = formula.name
    exact = (value, sp.diff(value, s_0), sp.diff(value, s_1))
    claims = ("the value is the derived one", "its derivative by s_0", "its derivative by s_1")
    computed = formula.written_out(formula.args)
    checks = [
        zero(name, claim, in_half_angles(c - e, s_0, s_1), phases=(s_0, s_1))
        for claim, c, e in zip(claims, computed, exact, strict=True)
    ]
    return Kernel(
        formula, exact, derived(links, exact, name=name, statement=statement, latex=latex, checks=checks, emitted=(name,))
    )
