"""The flows of a generic mode, solved by SymPy. By superposition they are those of any number of modes.

Under a constant pressure every retardation displacement obeys a first-order law of its own, in contact every overstress does:
that these are the law of the foundation is the step "states".
"""

from dataclasses import dataclass

import sympy as sp

from ..check import Claim, Derived, derived, zero
from ..flows import solved, steady_state
from ..surface import RIGID
from ..symbols import alpha, beta, p, s, s_0
from .symbols import J, eta, f_0, z_0

u = RIGID


@dataclass(frozen=True)
class ModeFlows:
    """Stage 3 for a generic mode, as functions of s."""

    relaxation: Derived  # z(s) under the constant pressure p, entered with z_0
    contact: Derived  # f(s) in contact, entered with f_0


def mode_flows() -> ModeFlows:
    return ModeFlows(relaxation_flow(), contact_flow())


def relaxation_flow() -> Derived:
    r"""Eq. 5: Out of contact p is constant, and every retardation displacement creeps towards its share J_j p by itself.

    .. math:: z_j(s) = J_j p + (z_{j,0} - J_j p)\,e^{-(s - s_0)/\beta_j},\quad w = J_0 p + \sum_j z_j
    """
    flow = solved("relaxation flow", lambda unknown: unknown + beta * sp.diff(unknown, s) - J * p, entry=z_0)
    checks = [
        zero("the law of the mode holds under the constant pressure p", flow + beta * sp.diff(flow, s) - J * p),
        zero("the zone is entered with z_0", flow.subs(s, s_0) - z_0),
    ]
    return derived(relaxation_flow, flow, checks)


def contact_flow() -> Derived:
    r"""Eq. 5, 15: In contact w = u is given, and the overstress of every branch follows it by itself: a harmonic, and a transient
    that dies out over alpha_i.

    .. math:: f_i(s) = f_{sat,i}(s) + (f_{i,0} - f_{sat,i}(s_0))\,e^{-(s - s_0)/\alpha_i},\quad f_{sat,i} = \eta_i\frac{\alpha_i
        \cos s - \sin s}{1 + \alpha_i^2},\quad p = u + \sum_i f_i
    """
    flow = solved("contact flow", lambda unknown: unknown + alpha * sp.diff(unknown, s) - eta * sp.diff(u, s), entry=f_0)
    checks = [
        zero("the law of the branch holds with w = u", flow + alpha * sp.diff(flow, s) - eta * sp.diff(u, s)),
        zero("the zone is entered with f_0", flow.subs(s, s_0) - f_0),
    ]
    return derived(contact_flow, flow, checks, emitted=("overstress_after", "contact_pressure"))


def passed_once(flows: ModeFlows) -> list[Claim]:
    """What Eq. 13 asks of the foundation: in contact the pressure passes any value at most once either way."""
    flow = flows.contact.value
    harmonic = steady_state(flow)
    creep = u - alpha / eta * harmonic  # of a dashpot in complete contact: e = w - S f, S = alpha/eta
    return [
        zero(
            "in complete contact a dashpot follows the profile, alpha e' + e = u; elsewhere w, which is nowhere below u: "
            "its e is nowhere below that of complete contact, and f nowhere above",
            alpha * sp.diff(creep, s) + creep - u,
        ),
        zero(
            "in contact f falls short of complete contact by a decaying exponential; p is one harmonic less such terms, all "
            "positive, so p passes any p* at most once up and once down",
            flow - harmonic - (f_0 - harmonic.subs(s, s_0)) * sp.exp(-(s - s_0) / alpha),
        ),
    ]
