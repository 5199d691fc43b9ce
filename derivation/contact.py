"""What contact does to a material point: pressure, change of the internal state, work on the profile."""

from __future__ import annotations

import sympy as sp

from . import stable
from .check import Claim, zero
from .flows import Flows
from .functions import Formula
from .kernel import Kernel, kernel
from .symbols import J, beta, p_0, p_in, q_0, s, s_0, s_1


def contact(flows: Flows) -> tuple[Kernel, ...]:
    r""":math:`q = p + p_0` in contact.

    excess_after: Pressure above -p_0 in contact, when it was q_0 at s_0.

    .. math:: q(s_1) = (q_0 + [p_{sat}]_{s_0}^{s_1})\,e^{-(s_1 - s_0)/\alpha} - (p_0 + p_{sat}(s_1))\,(e^{-(s_1 - s_0)/\alpha} -
        1)

    contact_pressure: Contact pressure.

    .. math:: p(s_1) = q(s_1) - p_0
    """
    pressure = flows.contact.value.subs(s, s_1)
    return (
        kernel(contact, stable.EXCESS_AFTER, pressure + p_0),
        kernel(contact, stable.CONTACT_PRESSURE, pressure),
    )


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
    integrand = sp.expand(pressure - u)
    lagging = sp.integrate(integrand, s)
    balance = lagging.subs(s, s_1) - lagging.subs(s, s_0) - beta * change
    work_rate = sp.expand(pressure.subs(q_0, p_0 + p_in) * sp.diff(u, s))
    work = sp.Add(*(sp.integrate(term, s) for term in sp.Add.make_args(work_rate)))
    total = work.subs(s, s_1) - work.subs(s, s_0)
    return (
        kernel(
            contact_state,
            stable.CONTACT_INCREMENT,
            change,
            zero("the antiderivative of p - u differentiates back", sp.diff(lagging, s) - integrand),
            zero("int (p - w) ds = beta (z(s_1) - z(s_0)): the balance of z", balance, phases=(s_0, s_1)),
        ),
        kernel(
            contact_state,
            stable.CONTACT_WORK,
            total,
            _short_and_wide(),
            zero("the antiderivative differentiates to p u'", sp.diff(work, s) - work_rate, phases=(s_0, s)),
        ),
    )


def _short_and_wide() -> Claim:
    """Both forms of the integral of (1 - exp(-t/alpha)) u' over the zone are the same."""
    args, steps = stable.CONTACT_WORK.args, stable.CONTACT_WORK.steps
    short, wide = (Formula("form", args, form, steps).written_out(args) for form in (stable.SHORT, stable.WIDE))
    return zero("the form for short zones is that for wide ones", short - wide, phases=(s_0, s_1))
