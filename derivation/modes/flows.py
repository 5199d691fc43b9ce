"""The flows of a generic mode, solved by SymPy, and their sum put back into the law of order n."""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Any

import sympy as sp

from ..check import BEYOND, REPRODUCED, Check, Derived, derived, zero
from ..flows import _solved as solved
from ..model import rate
from ..symbols import D, alpha, beta, p, s, s_0
from .identity import POINTS, SYMBOLIC
from .law import Law
from .symbols import J_0, J, eta, f_0, z_0
from .tensor import component

u = D - 1 + sp.cos(s)


@dataclass(frozen=True)
class ModeFlows:
    """Stage 3 for a generic mode, as functions of s."""

    law: Law
    relaxation: Derived  # z(s) under the constant pressure p, entered with z_0
    contact: Derived  # f(s) in contact, entered with f_0


def mode_flows(law: Law) -> ModeFlows:
    return ModeFlows(law, relaxation_flow(law), contact_flow(law))


def relaxation_flow(law: Law) -> Derived:
    r"""Adhesion :math:`p=-p_0` or free :math:`p=0`: :math:`z_j = J_j p + (z_{j,0} - J_j p)\,e^{-(s-s_0)/\beta_j}`."""
    name = "relaxation flow"
    flow = solved(name, lambda unknown: unknown + beta * sp.diff(unknown, s) - J * p, entry=z_0)

    def residual(at: dict[Any, Any]) -> sp.Expr:
        values = {key: value.subs(at) for key, value in law.values.items()}
        w = values[J_0] * p + sp.Add(*(component(flow, law.modes, values, j) for j in range(law.modes)))
        return _operated(law.operators[0].subs(at), w) - p

    checks = [
        zero(name, "the law of the mode holds under the constant pressure p", flow + beta * sp.diff(flow, s) - J * p),
        zero(name, "the zone is entered with z_0", flow.subs(s, s_0) - z_0),
        _solves(name, "w = J_0 p + sum z_j solves the law of order n", residual, law),
    ]
    return derived(
        relaxation_flow,
        flow,
        name=name,
        statement="Out of contact p is constant, and every retardation displacement creeps towards its share J_j p by itself.",
        latex="z_j(s) = J_j p + (z_{j,0} - J_j p)\\,e^{-(s - s_0)/\\beta_j},\\quad w = J_0 p + \\sum_j z_j",
        checks=checks,
        paper="Eq. 5",
        status=REPRODUCED,
        emitted=("relaxation_after",),
    )


def contact_flow(law: Law) -> Derived:
    r"""Eq. 15 and its transients, :math:`w = u`: :math:`p = u + \sum_i f_i`."""
    name = "contact flow"
    flow = solved(name, lambda unknown: unknown + alpha * sp.diff(unknown, s) - eta * sp.diff(u, s), entry=f_0)

    def residual(at: dict[Any, Any]) -> sp.Expr:
        values = {key: value.subs(at) for key, value in law.values.items()}
        pressure = u + sp.Add(*(component(flow, law.modes, values, i) for i in range(law.modes)))
        Q, P = (operator.subs(at) for operator in law.operators)
        return _operated(Q, u) - _operated(P, pressure)

    checks = [
        zero(name, "the law of the branch holds with w = u", flow + alpha * sp.diff(flow, s) - eta * sp.diff(u, s)),
        zero(name, "the zone is entered with f_0", flow.subs(s, s_0) - f_0),
        _solves(name, "p = u + sum f_i solves the law of order n", residual, law),
    ]
    return derived(
        contact_flow,
        flow,
        name=name,
        statement="In contact w = u is given, and the overstress of every branch follows it by itself: a harmonic, and "
        "a transient "
        "that dies out over alpha_i.",
        latex=r"f_i(s) = f_{sat,i}(s) + (f_{i,0} - f_{sat,i}(s_0))\,e^{-(s - s_0)/\alpha_i},\quad "
        r"f_{sat,i} = \eta_i\frac{\alpha_i \cos s - \sin s}{1 + \alpha_i^2},\quad p = u + \sum_i f_i",
        checks=checks,
        paper="Eq. 5, 15",
        status=REPRODUCED if law.modes == 1 else BEYOND,
        emitted=("overstress_after", "contact_pressure"),
    )


def _operated(operator: sp.Expr, function: sp.Expr) -> sp.Expr:
    """A polynomial in d/ds, applied."""
    coefficients = reversed(sp.Poly(operator, rate).all_coeffs())
    return sp.Add(*(c * sp.diff(function, s, k) for k, c in enumerate(coefficients)))


def _solves(name: str, claim: str, residual: Any, law: Law) -> Check:
    """A residual of the law of order n: zero in symbols for one mode, else with rational times, the phases as symbols."""
    if law.modes < SYMBOLIC:
        return zero(name, claim, residual({}), phases=(s_0, s))
    times = [value for (symbol, *_), value in _times(law)]
    draw = random.Random(f"{name} {law.modes}")
    for _ in range(min(POINTS, 3)):
        at = {time: sp.Rational(draw.getrandbits(12) + 1, draw.getrandbits(6) + 1) for time in times}
        zero(name, claim, residual(at), phases=(s_0, s))
    return Check(claim, "exact zero at 3 sets of random rational times, phases and states as symbols")


def _times(law: Law) -> list[tuple[Any, sp.Expr]]:
    return [(key, value) for key, value in law.values.items() if isinstance(key, tuple) and key[0] in (alpha, beta)]
