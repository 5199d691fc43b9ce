"""Saturated contact of a strip: the periodic field (Eq. 15), its threshold and its friction."""

from dataclasses import dataclass

import sympy as sp

from . import stable
from .check import Derived, derived, holds, zero
from .flows import Flows, steady_state
from .functions import Formula
from .kernel import Kernel, kernel
from .strip import TIMES
from .symbols import PARAMETERS, D, L, V, alpha, beta, k, p_0, q_0, s, s_0, s_1

MODULUS = sp.sqrt((1 + beta**2) / (1 + alpha**2))
"""R = |K*|/K at the strip's frequency."""
STORAGE, LOSS = sp.symbols("storage loss", positive=True)
FIELD = D - 1 + STORAGE * sp.cos(s) - LOSS * sp.sin(s)
"""Eq. 15 on any foundation, by the storage and the loss of K*/K."""


@dataclass(frozen=True)
class Saturated:
    """Stage 4c: complete contact of one strip."""

    modulus: Derived  # (storage, loss) of the dimensionless K*/K at the strip's frequency
    kernels: tuple[Kernel, ...]
    means: Kernel
    threshold: Derived  # D at which the least pressure is -p_0


def saturated(flows: Flows) -> Saturated:
    modulus = complex_modulus(flows)
    _, loss = modulus.value
    field = field_kernels(flows, modulus.value)
    threshold = saturation_threshold(MODULUS, "R")
    return Saturated(
        modulus,
        (*modulus_kernels(modulus), *field),
        means(flows.strip.u, PARAMETERS, loss, stable.LOSS(alpha, beta, L)),
        threshold,
    )


def complex_modulus(flows: Flows) -> Derived:
    r"""Stiffness against a displacement that oscillates at the rate k V at which the strip's wave passes.

    .. math:: \frac{K^*(ikV)}{K} = \frac{1 + i\beta}{1 + i\alpha} = \frac{1 + \alpha\beta}{1 + \alpha^2} + i\,\frac{\beta -
        \alpha}{1 + \alpha^2}
    """
    strip = flows.strip
    ratio = sum(q * sp.I**n for n, q in enumerate(strip.operator_w)) / sum(c * sp.I**n for n, c in enumerate(strip.operator_p))
    real, imaginary = (sp.factor(part) for part in sp.cancel(sp.expand_complex(ratio)).as_real_imag())
    model = strip.foundation.model
    si = (model.transfer(sp.I * k * V) / strip.foundation.K).subs(TIMES)
    checks = [
        zero("storage + i loss is K*(i k V)/K of the material", sp.expand_complex(si) - real - sp.I * imaginary),
        zero("loss = (beta - alpha)/(1 + alpha^2)", imaginary - (beta - alpha) / (1 + alpha**2)),
    ]
    return derived(complex_modulus, (real, imaginary), checks)


def modulus_kernels(modulus: Derived) -> tuple[Kernel, ...]:
    r"""Storage, loss and :math:`R = |K^*|/K = \sqrt{(1+\beta^2)/(1+\alpha^2)}`.

    storage: Real part of K*/K.

    .. math:: \mathrm{Re}\,K^*/K = \frac{1 + \alpha\beta}{1 + \alpha^2}

    loss: Imaginary part of K*/K.

    .. math:: \mathrm{Im}\,K^*/K = \frac{L\beta}{1 + \alpha^2}

    modulus_ratio: Modulus of K*/K.

    .. math:: R = \sqrt{\frac{1 + \beta^2}{1 + \alpha^2}}
    """
    storage, loss = modulus.value
    squares = zero("R^2 = storage^2 + loss^2", MODULUS**2 - storage**2 - loss**2)
    return (
        kernel(modulus_kernels, stable.STORAGE, storage),
        kernel(modulus_kernels, stable.LOSS, loss),
        kernel(modulus_kernels, stable.MODULUS_RATIO, MODULUS, squares),
    )


def field_kernels(flows: Flows, modulus: tuple[sp.Expr, sp.Expr]) -> tuple[Kernel, ...]:
    r"""Eq. 15: :math:`p_{sat}(s) = D - 1 + \mathrm{Re}[K^*/K\; e^{is}]`.

    saturated_pressure, Eq. 15: Pressure of complete contact.

    .. math:: p_{sat} = D - 1 + \frac{(1 + \alpha\beta)\cos s - (\beta - \alpha)\sin s}{1 + \alpha^2}

    saturated_rise: Rise of the pressure of complete contact between two phases, without cancellation.

    .. math:: [p_{sat}]_{s_0}^{s_1}
    """
    storage, loss = modulus
    periodic = steady_state(flows.contact.value)
    eq_15 = D - 1 + sp.re(sp.expand_complex((storage + sp.I * loss) * sp.exp(sp.I * s)))
    own = (
        zero("the law holds with w = u", flows.strip.law(flows.strip.u, periodic)),
        holds("nothing of the entry is left", not periodic.has(s_0, q_0)),
        zero("it has the period 2 pi", periodic.subs(s, s + 2 * sp.pi) - periodic),
        zero("it is Eq. 15: the mean and one harmonic, weighted by K*", periodic - eq_15, phases=(s,)),
    )
    rise = periodic.subs(s, s_1) - periodic.subs(s, s_0)
    return (
        kernel(field_kernels, stable.SATURATED_PRESSURE, periodic, *own),
        kernel(field_kernels, stable.SATURATED_RISE, rise),
    )


def means(u: sp.Expr, args: tuple[sp.Symbol, ...], loss: sp.Expr, computed: sp.Expr) -> Kernel:
    r"""Eq. 11: Means of pressure and friction of a strip in complete contact.

    .. math:: \bar p = D - 1,\quad \bar\tau = \frac{1}{2\pi}\oint p\,u'\,ds = \tfrac12 \mathrm{Im}\,K^*(ikV)/K

    ``loss`` of the foundation, and how it is ``computed``.
    """
    mean_p, mean_tau, mean_w = (
        sp.integrate(sp.expand(part), (s, 0, 2 * sp.pi)) / (2 * sp.pi) for part in (FIELD, FIELD * sp.diff(u, s), u)
    )
    return kernel(
        means,
        Formula("means_c", args, (D - 1, computed / 2)),
        (mean_p, mean_tau.subs(LOSS, loss)),
        zero("mean p = mean w over a period", mean_p - mean_w),
        zero("mean friction = loss/2", mean_tau - LOSS / 2),
    )


def saturation_threshold(R: sp.Expr, ratio: str) -> Derived:
    r"""A strip is in complete contact when the least pressure of Eq. 15 is not below -p_0.

    .. math:: \min p_{sat} \ge -p_0,\quad D \ge 1 + R - p_0

    ``ratio``: R in LaTeX. The vector (storage, loss) is as long as R and has the direction of K*.
    """
    lag = sp.Symbol("lag", real=True)
    harmonic = FIELD.subs({STORAGE: R * sp.cos(lag), LOSS: R * sp.sin(lag)})
    least = D - 1 - R
    solution = sp.solve(least + p_0, D)[0]
    claims = [
        zero("p_sat = D - 1 + R cos(s + arg K*)", sp.expand_trig(D - 1 + R * sp.cos(s + lag)) - harmonic),
        zero("least where the cosine is -1: D - 1 - R", sp.expand_trig(harmonic.subs(s, sp.pi - lag)) - least),
        zero("at the threshold the least pressure is -p_0", least.subs(D, solution) + p_0),
        holds("and it grows with D", sp.diff(least, D).is_positive),
    ]
    return derived(saturation_threshold, solution, claims, latex=rf"D_j \ge A(1 + {ratio}) - p_0/K")
