"""Stable forms: how the generated solver computes each quantity of a strip.

These are *candidates*, chosen by hand so that nothing overflows and nothing cancels beyond what its inputs allow. None
is believed: each is proven equal to the expression that SymPy derived, by the function that derived it.

Choices that matter:
* differences of cosines as products of sines;
* states as ``(state + rise) decay - (forced state at the end) decay_loss``: exact for short zones, for long ones, between;
* for the balance of a period what each zone *changes*, so that slow foundations keep relative accuracy;
* decays only through the helpers ``decay``, ``decay_loss``, ... whose exponents are never positive;
* ``loss = L beta/(1 + alpha^2)`` as the one constant of the saturated field, ``p_sat = u + loss (alpha cos s - sin s)``:
  it vanishes with ``T_eps = T_sigma`` and squares no large number;
* the change of ``z = w - J p`` over contact in a form whose terms shrink with the zone and hold no factor ``beta``,
  although it equals ``(1/beta) int (p - w) ds``: a period's balance keeps its digits at ``beta = 1e9``.
"""

import sympy as sp

from .functions import (
    Formula,
    arc_half,
    decay,
    decay_loss,
    decay_mean,
    either,
    hypot,
    loss_mean,
    loss_mean_twice,
    sine_deficit,
    sine_lag,
    versine,
)
from .symbols import D, J, L, alpha, beta, excess, gap_0, lag_0, p, p_0, p_in, q_0, s, s_0, s_1, w_0

middle, half, width, lag = sp.symbols("middle half width lag", real=True)
loss_factor, sin_ahead, cos_ahead = sp.symbols("loss_factor sin_ahead cos_ahead", real=True)
unit, alpha_unit, beta_unit = sp.symbols("unit alpha_unit beta_unit", positive=True)
rise, kept, lost, lost_twice = sp.symbols("rise kept lost lost_twice", real=True)
moment_sin, moment_cos, kept_sin, kept_cos = sp.symbols("moment_sin moment_cos kept_sin kept_cos", real=True)
part, t_versine, lost_sin, lost_versine = sp.symbols("part t_versine lost_sin lost_versine", real=True)
ramp, ramp_work = sp.symbols("ramp ramp_work", real=True)
amplitude, steepness, level = sp.symbols("amplitude steepness level", real=True)

HALVES = ((middle, (s_0 + s_1) / 2), (half, (s_1 - s_0) / 2))
WIDTH = (width, s_1 - s_0)

# -- rigid profile and load ---------------------------------------------------------------------------------------------

PROFILE = Formula("profile", (s, D), D - versine(s))
PROFILE_SLOPE = Formula("profile_slope", (s,), -sp.sin(s))
PROFILE_RISE = Formula("profile_rise", (s_0, s_1), -2 * sp.sin(middle) * sp.sin(half), HALVES)
PROFILE_INTEGRAL = Formula(
    "profile_integral",
    (s_0, s_1, D),
    D * width - 2 * (sine_deficit(half) + sp.sin(half) * versine(middle)),
    (WIDTH, *HALVES),
)
FORCING = Formula("forcing", (s, D, beta), PROFILE(s, D) + beta * PROFILE_SLOPE(s))
FORCING_ARC = Formula(
    "forcing_arc",
    (excess, D, beta),
    (-sp.atan(beta), arc_half(level + beta * steepness, 1 + amplitude - level)),
    ((amplitude, hypot(1, beta)), (steepness, beta / (1 + amplitude)), (level, D + excess)),
)

# -- saturated contact --------------------------------------------------------------------------------------------------

UNIT = ((unit, 1 / hypot(1, alpha)), (alpha_unit, alpha * unit))
STORAGE = Formula("storage", (alpha, beta), unit**2 + alpha_unit * beta_unit, (*UNIT, (beta_unit, beta * unit)))
LOSS = Formula("loss", (alpha, beta, L), L * beta_unit * unit, (UNIT[0], (beta_unit, beta * unit)))
MODULUS_RATIO = Formula("modulus_ratio", (alpha, beta), hypot(1, beta) / hypot(1, alpha))

LABELLED_LOSS = (loss_factor, LOSS(alpha, beta, L))
SATURATED_PRESSURE = Formula(
    "saturated_pressure",
    (s, D, alpha, beta, L),
    PROFILE(s, D) + LOSS(alpha, beta, L) * (alpha * sp.cos(s) - sp.sin(s)),
)
SATURATED_RISE = Formula(
    "saturated_rise",
    (s_0, s_1, alpha, beta, L),
    -2 * sp.sin(half) * (sp.sin(middle) + loss_factor * (alpha * sp.sin(middle) + sp.cos(middle))),
    (*HALVES, LABELLED_LOSS),
)

# -- adhesion and free gap: constant pressure ---------------------------------------------------------------------------

GAP_AFTER = Formula(
    "gap_after",
    (s_0, s_1, gap_0, p, D, beta),
    (gap_0 - PROFILE_RISE(s_0, s_1)) * decay(s_1 - s_0, beta) + (PROFILE(s_1, D) - p) * decay_loss(s_1 - s_0, beta),
)
GAP_CHANGE = Formula(
    "gap_change",
    (s_0, s_1, gap_0, p, D, beta),
    (PROFILE(s_1, D) + gap_0 - p) * decay_loss(s_1 - s_0, beta) - PROFILE_RISE(s_0, s_1) * decay(s_1 - s_0, beta),
)
RELAXATION_INCREMENT = Formula("relaxation_increment", (s_0, s_1, lag_0, beta), lag_0 * decay_loss(s_1 - s_0, beta))
RELAXATION_INTEGRAL = Formula(
    "relaxation_integral",
    (s_0, s_1, w_0, p, beta),
    width * (w_0 * decay_mean(width, beta) + p * loss_mean(width, beta)),
    (WIDTH,),
)

# -- contact: w = u ------------------------------------------------------------------------------------------------------

EXCESS_AFTER = Formula(
    "excess_after",
    (s_0, s_1, q_0, p_0, D, alpha, beta, L),
    (q_0 + SATURATED_RISE(s_0, s_1, alpha, beta, L)) * decay(s_1 - s_0, alpha)
    - (p_0 + SATURATED_PRESSURE(s_1, D, alpha, beta, L)) * decay_loss(s_1 - s_0, alpha),
)

AHEAD = (  # sine and cosine of atan(alpha) - s_0
    *UNIT,
    (sin_ahead, alpha_unit * sp.cos(s_0) - unit * sp.sin(s_0)),
    (cos_ahead, alpha_unit * sp.sin(s_0) + unit * sp.cos(s_0)),
)
CONTACT_INCREMENT = Formula(
    "contact_increment",
    (s_0, s_1, q_0, p_0, D, alpha, beta, J, L),
    J * lag * decay_loss(width, alpha) + L * unit * (sin_ahead * sine_lag(width, alpha) - cos_ahead * versine(width)),
    (WIDTH, (lag, PROFILE(s_0, D) + p_0 - q_0), *AHEAD),
)

# Work of the contact pressure on the profile, int p u' ds, with t = s - s_0 and e = exp(-t/alpha):
#     p = p_in e + [u] + u(s_0) (1 - e) + loss (cos s_0 C - sin s_0 S),
#     C = alpha (cos t - e) - sin t,   S = -C' = cos t - e + alpha sin t.
# C ("ramp") starts like t^2 although its terms start like t: written with lost = int (1 - e) dt, its terms do too. The
# integrals of (1 - e)(1 - cos t) and of (1 - e) sin t follow by parts, with lost_twice = int lost dt; those of e cos t and
# e sin t likewise, with kept = int e dt. Where the zone is nearly a period long, int (1 - e) u' dt is nearly nothing, and the
# terms of that form are not: there it is taken from the antiderivative, whose terms then vanish with it.
_vs, _sd = versine(width), sine_deficit(width)
SHORT = -(sp.sin(s_0) * (lost - lost_versine) + sp.cos(s_0) * lost_sin)
WIDE = unit * (
    unit * (rise + kept * sp.sin(s_1)) + alpha_unit * (kept * sp.cos(s_1) - 2 * sp.sin(width / 2) * sp.cos((s_0 + s_1) / 2))
)
CONTACT_WORK = Formula(
    "contact_work",
    (s_0, s_1, p_in, D, alpha, beta, L),
    rise**2 / 2
    - p_in * (sp.sin(s_0) * kept_cos + sp.cos(s_0) * kept_sin)
    + PROFILE(s_0, D) * either(width, SHORT, WIDE)
    - LOSS(alpha, beta, L) * (ramp_work + sp.sin(s_0) * sp.sin(s_1) * ramp),
    (
        WIDTH,
        (rise, PROFILE_RISE(s_0, s_1)),
        *UNIT,
        (kept, width * decay_mean(width, alpha)),
        (moment_cos, unit * kept * sp.cos(width) + alpha_unit * _vs),
        (moment_sin, alpha_unit * decay(width, alpha) * sp.sin(width)),
        (kept_cos, unit * moment_cos + alpha_unit * moment_sin),
        (kept_sin, alpha_unit * moment_cos - unit * moment_sin),
        (lost, width * loss_mean(width, alpha)),
        (lost_twice, width**2 / 2 * loss_mean_twice(width, alpha)),
        (part, _sd - kept * _vs),
        (t_versine, width * _sd - sine_deficit(width / 2) * (width + 2 * sp.sin(width / 2))),
        (lost_versine, unit * (unit * part + alpha_unit * (lost * sp.sin(width) + t_versine - lost_twice))),
        (lost_sin, unit * (unit * (lost * sp.sin(width) + t_versine - lost_twice) - alpha_unit * part)),
        (ramp, _sd - lost - alpha * _vs),
        (ramp_work, lost_versine - part - sine_deficit(2 * width) / 4 - alpha * _vs**2 / 2),
    ),
)
