"""The flows of the three zones: SymPy solves the law with w given (contact) or p given (adhesion, free gap).

One integration constant per mode is eliminated by the state in which the zone is entered, at the phase ``s_0``. Relative
to that edge every exponent is ``-(s - s_0)/T <= 0``: nothing can overflow.
"""

from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from .check import DerivationError, Derived, derived, zero
from .strip import Strip
from .symbols import gap_0, p, p_0, q_0, s, s_0, w_0


@dataclass(frozen=True)
class Flows:
    """Stage 3: pressure in contact, displacement under a constant pressure, as functions of s."""

    strip: Strip
    contact: Derived  # p(s), entered at s_0 with the pressure q_0 - p_0
    relaxation: Derived  # w(s) under the constant pressure p, entered at s_0 with w_0
    gap: Derived  # g(s) = w - u, entered with gap_0


def flows(strip: Strip) -> Flows:
    contact, relaxation = contact_flow(strip), relaxation_flow(strip)
    return Flows(strip, contact, relaxation, gap_flow(strip, relaxation.value))


def contact_flow(strip: Strip) -> Derived:
    r"""Eq. 5: In contact w = u is given and the law is an equation for p: the saturated field plus a transient that dies out over
    alpha.

    .. math:: p(s) = p_{sat}(s) + (p(s_0) - p_{sat}(s_0))\,e^{-(s-s_0)/\alpha}
    """
    pressure = solved("contact flow", lambda unknown: strip.law(strip.u, unknown), entry=q_0 - p_0)
    checks = [
        zero("the law holds with w = u", strip.law(strip.u, pressure)),
        zero("the zone is entered at the pressure q_0 - p_0", pressure.subs(s, s_0) - (q_0 - p_0)),
    ]
    return derived(contact_flow, pressure, checks, emitted=("excess_after",))


def relaxation_flow(strip: Strip) -> Derived:
    r"""Eq. 5: Out of contact p is constant, -p_0 within the reach of adhesion and 0 beyond it, and w creeps towards p.

    .. math:: w(s) = p + (w_0 - p)\,e^{-(s-s_0)/\beta}
    """
    displacement = solved("relaxation flow", lambda unknown: strip.law(unknown, p), entry=w_0)
    checks = [
        zero("the law holds under the constant pressure p", strip.law(displacement, p)),
        zero("the zone is entered with w_0", displacement.subs(s, s_0) - w_0),
    ]
    return derived(relaxation_flow, displacement, checks)


def gap_flow(strip: Strip, displacement: sp.Expr) -> Derived:
    r"""The gap between the foundation and the rigid profile is driven by the single harmonic H = u + beta u'.

    .. math:: g + \beta g' = p - H,\quad H = u + \beta u'
    """
    gap = displacement.subs(w_0, strip.u.subs(s, s_0) + gap_0) - strip.u
    forcing = strip.law(strip.u, sp.Integer(0))
    checks = [
        zero("the gap obeys g + beta g' = p - H", strip.law(gap, p) + forcing),
        zero("the zone is entered with gap_0", gap.subs(s, s_0) - gap_0),
    ]
    return derived(gap_flow, gap, checks, emitted=("gap_after",))


def steady_state(flow: sp.Expr) -> sp.Expr:
    """What a flow comes to once its transient has died out: the periodic solution."""
    return flow.replace(sp.exp, lambda exponent: sp.Integer(0))


def solved(name: str, law: Callable[[sp.Expr], sp.Expr], entry: sp.Expr, along: sp.Symbol = s, since: sp.Symbol = s_0) -> sp.Expr:
    """Solve the linear law for a function of ``along`` with ``f(since) = entry``.

    The general solution is a particular one plus a constant times a mode. The entry condition fixes the constant, and
    the mode is written relative to the entry edge.
    """
    function = sp.Function("f")(along)
    general = sp.expand(sp.dsolve(sp.Eq(sp.expand(law(function)), 0), function).rhs)
    constants = sorted(general.free_symbols - law(function).free_symbols, key=str)
    if len(constants) != 1:
        raise DerivationError(name, f"one integration constant, not {constants}")
    mode = general.coeff(constants[0])
    if sp.expand(general - constants[0] * mode).has(constants[0]):
        raise DerivationError(name, "the general solution is linear in its integration constant")
    particular = sp.factor_terms(sp.expand(general.subs(constants[0], 0)))
    decayed = sp.exp(sp.factor_terms(sp.expand(sp.log(mode / mode.subs(along, since)), force=True)))
    return particular + (entry - particular.subs(along, since)) * decayed
