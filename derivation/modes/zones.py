"""What each zone does to a material point with n modes: stable forms proven equal to the flows that SymPy solved."""

import sympy as sp

from ..kernel import Kernel, kernel, pair
from ..symbols import p, p_0, p_in, s, s_0, s_1
from ..zones import over_zone
from . import stable
from .flows import ModeFlows, u
from .symbols import J_0, J, S, across, back, enter, eta, f, f_0, sandwich, share, total, z, z_0

u_0, u_1 = u.subs(s, s_0), u.subs(s, s_1)


def states() -> tuple[Kernel, ...]:
    r""":math:`w = J_0 p + \sum z_j`, and the other coordinates of the same state.

    displacement: Displacement of a material point.

    .. math:: w = J_0 p + \sum_j z_j

    overstress: Overstress of every branch, where w and p belong together.

    .. math:: f = -N (z - J p),\quad N_{ij} = \frac{\eta_i}{\beta_j - \alpha_i}

    dashpots: Dashpot displacements.

    .. math:: e = w - S f
    """
    lag = z - J * p
    return (
        kernel(states, stable.DISPLACEMENT, J_0 * p + total(z)),
        kernel(states, stable.OVERSTRESS, -across(enter, lag)),
        kernel(states, stable.DASHPOTS, J_0 * p + total(z) + S * across(enter, lag)),
    )


def relaxation(flows: ModeFlows) -> tuple[Kernel, ...]:
    r"""z under a constant pressure: its change, and, for Eq. 11, :math:`\int w\,ds`.

    relaxation_increment: Change of z under a constant pressure.

    .. math:: z_j(s_1) - z_j(s_0)

    relaxation_integral, Eq. 11: Displacement summed over the zone.

    .. math:: \int_{s_0}^{s_1} w\,ds
    """
    flow = flows.relaxation.value
    integral, claim = over_zone(flow, "z")
    return (
        kernel(relaxation, stable.RELAXATION_INCREMENT, flow.subs(s, s_1) - z_0),
        kernel(relaxation, stable.RELAXATION_INTEGRAL, J_0 * p * (s_1 - s_0) + total(integral), claim),
    )


def gap(flows: ModeFlows) -> tuple[Kernel, ...]:
    r""":math:`g = w - u` under a constant pressure.

    gap_after: Gap at s_1 under the constant pressure p since s_0.

    .. math:: g = p - u(s_1) + \sum_j (z_{j,0} - J_j p) e^{-(s_1 - s_0)/\beta_j}

    gap_change: Its change since s_0, for zones too short to change it much.

    .. math:: g(s_1) - g(s_0)

    gap_entry: Constants of gap_event in a zone entered at s_0 with z_0 under the constant pressure p. Those with one
    value per mode come last: amplitudes, times that can be divided by, rates.

    .. math:: s_0,\quad D - p,\quad z_0 - J p,\quad \beta,\quad (z_0 - J p)/\beta

    gap_event: Gap and its slope at s_1, from the constants of gap_entry. s_1 must not be before s_0.

    .. math:: g = p - u(s_1) + \sum_j (z_{j,0} - J_j p) e^{-(s_1 - s_0)/\beta_j}
    """
    after = flows.relaxation.value.subs(s, s_1)
    g = J_0 * p + total(after) - u_1
    change = total(after - z_0) - (u_1 - u_0)
    # J_0 = 1 - sum J: what is left of w long after the entry is p.
    level = p + total(after - J * p) - u_1
    slope = total(sp.diff(after, s_1)) - sp.diff(u_1, s_1)
    return (
        kernel(gap, stable.GAP_AFTER, g),
        kernel(gap, stable.GAP_CHANGE, change),
        *pair(gap, (stable.GAP_ENTRY, stable.GAP_EVENT), (level, slope)),
    )


def contact(flows: ModeFlows) -> tuple[Kernel, ...]:
    r"""Overstress and pressure in contact, the change of z, and, for Eq. 11, the work :math:`\int p\,u'\,ds`.

    overstress_after: Overstress of every branch in contact, when it was f_0 at s_0.

    .. math:: f_i(s_1) = f_{sat,i}(s_1) + (f_{i,0} - f_{sat,i}(s_0)) e^{-(s_1 - s_0)/\alpha_i}

    contact_pressure: Contact pressure.

    .. math:: p = u + \sum_i f_i

    excess_change: Change of the contact pressure since s_0.

    .. math:: p(s_1) - p(s_0)

    contact_increment: Change of the retardation displacements over contact: what the dashpots creep, shared out.

    .. math:: \Delta z = G\,\Delta e,\quad \eta_i \Delta e_i = \int_{s_0}^{s_1} f_i\,ds

    contact_work, Eq. 11: Work of the contact pressure on the rigid profile.

    .. math:: \int_{s_0}^{s_1} p\,u'\,ds

    excess_entry: Constants of excess_event in a contact entered at s_0 with the overstresses f_0.

    .. math:: s_0,\quad D + p_0,\quad \sum_i \frac{\eta \alpha}{1 + \alpha^2},\quad \sum_i \frac{\eta}{1 + \alpha^2},\quad
        f_0,\quad f_{sat}(s_0),\quad \alpha,\quad \frac{f_0 - f_{sat}(s_0)}{\alpha}

    excess_event: Pressure above -p_0 in contact and its slope at s_1, from the constants of excess_entry. s_1 must not be before
    s_0.

    .. math:: q = p_0 + u(s_1) + \sum_i f_i(s_1)
    """
    flow = flows.contact.value
    after = flow.subs(s, s_1)
    creep, of_creep = over_zone(flow, "f")
    work, of_work = over_zone(flow * sp.diff(u, s), "f u'")
    own, of_own = over_zone(u * sp.diff(u, s), "u u'")
    excess = p_0 + u_1 + total(after)
    slope = sp.diff(u_1, s_1) + total(sp.diff(after, s_1))
    return (
        kernel(contact, stable.OVERSTRESS_AFTER, after),
        kernel(contact, stable.CONTACT_PRESSURE, u + total(f)),
        kernel(contact, stable.EXCESS_CHANGE, u_1 - u_0 + total(after - f_0)),
        kernel(contact, stable.CONTACT_INCREMENT, across(share, creep / eta), of_creep),
        kernel(contact, stable.CONTACT_WORK, own + total(work), of_work, of_own),
        *pair(contact, (stable.EXCESS_ENTRY, stable.EXCESS_EVENT), (excess, slope)),
    )


def passages(flows: ModeFlows) -> tuple[Kernel, ...]:
    r"""A zone as an affine map of the state, and with all its derivatives: what the edge equations of a regime are made of.

    relaxation_map: A gap zone as an affine map of the state: z(s_1) - z_0 = drive - forget z_0, each displacement by itself.

    .. math:: \Delta z = c - R z_0

    contact_map: A contact zone, entered at the pressure p_in, as an affine map of the state.

    .. math:: \Delta z = c - R z_0

    relaxation_passage: Passage through a gap zone and its derivatives. In this order: change of z; its derivatives by
    s_0 and by s_1; change of the gap; its derivatives by z_0, s_0, s_1.

    .. math:: \Delta z,\quad \partial_{s_0}\Delta z,\quad \partial_{s_1}\Delta z,\quad \Delta g,\quad
        \partial_{z_0} \Delta g,\quad \partial_{s_0} \Delta g,\quad \partial_{s_1} \Delta g

    contact_passage: Passage through a contact zone, entered at the pressure p_in, and its derivatives. In this order:
    change of z; its derivatives by s_0 and by s_1; change of the pressure; its derivatives by z_0, s_0, s_1.

    .. math:: \Delta z,\quad \partial_{s_0}\Delta z,\quad \partial_{s_1}\Delta z,\quad \Delta p,\quad
        \partial_{z_0} \Delta p,\quad \partial_{s_0} \Delta p,\quad \partial_{s_1} \Delta p
    """
    after, pressed = (flow.value.subs(s, s_1) for flow in (flows.relaxation, flows.contact))
    change, pressing = sp.expand(after - z_0), pressed - f_0
    creep = over_zone(flows.contact.value, "f")[0] / eta  # of a dashpot's displacement over contact
    entered = {f_0: across(enter, sp.expand(-(z_0 - J * p_in)))}
    by_f = sp.diff(creep, f_0)
    relaxation_terms = (
        change,
        *(sp.diff(change, edge) for edge in (s_0, s_1)),
        total(change) - (u_1 - u_0),
        sp.diff(change, z_0),
        *(total(sp.diff(change, edge)) - sp.diff(u_1 - u_0, edge) for edge in (s_0, s_1)),
    )
    contact_terms = (
        *(across(share, part.subs(entered)) for part in (creep, sp.diff(creep, s_0), sp.diff(creep, s_1))),
        u_1 - u_0 + total(pressing.subs(entered)),
        -back(enter, sp.diff(pressing, f_0)),
        *(sp.diff(u_1 - u_0, edge) + total(sp.diff(pressed, edge).subs(entered)) for edge in (s_0, s_1)),
    )
    return (
        kernel(passages, stable.RELAXATION_MAP, (-sp.diff(change, z_0), change.subs(z_0, 0))),
        kernel(
            passages, stable.CONTACT_MAP, (sandwich(share, by_f, enter), across(share, creep.subs(f_0, across(enter, J) * p_in)))
        ),
        kernel(passages, stable.RELAXATION_PASSAGE, relaxation_terms),
        kernel(passages, stable.CONTACT_PASSAGE, contact_terms),
    )
