"""A whole level in complete contact, averaged over its strips (Eq. 11), and a stack of such levels (Eq. 16).

SI throughout. The level's strips are those of :mod:`.strip`, with amplitude and penetration that vary over y.
"""

import sympy as sp

from . import stable
from .check import Claim, Derived, derived, holds, zero
from .functions import Formula, written_out
from .kernel import Kernel, kernel
from .paper.record import CORRECTIONS
from .saturated import FIELD, LOSS, MODULUS
from .strip import Strip
from .surface import AMPLITUDE, HEIGHT, PENETRATION, WAVE, mean_over_cell, mean_over_wave
from .symbols import D, D_level, K, L, T_eps, T_sigma, V, alpha, beta, h, k, l, p_0, p_nominal, s, x, y

R = sp.Symbol("R", positive=True)
"""|K*|/K of the wave of a level."""
ratio = sp.Symbol("ratio", positive=True)
TIMES = {alpha: k * V * T_sigma, beta: k * V * T_eps, L: 1 - T_sigma / T_eps}
RATIO = 20  # l_1/l_2 of the paper's two levels
STRIP_MEANS = K * (PENETRATION - AMPLITUDE), K * AMPLITUDE * k * AMPLITUDE * LOSS / 2
"""Eq. 11: mean pressure and friction of a strip in complete contact, the latter by the loss of its wave. SI."""
Foundation = tuple[sp.Symbol, ...]  # what is given of it
Level = tuple[tuple[Kernel, Kernel, Kernel], Derived]


def level(threshold: sp.Expr) -> Level:
    """Stage 6: the level in complete contact, with one relaxation time. ``threshold``: D of a strip."""
    speed, excess = 2 * sp.pi * V / l, sp.Symbol("T_delta", nonnegative=True)
    above = sp.factor(((beta**2 - alpha**2) / (1 + alpha**2)).subs(beta, alpha + excess))
    return in_complete_contact(
        (K, T_eps, T_sigma),
        stable.MODULUS_RATIO(T_sigma * speed, T_eps * speed),
        stable.LOSS(T_sigma * speed, (T_eps - T_sigma) * speed, 1),  # the loss of beta and L is that of L beta and 1
        threshold.subs(MODULUS, R),
        holds("R >= 1: R^2 - 1 = (beta^2 - alpha^2)/(1 + alpha^2) >= 0", above.is_nonnegative),
    )


def in_complete_contact(given: Foundation, modulus: sp.Expr, loss: sp.Expr, threshold: sp.Expr, at_least_one: Claim) -> Level:
    """What a level in complete contact comes to on any foundation, and a stack of them.

    ``modulus``, ``loss``: |K*|/K and Im K*/K of its wave, as they are computed from what is ``given`` of the foundation;
    ``threshold``: D of a strip, by its R; ``at_least_one``: R >= 1.
    """
    saturated = saturation(given, modulus, threshold, at_least_one)
    return (*saturated, saturation_friction(given, loss)), stack_friction(written_out(loss))


def in_si(field: sp.Expr) -> sp.Expr:
    """A pressure of complete contact in a strip, given in units of K A over the phase, as a field of x and y in SI."""
    return sp.expand(sp.simplify(K * AMPLITUDE * field.subs({D: PENETRATION / AMPLITUDE, s: -k * x}).subs(TIMES)))


def over_strips(quantity: sp.Expr) -> sp.Expr:
    """Eq. 11: mean over the strips of a level, y from 0 to l."""
    return sp.simplify(mean_over_wave(quantity, y))


def of_every_strip(threshold: sp.Expr, at_least_one: Claim) -> tuple[sp.Expr, list[Claim]]:
    """Penetration from which every strip of a level is saturated, and why. ``threshold``: D_j/A of a strip, by its R >= 1."""
    over_one, cosine = sp.Symbol("R_minus_1", nonnegative=True), sp.Symbol("cosine", real=True)
    scaled = threshold.subs(p_0, p_0 / (K * AMPLITUDE))  # which is in K A
    needed = sp.expand(AMPLITUDE * scaled + h / 2 * (1 - sp.cos(k * y)))  # D of the level
    slope = sp.diff(needed.subs(sp.cos(k * y), cosine), cosine).subs(R, 1 + over_one)
    exact = needed.subs(y, 0)
    return exact, [
        at_least_one,
        zero("the penetration a strip needs is linear in cos ky", sp.diff(slope, cosine)),
        holds("and grows with it: the middle strip, y = 0, is the last to saturate", sp.factor(slope).is_nonnegative),
        zero("there it is h/2 (1 + R) - p_0/K", exact - (h / 2 * (1 + R) - p_0 / K)),
    ]


def one_level() -> tuple[sp.Expr, sp.Expr]:
    """Eq. 11: the same of a level."""
    pressure, friction = map(over_strips, STRIP_MEANS)
    return pressure, friction.subs(WAVE)


def saturation(given: Foundation, modulus: sp.Expr, threshold: sp.Expr, at_least_one: Claim) -> tuple[Kernel, Kernel]:
    r"""From where on a level is in complete contact.

    level_saturation_penetration: Penetration from which every strip of a level is in complete contact.

    .. math:: D_{sat} = \frac h2 (1 + R) - \frac{p_0}{K},\quad R = |K^*(ikV)|/K

    level_saturation_pressure, Eq. 11: Nominal pressure from which a level is in complete contact.

    .. math:: p_{sat} = \tfrac14 K h (2R - 1) - p_0
    """
    penetration, claims = of_every_strip(threshold, at_least_one)
    mean, _ = one_level()
    of_mean = zero("the level's mean pressure in complete contact is K (D - 3h/4)", mean - K * (D_level - sp.Rational(3, 4) * h))

    def of_level(name: str, result: sp.Expr, exact: sp.Expr, *claims: Claim) -> Kernel:
        formula = Formula(f"level_saturation_{name}", (*given, p_0, l, h, V), result, ((ratio, modulus),))
        return kernel(saturation, formula, exact.subs(WAVE).subs(R, written_out(modulus)), *claims)

    return (
        of_level("penetration", h / 2 * (1 + ratio) - p_0 / K, penetration, *claims),
        of_level("pressure", K * h / 4 * (2 * ratio - 1) - p_0, mean.subs(D_level, penetration), of_mean),
    )


def saturation_friction(given: Foundation, loss: sp.Expr) -> Kernel:
    r"""Eq. 10, 11: Friction of a level in complete contact.

    .. math:: \tau_{sat} = \frac{3\pi}{32} \frac{h^2}{l}\,\mathrm{Im}\,K^*(ikV)
    """
    formula = Formula("level_saturation_friction", (*given, l, h, V), 3 * sp.pi / 32 * K * h**2 / l * loss)
    _, friction = one_level()
    stress = in_si(FIELD) * sp.diff(HEIGHT, x)
    checks = [
        zero("it is 3 pi/32 h^2/l Im K*", friction - sp.Rational(3, 32) * sp.pi * K * h**2 / l * LOSS),
        zero("Eq. 15 in Eq. 10, averaged over the cell, is tau_sat", sp.simplify(mean_over_cell(stress).subs(WAVE) - friction)),
    ]
    return kernel(saturation_friction, formula, friction.subs(LOSS, written_out(loss)), *checks)


def stack_friction(loss: sp.Expr) -> Derived:
    r"""Eq. 16: Friction coefficient when every level is in complete contact. The levels add: however deep one is pressed, its
    friction tau_sat is the same.

    .. math:: \mu = \frac{3\pi}{32\,p_1} \sum_i \frac{h_i^2}{l_i}\,\mathrm{Im}\,K^*(ik_iV)

    ``loss``: Im K*/K of the wave of one level.
    """
    _, friction = one_level()
    corrected = sp.Rational(3, 16) * sp.pi**2 * K * h**2 * (beta - alpha) / (2 * sp.pi * l * (1 + alpha**2))
    checks = [
        zero(
            "with one relaxation time each term is that of Eq. 16 as corrected",
            friction.subs(LOSS, (beta - alpha) / (1 + alpha**2)) - corrected,
        ),
    ]
    term = friction.subs(LOSS, loss) / p_nominal
    return derived(stack_friction, term, checks, correction=CORRECTIONS[16], emitted=("level_saturation_friction",))


def printed_equation_16(one_level: sp.Expr) -> Derived:
    r"""Eq. 16: What is wrong with Eq. 16 as printed, and by what factor.

    .. math:: \mu = \frac{3\pi^2}{16} \frac{K V (T_\epsilon - T_\sigma)}{p_1} \sum_i \frac{h_i^2}{l_i^2 + 4\pi^2 V^2
        T_\sigma^2},\quad \frac{\text{printed}}{\text{derived}} = \frac{16}{3 h_i}
    """
    true = one_level / p_nominal
    printed = sp.pi**2 * K * V * (T_eps - T_sigma) / p_nominal * h / (l**2 + 4 * sp.pi**2 * V**2 * T_sigma**2)
    unit = sp.Symbol("lambda", positive=True)  # lengths in a unit smaller by lambda; Pa and s as they are
    change = {h: unit * h, l: unit * l, V: unit * V, K: K / unit}
    scaled_true = sp.cancel(sp.together(true.subs(change, simultaneous=True) / true))
    scaled_printed = sp.cancel(sp.together(printed.subs(change, simultaneous=True) / printed))
    speed = l / (2 * sp.pi * T_sigma)
    peak = sp.diff(true, V)
    peaks = {form: sp.simplify(e.subs(V, speed)) for form, e in (("true", true), ("printed", printed))}
    checks: list[Claim] = [
        zero("the derived form does not depend on the unit of length", scaled_true - 1),
        zero("the printed form does: in a unit of length smaller by lambda it is smaller by lambda", scaled_printed - 1 / unit),
        zero("each printed term is 16/(3 h) times the derived one", printed / true - sp.Rational(16, 3) / h),
        zero("each level's friction peaks at V = l/(2 pi T_sigma)", peak.subs(V, speed)),
        zero(
            "the peaks go like h^2/l; as printed they would go like h/l",
            [sp.diff(peaks["true"] * l / h**2, v) for v in (h, l)] + [sp.diff(peaks["printed"] * l / h, v) for v in (h, l)],
        ),
        holds(
            "Fig. 7: its text says that level 1 has the highest peak; h^2/l has (1 : 0.2 : 0.05), h/l the reverse order",
            _peak_orders(),
        ),
    ]
    emitted = ("level_saturation_friction",)
    return derived(printed_equation_16, (true, printed), checks, "Eq. 16 as printed", correction=CORRECTIONS[16], emitted=emitted)


FIGURE_7 = tuple(tuple(map(sp.Rational, ends)) for ends in (("1e-5", "1e-6"), ("5e-7", "1e-7"), ("5e-9", "5e-9")))
"""Wavelengths and heights of its levels, m."""


def _peak_orders() -> bool:
    square = [height**2 / length for length, height in FIGURE_7]
    plain = [height / length for length, height in FIGURE_7]
    return [value / square[0] for value in square] == [1, sp.Rational(1, 5), sp.Rational(1, 20)] and plain == sorted(plain)


def least_pressure(threshold: sp.Expr, saturation: sp.Expr) -> Derived:
    r"""Level i and all below it are in complete contact from the nominal pressure P_i on: its least local pressure must not fall
    below -p_0, nor below what the level under it needs. Eq. 16 holds from P_1 on.

    .. math:: \min p = p_i - \tfrac14 K h_i (2 R_i - 1),\quad P_M = p_{sat,M},\quad P_i = \max\left(p_{sat,i},\ P_{i+1} +
        \tfrac14 K h_i (2 R_i - 1)\right)
    """
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
    return derived(least_pressure, least, checks, "least pressure in complete contact", emitted=("level_saturation_pressure",))


def levels_together(strip: Strip, one_level: sp.Expr) -> Derived:
    r"""In complete contact the whole surface can be treated at once, without a recursion and without the assumption that the
    wavelengths are far apart. The levels add exactly, with the factor 3 pi^2/16 and the square of h.

    .. math:: \bar\tau = \tfrac12 \sum_n n k A_n^2\,\mathrm{Im}\,K^*(i n k V),\quad \bar\tau = \sum_i \tau_{sat}(h_i, l_i)
    """
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
    return derived(levels_together, stated, checks, "levels in complete contact together", emitted=("level_saturation_friction",))


def crests_at_rest() -> Derived:
    r"""Without adhesion and at rest contact begins with the crests, which are paraboloids there: the nominal pressure at a small
    penetration.

    .. math:: \frac{K D^2}{2\pi h}
    """
    crest = sum(sp.diff(HEIGHT, *pair).subs({x: 0, y: 0}) * sp.Mul(*pair) / 2 for pair in ((x, x), (x, y), (y, x), (y, y)))
    flat, r = [HEIGHT, sp.diff(HEIGHT, x), sp.diff(HEIGHT, y)], sp.Symbol("r", positive=True)
    sunk = D_level - (crest.subs(y, 0)).subs(x, r)
    edge = sp.sqrt(4 * D_level / (h * k**2))
    load = sp.integrate(sp.expand(K * sunk * 2 * sp.pi * r), (r, 0, edge)) / l**2
    value = K * D_level**2 / (2 * sp.pi * h)
    claims = [
        zero("at the crest neither height nor slope", [part.subs({x: 0, y: 0}) for part in flat]),
        zero("next to it the height is that of a paraboloid", crest - h * k**2 / 4 * (x**2 + y**2)),
        zero("contact ends at this distance from it", sunk.subs(r, edge)),
        zero("K times the penetration there, over the cell", load.subs(WAVE) - value),
    ]
    return derived(crests_at_rest, value, claims)
