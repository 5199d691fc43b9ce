"""Stable forms: how the generated solver computes each quantity of a strip.

These are *candidates*, chosen by hand so that nothing overflows and nothing cancels beyond what its inputs allow. None
is believed: each is proven equal to the expression that SymPy derived, by the function that derived it.

Choices that matter:
* differences of cosines as products of sines;
* what a zone *changes*, rather than what it ends with, so that short zones and slow foundations keep relative accuracy;
* decays only through the helpers ``decay``, ``decay_loss``, ... whose exponents are never positive;
* ``loss = L beta/(1 + alpha^2)`` as the one constant of the saturated field, ``p_sat = u + loss (alpha cos s - sin s)``:
  it vanishes with ``T_eps = T_sigma`` and squares no large number;
* the change of ``z = w - J p`` over contact in a form whose terms shrink with the zone and hold no factor ``beta``,
  although it equals ``(1/beta) int (p - w) ds``: a period's balance keeps its digits at ``beta = 1e9``.
"""

from __future__ import annotations

import sympy as sp

from .functions import (
    Formula,
    arc_half,
    decay,
    decay_loss,
    decay_mean,
    decay_rate,
    hypot,
    loss_mean,
    sine_deficit,
    versine,
)
from .symbols import D, J, L, alpha, beta, excess, gap_0, lag_0, p, p_0, q_0, s, s_0, s_1, w_0

middle, half, width, lag, transient = sp.symbols("middle half width lag transient", real=True)
loss_factor, sin_ahead, cos_ahead = sp.symbols("loss_factor sin_ahead cos_ahead", real=True)
unit, alpha_unit, beta_unit = sp.symbols("unit alpha_unit beta_unit", positive=True)
rise, sweep, tail, held = sp.symbols("rise sweep tail held", real=True)
moment_sin, moment_cos, lost_sin, lost_cos = sp.symbols("moment_sin moment_cos lost_sin lost_cos", real=True)
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

PROFILE.partials[0] = lambda s, D: PROFILE_SLOPE(s)

# -- saturated contact --------------------------------------------------------------------------------------------------

_unit = ((unit, 1 / hypot(1, alpha)), (alpha_unit, alpha * unit))
STORAGE = Formula(
    "storage", (alpha, beta), unit**2 + alpha_unit * beta_unit, (*_unit, (beta_unit, beta * unit))
)
LOSS = Formula("loss", (alpha, beta, L), L * beta_unit * unit, (_unit[0], (beta_unit, beta * unit)))
MODULUS_RATIO = Formula("modulus_ratio", (alpha, beta), hypot(1, beta) / hypot(1, alpha))

_loss = (loss_factor, LOSS(alpha, beta, L))
SATURATED_PRESSURE = Formula(
    "saturated_pressure",
    (s, D, alpha, beta, L),
    PROFILE(s, D) + LOSS(alpha, beta, L) * (alpha * sp.cos(s) - sp.sin(s)),
)
SATURATED_SLOPE = Formula(
    "saturated_slope",
    (s, alpha, beta, L),
    PROFILE_SLOPE(s) - LOSS(alpha, beta, L) * (alpha * sp.sin(s) + sp.cos(s)),
)
SATURATED_RISE = Formula(
    "saturated_rise",
    (s_0, s_1, alpha, beta, L),
    -2 * sp.sin(half) * (sp.sin(middle) + loss_factor * (alpha * sp.sin(middle) + sp.cos(middle))),
    (*HALVES, _loss),
)

# -- adhesion and free gap: constant pressure ---------------------------------------------------------------------------

_lag = (lag, PROFILE(s_0, D) + gap_0 - p)
GAP_AFTER = Formula(
    "gap_after",
    (s_0, s_1, gap_0, p, D, beta),
    gap_0 - PROFILE_RISE(s_0, s_1) + lag * decay_loss(s_1 - s_0, beta),
    (_lag,),
)
GAP_AFTER_SLOPE = Formula(
    "gap_after_slope",
    (s_0, s_1, gap_0, p, D, beta),
    -PROFILE_SLOPE(s_1) - lag * decay_rate(s_1 - s_0, beta),
    (_lag,),
)
GAP_AFTER_START = Formula(
    "gap_after_start",
    (s_0, s_1, gap_0, p, D, beta),
    PROFILE_SLOPE(s_0) * decay(s_1 - s_0, beta) + lag * decay_rate(s_1 - s_0, beta),
    (_lag,),
)
DISPLACEMENT_AFTER = Formula(
    "displacement_after", (s_0, s_1, w_0, p, beta), w_0 + (w_0 - p) * decay_loss(s_1 - s_0, beta)
)
RELAXATION_INCREMENT = Formula("relaxation_increment", (s_0, s_1, lag_0, beta), lag_0 * decay_loss(s_1 - s_0, beta))
RELAXATION_INCREMENT_SLOPE = Formula(
    "relaxation_increment_slope", (s_0, s_1, lag_0, beta), -lag_0 * decay_rate(s_1 - s_0, beta)
)
RELAXATION_INTEGRAL = Formula(
    "relaxation_integral",
    (s_0, s_1, w_0, p, beta),
    width * (w_0 * decay_mean(width, beta) + p * loss_mean(width, beta)),
    (WIDTH,),
)

GAP_AFTER.partials.update({0: lambda *v: GAP_AFTER_START(*v), 1: lambda *v: GAP_AFTER_SLOPE(*v)})
RELAXATION_INCREMENT.partials.update(
    {
        0: lambda s_0, s_1, lag_0, beta: -RELAXATION_INCREMENT_SLOPE(s_0, s_1, lag_0, beta),
        1: lambda *v: RELAXATION_INCREMENT_SLOPE(*v),
        2: lambda s_0, s_1, lag_0, beta: decay_loss(s_1 - s_0, beta),
    }
)

# -- contact: w = u ------------------------------------------------------------------------------------------------------

_transient = (transient, q_0 - p_0 - SATURATED_PRESSURE(s_0, D, alpha, beta, L))
_contact = (s_0, s_1, q_0, p_0, D, alpha, beta, L)
EXCESS_AFTER = Formula(
    "excess_after",
    _contact,
    q_0 + SATURATED_RISE(s_0, s_1, alpha, beta, L) + transient * decay_loss(s_1 - s_0, alpha),
    (_transient,),
)
EXCESS_AFTER_SLOPE = Formula(
    "excess_after_slope",
    _contact,
    SATURATED_SLOPE(s_1, alpha, beta, L) - transient * decay_rate(s_1 - s_0, alpha),
    (_transient,),
)
EXCESS_AFTER_START = Formula(
    "excess_after_start",
    _contact,
    transient * decay_rate(s_1 - s_0, alpha) - SATURATED_SLOPE(s_0, alpha, beta, L) * decay(s_1 - s_0, alpha),
    (_transient,),
)
CONTACT_PRESSURE = Formula(
    "contact_pressure",
    _contact,
    q_0 - p_0 + SATURATED_RISE(s_0, s_1, alpha, beta, L) + transient * decay_loss(s_1 - s_0, alpha),
    (_transient,),
)
EXCESS_AFTER.partials.update({0: lambda *v: EXCESS_AFTER_START(*v), 1: lambda *v: EXCESS_AFTER_SLOPE(*v)})

_increment = (s_0, s_1, q_0, p_0, D, alpha, beta, J, L)
_contact_lag = (lag, PROFILE(s_0, D) + p_0 - q_0)
_ahead = (  # sine and cosine of atan(alpha) - s_0
    *_unit,
    (sin_ahead, alpha_unit * sp.cos(s_0) - unit * sp.sin(s_0)),
    (cos_ahead, alpha_unit * sp.sin(s_0) + unit * sp.cos(s_0)),
)
CONTACT_INCREMENT = Formula(
    "contact_increment",
    _increment,
    J * lag * decay_loss(width, alpha)
    + L
    * unit
    * (sin_ahead * (width * loss_mean(width, alpha) - sine_deficit(width)) - cos_ahead * versine(width)),
    (WIDTH, _contact_lag, *_ahead),
)
CONTACT_INCREMENT_SLOPE = Formula(
    "contact_increment_slope",
    _increment,
    -J * lag * decay_rate(width, alpha)
    - L * unit * (sin_ahead * (decay_loss(width, alpha) + versine(width)) + cos_ahead * sp.sin(width)),
    (WIDTH, _contact_lag, *_ahead),
)
CONTACT_INCREMENT_START = Formula(
    "contact_increment_start",
    _increment,
    J * (PROFILE_SLOPE(s_0) * decay_loss(width, alpha) + lag * decay_rate(width, alpha))
    + L * unit * (sin_ahead * decay_loss(width, alpha) + cos_ahead * width * decay_mean(width, alpha)),
    (WIDTH, _contact_lag, *_ahead),
)
CONTACT_INCREMENT.partials.update(
    {0: lambda *v: CONTACT_INCREMENT_START(*v), 1: lambda *v: CONTACT_INCREMENT_SLOPE(*v)}
)

# Work of the excess pressure q = p + p_0 on the profile, int q u' ds. With held = int (1 - exp(-t/alpha)) dt the
# integrals of (1 - exp(-t/alpha)) cos t and of (1 - exp(-t/alpha)) sin t follow by parts from those of t sin t and t cos t.
CONTACT_WORK = Formula(
    "contact_work",
    _contact,
    q_0 * rise
    + (1 + alpha * loss_factor) * rise**2 / 2
    + loss_factor * sweep
    + transient * (sp.sin(s_0) * lost_cos + sp.cos(s_0) * lost_sin),
    (
        WIDTH,
        _transient,
        _loss,
        (rise, PROFILE_RISE(s_0, s_1)),
        (tail, sine_deficit(2 * width) / 4),
        (
            sweep,
            sp.cos(s_0) ** 2 * tail
            + sp.sin(s_0) * sp.cos(s_0) * versine(width) * sp.cos(width)
            + sp.sin(s_0) ** 2 * (sine_deficit(width) - tail),
        ),
        (held, width * loss_mean(width, alpha)),
        (moment_sin, held * sp.cos(width) + width * versine(width) - sine_deficit(width)),
        (moment_cos, held * sp.sin(width) + versine(width) - width * sp.sin(width)),
        *_unit,
        (lost_cos, unit * (unit * moment_sin - alpha_unit * moment_cos)),
        (lost_sin, unit * (alpha_unit * moment_sin + unit * moment_cos)),
    ),
)
