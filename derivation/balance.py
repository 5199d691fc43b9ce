"""The balance of a period, mean p = mean w, and what is known of its parts: it excludes orbits, and says where others start."""

from collections.abc import Sequence

import sympy as sp

from .check import Derived, derived, zero
from .flows import Flows
from .regime import Zone
from .sequences import ADHESION, CONTACT, PERIOD, Row
from .symbols import D, J, L, a, alpha, beta, c, d, delta_0, gap_0, p, p_0, q_0, s, s_0, s_1, w_0
from .zones import over_zone

lasts, rises, jump = sp.symbols("lasts rises jump", positive=True)
NAMES = {"F": lasts, "r": rises, r"\Deltaw": jump}
"""In the displays."""


def pull_and_pressure(regimes: Sequence[Row], flows: Flows) -> Derived:
    r"""Nothing is left of beta z' = p - w over a period: the pressure over -p_0, summed over contact, is p_0 times the length of
    engagement and the sum of w. That pressure, where contact begins with none:

    .. math:: \int_{s_0}^{s_1} q\,ds = (D - 1 + p_0)(s_1 - s_0) + \sin s_1 - \sin s_0 + \beta (\cos s_1 - \cos s_0) - \alpha
        q(s_1)
    """
    begun = (flows.contact.value + p_0).subs(q_0, 0)
    total, claim = over_zone(begun, "q")
    profile, _ = over_zone(flows.strip.u + p_0, "u")
    balance = profile + beta * (flows.strip.u.subs(s, s_1) - flows.strip.u.subs(s, s_0)) - alpha * begun.subs(s, s_1)
    claims = [
        claim,
        zero("alpha q' + q = u + beta u' + p_0, summed", total - balance, phases=(s_0, s_1)),
        zero("of p is left, beside q, -p_0 over the length of engagement", [_outside(regime.zones) for regime in regimes]),
    ]
    return derived(pull_and_pressure, total, claims)


def _outside(zones: Sequence[Zone]) -> sp.Expr:
    """The pressure less q, summed over a period, and p_0 over contact and adhesion."""
    pressed = [(-p_0 if zone.kind == CONTACT else zone.load) * (zone.last - zone.first) for zone in zones]
    engaged = [p_0 * (zone.last - zone.first) for zone in zones if zone.kind in (CONTACT, ADHESION)]
    return sp.expand(sum(pressed) + sum(engaged))


def before_contact(flows: Flows) -> Derived:
    r"""Adhesion begins at s_0, where w = D - r, and ends where the gap has closed. There 1 - cos s_1 is

    .. math:: r - (D + p_0 - r) \left(e^{-(s_1 - s_0)/\beta} - 1\right)
    """
    value = rises - (D + p_0 - rises) * (sp.exp(-(s_1 - s_0) / beta) - 1)
    gap = flows.gap.value.subs({p: -p_0, s: s_1}).subs(gap_0, D - rises - flows.strip.u.subs(s, s_0))
    claim = zero("the gap at s_1 is what 1 - cos s_1 is more", gap - (1 - sp.cos(s_1) - value), phases=(s_0, s_1))
    return derived(before_contact, value, [claim])


def before_onset(flows: Flows) -> Derived:
    r"""A free zone that lasts F leads to an onset at d, where w = u + delta_0, from a release after which w is more by its step.
    The cosine of the phase of the release, and the sum of w over the zone:

    .. math:: \cos d - \Delta w + (u(d) + \delta_0) \left(e^{F/\beta} - 1\right),\quad (u(d) + \delta_0) \beta \left(e^{F/\beta} -
        1\right)
    """
    height = flows.strip.u.subs(s, d) + delta_0
    cosine = sp.cos(d) - jump + height * (sp.exp(lasts / beta) - 1)
    summed = height * beta * (sp.exp(lasts / beta) - 1)
    fades = flows.relaxation.value.subs({p: 0, w_0: D - 1 + cosine + delta_0 + jump})
    total, claim = over_zone(fades, "w")
    claims = [
        zero("w fades to u + delta_0", fades.subs(s, s_0 + lasts) - height),
        claim,
        zero("and its sum", total.subs(s_1, s_0 + lasts) - summed),
    ]
    return derived(before_onset, (cosine, summed), claims)


def standing_still(flows: Flows) -> Derived:
    r"""On a fast foundation z stands still. Contact and adhesion are as long before the crest as after it then, w is u(a) while
    the gap adheres and more by its step in the free zone, and of the mean of w less that of p is left, times pi, and by a:

    .. math:: \pi (u(a) + \Delta w) + (p_0 - \Delta w) c - \frac{L}{J} (\sin a - a \cos a),\quad -\sin a \left(\pi + \frac{L}{J}
        a - \frac{p_0 - \Delta w}{\sin c}\right)
    """
    u = flows.strip.u
    held = u.subs(s, a)
    value = PERIOD / 2 * (held + jump) + (p_0 - jump) * c - (1 - J) / J * (sp.sin(a) - a * sp.cos(a))
    pressed = -p_0 + (u - held) / J
    summed_w = sp.integrate(u, (s, -a, a)) + held * 2 * (c - a) + (held + jump) * (PERIOD - 2 * c)
    summed_p = sp.integrate(sp.expand(pressed), (s, -a, a)) - p_0 * 2 * (c - a)
    release = sp.Function("c")(a)  # where the profile has sunk by delta_0
    moves = sp.diff(release, a)
    rate = sp.solve(sp.diff(held - u.subs(s, release) - delta_0, a), moves)[0]
    slope = sp.diff(value.subs(c, release), a).subs(moves, rate).subs(release, c)
    stated = -sp.sin(a) * (PERIOD / 2 + L / J * a - (p_0 - jump) / sp.sin(c))
    claims = [
        zero("in contact, from p = -p_0 at a, z stands still", (u - J * pressed) - (held + J * p_0)),
        zero("half of the sum of w less that of p", (summed_w - summed_p) / 2 - value),
        zero("by a, with the c that it leads to", slope - stated.subs(L, 1 - J)),
    ]
    return derived(standing_still, (value, stated), claims)
