"""What results look like in a terminal and in a notebook: what was solved, the range of what came out, how well."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING, Any

import numpy as np

from .tables import over_strips

if TYPE_CHECKING:
    from .level_solution import LevelSolution
    from .result import Result
    from .strip_solution import StripSolution
    from .sweeps.run import Sweep

#: heading, and rows of label and text
Shown = tuple[str, list[tuple[str, str]]]


def as_text(shown: Shown) -> str:
    """A few lines."""
    title, rows = shown
    width = max(len(label) for label, _ in rows)
    return "\n".join([title, *(f"  {label.ljust(width)}  {text}" for label, text in rows)])


def as_html(shown: Shown) -> str:
    """A small table."""
    title, rows = shown
    cell = '<td style="text-align:left">{}</td>'
    body = "".join(f"<tr>{cell.format(html.escape(label))}{cell.format(html.escape(text))}</tr>" for label, text in rows)
    return f"<div><strong>{html.escape(title)}</strong><table><tbody>{body}</tbody></table></div>"


def model_name(material: Any) -> str:
    """What the model of a material is called: of a generated one by the name that its file gives it."""
    return repr(material).partition("(")[0]


def of_result(result: Result) -> Shown:
    """A :class:`hystrip.Result`."""
    size, counts = np.size(result.mu), result.counts
    closed, off = counts["points_in_closed_form"], counts["points_below_pull_off"]
    work = f"{counts['strips_solved']} strips solved" if counts["strips_solved"] else "no strip to solve"
    return f"Result: {_count(size, 'point')}, {_count(len(result.levels), 'level')}", [
        ("mu", f"{span(result.mu)}, error at most {_most(result.error_estimate)}{_missed(result)}"),
        *([("penetration", span(result.penetration, "m"))] if result.load == "penetration" else []),
        ("pressure", span(result.pressure, "Pa")),
        ("velocity", span(result.velocity, "m/s")),
        ("real contact", percent(result.contact_fraction)),
        (
            "asked",
            f"{result.branch}, {result.edge}, rtol {result.rtol:g}{over_strips(result.strips)}; {model_name(result.material)}",
        ),
        ("work", f"{work}, {_count(closed, 'point')} in closed form, {off} below pull-off"),
    ]


def of_level(solution: LevelSolution) -> Shown:
    """A :class:`hystrip.LevelSolution`."""
    asked, error = solution.inputs, np.asarray(solution.error_estimate)
    panels = "" if asked.strips is None else f", {asked.strips} equal strips"
    off = int(np.count_nonzero(solution.pulled_off))
    return f"LevelSolution: {_count(np.size(solution.D), 'point')}, l = {asked.level.l:g} m, h = {asked.level.h:g} m", [
        ("pressure", f"{span(solution.p_mean, 'Pa')}, error at most {_most(error[0])} Pa"),
        ("friction", f"{span(solution.tau_mean, 'Pa')}, error at most {_most(error[1])} Pa"),
        ("contact", percent(solution.contact_fraction) + _missed(solution)),
        ("penetration", span(solution.D, "m")),
        ("velocity", span(asked.velocity, "m/s")),
        ("asked", f"{asked.branch}, {asked.edge}, rtol {asked.rtol:g}{panels}; {model_name(asked.material)}"),
        ("work", f"{_count(solution.strips, 'strip')}, {_count(off, 'point')} below pull-off"),
    ]


def of_strips(strips: StripSolution) -> Shown:
    """A :class:`hystrip.StripSolution`."""
    names, counts = np.unique(strips.regime_name.astype(str), return_counts=True)
    order = np.argsort(-counts, kind="stable")
    return f"StripSolution: {_count(strips.p_mean.size, 'strip')}", [
        ("pressure", span(strips.p_mean, "Pa")),
        ("friction", span(strips.tau_mean, "Pa")),
        ("contact", percent(strips.contact_fraction)),
        ("regimes", "; ".join(f"{counts[i]} in {names[i]}" for i in order) or "-"),
        ("asked", f"{strips.branch}, {strips.edge}"),
    ]


def of_sweep(sweep: Sweep) -> Shown:
    """A :class:`hystrip.Sweep`."""
    plan, failed = sweep.plan, len(sweep.failed)
    axes = [f"{axis.name} ({axis.values.size}): {span(axis.values, axis.unit)}" for axis in plan.axes]
    together = "every combination" if plan.combine == "grid" else "taken together"
    return f"Sweep of {plan.name}: {_count(plan.size, 'point')}, {_count(plan.levels, 'level')}", [
        ("over", "; ".join(axes) + (f", {together}" if len(axes) > 1 else "")),
        ("mu", f"{span(sweep.columns['mu'])}, error at most {_most(sweep.columns['error estimate of mu'])}"),
        ("failed", _count(failed, "point") + (f": {next(iter(sweep.failed.values()))}" if failed else "")),
        ("work", f"{sweep.solved} batches solved now, {sweep.kept} from before"),
        ("file", str(sweep.path)),
    ]


def span(values: Any, unit: str = "") -> str:
    """Range of the values that are not NaN; a dash without any."""
    values = np.ravel(values)
    values = values[~np.isnan(values)]
    tail = f" {unit}" if unit not in ("", "1") else ""
    if not values.size:
        return "-"
    digits = 5 if unit == "K" else 4  # 293.15 K
    low, high = f"{values.min():.{digits}g}", f"{values.max():.{digits}g}"
    return (low if low == high else f"{low} .. {high}") + tail


def percent(values: Any) -> str:
    """Range of fractions, in per cent; a dash without any."""
    values = np.ravel(values)
    values = 100 * values[~np.isnan(values)]
    if not values.size:
        return "-"
    low, high = f"{values.min():.3g}", f"{values.max():.3g}"
    return (low if low == high else f"{low} .. {high}") + " %"


def _most(errors: Any) -> str:
    errors = np.ravel(errors)
    errors = errors[~np.isnan(errors)]
    return f"{errors.max():.1e}" if errors.any() else "0" if errors.size else "-"


def _missed(result: Result | LevelSolution) -> str:
    """How many points are not known to be as accurate as asked."""
    missed = int(np.count_nonzero(~result.converged))
    return f"; {_count(missed, 'point')} not as accurate as asked" if missed else ""


def _count(number: int, what: str) -> str:
    return f"{number} {what}" + ("" if number == 1 else "s")
