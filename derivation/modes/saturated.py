"""Complete contact of a strip and of a level with n modes: K* at the strip's frequency, threshold, friction."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ..check import Claim, Derived, derived, holds, zero
from ..functions import stack_sum
from ..kernel import Kernel, kernel
from ..level import MISPRINT, R, friction_of_strips, load_of_strips, of_every_strip
from ..saturated import saturation_threshold
from ..symbols import D, D_level, K, alpha, h, l, p_0, p_nominal, s
from . import stable
from .flows import ModeFlows, u
from .symbols import eta, f_0
from .tensor import total

R_LOSS = sp.Symbol("loss", positive=True)


@dataclass(frozen=True)
class Complete:
    """Complete contact: the emitted kernels, and what holds for the strip and its level."""

    modulus: Derived
    kernels: tuple[Kernel, ...]
    threshold: Derived
    means: Derived
    penetration: Derived
    pressure: Derived
    friction: Derived
    stack: Derived


def complete_contact(flows: ModeFlows) -> Complete:
    least, means = threshold(), saturated_means()
    mean_p, mean_tau = means.value
    penetration = saturation_penetration(least.value)
    pressure = saturation_pressure(penetration.value, mean_p)
    friction = saturation_friction(mean_tau)
    kernels = (*modulus_kernels(), *field_kernels(flows))
    return Complete(complex_modulus(), kernels, least, means, penetration, pressure, friction, stack_friction(friction.value))


def complex_modulus() -> Derived:
    r"""Stiffness against a displacement that oscillates at the rate k V at which the strip's wave passes.

    .. math:: \frac{K^*(ikV)}{K} = 1 + \sum_i \frac{\eta_i \alpha_i}{1 + \alpha_i^2} + i \sum_i \frac{\eta_i}{1 + \alpha_i^2}
    """
    term = sp.I * eta / (1 + sp.I * alpha)
    motion = sp.exp(sp.I * s)  # of w, and term times it of f
    real, imaginary = (sp.simplify(part) for part in sp.expand_complex(term).as_real_imag())
    checks = [
        zero(
            "a branch answers w = exp(i s) with the overstress i eta/(1 + i alpha) w",
            sp.simplify((term + alpha * term * sp.I - eta * sp.I) * motion),
        ),
        zero("every branch adds eta alpha/(1 + alpha^2) to the storage", real - eta * alpha / (1 + alpha**2)),
        zero("and eta/(1 + alpha^2) to the loss", imaginary - eta / (1 + alpha**2)),
    ]
    return derived(complex_modulus, (real, imaginary), checks, emitted=("storage", "loss", "modulus_ratio"))


def modulus_kernels() -> tuple[Kernel, ...]:
    r"""Storage, loss and :math:`R = |K^*|/K`.

    storage: Real part of K*/K.

    .. math:: 1 + \sum_i \frac{\eta_i \alpha_i}{1 + \alpha_i^2}

    loss: Imaginary part of K*/K.

    .. math:: \sum_i \frac{\eta_i}{1 + \alpha_i^2}

    modulus_ratio: Modulus of K*/K.

    .. math:: R = |K^*(ikV)|/K
    """
    real, imaginary = 1 + total(eta * alpha / (1 + alpha**2)), total(eta / (1 + alpha**2))
    return (
        kernel(modulus_kernels, stable.STORAGE, real),
        kernel(modulus_kernels, stable.LOSS, imaginary),
        kernel(modulus_kernels, stable.MODULUS_RATIO, sp.sqrt(real**2 + imaginary**2)),
    )


def field_kernels(flows: ModeFlows) -> tuple[Kernel, ...]:
    r"""Eq. 15: :math:`p_{sat} = u + \sum_i f_{sat,i}`.

    saturated_overstress, Eq. 15: Overstress of every branch in complete contact.

    .. math:: f_{sat,i} = \eta_i\frac{\alpha_i \cos s - \sin s}{1 + \alpha_i^2}

    saturated_pressure, Eq. 15: Pressure of complete contact.

    .. math:: p_{sat} = u + \sum_i f_{sat,i}
    """
    # What the contact flow leaves behind when its transients have died out.
    harmonic = flows.contact.value.replace(sp.exp, lambda exponent: sp.Integer(0))
    eq_15 = sp.re(sp.expand_complex(sp.I * eta / (1 + sp.I * alpha) * sp.exp(sp.I * s)))
    own: tuple[Claim, ...] = (
        holds("nothing of the entry is left", not harmonic.has(f_0)),
        zero("it has the period 2 pi", harmonic.subs(s, s + 2 * sp.pi) - harmonic),
        zero("it is Eq. 15: one harmonic, weighted by the branch's part of K*", harmonic - eq_15, phases=(s,)),
    )
    return (
        kernel(field_kernels, stable.SATURATED_OVERSTRESS, harmonic, *own),
        kernel(field_kernels, stable.SATURATED_PRESSURE, u + total(harmonic)),
    )


def threshold() -> Derived:
    """Of D for complete contact: the pressure is one harmonic, whatever makes up its storage and loss."""
    lag = sp.Symbol("lag", real=True)
    field = D - 1 + R * sp.cos(lag) * sp.cos(s) - R * sp.sin(lag) * sp.sin(s)
    harmonic = sp.expand_trig(D - 1 + R * sp.cos(s + lag))
    return saturation_threshold(R, "|K^*|/K", [zero("p_sat = D - 1 + R cos(s + arg K*)", harmonic - field, phases=(s,))])


def saturated_means() -> Derived:
    r"""Eq. 11: Means of pressure and friction of a strip in complete contact.

    .. math:: \bar p = D - 1,\quad \bar\tau = \tfrac12 \mathrm{Im}\,K^*(ikV)/K
    """
    name = "means_c"
    storage, loss = sp.Symbol("storage", real=True), R_LOSS
    pressure = D - 1 + storage * sp.cos(s) - loss * sp.sin(s)
    mean = [sp.integrate(sp.expand(q), (s, 0, 2 * sp.pi)) / (2 * sp.pi) for q in (pressure, pressure * sp.diff(u, s), u)]
    checks = [
        zero("mean p = mean w over a period", mean[0] - mean[2]),
        zero("mean friction = loss/2", mean[1] - loss / 2),
    ]
    return derived(saturated_means, (mean[0], mean[1]), checks, name=name, emitted=("means_c",))


def saturation_penetration(threshold: sp.Expr) -> Derived:
    r"""Penetration from which every strip of a level is in complete contact.

    .. math:: D_{sat} = \frac h2 (1 + R) - \frac{p_0}{K}
    """
    name = "level_saturation_penetration"
    storage, loss = sp.symbols("storage_minus_1 loss", nonnegative=True)
    above = sp.expand((1 + storage) ** 2 + loss**2 - 1)
    exact, checks = of_every_strip(threshold, holds("R >= 1: the storage is at least 1", above.is_nonnegative))
    return derived(saturation_penetration, exact, checks, name=name, emitted=(name,))


def saturation_pressure(penetration: sp.Expr, mean_p: sp.Expr) -> Derived:
    r"""Eq. 11: Nominal pressure from which a level is in complete contact.

    .. math:: p_{sat} = \tfrac14 K h (2R - 1) - p_0
    """
    name = "level_saturation_pressure"
    exact = load_of_strips(mean_p).subs(D_level, penetration)
    checks = [zero("p_sat = K h (2 R - 1)/4 - p_0", exact - (K * h / 4 * (2 * R - 1) - p_0))]
    return derived(saturation_pressure, exact, checks, name=name, emitted=(name,))


def saturation_friction(mean_tau: sp.Expr) -> Derived:
    r"""Eq. 10, 11: Friction of a level in complete contact.

    .. math:: \tau_{sat} = \frac{3\pi}{32} \frac{h^2}{l}\,\mathrm{Im}\,K^*(ikV)
    """
    name = "level_saturation_friction"
    exact = friction_of_strips(mean_tau)
    checks = [zero("it is 3 pi/32 h^2/l Im K*", exact - sp.Rational(3, 32) * sp.pi * K * h**2 / l * R_LOSS)]
    return derived(saturation_friction, exact, checks, name=name, emitted=(name,))


def stack_friction(friction: sp.Expr) -> Derived:
    r"""Eq. 16: Friction coefficient when every level is in complete contact: the levels add.

    .. math:: \mu = \frac{3\pi}{32\,p_1} \sum_i \frac{h_i^2}{l_i}\,\mathrm{Im}\,K^*(ik_iV)
    """
    name = "saturated_stack_friction"
    times = sp.symbols("alpha beta", positive=True)
    one_time = (times[1] - times[0]) / (1 + times[0] ** 2)
    stated = sp.Rational(3, 16) * sp.pi**2 * K * h**2 * (times[1] - times[0]) / (2 * sp.pi * l * (1 + times[0] ** 2))
    checks = [zero("with one relaxation time each term is that of Eq. 16 as corrected", friction.subs(R_LOSS, one_time) - stated)]
    return derived(stack_friction, stack_sum(friction) / p_nominal, checks, name=name, correction=MISPRINT, emitted=(name,))
