"""Energy balance of a strip: what of the friction is loss in the foundation, and what else is in it.

The law is a spring of compliance J in series with a spring 1/L beside a dashpot beta/L; z is the displacement of the latter
pair. With the energy ``Phi = z^2/(2 L) + J p^2/2`` it reads ``p w' = (beta/L) z'^2 + Phi'``. Summed over a period, ``Phi`` and
the work against the traction leave something at the steps of p: the energy that a detachment costs (constitutive), or a
correction without a physical meaning (continuous, which leaves the instantaneous response out).
"""

import sympy as sp

from .check import Derived, derived, holds, zero
from .flows import Flows
from .sequences import ADHESION, CONTACT, Row
from .symbols import J, L, beta, chi, delta_0, p, p_0, s, s_0


def power_balance(flows: Flows) -> Derived:
    r"""The power that enters the foundation is lost in its dashpot, never negative, or stored in its two springs.

    .. math:: p\,w' = \frac{\beta}{L}\,z'^2 + \frac{d}{ds}\left(\frac{z^2}{2L} + \frac{J p^2}{2}\right)
    """
    residuals = []
    for w, pressure in ((flows.strip.u, flows.contact.value), (flows.relaxation.value, p)):
        z = w - J * pressure
        stored = z**2 / (2 * L) + J * pressure**2 / 2
        residuals.append(pressure * sp.diff(w, s) - beta / L * sp.diff(z, s) ** 2 - sp.diff(stored, s))
    checks = [zero("in contact, and under a constant pressure", residuals, phases=(s_0, s))]
    return derived(power_balance, None, checks)


def friction_balance(regime: Row) -> Derived:
    r""":math:`2\pi\bar\tau = E + X`: loss of one cycle, and what the steps of p leave."""
    heights = {zone.first: sp.Symbol(f"u_{zone.first}", real=True) for zone in regime.zones}
    extra = sp.Integer(0)
    for zone in regime.zones:
        first, last = heights[zone.first], heights.get(zone.last, heights[regime.zones[0].first])
        extra += _stored(zone, last, zone.exit) - _stored(zone, first, zone.entry)
        if zone.kind == ADHESION:  # p u' = p w' - p g'
            extra += p_0 * (zone.exit - zone.entry)
    extra = sp.expand(extra.subs(L, 1 - J))
    onset, release = heights[regime.edges[0]], heights[regime.edges[-1]]
    stiff = 1 / J  # glassy modulus
    if regime.sequence in ("acaf", "af"):
        continuous, constitutive = -J * p_0 * (onset - release) / (1 - J), J * p_0**2
        claim = "constitutive: X = p_0^2/K_g, what a detachment costs at the glassy modulus"
        checks = [
            zero("continuous: X = -(J/L) p_0 (w_d - w_c)", sp.factor(extra.subs(chi, 0) - continuous)),
            zero(claim, sp.factor(extra.subs(chi, 1) - constitutive)),
        ]
        latex = r"X = (1 - \chi)\left[-\tfrac{J}{L}\,p_0\,(w_d - w_c)\right] + \chi J p_0^2"
    elif regime.sequence == "afc":
        work = p_0 * delta_0 + p_0**2 / (2 * stiff) - stiff * delta_0**2 / 2
        checks = [
            zero("X = p_0 delta_0 + p_0^2/(2 K_g) - K_g delta_0^2/2", sp.factor(extra - work)),
            holds(
                "the snap costs nothing when it only just happens: both forms of X agree at J p_0 = delta_0",
                sp.factor((work - J * p_0**2).subs(delta_0, J * p_0)) == 0,
            ),
        ]
        latex = r"X = p_0 \delta_0 + \frac{p_0^2}{2 K_g} - \frac{K_g \delta_0^2}{2}"
    else:
        checks = [zero("nothing detaches: X = 0, the friction is the loss", extra)]
        latex = "X = 0"
    return derived(
        friction_balance,
        extra,
        checks,
        name=f"friction balance {regime.sequence}",
        statement=f"Mean friction against loss: {regime.title}. E is the dashpot's loss of one cycle, X the rest.",
        latex=rf"2\pi\bar\tau = E + X,\quad E = \frac{{\beta}}{{L}}\oint z'^2 ds,\quad {latex}",
    )


def _stored(zone, height: sp.Symbol, state: sp.Expr) -> sp.Expr:
    """Energy in the springs at an edge of a zone where the profile has the given height."""
    w, pressure = (height, state - p_0) if zone.kind == CONTACT else (height + state, zone.load)
    z = w - J * pressure
    return z**2 / (2 * L) + J * pressure**2 / 2
