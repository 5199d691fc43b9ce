"""Friction and real contact of a sweep over what was swept."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .axis import over_decades, scale
from .friction import limits_apart_from_the_pole
from .legend import legend_above
from .style import COLUMN, DASHES, OKABE_ITO, stacked, styled
from .units import unit_for

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..sweeps.plan import Axis
    from ..sweeps.run import Sweep

#: most lines, of more combinations of the other swept quantities
_LINES = 6


@styled
def over_swept(sweep: Sweep) -> Figure:
    """Draw a :class:`hystrip.Sweep` over the swept quantity of most values, the last of them: a line for each of at most six
    combinations of the others (of more the legend says so). Lines end where points failed or are pulled off, those of mu at
    p = 0, where it has a pole; circles mark points that did not converge.
    """
    axes, grid = sweep.plan.axes, sweep.plan.combine == "grid"
    at = max(range(len(axes)), key=lambda n: (np.unique(axes[n].values).size, n))
    count, place = axes[at].values.size, at if grid else 0
    rows = lambda values: np.moveaxis(np.reshape(values, sweep.plan.shape), place, -1).reshape(-1, count)  # noqa: E731
    others = [n for n, axis in enumerate(axes) if grid and n != at and axis.values.size > 1]
    coordinates = sweep.plan.coordinates(np.arange(sweep.plan.size))
    x, label = _values(axes[at], axes[at].values)
    order = np.argsort(x, kind="stable")
    off, sure = (rows(sweep.columns[each]) == 1 for each in ("pulled off", "converged"))
    panels = stacked(2, COLUMN, 1.46 * COLUMN)
    pressure = rows(sweep.columns["pressure [Pa]"])
    shown = np.unique(np.linspace(0, len(off) - 1, min(len(off), _LINES)).round().astype(int))
    for panel, column in zip(panels, ("mu", "contact fraction"), strict=True):
        for number, row in enumerate(shown):
            y = np.where(off[row], np.nan, rows(sweep.columns[column])[row])
            said = ", ".join(_said(axes[n], rows(coordinates[:, n])[row, 0]) for n in others)
            style = {"color": OKABE_ITO[number], "linestyle": DASHES[number % len(DASHES)] if number else "-"}
            p = pressure[row][order]
            at_pole = np.flatnonzero(p[1:] * p[:-1] < 0) + 1 if column == "mu" else []
            line = (np.insert(each[order], at_pole, np.nan) for each in (x, y))
            panel.plot(*line, marker=".", markersize=min(3.0, 90 / count), label=said, **style)
            doubtful = ~sure[row] & np.isfinite(y)
            panel.plot(x[doubtful], y[doubtful], "o", markersize=5, markerfacecolor="none", color="black", zorder=4)
        if column == "mu" and (pressure <= 0).any():
            known = np.isfinite(pressure)
            panel.set_ylim(*limits_apart_from_the_pole(pressure[known], [rows(sweep.columns[column])[known]]))
        reasons = {
            "pulled off: no contact": off.all(),
            "no point could be solved": len(sweep.failed) == sweep.plan.size,
            "$\\mu$ is not defined at zero pressure": column == "mu" and not pressure.any(),
        }
        for said in [text for text, holds in reasons.items() if holds][:1]:
            panel.text(0.5, 0.55, said, ha="center", va="bottom", transform=panel.transAxes)
        panel.axhline(0, color="0.6", linewidth=0.5, zorder=0)
    panels[0].set_ylabel(r"friction coefficient $\mu$")
    panels[1].set_ylabel("contact fraction")
    if x.min() < x.max():
        scale(panels[1], x.min(), x.max(), over_decades(np.unique(x)))
    panels[1].set_xlabel(label)
    figure: Figure = panels[0].figure
    figure.align_ylabels()
    if shown.size < len(off):
        panels[0].plot([], [], " ", label=f"{shown.size} of {len(off)} combinations are drawn")
    handles, labels = panels[0].get_legend_handles_labels()
    if len(handles) > 1:
        legend_above(figure, handles, labels)
    return figure


def _values(axis: Axis, values: np.ndarray) -> tuple[np.ndarray, str]:
    """Values as they are drawn, and the name of what was swept with its unit."""
    if axis.key == "temperature":
        return values - 273.15, "temperature (°C)"
    factor, unit = unit_for(axis.unit, values)
    return values / factor, f"{axis.key} ({unit})" if unit != "1" else axis.key


def _said(axis: Axis, value: float) -> str:
    """A value of a swept quantity in words."""
    drawn, label = _values(axis, np.array(value))
    name, _, unit = label.partition(" (")
    return f"{name} {drawn:.4g} {unit.rstrip(')')}".rstrip()
