"""Pressure and friction of a level over penetration, pressed in and pulled back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .legend import legend_above
from .style import COLUMN, DASHES, OKABE_ITO, stacked, styled
from .units import pressure, unit_for

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..level_solution import LevelSolution
    from ..loop import Loop

#: a step of the pressure over this part of its range between neighbours is a jump: no line
_JUMP = 0.03


@styled
def loading_loop(loop: Loop) -> Figure:
    """Draw a :class:`hystrip.loop.Loop`: mean pressure above, friction below, over penetration; pull-off marked."""
    upper, lower = stacked(2, COLUMN, 1.15 * COLUMN)
    both = (loop.loading, loop.unloading)
    length, metres = unit_for("m", *(each.D for each in both))
    spans = unit_for("Pa", *(each.p_mean for each in both)), unit_for("Pa", *(each.tau_mean for each in both))
    for each, color, dash, label in (
        (loop.unloading, OKABE_ITO[0], "-", "pulled back"),
        (loop.loading, OKABE_ITO[1], DASHES[0], "pressed in"),
    ):
        at = _jumps(each)
        D = np.insert(each.D, at, np.nan) / length
        upper.plot(D, np.insert(each.p_mean, at, np.nan) / spans[0][0], color=color, linestyle=dash, label=label)
        lower.plot(D, np.insert(each.tau_mean, at, np.nan) / spans[1][0], color=color, linestyle=dash)
        for index in at:
            sides = slice(index - 1, index + 1)
            for panel, values, (factor, _) in ((upper, each.p_mean, spans[0]), (lower, each.tau_mean, spans[1])):
                panel.plot(each.D[sides] / length, values[sides] / factor, color=color, linestyle=":", linewidth=0.7)
    if loop.pull_off < 0:
        mark = (loop.pull_off_penetration / length, loop.pull_off / spans[0][0])
        upper.plot(*mark, "o", color="black", markersize=4, zorder=4, label=f"pull-off, {pressure(loop.pull_off)}")
    for panel in (upper, lower):
        panel.axhline(0, color="0.6", linewidth=0.5, zorder=0)
    upper.set_ylabel(f"mean pressure ({spans[0][1]})")
    lower.set_ylabel(f"friction stress ({spans[1][1]})")
    lower.set_xlabel(f"penetration $D$ ({metres})")
    held = np.flatnonzero(loop.unloading.p_mean)  # far below, nothing happens
    first = loop.unloading.D[max(held[0] - 1, 0)] if held.size else loop.unloading.D[0]
    last = loop.unloading.D[-1]
    lower.set_xlim((first - 0.04 * (last - first)) / length, last / length)
    figure: Figure = upper.figure
    figure.align_ylabels()
    legend_above(figure, *upper.get_legend_handles_labels())
    return figure


def _jumps(curve: LevelSolution) -> np.ndarray:
    """Places in the list before which the pressure jumps."""
    return np.flatnonzero(np.abs(np.diff(curve.p_mean)) > _JUMP * np.ptp(curve.p_mean)) + 1
