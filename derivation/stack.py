"""Complete contact on all levels at once: from which pressure, and why Eq. 16 is more than an approximation there."""

import sympy as sp

from .check import Derived, derived, holds, zero
from .kernel import Kernel
from .level import TIMES
from .saturated import MODULUS
from .strip import Strip
from .surface import AMPLITUDE, HEIGHT, PENETRATION, WAVE, mean_over_wave
from .symbols import D, D_level, K, V, h, k, l, p_0, p_nominal, x, y

RATIO = 20  # l_1/l_2 of the paper's two levels


def stack(strip: Strip, threshold: sp.Expr, whole: tuple[Kernel, Kernel, Kernel]) -> tuple[Derived, Derived]:
    """Stage 8: a stack of levels in complete contact. ``threshold``: D of a strip; ``whole``: the kernels of one level."""
    _, pressure, friction = whole
    return least_pressure(threshold, pressure.exact), levels_together(strip, friction.exact)


def least_pressure(threshold: sp.Expr, saturation: sp.Expr) -> Derived:
    r"""Level i and all below it are in complete contact from the nominal pressure P_i on: its least local pressure must not fall
    below -p_0, nor below what the level under it needs. Eq. 16 holds from P_1 on.

    .. math:: \min p = p_i - \tfrac14 K h_i (2 R_i - 1),\quad P_M = p_{sat,M},\quad P_i = \max\left(p_{sat,i},\ P_{i+1} +
        \tfrac14 K h_i (2 R_i - 1)\right)
    """
    name = "least pressure in complete contact"
    symbol, over_one, cosine = sp.Symbol("R", positive=True), sp.Symbol("R_minus_1", nonnegative=True), sp.Symbol("c", real=True)
    lowest = D - threshold.subs(p_0, 0)  # of Eq. 15 in a strip: the threshold says where it is -p_0
    in_strip = sp.expand(sp.simplify(K * AMPLITUDE * lowest.subs(MODULUS, symbol).subs(D, PENETRATION / AMPLITUDE)))
    over_y = in_strip.subs(sp.cos(k * y), cosine)
    pressed = p_nominal / K + sp.Rational(3, 4) * h  # penetration in complete contact
    least = sp.expand(over_y.subs(cosine, 1).subs(D_level, pressed))
    drop = K * h * (2 * symbol - 1) / 4
    at_saturation = least.subs(symbol, MODULUS.subs(TIMES).subs(WAVE)).subs(p_nominal, saturation)
    checks = [
        zero("the least pressure of a strip is linear in cos ky", sp.diff(over_y, cosine, 2)),
        holds(
            "and falls with it: it is least in the middle strip, y = 0",
            sp.factor(sp.diff(over_y, cosine).subs(symbol, 1 + over_one)).is_nonpositive,
        ),
        zero("there it is p_i - K h (2 R - 1)/4", least - p_nominal + drop),
        zero("at p_i = p_sat it is -p_0", sp.simplify(at_saturation + p_0)),
    ]
    return derived(least_pressure, least, checks, name=name, emitted=("level_saturation_pressure",))


def levels_together(strip: Strip, one_level: sp.Expr) -> Derived:
    r"""In complete contact the whole surface can be treated at once, without a recursion and without the assumption that the
    wavelengths are far apart. The levels add exactly, with the factor 3 pi^2/16 and the square of h.

    .. math:: \bar\tau = \tfrac12 \sum_n n k A_n^2\,\mathrm{Im}\,K^*(i n k V),\quad \bar\tau = \sum_i \tau_{sat}(h_i, l_i)
    """
    name = "levels in complete contact together"
    transfer, wave_numbers = strip.foundation.model.transfer, (1, RATIO)  # in units of k
    amplitudes = sp.symbols(" ".join(f"A_{n}" for n in wave_numbers), real=True)
    heights = sp.symbols(" ".join(f"h_{n}" for n in wave_numbers), positive=True)
    storage, loss = zip(*(sp.expand_complex(transfer(sp.I * n * k * V)).as_real_imag() for n in wave_numbers), strict=True)
    middle = sp.Symbol("w_mean", real=True)
    w, p, stated = middle, transfer(0) * middle, sp.Integer(0)
    for n, wave, real, imaginary in zip(wave_numbers, amplitudes, storage, loss, strict=True):
        w += wave * sp.cos(n * k * x)
        p += wave * (sp.factor(real) * sp.cos(n * k * x) + sp.factor(imaginary) * sp.sin(n * k * x))
        stated += n * k * wave**2 * sp.factor(imaginary) / 2
    friction = mean_over_wave(-p * sp.diff(w, x), x)
    own = [{k: n * k, h: height} for n, height in zip(wave_numbers, heights, strict=True)]
    surface = D_level - sum(HEIGHT.subs(level, simultaneous=True) for level in own)
    harmonics = {wave: AMPLITUDE.subs(level, simultaneous=True) for wave, level in zip(amplitudes, own, strict=True)}
    rest = sp.expand(surface - (w - middle).subs(harmonics))
    averaged = mean_over_wave(stated.subs(harmonics), y)
    levels = sum(one_level.subs(l, 2 * sp.pi / k).subs(level, simultaneous=True) for level in own)
    checks = [
        zero("each harmonic answers with its own K*: Eq. 5 holds", sp.simplify(strip.misses(w, p))),
        zero("the mean of p f_x is the sum over the harmonics: products of different ones vanish", friction - stated),
        zero(f"two levels with l_1 = {RATIO} l_2 on top of one another are two such harmonics", sp.diff(rest, x)),
        zero("and their exact friction is the sum of both tau_sat: what Eq. 12 to 14 give", sp.simplify(averaged - levels)),
    ]
    return derived(levels_together, stated, checks, name=name, emitted=("level_saturation_friction",))
