"""Complete contact of a strip and of a level with n modes: K* at the strip's frequency, threshold, friction."""

from __future__ import annotations

from dataclasses import dataclass, replace

import sympy as sp

from ..check import Claim, Derived, derived, holds, zero
from ..functions import Formula, stack_sum
from ..kernel import Kernel, kernel
from ..level import MISPRINT, R, Wave, friction_of_strips, saturation
from ..level import ratio as level_ratio
from ..saturated import saturation_threshold
from ..symbols import D, K, V, alpha, h, l, p_nominal, s
from . import stable
from .flows import ModeFlows, u
from .symbols import OF_STRIP, eta, f_0, m
from .tensor import at_speed, total

R_LOSS = sp.Symbol("loss", positive=True)
AT_SPEED = at_speed(m, 2 * sp.pi * V / l)
PASSING = AT_SPEED.scaled()
"""Of a level's wave; its modes have times in seconds."""
FRICTION = Formula("level_saturation_friction", (K, m, l, h, V), 3 * sp.pi / 32 * K * h * (h / l) * stable.LOSS(AT_SPEED))


@dataclass(frozen=True)
class Complete:
    """Complete contact of a strip and of a level; ``mean``, ``friction`` and ``stack`` by the loss of the wave."""

    modulus: Derived
    kernels: tuple[Kernel, ...]
    threshold: Derived
    means: Kernel
    level: tuple[Kernel, ...]
    mean: tuple[sp.Expr, sp.Expr]
    friction: sp.Expr
    stack: sp.Expr


def complete_contact(flows: ModeFlows) -> Complete:
    kernels, least = (*modulus_kernels(), *field_kernels(flows)), threshold()
    _, loss, ratio = (kernel.exact for kernel in kernels[:3])
    means, mean = saturated_means(loss)
    storage, rest = sp.symbols("storage_minus_1 loss", nonnegative=True)
    at_least_one = holds("R >= 1: the storage is at least 1", sp.expand((1 + storage) ** 2 + rest**2 - 1).is_nonnegative)
    wave = Wave((K, m), ratio.subs(PASSING), ((level_ratio, stable.MODULUS_RATIO(AT_SPEED)),), at_least_one)
    friction = friction_of_strips(mean[1])
    level = (
        *saturation(wave, least.value, mean[0]),
        saturation_friction(friction, loss.subs(PASSING)),
        stack_friction(friction, loss.subs(PASSING)),
    )
    level = tuple(replace(kernel, moving=True) for kernel in level)
    return Complete(complex_modulus(), kernels, least, means, level, mean, friction, stack_sum(friction) / p_nominal)


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


def saturated_means(loss: sp.Expr) -> tuple[Kernel, tuple[sp.Expr, sp.Expr]]:
    r"""Eq. 11: Means of pressure and friction of a strip in complete contact.

    .. math:: \bar p = D - 1,\quad \bar\tau = \tfrac12 \mathrm{Im}\,K^*(ikV)/K

    Also by the symbol R_LOSS, for which ``loss`` stands.
    """
    pressure = D - 1 + sp.Symbol("storage", real=True) * sp.cos(s) - R_LOSS * sp.sin(s)
    mean_p, mean_tau, mean_w = (
        sp.integrate(sp.expand(q), (s, 0, 2 * sp.pi)) / (2 * sp.pi) for q in (pressure, pressure * sp.diff(u, s), u)
    )
    claims = (zero("mean p = mean w over a period", mean_p - mean_w), zero("mean friction = loss/2", mean_tau - R_LOSS / 2))
    formula = Formula("means_c", OF_STRIP, (D - 1, stable.LOSS(m) / 2))
    return kernel(saturated_means, formula, (mean_p, mean_tau.subs(R_LOSS, loss)), *claims), (mean_p, mean_tau)


def saturation_friction(friction: sp.Expr, loss: sp.Expr) -> Kernel:
    r"""Eq. 10, 11: Friction of a level in complete contact.

    .. math:: \tau_{sat} = \frac{3\pi}{32} \frac{h^2}{l}\,\mathrm{Im}\,K^*(ikV)
    """
    claim = zero("it is 3 pi/32 h^2/l Im K*", friction - sp.Rational(3, 32) * sp.pi * K * h**2 / l * R_LOSS)
    return kernel(saturation_friction, FRICTION, friction.subs(R_LOSS, loss), claim)


def stack_friction(friction: sp.Expr, loss: sp.Expr) -> Kernel:
    r"""Eq. 16: Friction coefficient when every level is in complete contact: the levels add.

    .. math:: \mu = \frac{3\pi}{32\,p_1} \sum_i \frac{h_i^2}{l_i}\,\mathrm{Im}\,K^*(ik_iV)
    """
    alpha_1, beta_1 = sp.symbols("alpha beta", positive=True)
    one_time = (beta_1 - alpha_1) / (1 + alpha_1**2)
    stated = sp.Rational(3, 16) * sp.pi**2 * K * h**2 * (beta_1 - alpha_1) / (2 * sp.pi * l * (1 + alpha_1**2))
    claim = zero("with one relaxation time each term is that of Eq. 16 as corrected", friction.subs(R_LOSS, one_time) - stated)
    formula = Formula("saturated_stack_friction", (*FRICTION.args, p_nominal), stack_sum(FRICTION(*FRICTION.args)) / p_nominal)
    exact = stack_sum(friction.subs(R_LOSS, loss)) / p_nominal
    return kernel(stack_friction, formula, exact, claim, correction=MISPRINT)
