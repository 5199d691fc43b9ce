"""Complete contact of a strip and of a level with n modes: K* at the strip's frequency, threshold, friction."""

from dataclasses import replace

import sympy as sp

from ..check import Claim, Derived, derived, holds, zero
from ..flows import steady_state
from ..kernel import Kernel, kernel
from ..level import Level, R, in_complete_contact
from ..saturated import Saturated, means, saturation_threshold
from ..symbols import K, V, alpha, l, s
from . import stable
from .flows import ModeFlows, u
from .symbols import OF_STRIP, at_speed, eta, f_0, m, total

AT_SPEED = at_speed(m, 2 * sp.pi * V / l)
PASSING = AT_SPEED.scaled()
"""Of a level's wave; its modes have times in seconds."""


def saturated(flows: ModeFlows) -> Saturated:
    """Complete contact of a strip."""
    _, loss, _ = modulus = modulus_kernels()
    return Saturated(
        complex_modulus(),
        (*modulus, *field_kernels(flows)),
        means(u, OF_STRIP, loss.exact, stable.LOSS(m)),
        saturation_threshold(R, "|K^*|/K"),
    )


def level(threshold: sp.Expr) -> Level:
    """A level in complete contact. ``threshold``: D of a strip, by its R."""
    storage, rest = sp.symbols("storage_minus_1 loss", nonnegative=True)
    at_least_one = holds("R >= 1: the storage is at least 1", sp.expand((1 + storage) ** 2 + rest**2 - 1).is_nonnegative)
    kernels, stack = in_complete_contact((K, m), stable.MODULUS_RATIO(AT_SPEED), stable.LOSS(AT_SPEED), threshold, at_least_one)
    return tuple(replace(kernel, moving=True) for kernel in kernels), stack


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
    harmonic = steady_state(flows.contact.value)
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
