"""Friction coefficient over sliding velocity, with what every level contributes."""

from __future__ import annotations

from typing import Any

import numpy as np

from hystrip.plots.style import COLUMN, DASHES, OKABE_ITO, axes, styled
from hystrip.tables import friction_rows

_PREFIXES = ((1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm"))


@styled
def friction_over_velocity(scene: Any, result: Any) -> Any:
    """Draw mu over log velocity: the total in black, every level's part in colour.

    Parameters
    ----------
    scene : the :class:`hystrip.scene.Scene` that was solved, with at least two velocities
    result : what its ``solve`` returned. With several loads one panel is drawn for each of at most six of them.

    Returns
    -------
    matplotlib Figure
    """
    columns = friction_rows(scene, result)
    load_name, load = scene.load
    loads = np.atleast_1d(load)
    shown = np.unique(np.linspace(0, loads.size - 1, min(loads.size, 6)).round().astype(int))
    first = axes(COLUMN, (0.68 * shown.size + 0.1) * COLUMN)
    figure = first.figure
    first.remove()
    panels = figure.subplots(shown.size, 1, sharex=True, squeeze=False)[:, 0]
    table = {name: values.reshape(loads.size, -1) for name, values in columns.items()}
    for panel, row in zip(panels, shown, strict=True):
        _panel(panel, scene, {name: values[row] for name, values in table.items()})
        if loads.size > 1:
            panel.set_title(f"{load_name} {loads[row]:.4g} {'Pa' if load_name == 'pressure' else 'm'}", fontsize=7)
    panels[0].legend(loc="best", handlelength=2.6)
    panels[-1].set_xlabel("sliding velocity $V$ (m/s)")
    return figure


def _panel(panel: Any, scene: Any, columns: dict[str, np.ndarray]) -> None:
    order = np.argsort(columns["velocity [m/s]"], kind="stable")
    velocity = columns["velocity [m/s]"][order]
    panel.plot(velocity, columns["mu"][order], color="black", label="total", zorder=3)
    if len(scene.levels) > 1:
        for index, level in enumerate(scene.levels):
            panel.plot(
                velocity,
                columns[f"mu of level {index + 1}"][order],
                color=OKABE_ITO[index % len(OKABE_ITO)],
                linestyle=DASHES[index % len(DASHES)],
                label=f"level {index + 1} ($l$ = {_length(level.l)})",
            )
    panel.set_xscale("log")
    panel.set_xlim(velocity[0], velocity[-1])
    panel.axhline(0, color="0.6", linewidth=0.5, zorder=0)
    panel.set_ylabel(r"friction coefficient $\mu$")


def _length(metres: float) -> str:
    for factor, unit in _PREFIXES:
        if metres >= 0.999 * factor:
            return f"{metres / factor:.4g} {unit}"
    return f"{metres:.3g} m"
