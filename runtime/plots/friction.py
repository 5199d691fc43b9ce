"""Friction over sliding velocity or load: the coefficient, the stress, the contact, with what every level adds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..extras import require
from ..tables import parts_of_mu
from .axis import make_logarithmic, over_decades, scale
from .legend import legend_above
from .style import COLUMN, DASHES, OKABE_ITO, stacked, styled
from .units import length, unit_for

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..result import Result

#: panels of a result over velocity, one for each load
_PANELS = 6
#: near zero pressure mu has a pole: the axis shows mu where the pressure is at least this part of the largest; or all of it, if
#: that is no more than so many times as high
_APART, _LITTLE = 0.05, 3.0
#: a logarithmic axis ends at this part of the least total: what a level adds below is not worth decades of it
_FAINT = 1e-3
#: most levels that a legend names; of more it would be larger than the panels, and pairs of colour and dash repeat
_NAMED = 14
#: height of the scale that takes its place [inch]
_SCALE = 0.5
_LOADS = {"pressure": ("nominal pressure $p$", "Pa"), "penetration": ("penetration $D$", "m")}


@dataclass(frozen=True)
class _Quantity:
    """What is drawn: ``label`` and ``unit``, the total if there is one, and every level's."""

    label: str
    unit: str
    total: Callable[[Result], Any] | None
    parts: Callable[[Result], Any] | None


_QUANTITIES = {
    "mu": _Quantity(r"friction coefficient $\mu$", "", lambda r: r.mu, parts_of_mu),
    "tau": _Quantity(r"friction stress $\tau$", "Pa", lambda r: r.tau, lambda r: r.tau_by_level),
    "contact": _Quantity("contact fraction", "", lambda r: r.contact_fraction, lambda r: r.contact_by_level),
    "penetration": _Quantity("penetration $D$", "m", lambda r: r.penetration, None),
    "pressure": _Quantity("nominal pressure $p$", "Pa", lambda r: r.pressure, None),
}


@styled
def friction(result: Result, kind: str | None = None) -> Figure:
    """Draw a result over velocity, one panel for each of at most six loads (of more the legend says so); over the load where
    there is one velocity. Where the load spans decades, so may the values.

    Parameters
    ----------
    result : a :class:`hystrip.Result` at two velocities or loads at least
    kind : ``"mu"``, ``"tau"`` or ``"contact"``, each with every level's part. None: over velocity mu and, for a single load, the
        contact below it; over the load all three and the penetration, one above the other. At p = 0 the line of mu is broken:
        mu has a pole there. So are all lines at pull-off. Circles mark points that did not converge

    Raises ``InputError`` for a single point, which is no curve.
    """
    velocities, loads = np.unique(result.velocity).size, np.unique(getattr(result, result.load)).size
    if velocities * loads < 2:
        points = f"{np.size(result.mu)} point" + "s" * (np.size(result.mu) != 1)
        raise InputError("result", points, "a result of two different points or more: one is no curve")
    if velocities > 1:
        one_load = np.size(result.mu) == np.shape(result.mu)[_axis_of_velocity(result)]
        kinds = [kind] if kind else ["mu", "contact"] if one_load else ["mu"]
        return _over_velocity(result, [_QUANTITIES[each] for each in kinds])
    other = "penetration" if result.load == "pressure" else "pressure"
    return _over_load(result, [_QUANTITIES[each] for each in ([kind] if kind else ["tau", "contact", other, "mu"])])


def _axis_of_velocity(result: Result) -> int:
    """The last axis along which the velocity changes."""
    velocity = np.asarray(result.velocity)
    return max(axis for axis in range(velocity.ndim) if np.ptp(velocity, axis=axis).any())


def _over_velocity(result: Result, quantities: list[_Quantity]) -> Figure:
    """Panels one above the other: of several quantities, for one load; of several loads, for one quantity."""
    axis = _axis_of_velocity(result)
    count = np.shape(result.mu)[axis]
    flat = lambda values: np.moveaxis(values, axis, -1).reshape(-1, count)  # noqa: E731
    velocity, load, pressure, off, sure = map(
        flat, (result.velocity, getattr(result, result.load), result.pressure, result.pulled_off, result.converged)
    )
    rows = len(velocity)
    shown = np.unique(np.linspace(0, rows - 1, min(rows, _PANELS)).round().astype(int))
    places = [(quantity, row) for row in shown for quantity in quantities]
    panels = stacked(len(places), COLUMN, (0.68 * len(places) + 0.1) * COLUMN)
    for panel, (quantity, row) in zip(panels, places, strict=True):
        curves = _curves(result, quantity)
        unit = unit_for(quantity.unit, *(values for values, _, _ in curves))
        order = np.argsort(velocity[row], kind="stable")
        here = [(flat(values)[row][order], style, label) for values, style, label in curves]
        _draw(panel, quantity, velocity[row][order], here, unit, *(each[row][order] for each in (pressure, off, sure)))
        if shown.size > 1 or np.ptp(load[row]):
            factor, name = unit_for(_LOADS[result.load][1], load[row])
            ends = dict.fromkeys(f"{each / factor:.4g}" for each in (load[row].min(), load[row].max()))
            panel.set_title(f"{result.load} {' to '.join(ends)} {name}", fontsize=7)
    if shown.size < rows:
        panels[0].plot([], [], " ", label=f"{shown.size} of {rows} loads are drawn")
    low, high = velocity[shown].min(), velocity[shown].max()
    moving = np.unique(velocity[shown][velocity[shown] > 0])
    scale(panels[-1], low, high, 0 < 10 * low <= high * (1 + 1e-12))
    if low == 0 and over_decades(moving):
        panels[-1].set_xscale("symlog", linthresh=moving[0], linscale=0.5)
    panels[-1].set_xlabel("sliding velocity $V$ (m/s)")
    return _with_legend(panels, result)


def _over_load(result: Result, quantities: list[_Quantity]) -> Figure:
    text, unit = _LOADS[result.load]
    load = np.ravel(getattr(result, result.load))
    order = np.argsort(load, kind="stable")
    load = load[order]
    logarithmic = over_decades(np.unique(load))
    factor, name = (1.0, unit) if logarithmic else unit_for(unit, load)
    height = 0.75 if len(quantities) == 1 else 0.5 * len(quantities) + 0.1
    panels = stacked(len(quantities), COLUMN, height * COLUMN)
    of_points = [np.ravel(values)[order] for values in (result.pressure, result.pulled_off, result.converged)]
    for panel, quantity in zip(panels, quantities, strict=True):
        curves = [(np.ravel(values)[order], style, label) for values, style, label in _curves(result, quantity)]
        drawn = unit_for(quantity.unit, *(values for values, _, _ in curves))
        total = np.sort(curves[0][0][np.isfinite(curves[0][0])])
        spans = logarithmic and over_decades(total) and not any((values < 0).any() for values, _, _ in curves)
        if spans:
            make_logarithmic(panel, "y", total[0], total[-1])
        _draw(panel, quantity, load / factor, curves, drawn, *of_points)
        if spans:
            low, high = panel.get_ylim()
            panel.set_ylim(max(low, _FAINT * total[0] / drawn[0]), min(high, 2 * total[-1] / drawn[0]))
        if load[0] < 0 < load[-1]:
            panel.axvline(0, color="0.75", linewidth=0.5, zorder=0)
    scale(panels[-1], load[0] / factor, load[-1] / factor, logarithmic)
    panels[-1].set_xlabel(f"{text} ({name})")
    return _with_legend(panels, result)


def _curves(result: Result, quantity: _Quantity) -> list[tuple[np.ndarray, dict[str, Any], str]]:
    """Values, style and label of every line."""
    curves: list[tuple[np.ndarray, dict[str, Any], str]] = []
    if quantity.parts is not None and len(result.levels) > 1:
        colours = _colours(len(result.levels))
        for index, (level, part) in enumerate(zip(result.levels, quantity.parts(result), strict=True)):
            style, label = {"color": colours[index]}, f"_level {index + 1}"  # in no legend
            if len(colours) <= _NAMED:
                style["linestyle"] = DASHES[index % len(DASHES)]
                label = f"level {index + 1} ($l$ = {length(level.l)})"
            curves.append((np.asarray(part), style, label))
    if quantity.total is not None:
        curves.insert(0, (np.asarray(quantity.total(result)), {"color": "black", "zorder": 3}, "total"))
    return curves


def _colours(levels: int) -> list[Any]:
    """A colour for each level: of the palette, or of a scale from the first to the last of many."""
    if levels <= _NAMED:
        return [OKABE_ITO[index % len(OKABE_ITO)] for index in range(levels)]
    return list(require("matplotlib", "plot", "drawing").colormaps["viridis_r"](np.linspace(0.15, 1, levels)))


def limits_apart_from_the_pole(pressure: np.ndarray, curves: list[np.ndarray]) -> tuple[float, float]:
    """Limits of y without what the pole at zero pressure makes huge."""
    far = np.abs(pressure) >= _APART * np.abs(pressure).max()
    ends = []
    for shown in (far, np.full(far.shape, True)):
        seen = np.concatenate([values[shown & np.isfinite(values)] for values in curves])
        ends.append((min(seen.min(), 0.0), max(seen.max(), 0.0)) if seen.size else (0.0, 1.0))
    low, high = ends[1] if np.ptp(ends[1]) <= _LITTLE * np.ptp(ends[0]) else ends[0]
    margin = 0.05 * (high - low) or 1.0
    return low - margin, high + margin


def _changes(values: np.ndarray) -> np.ndarray:
    """Places in the list at which a value differs from the one before."""
    return np.flatnonzero(values[1:] != values[:-1]) + 1


def _draw(
    panel: Any, quantity: _Quantity, x: np.ndarray, curves: Any, unit: tuple[float, str],
    pressure: np.ndarray, off: np.ndarray, sure: np.ndarray,
) -> None:  # fmt: skip
    """Curves over ascending x, at which the pressure is ``pressure``, the surface pulled off where ``off`` says so, and which has
    converged where it is ``sure``."""
    pole = quantity is _QUANTITIES["mu"] and pressure.min() <= 0
    if pole:
        panel.set_ylim(*limits_apart_from_the_pole(pressure, [values / unit[0] for values, _, _ in curves]))
    doubtful, there = x[~sure], np.asarray(curves[0][0], float)[~sure] / unit[0]
    # no line through the pole, nor across the jump at pull-off
    at = np.union1d(_changes(off), _changes(np.sign(pressure)) if pole else []).astype(int)
    x = np.insert(x, at, np.nan)
    for values, style, label in curves:
        y = np.insert(np.asarray(values, float), at, np.nan) / unit[0]
        panel.plot(x, y, label=label, **style)
        seen = np.pad(np.isfinite(x + y), 1)
        alone = seen[1:-1] & ~seen[:-2] & ~seen[2:]  # of such a point no line would be drawn
        if alone.any():
            panel.plot(x[alone], y[alone], **style | {"marker": ".", "linestyle": "none"})
    if doubtful.size:
        panel.plot(doubtful, there, "o", markersize=4, markerfacecolor="none", color="black", zorder=4, label="not converged")
    undefined = pole and not pressure.any()
    if undefined or off.all():
        said = "$\\mu$ is not defined at zero pressure" if undefined else "pulled off: no contact"
        panel.text(0.5, 0.55, said, ha="center", va="bottom", transform=panel.transAxes)
    if off.all() and quantity is _QUANTITIES["contact"]:
        panel.set_ylim(-0.05, 1.05)
    if panel.get_yscale() == "linear":
        panel.axhline(0, color="0.6", linewidth=0.5, zorder=0)
    panel.set_ylabel(quantity.label + (f" ({unit[1]})" if unit[1] else ""))


def _with_legend(panels: Any, result: Result) -> Figure:
    handles, labels = panels[0].get_legend_handles_labels()
    figure: Figure = panels[0].figure
    figure.align_ylabels()
    many = len(result.levels) > _NAMED
    if many:
        _with_scale(panels, result)
    if many or len(handles) > 1:
        legend_above(figure, handles, labels)
    return figure


def _with_scale(panels: Any, result: Result) -> None:
    """Put a scale of the levels' colours above the panels, which keep their height."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    count, figure = len(result.levels), panels[0].figure
    scale = ScalarMappable(Normalize(0.5, count + 0.5), ListedColormap(_colours(count)))
    figure.set_figheight(figure.get_figheight() + _SCALE)
    bar = figure.colorbar(scale, ax=panels, location="top", aspect=40, label="level, and its wavelength $l$")
    ticks = np.linspace(1, count, 4).round().astype(int)
    bar.set_ticks(ticks, labels=[f"{each}\n{length(result.levels[each - 1].l)}" for each in ticks])
    bar.ax.minorticks_off()
    bar.ax.tick_params(which="both", length=0)
