"""Where the friction of a result comes from, in words."""

import warnings
from typing import Any

import numpy as np

from .display import model_name, percent, span
from .inputs.half_space import HalfSpace
from .inputs.materials import parameters
from .orbit.foundation import Foundation, foundation_of
from .plausibility import excited
from .tables import over_strips, shares

#: relaxation times that are listed one by one
_SHOWN = 3
#: what stands above shares of regimes: of 351 levels 99 of 100 were known to 1 % of the whole, the worst to 2.6 %
_REGIMES = "regimes of strips (shares mostly within 1 % of the whole):"


def summary(result: Any) -> str:
    """Text about a :class:`hystrip.Result`: the levels, the friction, what every level adds, and what was skipped."""
    return "\n".join(
        [*_inputs(result), "", *_levels(result), "", *_friction(result), *_contact(result), *_closer(result), *_work(result)]
    )


def deborah(result: Any) -> np.ndarray:
    """Deborah number ``k V T_eps`` of every level, (levels, ...): longest retardation time over that of a slide by ``1/k``."""
    k = np.array([level.k for level in result.levels])
    return np.multiply.outer(k, np.asarray(result.velocity)) * _foundation(result).longest_time


def peak_velocities(result: Any) -> np.ndarray:
    """Velocity, m/s, at which each level rubs most in saturated contact: ``Im K*(kV)`` is greatest; inf for ``T_sigma = 0``."""
    return np.array([level.l for level in result.levels]) / (2 * np.pi) * _foundation(result).lossiest_rate


def _foundation(result: Any) -> Foundation:
    """That of level 1: those of other levels have the same times."""
    return foundation_of(result.material.at_wavelength(result.levels[0].l))


def _inputs(result: Any) -> list[str]:
    m, a = result.material, result.adhesion
    known = excited(m, result.levels, result.velocity)
    sticky = f"gamma = {a.gamma:.4g} J/m^2, delta_0 = {a.delta_0:.4g} m, p_0 = {a.p_0:.4g} Pa" if a.p_0 > 0 else "none"
    shift = getattr(m, "shift", None)  # a material at a temperature has none
    at = f", as at T_ref = {shift.T_ref:.5g} K" if shift else ""
    at = at if result.temperature is None else f", at {result.temperature:.5g} K"
    given = f"penetration {span(result.penetration, 'm')}, " if result.load == "penetration" else ""
    at_load = f"{given}pressure {span(result.pressure, 'Pa')}"
    return [
        f"material   {model_name(m)}: {_parameters(m)}" + at,
        f"adhesion   {sticky}",
        f"closure    {result.edge}, branch {result.branch}, rtol {result.rtol:g}{over_strips(result.strips)}",
        f"points     {np.size(result.mu)}: {at_load}, velocity {span(result.velocity, 'm/s')}",
        *([f"excited    {known}"] if known else []),
        *(f"note       {note}" for note in result.notes),
    ]


def _parameters(material: Any) -> str:
    """All parameters of a material; of many relaxation times their number and range."""
    given, times = parameters(material), getattr(material, "times", ())
    if len(times) <= _SHOWN:
        return ", ".join(_parameter(*each, material) for each in given.items())
    few = [_parameter(name, value, material) for name, value in given.items() if "[" not in name]
    unit = "Pa" if isinstance(material, HalfSpace) else "Pa/m"
    return ", ".join([*few, f"{len(times)} times {span(times, 's')}, moduli {span(material.moduli, unit)}"])


def _parameter(name: str, value: Any, material: Any) -> str:
    """``K = 1e+09 Pa/m``; the unit of what is not known here is left to the model."""
    modulus = " Pa" if isinstance(material, HalfSpace) else " Pa/m"
    unit = {"K": " Pa/m", "E": " Pa", "moduli": modulus, "T_eps": " s", "T_sigma": " s", "times": " s"}.get(
        name.partition("[")[0], ""
    )
    return f"{name} = {value:.4g}{unit}"


def _levels(result: Any) -> list[str]:
    from .level.saturated import saturated_level

    De, V_peak, part = deborah(result), peak_velocities(result), shares(result)
    V = np.atleast_1d(np.asarray(result.velocity)).ravel()
    head = ["level", "l [m]", "h [m]", "De = k V T_eps", "V of its peak if", "p_sat alone"]
    rows = [[*head, "share of mu", "in contact", "in adhesion"], ["", "", "", "", "saturated [m/s]", "[Pa]", "", "", ""]]
    for i, level in enumerate(result.levels):
        p_sat = saturated_level(result.material, result.adhesion, level, V, result.branch).p_sat
        rows.append([
            str(i + 1), f"{level.l:.4g}", f"{level.h:.4g}", span(De[i]), f"{V_peak[i]:.4g}", span(p_sat),
            percent(part[i]), percent(result.contact_by_level[i]), percent(result.adhesion_by_level[i]),
        ])  # fmt: skip
    widths = [max(len(row[j]) for row in rows) for j in range(len(rows[0]))]
    return ["  ".join(text.rjust(width) for text, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def _friction(result: Any) -> list[str]:
    mu = np.ravel(result.mu)
    out = [f"mu         {span(mu)}"]
    if np.isfinite(mu).sum() > 1:
        top = int(np.nanargmax(np.abs(mu)))
        at = f"V = {np.ravel(result.velocity)[top]:.4g} m/s, p = {np.ravel(result.pressure)[top]:.4g} Pa"
        out.append(
            f"           largest at {at}: level shares " + ", ".join(percent(np.ravel(part)[top]) for part in shares(result))
        )
    error = np.ravel(result.error_estimate)
    error = error[~np.isnan(error)]
    if not error.size:
        return [*out, "error      undefined: " + ("zero pressure" if mu.size else "no points")]
    unknown = ", where the pressure may be zero" if np.isinf(error).any() else ""
    return [*out, f"error      of mu at most {error.max():.1e} (estimate){unknown}"]


def _contact(result: Any) -> list[str]:
    return [
        f"real contact (touching on every level)  {percent(result.contact_fraction)}",
        f"level 1 is saturated from {span(result.p_sat, 'Pa')}{' at the latest' if result.branch == 'loading' else ''}",
        *special_points(result),
    ]


def special_points(result: Any) -> list[str]:
    """How many points have no contact, and how many no mu, in a sentence each; nothing if there are none."""
    at_zero = np.asarray(result.pressure) == 0
    counts = {
        "below pull-off: no contact, tau = 0, nothing to solve": np.count_nonzero(result.pulled_off),
        "at zero pressure, where mu is not defined": np.count_nonzero(at_zero),
    }
    return [f"{count} point{'s lie' if count > 1 else ' lies'} {where}" for where, count in counts.items() if count]


def _closer(result: Any) -> list[str]:
    """Pull-off of level 1 (where it is unloaded to), and the regimes on every level, at the point of largest friction (the first,
    if there is none)."""
    from .at_point import index_of
    from .errors import ConvergenceWarning
    from .level_law import friction_law
    from .regimes_by_level import regimes_by_level

    if not np.size(result.mu):
        return []
    at = index_of(result, None)
    V, p = float(np.ravel(result.velocity)[at]), float(np.ravel(result.pressure)[at])
    ends = ""
    if result.branch == "unloading":
        pull_off, sure, of = 0.0, True, (result.material, result.adhesion, result.levels[0])
        if result.adhesion.p_0 > 0:
            with warnings.catch_warnings():  # nobody asked for this law: what it lacks is said in the text
                warnings.simplefilter("ignore", ConvergenceWarning)
                law = friction_law(*of, V=V, rtol=1e-2, below=0.0, edge=result.edge)
            pull_off, sure = law.pull_off, law.converged
        ends = f"pull-off of level 1 at {pull_off:.4g} Pa{'' if sure else ' (not converged)'}; "
    regimes = regimes_by_level(result, at)
    out = [f"at V = {V:.4g} m/s, p = {p:.4g} Pa: {ends}{_REGIMES if regimes else 'nothing touches'}"]
    for number, each in enumerate(regimes, start=1):
        place = "all the area" if number == 1 else f"the contact of level {number - 1}, {100 * each.area:.3g} % of the area"
        out.append(f"           level {number} ({place}):")
        shares_of = {name: f"{100 * share:.0f}" if share > 5e-3 else "<1" for name, share in each.shares.items()}
        out += [f"           {share:>6} %  {name}" for name, share in shares_of.items()]
    return out


def _work(result: Any) -> list[str]:
    c = result.counts
    decided = c["strips_decided_by_threshold"]
    closed, off = c["points_in_closed_form"], c["points_below_pull_off"]
    return [
        f"work       {c['strips_solved']} strips solved; skipped: {decided} strips by a threshold (saturated or free),",
        f"           {closed} points by the closed form (every level saturated), {off} points below pull-off",
    ]
