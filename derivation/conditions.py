"""The problem of a strip: the conditions in its zones and at its edges, once more in the paper's variables x and SI.

The regimes are derived in the phase ``s = -k x`` and without dimensions. Here the strip's problem is stated as the paper
states it, Eq. 5 is solved in x with the conditions at d, b, -a and -c, and the same boundary equations have to come out.
"""

import sympy as sp

from .check import Derived, derived, holds, zero
from .flows import solved
from .paper.record import CORRECTIONS
from .sequences import Row
from .strip import TIMES, Strip
from .surface import AMPLITUDE, HEIGHT, PENETRATION
from .symbols import A, D, D_j, D_level, K, a, b, c, chi, d, delta_0, k, p_0, s, x


def zone_conditions(u: sp.Expr) -> Derived:
    r"""Eq. 6: Every point of a strip is in contact, where w is given and the pressure must not fall below -p_0, or
    out of it, where the pressure is given by the gap and the gap must stay in its range.

    .. math:: g = w - (D - f),\quad \{g = 0,\ p \ge -p_0\},\quad \{0 < g \le \delta_0,\ p = -p_0\},\quad \{g > \delta_0,\ p =
        0\}
    """
    displacement = sp.Function("w")(s)  # in units of A
    gap = AMPLITUDE * displacement - (D_level - HEIGHT)
    deep, high = (sp.expand(w).coeff(sp.cos(k * x)) for w in (D_level + HEIGHT, D_level - HEIGHT))
    in_strip = AMPLITUDE * (displacement - u.subs({D: PENETRATION / AMPLITUDE, s: -k * x}))
    checks = [
        zero("in the strip at y the gap is A (w - u)", sp.simplify(gap - in_strip)),
        zero("it is zero where Eq. 6 holds, w = D - f", gap.subs(displacement, (D_level - HEIGHT) / AMPLITUDE)),
        holds(
            "the printed w = f + D is deepest in the valleys of the surface: its cos kx term has the other sign",
            deep == -high != 0,
        ),
    ]
    return derived(zone_conditions, gap, checks, correction=CORRECTIONS[6])


def strip_problem(strip: Strip, discrete: Row) -> Derived:
    r"""The steady law in each zone and the conditions at its edges determine a, b, c and d. The pressure is
    continuous at b and -a and steps by p_0 at d and -c, where w is continuous or steps too.

    .. math:: g(d) = \delta_0,\quad g(b) = 0,\quad p(b) = -p_0,\quad p(-a) = -p_0,\quad g(-c) = \delta_0,\quad [w]_d = -\chi J_0
        p_0,\quad [w]_{-c} = \chi J_0 p_0,\quad w(x + l) = w(x)
    """
    profile = D_j - A * (1 - sp.cos(k * x))
    onset, begins, ends, leaves = sp.symbols("x_d x_b x_a x_c", real=True)  # where d, b, -a, -c stand
    step = chi * strip.foundation.J_0 * p_0  # of w where the traction begins; it steps back where the traction ends

    def gap_at(place: sp.Expr, since: sp.Symbol, gap: sp.Expr, load: sp.Expr) -> sp.Expr:
        """Gap at ``place`` after a zone at the pressure ``load`` that was entered at ``since`` with ``gap``."""
        w = solved("strip problem", lambda unknown: strip.misses(unknown, load), profile.subs(x, since) + gap, x, since)
        return (w - profile).subs(x, place)

    pressure = solved("strip problem", lambda unknown: strip.misses(profile, unknown), -p_0, x, begins)
    left = (
        gap_at(begins, onset, delta_0 - step, -p_0),
        pressure.subs(x, ends) + p_0,
        gap_at(leaves, ends, sp.Integer(0), -p_0) - delta_0,
        gap_at(onset - 2 * sp.pi / k, leaves, delta_0 + step, sp.Integer(0)) - delta_0,
    )
    places = {onset: -d / k, begins: -b / k, ends: -a / k, leaves: -c / k}
    groups, unit = {p_0: K * A * p_0, delta_0: A * delta_0, D_j: A * D}, (A, K * A, A, A)  # of a gap, of a pressure
    residuals = [
        sp.expand(condition.subs(groups, simultaneous=True).subs(TIMES).subs(places)) / size - zone.misses()
        for condition, size, zone in zip(left, unit, discrete.zones, strict=True)
    ]
    checks = [
        zero(
            "Eq. 5 solved in x and SI with these conditions gives the boundary equations of the regime acaf",
            residuals,
            phases=discrete.edges,
        ),
        zero(
            "d > b > -a > -c in x is d < b < a < c in s",
            [k * place + edge for place, edge in zip(places.values(), (d, b, a, c), strict=True)],
        ),
    ]
    return derived(strip_problem, left, checks, emitted=("residual_acaf",))
