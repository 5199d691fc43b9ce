"""What each zone does to a material point: stable forms proven equal to the flows that SymPy solved."""

import sympy as sp

from . import stable
from .check import Claim, derived, holds, zero
from .flows import Flows
from .functions import Formula
from .integral import integral
from .kernel import Kernel, kernel
from .symbols import D, J, beta, excess, gap_0, lag_0, p, p_0, p_in, q_0, s, s_0, s_1, w_0


def over_zone(integrand: sp.Expr, name: str) -> tuple[sp.Expr, Claim]:
    """The integral of a flow from s_0 to s_1, and why it is that; ``name``: of the flow."""
    primitive = integral(integrand, s)
    over = primitive.subs(s, s_1) - primitive.subs(s, s_0)
    left = [sp.diff(over, s_1) - integrand.subs(s, s_1), over.subs(s_1, s_0)]
    return over, zero(f"the integral differentiates to {name}, and vanishes with the zone", left, phases=(s_0, s_1))


def zones(flows: Flows) -> tuple[Kernel, ...]:
    """Stage 4b: the building blocks of every regime."""
    return (
        *rigid_profile(flows.strip.u),
        *load(flows),
        *gap(flows),
        *relaxation(flows),
        *contact(flows),
        *contact_state(flows),
    )


def rigid_profile(u: sp.Expr) -> tuple[Kernel, ...]:
    r""":math:`u(s)`, :math:`u'(s)`, :math:`u(s_1)-u(s_0)`, :math:`\int u\,ds`.

    profile: Rigid profile of the strip.

    .. math:: u(s) = D - 1 + \cos s

    profile_slope: Slope of the rigid profile.

    .. math:: u'(s) = -\sin s

    profile_rise: Rise of the rigid profile between two phases, without cancellation.

    .. math:: u(s_1) - u(s_0) = -2 \sin\tfrac{s_0 + s_1}{2} \sin\tfrac{s_1 - s_0}{2}

    profile_integral: Integral of the rigid profile: the displacement summed over a contact zone.

    .. math:: \int_{s_0}^{s_1} u\,ds
    """
    integral, claim = over_zone(u, "u")
    return (
        kernel(rigid_profile, stable.PROFILE, u),
        kernel(rigid_profile, stable.PROFILE_SLOPE, sp.diff(u, s)),
        kernel(rigid_profile, stable.PROFILE_RISE, u.subs(s, s_1) - u.subs(s, s_0)),
        kernel(rigid_profile, stable.PROFILE_INTEGRAL, integral, claim),
    )


def load(flows: Flows) -> tuple[Kernel, ...]:
    r""":math:`H = u + \beta u'`, and the arc where :math:`H + e > 0`.

    forcing: The load harmonic, which drives every event.

    .. math:: H(s) = u + \beta u'

    forcing_arc: H + e > 0 exactly for |s - centre| < half, modulo 2 pi. An event function F with F + T F' = +-(H + e) has at a
    zero a slope of the sign of that harmonic: its upward and downward zeros lie in these arcs.

    .. math:: \text{centre} = -\arctan\beta,\quad \text{half} = \arccos\frac{1 - D - e}{\sqrt{1 + \beta^2}}
    """
    H = flows.strip.law(flows.strip.u, sp.Integer(0))
    forcing = kernel(load, stable.FORCING, H)
    centre, half = (-sp.atan(beta), (1 - D - excess) / sp.sqrt(1 + beta**2))
    angle = sp.Symbol("theta", real=True)
    around = sp.expand_trig(sp.expand(H.subs(s, angle - sp.atan(beta))))
    harmonic = D - 1 + sp.sqrt(1 + beta**2) * sp.cos(angle)
    stated = stable.FORCING_ARC.written_out()
    checks = [
        zero("about s = -arctan(beta), H is D - 1 + sqrt(1 + beta^2) cos", sp.radsimp(sp.expand(around - harmonic))),
        zero("H + e vanishes where that cosine is (1 - D - e)/sqrt(1 + beta^2)", harmonic.subs(sp.cos(angle), half) + excess),
        zero("the stable form says the same", [stated[0] - centre, sp.radsimp(sp.cos(stated[1]) - half)]),
        holds("with a half between 0 and pi: an arc cosine", stated[1].func == sp.acos),
    ]
    exact = (centre, sp.acos(half))
    record = derived(load, exact, checks, "forcing_arc", emitted=("forcing_arc",))
    return forcing, Kernel(stable.FORCING_ARC, exact, record)


def gap(flows: Flows) -> tuple[Kernel, ...]:
    r""":math:`g(s_1) = g_0 - [u] + (u(s_0) + g_0 - p)(e^{-(s_1-s_0)/\beta} - 1)`.

    gap_after: Gap at s_1 when it was gap_0 at s_0 and the pressure is the constant p since.

    .. math:: g(s_1) = (g_0 - [u]_{s_0}^{s_1})\,e^{-(s_1 - s_0)/\beta} + (u(s_1) - p)\,(e^{-(s_1 - s_0)/\beta} - 1)

    gap_change: Change of the gap since s_0, for zones too short to change it much.

    .. math:: g(s_1) - g_0
    """
    g = flows.gap.value.subs(s, s_1)
    return (
        kernel(gap, stable.GAP_AFTER, g),
        kernel(gap, stable.GAP_CHANGE, g - gap_0),
    )


def relaxation(flows: Flows) -> tuple[Kernel, ...]:
    r""":math:`w(s_1)`, its change, and :math:`\int w\,ds` (Eq. 11), under a constant pressure.

    relaxation_increment: Change of w, and of z, over an adhesion or free zone entered with the lag w - p.

    .. math:: \Delta z = (w_0 - p)(e^{-(s_1-s_0)/\beta} - 1)

    relaxation_integral, Eq. 11: Displacement summed over the zone: a convex combination of w_0 and p, so nothing cancels.

    .. math:: \int_{s_0}^{s_1} w\,ds
    """
    w = flows.relaxation.value
    after = w.subs(s, s_1)
    change = (after - w_0).subs(w_0, p + lag_0)
    total, claim = over_zone(w, "w")
    return (
        kernel(relaxation, stable.RELAXATION_INCREMENT, change),
        kernel(
            relaxation,
            stable.RELAXATION_INTEGRAL,
            total,
            claim,
            zero(
                "int (p - w) ds = beta (w(s_1) - w_0): the balance of z",
                p * (s_1 - s_0) - total - beta * (after - w_0),
                phases=(s_0, s_1),
            ),
        ),
    )


def contact(flows: Flows) -> tuple[Kernel, ...]:
    r""":math:`q = p + p_0` in contact.

    excess_after: Pressure above -p_0 in contact, when it was q_0 at s_0.

    .. math:: q(s_1) = (q_0 + [p_{sat}]_{s_0}^{s_1})\,e^{-(s_1 - s_0)/\alpha} - (p_0 + p_{sat}(s_1))\,(e^{-(s_1 - s_0)/\alpha} -
        1)
    """
    return (kernel(contact, stable.EXCESS_AFTER, flows.contact.value.subs(s, s_1) + p_0),)


def contact_state(flows: Flows) -> tuple[Kernel, ...]:
    r""":math:`\Delta z = [u] - J[p]` over contact, equal to :math:`\frac1\beta\int(p-u)\,ds`.

    contact_increment: Change of z = w - J p over contact.

    .. math:: \Delta z = [u]_{s_0}^{s_1} - J [p]_{s_0}^{s_1} = \frac1\beta \int_{s_0}^{s_1} (p - u)\,ds

    contact_work, Eq. 11: Work of the contact pressure on the rigid profile, entered at the pressure p_in.

    .. math:: \int_{s_0}^{s_1} p\,u'\,ds
    """
    u, pressure = flows.strip.u, flows.contact.value
    rise = u.subs(s, s_1) - u.subs(s, s_0)
    change = rise - J * (pressure.subs(s, s_1) - (q_0 - p_0))
    lagging, of_lag = over_zone(pressure - u, "p - u")
    work, of_work = over_zone(pressure.subs(q_0, p_0 + p_in) * sp.diff(u, s), "p u'")
    return (
        kernel(
            contact_state,
            stable.CONTACT_INCREMENT,
            change,
            of_lag,
            zero("int (p - w) ds = beta (z(s_1) - z(s_0)): the balance of z", lagging - beta * change, phases=(s_0, s_1)),
        ),
        kernel(contact_state, stable.CONTACT_WORK, work, _short_and_wide(), of_work),
    )


def _short_and_wide() -> Claim:
    """Both forms of the integral of (1 - exp(-t/alpha)) u' over the zone are the same."""
    args, steps = stable.CONTACT_WORK.args, stable.CONTACT_WORK.steps
    short, wide = (Formula("form", args, form, steps).written_out() for form in (stable.SHORT, stable.WIDE))
    return zero("the form for short zones is that for wide ones", short - wide, phases=(s_0, s_1))
