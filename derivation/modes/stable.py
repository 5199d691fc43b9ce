"""Stable forms for n modes: candidates, each proven equal to the derived expression of a generic mode.

Choices that matter, beyond those of one mode:
* the state handed from zone to zone is z, which no step of p changes; contact works on the overstress f, which stays
  finite for a branch without spring, and whose decay is independent of every other branch;
* what contact changes in z is the change of the dashpot displacements e, shared out: slow modes change little, and that
  little is not a difference of large terms;
* every weight is positive, so that sums over modes do not cancel where the modes agree.
"""

import sympy as sp

from .. import stable
from ..functions import (
    Formula,
    decay,
    decay_loss,
    decay_mean,
    decay_rate,
    divisible,
    expm1,
    hypot,
    loss_mean,
    per_time,
    sine_deficit,
    versine,
)
from ..stable import (
    AHEAD,
    HALVES,
    PROFILE,
    PROFILE_RISE,
    PROFILE_SLOPE,
    UNIT,
    WIDTH,
    alpha_unit,
    amplitude,
    cos_ahead,
    half,
    lag,
    level,
    middle,
    sin_ahead,
    unit,
    width,
)
from ..symbols import D, alpha, beta, p, p_0, p_in, s, s_0, s_1
from .symbols import J_0, J, S, across, back, enter, eta, f, f_0, m, sandwich, share, total, z, z_0

response, time, rates, moved, rate_end = sp.symbols("response time rates moved rate_end", real=True)
harmonic, transient, fading, kept, creep, creep_end, creep_start, lost = sp.symbols(
    "harmonic transient fading kept creep creep_end creep_start lost", real=True
)
decayed, lapsed, stiff, lossy = sp.symbols("decayed lapsed stiff lossy", real=True)

_response = (UNIT[0], (response, eta * unit**2))


def _field(phase: sp.Symbol) -> sp.Expr:
    """Overstress of a branch in complete contact."""
    return response * (alpha * sp.cos(phase) - sp.sin(phase))


def _fall(phase: sp.Symbol) -> sp.Expr:
    """How fast that falls."""
    return response * (alpha * sp.sin(phase) + sp.cos(phase))


# -- states ------------------------------------------------------------------------------------------------------------

DISPLACEMENT = Formula("displacement", (z, p, m), J_0 * p + total(z))
OVERSTRESS = Formula("overstress", (z, p, m), -across(enter, z - J * p))
DASHPOTS = Formula("dashpots", (z, p, m), J_0 * p + total(z) + S * across(enter, z - J * p))

# -- adhesion and free gap: constant pressure --------------------------------------------------------------------------

_gap_zone = (s_0, s_1, z_0, p, m)
RELAXATION_INCREMENT = Formula("relaxation_increment", _gap_zone, (z_0 - J * p) * decay_loss(s_1 - s_0, beta))
RELAXATION_INTEGRAL = Formula(
    "relaxation_integral",
    _gap_zone,
    width * (J_0 * p + total(z_0 * decay_mean(width, beta) + J * p * loss_mean(width, beta))),
    (WIDTH,),
)
GAP_AFTER = Formula(
    "gap_after",
    (s_0, s_1, z_0, p, D, m),
    J_0 * p + total(z_0 * decay(width, beta) - J * p * decay_loss(width, beta)) - PROFILE(s_1, D),
    (WIDTH,),
)
GAP_CHANGE = Formula("gap_change", _gap_zone, total((z_0 - J * p) * decay_loss(s_1 - s_0, beta)) - PROFILE_RISE(s_0, s_1))
RELAXATION_MAP = Formula("relaxation_map", (s_0, s_1, p, m), (-lost, -J * p * lost), ((lost, decay_loss(s_1 - s_0, beta)),))
RELAXATION_PASSAGE = Formula(
    "relaxation_passage",
    _gap_zone,
    (
        lag * lost,
        rates,
        -rates,
        total(lag * lost) - PROFILE_RISE(s_0, s_1),
        lost,
        total(rates) + PROFILE_SLOPE(s_0),
        -total(rates) - PROFILE_SLOPE(s_1),
    ),
    (WIDTH, (lag, z_0 - J * p), (lost, decay_loss(width, beta)), (rates, lag * decay_rate(width, beta))),
)
GAP_ENTRY = Formula(
    "gap_entry",
    (s_0, z_0, p, D, m),
    (s_0, D - p, amplitude, divisible(beta), per_time(amplitude, beta)),
    ((amplitude, z_0 - J * p),),
)
GAP_EVENT = Formula(
    "gap_event",
    (s_1, s_0, level, amplitude, time, rates),
    (total(amplitude * decayed) + versine(s_1) - level, sp.sin(s_1) - total(rates * decayed)),
    ((decayed, sp.exp((s_0 - s_1) / time)),),
)

# -- contact: w = u ----------------------------------------------------------------------------------------------------

_contact_zone = (s_0, s_1, f_0, m)
SATURATED_OVERSTRESS = Formula("saturated_overstress", (s, m), _field(s), _response)
_rise = (moved, -2 * sp.sin(half) * _fall(middle))
_end = (harmonic, _field(s_1))
OVERSTRESS_AFTER = Formula(
    "overstress_after",
    _contact_zone,
    (f_0 + moved) * decay(width, alpha) - harmonic * decay_loss(width, alpha),
    (WIDTH, *HALVES, *_response, _rise, _end),
)
CONTACT_PRESSURE = Formula("contact_pressure", (s, f, D), PROFILE(s, D) + total(f))
EXCESS_CHANGE = Formula(
    "excess_change",
    _contact_zone,
    PROFILE_RISE(s_0, s_1)
    + total(f_0 * decay_loss(width, alpha) + moved * decay(width, alpha) - harmonic * decay_loss(width, alpha)),
    (WIDTH, *HALVES, *_response, _rise, _end),
)
_creep = (  # change of e over a contact entered without overstress
    creep,
    unit * (sin_ahead * (width * loss_mean(width, alpha) - sine_deficit(width)) - cos_ahead * versine(width)),
)
CONTACT_INCREMENT = Formula(
    "contact_increment",
    _contact_zone,
    across(share, creep - S * f_0 * decay_loss(width, alpha)),
    (WIDTH, *AHEAD, _creep),
)
CONTACT_MAP = Formula(
    "contact_map",
    (s_0, s_1, p_in, m),
    (-sandwich(share, lost, enter), across(share, creep - lost * across(enter, J) * p_in)),
    (WIDTH, *AHEAD, _creep, (lost, S * decay_loss(width, alpha))),
)
CONTACT_PASSAGE = Formula(
    "contact_passage",
    (s_0, s_1, z_0, p_in, m),
    (
        across(share, creep - S * f_0 * lost),
        across(share, creep_start - fading),
        across(share, creep_end + fading),
        PROFILE_RISE(s_0, s_1) + total(f_0 * lost + moved * kept - harmonic * lost),
        -back(enter, lost),
        total(transient + eta * unit * cos_ahead * kept) - PROFILE_SLOPE(s_0),
        PROFILE_SLOPE(s_1) - total(transient + _fall(s_1)),
    ),
    (
        WIDTH,
        *HALVES,
        *AHEAD,
        _response[1],
        (f_0, OVERSTRESS(z_0, p_in, m)),
        (lost, decay_loss(width, alpha)),
        (kept, decay(width, alpha)),
        (rate_end, per_time(kept, alpha)),
        (fading, S * f_0 * rate_end),
        _creep,
        (creep_end, -unit * (sin_ahead * (lost + versine(width)) + cos_ahead * sp.sin(width))),
        (creep_start, unit * lost * (sin_ahead - alpha * cos_ahead)),
        _rise,
        _end,
        (transient, (f_0 - eta * unit * sin_ahead) * rate_end),
    ),
)
EXCESS_ENTRY = Formula(
    "excess_entry",
    (s_0, f_0, p_0, D, m),
    (
        s_0,
        D + p_0,
        total(response * alpha),
        total(response),
        f_0,
        _field(s_0),
        divisible(alpha),
        per_time(f_0 - _field(s_0), alpha),
    ),
    _response,
)
EXCESS_EVENT = Formula(
    "excess_event",
    (s_1, s_0, level, stiff, lossy, f_0, harmonic, time, rates),
    (
        level
        - versine(s_1)
        - 2 * (stiff * sp.sin(middle) + lossy * sp.cos(middle)) * sp.sin(half)
        + total(f_0 * decayed - harmonic * lapsed),
        -sp.sin(s_1) - stiff * sp.sin(s_1) - lossy * sp.cos(s_1) - total(rates * decayed),
    ),
    (*HALVES, (decayed, sp.exp((s_0 - s_1) / time)), (lapsed, expm1((s_0 - s_1) / time))),
)

# -- work of the contact pressure on the profile: the sums of one mode, per branch -------------------------------------

_work = [step for step in stable.CONTACT_WORK.steps if step[0] != stable.lost_sin]
_of_branch = f_0 * (sp.sin(s_0) * stable.kept_cos + sp.cos(s_0) * stable.kept_sin) + response * (
    stable.ramp_work + sp.sin(s_0) * sp.sin(s_1) * stable.ramp
)
CONTACT_WORK = Formula(
    "contact_work",
    (s_0, s_1, f_0, D, m),
    stable.rise * (PROFILE(s_0, D) + PROFILE(s_1, D)) / 2 - total(_of_branch),
    (*_work, _response[1]),
)

# -- complete contact --------------------------------------------------------------------------------------------------

STORAGE = Formula("storage", (m,), 1 + total(eta * unit * alpha_unit), UNIT)
LOSS = Formula("loss", (m,), total(eta * unit**2), UNIT[:1])
MODULUS_RATIO = Formula("modulus_ratio", (m,), hypot(1 + total(eta * unit * alpha_unit), total(eta * unit**2)), UNIT)
SATURATED_PRESSURE = Formula("saturated_pressure", (s, D, m), PROFILE(s, D) + total(_field(s)), _response)
