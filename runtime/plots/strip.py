"""Pressure, gap and rigid profile of one strip over a period, and what rubs in it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from .legend import legend_above
from .style import COLUMN, DASHES, OKABE_ITO, stacked, styled
from .units import length, unit_for

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..strip_solution import StripSolution
    from ..typing import Floats


@styled
def strip_fields(strip: StripSolution, points: int = 1001) -> Figure:
    """Draw a single strip at ``points`` places: pressure above, foundation and profile below, contact shaded.

    Raises ``InputError`` for a solution of several strips.
    """
    return _draw(strip, points, None, "")


@styled
def strip_stresses(strip: StripSolution, x: Floats, stresses: Sequence[Floats], title: str) -> Figure:
    """The same, and the tangential stress along the strip (Fig. 5), Pa: ``stresses`` of level 1 and of those below at ``x``."""
    return _draw(strip, x.size, stresses, title)


def _draw(strip: StripSolution, points: int, stresses: Sequence[Floats] | None, title: str) -> Figure:
    if np.size(strip.p_mean) != 1:
        raise InputError("strip", f"{np.size(strip.p_mean)} strips", "a solution of one strip")
    period = float(np.ravel(strip.wavelength)[0])
    x = np.linspace(-0.5, 0.5, points) * period
    p, w, gap = (np.ravel(each(x)) for each in (strip.pressure, strip.displacement, strip.gap))
    panels = stacked(2 if stresses is None else 3, COLUMN, (1.2 if stresses is None else 1.56) * COLUMN)
    share = x / period
    _pressure(panels[0], share, p)
    heights = np.ptp(w), np.ptp(w - gap)
    factor, unit = unit_for("m", heights if any(heights) else w)
    # positive displacement goes into the foundation: drawn downwards, the profile lies above it
    panels[1].plot(share, -(w - gap) / factor, color=OKABE_ITO[1], linestyle=DASHES[0], label="rigid profile")
    panels[1].plot(share, -w / factor, color="black", label="foundation")
    panels[1].set_ylabel(f"height ({unit})")
    if stresses is not None:
        _stresses(panels[2], share, stresses)
    for panel in panels:
        low, high = panel.get_ylim()
        panel.fill_between(share, low, high, where=gap <= 0, color="0.9", linewidth=0, zorder=-1, label="contact")
        panel.set_ylim(low, high)
    panels[-1].set_xlabel(f"$x/l$, $l$ = {length(period)} (sliding towards $+x$)")
    panels[-1].set_xlim(-0.5, 0.5)
    if title:
        panels[0].set_title(title, fontsize=7)
    figure: Figure = panels[0].figure
    figure.align_ylabels()
    found = dict(zip(*reversed(panels[1].get_legend_handles_labels()), strict=True))
    if stresses is not None and len(stresses) > 1:
        found |= dict(zip(*reversed(panels[2].get_legend_handles_labels()), strict=True))
    legend_above(figure, list(found.values()), list(found))
    return figure


def _pressure(panel: Any, share: np.ndarray, p: np.ndarray) -> None:
    factor, unit = unit_for("Pa", p)
    panel.plot(share, p / factor, color="black")
    panel.axhline(0, color="0.6", linewidth=0.5, zorder=0)
    panel.set_ylabel(f"pressure ({unit})")


def _stresses(panel: Any, share: np.ndarray, stresses: Sequence[Floats]) -> None:
    factor, unit = unit_for("Pa", *stresses)
    looks = ((OKABE_ITO[0], "-", "stress of level 1"), (OKABE_ITO[2], DASHES[1], "stress of the levels below"))
    for stress, (color, dash, label) in zip(stresses, looks, strict=False):
        panel.plot(share, stress / factor, color=color, linestyle=dash, label=label)
    panel.axhline(0, color="0.6", linewidth=0.5, zorder=0)
    panel.set_ylabel(f"tangential stress ({unit})")
