"""A level and what it carries, on a foundation with n relaxation times (Eq. 7, 9 to 14).

As in :mod:`..multilevel`; what differs is why the pressure passes a value at most once either way.
"""

import sympy as sp

from ..check import Claim, zero
from ..multilevel import (
    Multilevel,
    carried_friction,
    contact_area,
    equilibrium,
    friction_coefficient,
    local_shear,
    local_stress,
    means_over_a_level,
)
from ..saturated import FIELD, LOSS
from ..sequences import ADHESION, CONTACT, PERIOD
from ..symbols import alpha, p_0, s, s_0
from .flows import ModeFlows, u
from .regimes import ModeRegime
from .symbols import eta, f_0


def mode_levels(flows: ModeFlows, regimes: tuple[ModeRegime, ...]) -> Multilevel:
    """Eq. 7 and 9 to 14 for a foundation with n relaxation times."""
    touching = tuple(regime for regime in regimes if regime.edges and regime.touches)
    return Multilevel(
        equilibrium(touching, [_unbalanced(regime) for regime in touching]),
        contact_area(touching),
        local_stress(u, FIELD, sp.pi * LOSS),
        means_over_a_level(),
        local_shear(),
        carried_friction(passed_once(flows), ("excess_event",)),
        friction_coefficient(),
    )


def passed_once(flows: ModeFlows) -> list[Claim]:
    """What Eq. 13 asks of the foundation: in contact the pressure passes any value at most once either way."""
    flow = flows.contact.value
    harmonic = flow.replace(sp.exp, lambda exponent: sp.Integer(0))
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


def _unbalanced(regime: ModeRegime) -> sp.Expr:
    """Pressure summed over contact, against that over the period, which is 2 pi times the mean."""
    mean = sp.Symbol("p_mean", real=True)
    outside = sum(zone.pressure * (zone.last - zone.first) for zone in regime.zones if zone.kind != CONTACT)
    adhesion = sum(zone.last - zone.first for zone in regime.zones if zone.kind == ADHESION)
    return sp.expand(PERIOD * mean - outside - (PERIOD * mean + p_0 * adhesion))
