"""A level and what it carries: load, area, local stress, means, local shear, friction coefficient (Eq. 7, 9 to 14).

The recursion itself is run by the runtime, over solved strips. What it has to compute is derived here: the shear from the
power of sliding, what a strip carries in its contact, and the coefficient, which in complete contact is Eq. 16.
"""

from collections.abc import Sequence

import sympy as sp

from .check import Claim, Derived, derived, zero
from .level import STRIP_MEANS, in_si, one_level, over_strips
from .paper.record import CORRECTIONS
from .saturated import FIELD, LOSS
from .sequences import ADHESION, CONTACT, FREE, PERIOD, Row
from .strip import Strip
from .surface import AMPLITUDE, HEIGHT, RIGID, WAVE, mean_over_cell, mean_over_wave
from .symbols import D_level, K, V, a, b, h, k, l, p_0, p_nominal, s, s_0, s_1, t, x, y

tau_below, slope_x, pressure, unknown = sp.symbols("tau_M f_x p tau", real=True)


def multilevel(regimes: Sequence[Row], passed_once: Sequence[Claim], emitted: tuple[str, ...]) -> tuple[Derived, ...]:
    """Stage 7: what the levels of a surface have to do with one another, Eq. 7 and 9 to 14 on any foundation.

    ``passed_once``: why the pressure of a contact passes any value at most once either way; ``emitted``: what finds these places.
    """
    touching = [regime for regime in regimes if regime.edges and regime.touches]
    return (
        equilibrium(touching),
        contact_area(touching),
        local_stress(),
        means_over_a_level(),
        local_shear(),
        carried_friction(touching, passed_once, emitted),
        friction_coefficient(),
    )


def local_stress() -> Derived:
    r"""Eq. 10: The pressure acts on the slope of the surface: per nominal area it resists the motion with p f_x. In front of a
    crest, f_x > 0, pressure resists; behind it, pressure drives and the traction of adhesion resists.

    .. math:: \tau(x, y) = p(x, y)\,\frac{\partial f}{\partial x}
    """
    slope = sp.diff(HEIGHT, x)
    stress = pressure * slope
    work = sp.integrate(sp.expand(FIELD * sp.diff(RIGID, s)), (s, 0, PERIOD))
    checks = [
        zero("a point of the foundation in contact yields at the rate w_t = V f_x", yielding() - V * slope),
        zero(
            "it is the stress whose power V tau is the power p w_t of the pressure on the foundation",
            sp.solve(V * unknown - pressure * yielding(), unknown)[0] - stress,
        ),
        zero("in a strip f_x is k A u': its mean is that of p u'", slope - k * AMPLITUDE * sp.diff(RIGID, s).subs(s, -k * x)),
        zero("in complete contact its work over a period is pi Im K*/K, what an oscillation loses", work - sp.pi * LOSS),
    ]
    return derived(local_stress, stress, checks)


def means_over_a_level() -> Derived:
    r"""Eq. 11: A level's means of pressure and friction are those of its strips averaged over y. The strips do not act on one
    another, because the foundation is local.

    .. math:: \bar p = \frac1l \int_0^l \bar p_j\,dy,\quad \bar\tau = \frac1l \int_0^l \bar\tau_j\,dy

    Checked in complete contact, for which both can be integrated.
    """
    checks = [
        zero(
            "complete contact: the strips' mean pressure, averaged over y, is that of Eq. 15 over the cell",
            over_strips(STRIP_MEANS[0]) - mean_over_cell(in_si(FIELD)),
        ),
        zero(
            "equal strips represented by their middles: 2 N = 4 and 6 already give both means of complete contact exactly",
            [_equal_strips(mean, number) - over_strips(mean) for mean in STRIP_MEANS for number in (2, 3)],
        ),
    ]
    return derived(
        means_over_a_level, tuple(sp.Integral(sp.Function(f"{mean}_j")(y), (y, 0, l)) / l for mean in ("p", "tau")), checks
    )


def local_shear() -> Derived:
    r"""Eq. 12: Where level M-1 is in contact, two things oppose the motion: its pressure on its own slope, and the friction of
    level M, for which the local pressure is the nominal one, because its wavelength is much smaller. In an adhesion zone, at p
    = -p_0, only the first is left: the levels below carry nothing there.

    .. math:: \tau_{M-1}(x, y) = p\,f_x + \tau_M[p]
    """
    shear = pressure * slope_x + tau_below
    resisted = pressure * yielding() + V * tau_below  # power per area: of the pressure, and lost on the levels below
    checks = [
        zero(
            "it is the shear whose power V tau is that of the pressure on the foundation and that lost on the levels below",
            sp.solve(V * unknown - resisted, unknown)[0] - shear.subs(slope_x, sp.diff(HEIGHT, x)),
        ),
    ]
    return derived(local_shear, shear, checks, correction=CORRECTIONS[12])


def passed_once(strip: Strip) -> Claim:
    """What Eq. 13 asks of a foundation with one relaxation time."""
    level = sp.Symbol("p_star", real=True)
    pressure = sp.Function("p")(s)
    above = sum(c * sp.diff(pressure - level, s, n) for n, c in enumerate(strip.operator_p))
    harmonic = strip.law(strip.u, sp.Integer(0)) - level
    return zero(
        "in contact p - p* is driven by one harmonic, H - p*, for every p*: p passes p* at most once up and once down",
        sp.expand((harmonic - above).doit() - strip.law(strip.u, pressure).doit()),
    )


def carried_friction(touching: Sequence[Row], passed_once: Sequence[Claim], emitted: tuple[str, ...]) -> Derived:
    r"""Eq. 13: What level M carries is averaged over the contact of level M-1 alone; in a strip, from x = -a to b,
    that is C_j, the integral of its law over the contact zone. The law jumps at pull-off and bends at saturation, so
    the zone is cut where p passes these pressures and no quadrature goes across.

    .. math:: \bar\tau_{M-1} = \frac{1}{l^2} \iint p\,f_x\,dx\,dy + \frac{1}{l^2} \iint_{\text{contact}}
        \tau_M[p]\,dx\,dy,\quad C_j = \frac{1}{l} \int_{-a}^{b} \tau_M[p]\,dx = \frac{1}{2\pi} \int_{-kb}^{ka}
        \tau_M[p(s)]\,ds
    """
    value = sp.Integral(sp.Function("tau_M")(sp.Function("p")(s)), (s, s_0, s_1)) / PERIOD
    beyond = zero(
        "over the whole cell the printed form has more: tau_M[0] times the free part, tau_M[-p_0] times the part in adhesion",
        [_beyond_contact(regime) for regime in touching],
    )
    return derived(carried_friction, value, [*passed_once, beyond], correction=CORRECTIONS[12], emitted=emitted)


def friction_coefficient() -> Derived:
    r"""Eq. 14: The shear of the largest level, which holds what all levels contribute, over its nominal pressure. The
    load is that of the largest level: the smaller ones enter through the shear alone.

    .. math:: \mu = \frac{\tau_1}{p_1}
    """
    upper, lower = ({symbol: sp.Symbol(f"{symbol}_{i}", positive=True) for symbol in (h, l, LOSS)} for i in (1, 2))
    pressed, (_, friction_of_one) = in_si(FIELD), one_level()
    shear = pressed * sp.diff(HEIGHT, x) + friction_of_one.subs(lower)  # Eq. 12 in complete contact: the law below is constant
    both = sum(friction_of_one.subs(level) for level in (upper, lower)) / p_nominal
    load, friction = (mean_over_cell(part).subs(WAVE).subs(upper) for part in (pressed, shear))
    checks = [
        zero(
            "Eq. 12 with Eq. 15 on level 1 and the law of level 2, averaged over the cell and divided by its load: "
            "Eq. 16, corrected",
            sp.simplify(friction / load - both.subs(p_nominal, load)),
        )
    ]
    return derived(
        friction_coefficient,
        sp.Symbol("tau_1", real=True) / p_nominal,
        checks,
        correction=CORRECTIONS[12],
        emitted=("level_saturation_friction",),
    )


def yielding() -> sp.Expr:
    """Rate w_t at which a point of the foundation in contact yields, from w = D - f(X - V t, y), at x = X - V t."""
    fixed = sp.Symbol("X", real=True)
    return sp.diff((D_level - HEIGHT).subs(x, fixed - V * t), t).subs(fixed, x + V * t)


def _equal_strips(mean: sp.Expr, number: int) -> sp.Expr:
    """Eq. 11 with 2 N equal strips of the cell."""
    middles = [2 * sp.pi / k * (sp.Rational(2 * j + 1, 2) / (2 * number)) for j in range(2 * number)]
    return sum((mean.subs(y, middle) for middle in middles), sp.Integer(0)) / (2 * number)


def _beyond_contact(regime: Row) -> sp.Expr:
    """The law over the whole period, less over contact, less what is said of the rest: the parts of a period make it up."""
    law, over = sp.Function("tau_M"), {CONTACT: sp.Integer(0), ADHESION: sp.Integer(0), FREE: sp.Integer(0)}
    for zone in regime.zones:
        over[zone.kind] += zone.last - zone.first
    rest = sum(law(zone.load) * (zone.last - zone.first) for zone in regime.zones if zone.kind != CONTACT)
    free = PERIOD - over[CONTACT] - over[ADHESION]
    return sp.expand(rest - law(sp.Integer(0)) * free - law(-p_0) * over[ADHESION])


def equilibrium(touching: Sequence[Row]) -> Derived:
    r"""Eq. 7: The nominal pressure balances what the surface carries: the pressure in contact and the traction of
    adhesion, summed over both, per area of the cell. Outside both the pressure is zero.

    .. math:: \bar p = \frac{1}{l^2} \iint_{\Omega} p(x, y)\,dx\,dy
    """
    relaxed = D_level - HEIGHT  # w at rest
    stored = mean_over_cell(K * relaxed**2 / 2)
    carried = mean_over_cell(K * relaxed)
    claims = [
        zero(
            "virtual work: pressing the relaxed foundation deeper by dD stores the integral of p times dD",
            sp.diff(stored, D_level) - carried,
        ),
        zero(
            "outside contact there is the load -p_0 over the width in adhesion: contact carries 2 pi mean p and p_0 times that",
            [_outside_contact(regime) for regime in touching],
        ),
    ]
    value = sp.Integral(sp.Function("p")(x, y), x, y) / l**2
    return derived(equilibrium, value, claims, emitted=tuple(f"means_{regime.sequence}" for regime in touching))


def _outside_contact(regime: Row) -> sp.Expr:
    """Pressure summed over the zones out of contact, and p_0 over the width in adhesion."""
    loads = [zone.load * (zone.last - zone.first) for zone in regime.zones if zone.kind != CONTACT]
    return sp.expand(sum(loads) + p_0 * sum(zone.last - zone.first for zone in regime.zones if zone.kind == ADHESION))


def contact_area(regimes: Sequence[Row]) -> Derived:
    r"""Eq. 9: The contact area of a level is the sum over its strips of the contact length a + b times the width of a strip; over
    l^2 it is the fraction of the nominal area in contact.

    .. math:: A = 2 \Delta \sum_{j=1}^{N} (a_j + b_j),\quad l = 2 N \Delta
    """
    length, behind, ahead = sp.Function("length"), *sp.symbols("x_a x_b", positive=True)  # contact from x = -x_a to x_b
    one, other = sp.symbols("c_0 c_1", real=True)
    linear = lambda place: one + other * sp.cos(k * place)  # noqa: E731
    spans = [zone.last - zone.first for regime in regimes for zone in regime.zones if zone.kind == CONTACT and zone.first == b]
    widths = [span.subs({a: k * behind, b: -k * ahead}) / k - behind - ahead for span in spans]
    checks = [
        zero("the contact zone from phase b to phase a is a + b long in x", widths),
        zero("the surface is the same at y and -y: half a cell counts twice", HEIGHT.subs(y, -y) - HEIGHT),
        zero("complete contact, a + b = l in every strip: the whole cell", [_area(lambda _: l, n) - l**2 for n in (1, 2, 5)]),
        zero(
            "strips represented by their middles: a length linear in cos ky is summed to its integral over the cell",
            [_area(linear, n) - l * mean_over_wave(linear(y), y).subs(k, 2 * sp.pi / l) for n in (2, 3)],
        ),
    ]
    return derived(contact_area, sp.Integral(length(y), (y, 0, l)), checks)


def _area(length, number: int) -> sp.Expr:
    """Eq. 9 with N strips in half a cell, each at its middle."""
    width = l / (2 * number)
    middles = [(sp.Rational(2 * j + 1, 2) * width) for j in range(number)]
    return sum((2 * width * length(place) for place in middles), sp.Integer(0)).subs(k, 2 * sp.pi / l)
