"""Friction coefficient over sliding velocity or load, with what every level contributes."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InputError
from ..tables import LOAD_UNITS, parts_of_mu
from .style import COLUMN, DASHES, OKABE_ITO, length, stacked, styled

_PANELS = 6
LOAD_LABELS = {"pressure": "nominal pressure $p$ (Pa)", "penetration": "penetration $D$ (m)"}


@styled
def friction(result: Any) -> Any:
    """Draw mu with every level's part: over log velocity, one panel for each of at most six loads; over the load where
    there is a single velocity.

    Parameters
    ----------
    result : a :class:`hystrip.Result` with at least two points

    Returns
    -------
    matplotlib Figure
    """
    shape = np.shape(result.mu)
    if np.size(result.mu) < 2:
        raise InputError("result", f"{np.size(result.mu)} point", "a result of two points or more: one point is no curve")
    load = np.asarray(getattr(result, result.load))
    over_velocity = np.unique(result.velocity).size > 1
    # one curve for each row; rows differ in the load
    flat = (lambda v: np.reshape(v, (-1, shape[-1]))) if over_velocity and len(shape) > 1 else (lambda v: np.reshape(v, (1, -1)))
    velocity, load, mu = flat(result.velocity), flat(load), flat(result.mu)
    parts = [flat(part) for part in parts_of_mu(result)]
    rows = np.unique(np.linspace(0, len(mu) - 1, min(len(mu), _PANELS)).round().astype(int))
    panels = stacked(rows.size, COLUMN, (0.68 * rows.size + 0.1) * COLUMN)
    figure = panels[0].figure
    for panel, row in zip(panels, rows, strict=True):
        x = velocity[row] if over_velocity else load[row]
        _panel(panel, result.levels, x, mu[row], [part[row] for part in parts])
        if rows.size > 1:
            panel.set_title(f"{result.load} {load[row][0]:.4g} {LOAD_UNITS[result.load]}", fontsize=7)
        if over_velocity and x.min() > 0:
            panel.set_xscale("log")
    if len(result.levels) > 1:
        handles, labels = panels[0].get_legend_handles_labels()
        figure.legend(
            handles, labels, loc="outside upper center", ncols=min(3, len(handles)), handlelength=2.2, columnspacing=1.0
        )
    panels[-1].set_xlabel("sliding velocity $V$ (m/s)" if over_velocity else LOAD_LABELS[result.load])
    return figure


def _panel(panel: Any, levels: Any, x: np.ndarray, mu: np.ndarray, parts: list[np.ndarray]) -> None:
    order = np.argsort(x, kind="stable")
    panel.plot(x[order], mu[order], color="black", label="total", zorder=3)
    if len(levels) > 1:
        for index, (level, part) in enumerate(zip(levels, parts, strict=True)):
            panel.plot(
                x[order],
                part[order],
                color=OKABE_ITO[index % len(OKABE_ITO)],
                linestyle=DASHES[index % len(DASHES)],
                label=f"level {index + 1} ($l$ = {length(level.l)})",
            )
    panel.set_xlim(x[order][0], x[order][-1])
    panel.axhline(0, color="0.6", linewidth=0.5, zorder=0)
    panel.set_ylabel(r"friction coefficient $\mu$")
