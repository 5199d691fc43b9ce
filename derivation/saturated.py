"""Saturated contact of a strip: the periodic field (Eq. 15), its threshold and its friction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import sympy as sp

from . import stable
from .check import Check, Derived, derived, holds, zero
from .flows import Flows
from .functions import Formula
from .kernel import Kernel, kernel
from .strip import TIMES
from .symbols import PARAMETERS, D, L, V, alpha, beta, k, p_0, q_0, s, s_0, s_1

MODULUS = sp.sqrt((1 + beta**2) / (1 + alpha**2))
"""R = |K*|/K at the strip's frequency."""


@dataclass(frozen=True)
class Saturated:
    """Stage 4c: complete contact of one strip."""

    modulus: Derived  # (storage, loss) of the dimensionless K*/K at the strip's frequency
    kernels: tuple[Kernel, ...]
    means: Kernel
    threshold: Derived  # D at which the least pressure is -p_0


def saturated(flows: Flows) -> Saturated:
    modulus = complex_modulus(flows)
    field = field_kernels(flows, modulus.value)
    return Saturated(
        modulus, (*modulus_kernels(modulus), *field), means(flows, field[0].exact), threshold(field[0].exact, modulus.value)
    )


def complex_modulus(flows: Flows) -> Derived:
    r""":math:`K^*(i\omega)/K = (1 + i\beta)/(1 + i\alpha)` at :math:`\omega = kV`."""
    name = "complex modulus"
    strip = flows.strip
    ratio = sum(q * sp.I**n for n, q in enumerate(strip.operator_w)) / sum(c * sp.I**n for n, c in enumerate(strip.operator_p))
    real, imaginary = (sp.factor(part) for part in sp.cancel(sp.expand_complex(ratio)).as_real_imag())
    model = strip.foundation.model
    si = (model.transfer(sp.I * k * V) / strip.foundation.K).subs(TIMES)
    checks = [
        zero(name, "storage + i loss is K*(i k V)/K of the material", sp.expand_complex(si) - real - sp.I * imaginary),
        zero(name, "loss = (beta - alpha)/(1 + alpha^2)", imaginary - (beta - alpha) / (1 + alpha**2)),
    ]
    return derived(
        complex_modulus,
        (real, imaginary),
        name=name,
        statement="Stiffness against a displacement that oscillates at the rate k V at which the strip's wave passes.",
        latex=r"\frac{K^*(ikV)}{K} = \frac{1 + i\beta}{1 + i\alpha}"
        r" = \frac{1 + \alpha\beta}{1 + \alpha^2} + i\,\frac{\beta - \alpha}{1 + \alpha^2}",
        checks=checks,
    )


def modulus_kernels(modulus: Derived) -> tuple[Kernel, ...]:
    r"""Storage, loss and :math:`R = |K^*|/K = \sqrt{(1+\beta^2)/(1+\alpha^2)}`."""
    storage, loss = modulus.value
    squares = zero("modulus_ratio", "R^2 = storage^2 + loss^2", MODULUS**2 - storage**2 - loss**2)
    return (
        kernel(
            modulus_kernels,
            stable.STORAGE,
            storage,
            "Real part of K*/K.",
            r"\mathrm{Re}\,K^*/K = \frac{1 + \alpha\beta}{1 + \alpha^2}",
        ),
        kernel(
            modulus_kernels, stable.LOSS, loss, "Imaginary part of K*/K.", r"\mathrm{Im}\,K^*/K = \frac{L\beta}{1 + \alpha^2}"
        ),
        kernel(
            modulus_kernels,
            stable.MODULUS_RATIO,
            MODULUS,
            "Modulus of K*/K.",
            r"R = \sqrt{\frac{1 + \beta^2}{1 + \alpha^2}}",
            squares,
        ),
    )


def field_kernels(flows: Flows, modulus: tuple[sp.Expr, sp.Expr]) -> tuple[Kernel, ...]:
    r"""Eq. 15: :math:`p_{sat}(s) = D - 1 + \mathrm{Re}[K^*/K\; e^{is}]`."""
    name = "saturated_pressure"
    storage, loss = modulus
    # The periodic solution is what the contact flow leaves behind when its transient has died out.
    pressure = flows.contact.value
    periodic = pressure.replace(sp.exp, lambda exponent: sp.Integer(0))
    eq_15 = D - 1 + sp.re(sp.expand_complex((storage + sp.I * loss) * sp.exp(sp.I * s)))
    own = (
        zero(name, "the law holds with w = u", flows.strip.law(flows.strip.u, periodic)),
        holds(name, "nothing of the entry is left", not periodic.has(s_0, q_0)),
        zero(name, "it has the period 2 pi", periodic.subs(s, s + 2 * sp.pi) - periodic),
        zero(name, "it is Eq. 15: the mean and one harmonic, weighted by K*", periodic - eq_15, phases=(s,)),
    )
    rise = periodic.subs(s, s_1) - periodic.subs(s, s_0)
    return (
        kernel(
            field_kernels,
            stable.SATURATED_PRESSURE,
            periodic,
            "Pressure of complete contact.",
            r"p_{sat} = D - 1 + \frac{(1 + \alpha\beta)\cos s - (\beta - \alpha)\sin s}{1 + \alpha^2}",
            *own,
            paper="Eq. 15",
        ),
        kernel(
            field_kernels,
            stable.SATURATED_SLOPE,
            sp.diff(periodic, s),
            "Slope of the pressure of complete contact.",
            r"p_{sat}'(s)",
        ),
        kernel(
            field_kernels,
            stable.SATURATED_RISE,
            rise,
            "Rise of the pressure of complete contact between two phases, without cancellation.",
            r"[p_{sat}]_{s_0}^{s_1}",
        ),
    )


def means(flows: Flows, pressure: sp.Expr) -> Kernel:
    r"""Eq. 11 in complete contact: :math:`\bar p = D - 1`, :math:`\bar\tau = \frac12\mathrm{Im}\,K^*/K`."""
    name = "means_c"
    u = flows.strip.u
    mean_p = sp.integrate(sp.expand(pressure), (s, 0, 2 * sp.pi)) / (2 * sp.pi)
    mean_tau = sp.integrate(sp.expand(pressure * sp.diff(u, s)), (s, 0, 2 * sp.pi)) / (2 * sp.pi)
    mean_w = sp.integrate(u, (s, 0, 2 * sp.pi)) / (2 * sp.pi)
    return kernel(
        means,
        Formula(name, PARAMETERS, (D - 1, stable.LOSS(alpha, beta, L) / 2)),
        (mean_p, sp.factor(mean_tau)),
        "Means of pressure and friction of a strip in complete contact.",
        r"\bar p = D - 1,\quad \bar\tau = \frac{1}{2\pi}\oint p\,u'\,ds = \frac{L\beta}{2(1 + \alpha^2)}",
        zero(name, "mean p = mean w over a period", mean_p - mean_w),
        paper="Eq. 11",
    )


def threshold(pressure: sp.Expr, modulus: tuple[sp.Expr, sp.Expr]) -> Derived:
    r"""Complete contact needs :math:`\min p_{sat} \ge -p_0`: :math:`D \ge 1 + R - p_0`."""
    name = "saturation threshold"
    storage, loss = modulus
    R = MODULUS
    # p_sat = D - 1 + R cos(s + lag) with (cos lag, sin lag) = (storage, loss)/R.
    lag = sp.Symbol("lag", real=True)
    harmonic = sp.expand_trig(R * sp.cos(s + lag)).subs({sp.cos(lag): storage / R, sp.sin(lag): loss / R})
    checks: list[Check] = [
        zero(name, "p_sat = D - 1 + R cos(s + arg K*)", pressure - (D - 1) - harmonic, phases=(s,)),
        zero(name, "(storage, loss)/R is a unit vector, so that the least value is D - 1 - R", (storage**2 + loss**2) / R**2 - 1),
    ]
    return threshold_record(threshold, R, "R", checks)


def threshold_record(by: Callable[..., Any], R: sp.Expr, ratio: str, checks: list[Check]) -> Derived:
    """The record of the threshold, once the least pressure is shown to be ``D - 1 - R``; ``ratio``: R in LaTeX."""
    name = "saturation threshold"
    least = D - 1 - R
    solution = sp.solve(least + p_0, D)[0]
    checks = [
        *checks,
        zero(name, "at the threshold the least pressure is -p_0", least.subs(D, solution) + p_0),
        holds(name, "and it grows with D", sp.diff(least, D).is_positive),
    ]
    return derived(
        by,
        solution,
        name=name,
        statement="A strip is in complete contact when the least pressure of Eq. 15 is not below -p_0.",
        latex=rf"D_j \ge A(1 + {ratio}) - p_0/K",
        checks=checks,
    )
