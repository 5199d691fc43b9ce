"""A level that carries another: local shear, means, friction coefficient (Eq. 11 to 14).

The recursion itself is run by the runtime, over solved strips. What it has to compute is derived here: the shear from the
power of sliding, what a strip carries in its contact, and the coefficient, which in complete contact is Eq. 16.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from .averages import ZoneIntegrals
from .check import REPRODUCED, Check, Derived, derived, zero
from .functions import stack_sum, written_out
from .kernel import Kernel
from .level import Level, over_strips
from .regime import ADHESION, CONTACT, PERIOD, Regime
from .saturated import Saturated
from .strip import Strip
from .surface import AMPLITUDE, HEIGHT, PENETRATION, mean_over_wave
from .symbols import D, D_level, K, V, beta, h, k, l, p_0, p_nominal, q_0, s, s_0, s_1, t, x, y

tau_below, slope_x = sp.symbols("tau_M f_x", real=True)


@dataclass(frozen=True)
class Multilevel:
    """Stage 7: what the levels of a surface have to do with one another."""

    means: Derived  # Eq. 11
    shear: Derived  # Eq. 12
    carried: Derived  # Eq. 13
    coefficient: Derived  # Eq. 14


def multilevel(
    strip: Strip,
    saturated: Saturated,
    whole: Level,
    regimes: Sequence[Regime],
    means: Sequence[Kernel],
    integrals: ZoneIntegrals,
) -> Multilevel:
    exact = {kernel.formula.name: kernel.exact for kernel in (*saturated.kernels, *whole.kernels, *means)}
    return Multilevel(
        means_over_a_level(exact["saturated_pressure"], saturated.means.exact),
        local_shear(strip.u),
        carried_friction(strip, regimes, exact, integrals),
        friction_coefficient(exact["level_saturation_friction"], exact["saturated_stack_friction"]),
    )


def means_over_a_level(pressure: sp.Expr, means: tuple[sp.Expr, sp.Expr]) -> Derived:
    r"""Eq. 11: :math:`\bar p = \frac1l \int_0^l \bar p_j\,dy`, :math:`\bar\tau = \frac1l \int_0^l \bar\tau_j\,dy`.

    ``pressure`` and ``means`` of a strip in complete contact, for which both can be integrated.
    """
    name = "means over a level"
    in_strip = {D: PENETRATION / AMPLITUDE, s: -k * x}
    strip_p = sp.expand(sp.simplify(K * AMPLITUDE * means[0].subs(in_strip)))
    strip_tau = K * AMPLITUDE * k * AMPLITUDE * means[1]
    cell = mean_over_wave(mean_over_wave(sp.simplify(K * AMPLITUDE * pressure.subs(in_strip)), y), x)
    checks = [
        zero(
            name,
            "complete contact: the strips' mean pressure, averaged over y, is that of Eq. 15 over the cell",
            over_strips(strip_p) - cell,
        ),
        zero(
            name,
            "equal strips represented by their middles: 2 N = 4 and 6 already give both means of complete contact exactly",
            [_equal_strips(mean, number) - over_strips(mean) for mean in (strip_p, strip_tau) for number in (2, 3)],
        ),
    ]
    return derived(
        means_over_a_level,
        tuple(sp.Integral(sp.Function(f"{mean}_j")(y), (y, 0, l)) / l for mean in ("p", "tau")),
        name=name,
        statement="A level's means of pressure and friction are those of its strips averaged over y. The strips do not act on "
        "one another, because the foundation is local.",
        latex=r"\bar p = \frac1l \int_0^l \bar p_j\,dy,\quad \bar\tau = \frac1l \int_0^l \bar\tau_j\,dy",
        checks=checks,
        paper="Eq. 11",
        status=REPRODUCED,
    )


def local_shear(u: sp.Expr) -> Derived:
    r"""Eq. 12: :math:`\tau_{M-1}(x, y) = p\,f_x + \tau_M[p]` in contact."""
    name = "local shear"
    pressure, fixed = sp.symbols("p X", real=True)
    shear = pressure * slope_x + tau_below
    slope = sp.diff(HEIGHT, x)
    yields = sp.diff((D_level - HEIGHT).subs(x, fixed - V * t), t).subs(fixed, x + V * t)  # w_t of a point in contact
    checks = [
        zero(name, "a point of the foundation in contact yields at the rate w_t = V f_x", yields - V * slope),
        zero(
            name,
            "power: V tau is p w_t, what the pressure does on the foundation, and V tau_M, what the levels below dissipate",
            V * shear.subs(slope_x, slope) - pressure * yields - V * tau_below,
        ),
        zero(
            name,
            "in a strip f_x is k A u': the first term is the p u' of Eq. 10",
            slope - k * AMPLITUDE * sp.diff(u, s).subs(s, -k * x),
        ),
    ]
    return derived(
        local_shear,
        shear,
        name=name,
        statement="Where level M-1 is in contact, two things oppose the motion: its pressure on its own slope, and the friction "
        "of level M, for which the local pressure is the nominal one, because its wavelength is much smaller. In an adhesion "
        "zone, at p = -p_0, only the first is left: the levels below carry nothing there.",
        latex=r"\tau_{M-1}(x, y) = p\,f_x + \tau_M[p]",
        checks=checks,
        paper="Eq. 12",
        status=REPRODUCED,
    )


def carried_friction(strip: Strip, regimes: Sequence[Regime], means: Mapping[str, sp.Expr], integrals: ZoneIntegrals) -> Derived:
    r"""Eq. 13:

    .. math:: \bar\tau_{M-1} = \frac{1}{l^2}\iint p\,f_x\,dx\,dy + \frac{1}{l^2}\iint_{contact} \tau_M[p]\,dx\,dy
    """
    name = "carried friction"
    touching = [regime for regime in regimes if any(zone.kind == CONTACT for zone in regime.zones)]
    checks = [
        zero(
            name,
            "in contact p - p* is driven by one harmonic, H - p*, for every p*: p passes p* at most once up and once down",
            _above_a_pressure(strip),
        ),
        *(
            zero(
                name,
                f"a law tau_M = c p below: {regime.sequence} carries c (mean p + p_0 times the part of the period in adhesion)",
                _proportional(regime, means[f"means_{regime.sequence}"][0], integrals),
                phases=regime.edges,
            )
            for regime in touching
        ),
    ]
    return carried_record(carried_friction, checks, ("excess_after", "excess_after_slope"))


def carried_record(by: Callable, checks: Sequence[Check], emitted: tuple[str, ...]) -> Derived:
    """Eq. 13 as derived by ``by``, whose checks say what its foundation answers for."""
    return derived(
        by,
        sp.Integral(sp.Function("tau_M")(sp.Function("p")(s)), (s, s_0, s_1)) / PERIOD,
        name="carried friction",
        statement="What level M carries is averaged over the contact of level M-1 alone; in a strip that is the integral of its "
        "law over the contact zone. The law jumps at pull-off and bends at saturation, so the zone is cut where p passes "
        "these pressures and no quadrature goes across.",
        latex=r"\bar\tau_{M-1} = \frac{1}{l^2} \iint p\,f_x\,dx\,dy + \frac{1}{l^2} \iint_{\text{contact}} \tau_M[p]\,dx\,dy,"
        r"\quad \frac{1}{l} \int_{-a}^{b} \tau_M[p]\,dx = \frac{1}{2\pi} \int_b^a \tau_M[p(s)]\,ds",
        checks=checks,
        paper="Eq. 13",
        status=REPRODUCED,
        emitted=emitted,
    )


def friction_coefficient(one_level: sp.Expr, stack: sp.Expr, own: Sequence[sp.Symbol] = (h, l)) -> Derived:
    r"""Eq. 14: :math:`\mu = \tau_1/p_1`, with :math:`\tau_1` from the recursion of Eq. 13. ``own``: what differs by level."""
    name = "friction coefficient"
    tau_1 = sp.Symbol("tau_1", real=True)
    coefficient = tau_1 / p_nominal
    levels = [{symbol: sp.Symbol(f"{symbol}_{i}", positive=True) for symbol in own} for i in (1, 2, 3)]
    shear = sp.Integer(0)
    for level in reversed(levels):  # from the smallest up; in complete contact it is carried everywhere
        shear = one_level.subs(level) + shear
    checks = [
        zero(
            name,
            "three levels in complete contact: the recursion gives Eq. 16, corrected",
            coefficient.subs(tau_1, shear) - stack.replace(stack_sum, lambda term: sum(term.subs(level) for level in levels)),
        )
    ]
    return derived(
        friction_coefficient,
        coefficient,
        name=name,
        statement="The shear of the largest level, which holds what all levels contribute, over its nominal pressure. The load "
        "is that of the largest level: the smaller ones enter through the shear alone.",
        latex=r"\mu = \frac{\tau_1}{p_1}",
        checks=checks,
        paper="Eq. 14",
        status=REPRODUCED,
        emitted=("saturated_stack_friction",),
    )


def _equal_strips(mean: sp.Expr, number: int) -> sp.Expr:
    """Eq. 11 with 2 N equal strips of the cell."""
    middles = [2 * sp.pi / k * (sp.Rational(2 * j + 1, 2) / (2 * number)) for j in range(2 * number)]
    return sum((mean.subs(y, middle) for middle in middles), sp.Integer(0)) / (2 * number)


def _above_a_pressure(strip: Strip) -> sp.Expr:
    level = sp.Symbol("p_star", real=True)
    pressure = sp.Function("p")(s)
    above = sum(c * sp.diff(pressure - level, s, n) for n, c in enumerate(strip.operator_p))
    harmonic = strip.law(strip.u, sp.Integer(0)) - level
    return sp.expand((harmonic - above).doit() - strip.law(strip.u, pressure).doit())


def _proportional(regime: Regime, mean_p: sp.Expr, integrals: ZoneIntegrals) -> sp.Expr:
    """Pressure summed over contact, against the mean pressure that is emitted; the closing balance is zero on an orbit."""
    summed = adhesion = sp.Integer(0)
    for zone in regime.zones:
        if zone.kind == CONTACT:
            edges = {s_0: zone.first, s_1: zone.last, q_0: zone.entry}
            summed += integrals.contact.value[0].subs(edges, simultaneous=True)
        elif zone.kind == ADHESION:
            adhesion += zone.last - zone.first
    return written_out(summed) - PERIOD * mean_p - p_0 * adhesion - beta * written_out(regime.closing)
