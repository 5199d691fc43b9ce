"""Slope of the onset-to-onset map at a periodic orbit: how much of a shift of the onset is left one period later."""

from __future__ import annotations

import sympy as sp

from . import stable
from .check import Derived, derived, zero
from .functions import Formula, decay, either, quotient, written_out
from .kernel import Kernel, kernel
from .regime import Regime, Zone
from .sequences import CONTACT
from .symbols import D, J, L, alpha, beta, chi, gap_0, p, p_0, q_0, s_0, s_1


def shift_of_an_event() -> Derived:
    r"""The derivatives of a zone's flow F by its two edges are loads: what drives the event function there. The edge
    where the zone ends moves by minus their quotient.

    .. math:: \frac{\partial g/\partial s_0}{\partial g/\partial s_1} = -\frac{H(s_0) + g_0 - p}{H(s_1) + g(s_1) - p}\,e^{-(s_1
        - s_0)/\beta},\quad \frac{\partial q/\partial s_0}{\partial q/\partial s_1} = -\frac{H(s_0) + p_0 - q_0}{H(s_1) + p_0 -
        q(s_1)}\,e^{-(s_1 - s_0)/\alpha}
    """
    gap = stable.GAP_AFTER(s_0, s_1, gap_0, p, D, beta)
    pressure = stable.EXCESS_AFTER(s_0, s_1, q_0, p_0, D, alpha, beta, L)
    load_0, load_1 = stable.FORCING(s_0, D, beta), stable.FORCING(s_1, D, beta)
    checks = [
        zero(
            "adhesion and free gap: beta dg/ds_0 = (H_0 + gap_0 - p) exp(-(s_1 - s_0)/beta), beta dg/ds_1 = -(H_1 + g - p)",
            [
                beta * sp.diff(gap, s_0) - (load_0 + gap_0 - p) * decay(s_1 - s_0, beta),
                beta * sp.diff(gap, s_1) + (load_1 + gap - p),
            ],
            phases=(s_0, s_1),
        ),
        zero(
            "contact: alpha dq/ds_0 = -(H_0 + p_0 - q_0) exp(-(s_1 - s_0)/alpha), alpha dq/ds_1 = H_1 + p_0 - q",
            [
                alpha * sp.diff(pressure, s_0) + (load_0 + p_0 - q_0) * decay(s_1 - s_0, alpha),
                alpha * sp.diff(pressure, s_1) - (load_1 + p_0 - pressure),
            ],
            phases=(s_0, s_1),
        ),
    ]
    return derived(shift_of_an_event, None, checks)


def onset_slope(regime: Regime) -> Kernel:
    r"""A shift of the onset fades over contact with alpha and over the rest of the period with beta, and is scaled where p steps.
    The orbit is stable when T' < 1; T' = 1 is a fold.

    .. math:: T' = \prod_{\text{zones}} \frac{ds_{last}}{ds_{first}}
    """
    product: sp.Expr = sp.Integer(1)
    forgotten: sp.Expr = sp.Integer(1)
    upper, lower = [], []
    for zone in regime.zones:
        width = zone.last - zone.first
        forgotten *= decay(width, alpha if zone.kind == CONTACT else beta)
        entered, left = offsets(zone)
        last = _same_phase(zone.last)
        upper.append(sp.expand(stable.FORCING(zone.first, D, beta) + entered))
        lower.append(sp.expand(stable.FORCING(last, D, beta) + left))
    for above, below in zip(upper, lower, strict=True):
        product *= above / below
    product *= forgotten
    # What a zone is left with is what the next is entered with, except at a step of p: pair each zone's exit with the
    # next zone's entry.
    formula_result = direct = forgotten
    for below, above in zip(lower, upper[1:] + upper[:1], strict=True):
        if sp.expand(below - above) != 0:
            # where the ratio is small, 1 + ratio keeps its digits; else the quotient
            ratio = quotient(step_of_load(above - below), below)
            formula_result *= either(2 * sp.Abs(ratio), 1 + ratio, quotient(above, below))
            direct *= quotient(above, below)
    return kernel(
        onset_slope,
        Formula(f"onset_slope_{regime.sequence}", regime.args, formula_result),
        written_out(product),
        zero("the product over the zones, telescoped", written_out(direct) - written_out(product), phases=regime.edges),
        latex="T' = " + r" \cdot ".join(sp.latex(written_out(part)) for part in sp.Mul.make_args(direct)),
        phases=regime.edges,
    )


def offsets(zone: Zone) -> tuple[sp.Expr, sp.Expr]:
    """What the load of a zone is more than H where it is entered, and where it is left."""
    if zone.kind == CONTACT:
        return p_0 - zone.entry, p_0 - zone.exit
    return zone.entry - zone.load, zone.exit - zone.load


def step_of_load(change: sp.Expr) -> sp.Expr:
    """What a load steps by, without cancellation where J is nearly 1."""
    return sp.factor(change).subs({J * chi - 1: -(L * chi + 1 - chi), J - 1: -L})


def _same_phase(edge: sp.Expr) -> sp.Expr:
    """The edge itself instead of one period later: the load has the period 2 pi."""
    return edge.subs(sp.pi, 0)
