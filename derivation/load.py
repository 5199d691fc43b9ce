"""Load and contact area of a level (Eq. 7, 9)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from .averages import ZoneIntegrals
from .check import Derived, derived, zero
from .functions import written_out
from .regime import Regime
from .sequences import ADHESION, CONTACT, PERIOD
from .surface import HEIGHT, mean_over_cell, mean_over_wave
from .symbols import D_level, K, a, b, beta, k, l, p_0, q_0, s_0, s_1, x, y


def equilibrium(touching: Sequence[Any], unbalanced: Sequence[sp.Expr]) -> Derived:
    r"""Eq. 7: The nominal pressure balances what the surface carries: the pressure in contact and the traction of
    adhesion, summed over both, per area of the cell. Outside both the pressure is zero.

    .. math:: \bar p = \frac{1}{l^2} \iint_{\Omega} p(x, y)\,dx\,dy

    ``unbalanced``: of each regime in contact (:func:`unbalanced`), what its zones carry less 2 pi mean p.
    """
    relaxed = D_level - HEIGHT  # w at rest
    stored = mean_over_cell(K * relaxed**2 / 2)
    carried = mean_over_cell(K * relaxed)
    claims = [
        zero(
            "virtual work: pressing the relaxed foundation deeper by dD stores the integral of p times dD",
            sp.diff(stored, D_level) - carried,
        ),
        *(
            zero(
                f"{regime.sequence}: contact carries 2 pi mean p and p_0 times the width in adhesion; outside both "
                f"there is no load",
                left,
                phases=regime.edges,
            )
            for regime, left in zip(touching, unbalanced, strict=True)
        ),
    ]
    value = sp.Integral(sp.Function("p")(x, y), x, y) / l**2
    return derived(equilibrium, value, claims, emitted=tuple(f"means_{regime.sequence}" for regime in touching))


def unbalanced(regime: Regime, mean_p: sp.Expr, integrals: ZoneIntegrals) -> sp.Expr:
    """Pressure summed over contact, against the mean pressure that is emitted; the closing balance is zero on an orbit."""
    summed = adhesion = sp.Integer(0)
    for zone in regime.zones:
        if zone.kind == CONTACT:
            edges = {s_0: zone.first, s_1: zone.last, q_0: zone.entry}
            summed += integrals.contact.value[0].subs(edges, simultaneous=True)
        elif zone.kind == ADHESION:
            adhesion += zone.last - zone.first
    return written_out(summed) - PERIOD * mean_p - p_0 * adhesion - beta * written_out(regime.closing)


def contact_area(regimes: Sequence[Any]) -> Derived:
    r"""Eq. 9: The contact area of a level is the sum over its strips of the contact length a + b times the width of a strip; over
    l^2 it is the fraction of the nominal area in contact.

    .. math:: A = 2 \Delta \sum_{j=1}^{N} (a_j + b_j),\quad l = 2 N \Delta
    """
    length = sp.Function("length")
    ends = {a: k * sp.Symbol("x_a", positive=True), b: -k * sp.Symbol("x_b", positive=True)}  # contact from x = -a to b
    widths = []
    for regime in regimes:
        for zone in regime.zones:
            if zone.kind == CONTACT and zone.first == b:
                between = (zone.last - zone.first).subs(ends) / k
                widths.append(between - sp.Symbol("x_a", positive=True) - sp.Symbol("x_b", positive=True))
    checks = [
        zero("the contact zone from phase b to phase a is a + b long in x", widths),
        zero("the surface is the same at y and -y: half a cell counts twice", HEIGHT.subs(y, -y) - HEIGHT),
        zero("complete contact, a + b = l in every strip: the whole cell", [_area(lambda _: l, n) - l**2 for n in (1, 2, 5)]),
        zero(
            "strips represented by their middles: a length linear in cos ky is summed to its integral over the cell",
            [_area(_linear, n) - l * mean_over_wave(_linear(y), y).subs(k, 2 * sp.pi / l) for n in (2, 3)],
        ),
    ]
    return derived(contact_area, sp.Integral(length(y), (y, 0, l)), checks)


def _linear(place: sp.Expr) -> sp.Expr:
    one, other = sp.symbols("c_0 c_1", real=True)
    return one + other * sp.cos(k * place)


def _area(length, number: int) -> sp.Expr:
    """Eq. 9 with N strips in half a cell, each at its middle."""
    width = l / (2 * number)
    middles = [(sp.Rational(2 * j + 1, 2) * width) for j in range(number)]
    return sum((2 * width * length(place) for place in middles), sp.Integer(0)).subs(k, 2 * sp.pi / l)
