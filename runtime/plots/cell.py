"""The contact of a level over its cell."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .legend import legend_above
from .style import COLUMN, DASHES, axes, styled
from .units import length, pressure, unit_for

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..contact_map import ContactMap

#: a pressure that varies by less than this part of the largest has one colour
_ONE_COLOUR = 0.03
#: and by less than this is even: what is left is rounding
_ROUNDING = 1e-12


@styled
def contact_map(cell: ContactMap) -> Figure:
    """Draw a :class:`hystrip.contact_map.ContactMap`: the pressure in colours, contact and adhesion outlined.

    Where it hardly varies, a text says by how much: it has one colour.
    """
    from matplotlib.lines import Line2D

    l = cell.cell.level.l  # noqa: E741 - the paper's symbol
    factor, unit = unit_for("Pa", cell.pressure)
    p = cell.pressure / factor
    panel = axes(COLUMN, 0.85 * COLUMN)
    reach = np.abs(p).max() or 1.0
    mesh = panel.pcolormesh(cell.x / l, cell.y / l, p, cmap="PuOr_r", vmin=-reach, vmax=reach, shading="gouraud", rasterized=True)
    spread = np.ptp(cell.pressure)
    if spread < _ONE_COLOUR * factor * reach:
        said = f"within {pressure(spread)}" if spread > _ROUNDING * factor * reach else "everywhere"
        panel.text(0, 0, f"the same pressure\n{said}", ha="center", va="center", color="white" if p.any() else "black")
    outlines = []
    engaged = cell.contact | cell.adhesion
    for zone, border, style, label in (
        (cell.contact, cell.contact, "-", "contact"),
        (cell.adhesion, engaged, DASHES[1], "adhesion"),
    ):
        if border.any() and not border.all():
            panel.contour(cell.x / l, cell.y / l, border.astype(float), [0.5], colors="black", linestyles=[style], linewidths=0.8)
        if zone.any():
            text = f"{label} everywhere" if zone.all() else label
            outlines.append(Line2D([], [], color="black", linestyle=style, linewidth=0.8, label=text))
    panel.set_xlim(-0.5, 0.5)
    panel.set_ylim(-0.5, 0.5)
    bar = panel.figure.colorbar(mesh, ax=panel, label=f"pressure ({unit})", fraction=0.05)
    low, high = min(p.min(), 0.0), max(p.max(), 0.0)
    bar.ax.set_ylim(low, high if high > low else low + reach)
    bar.ax.tick_params(labelsize=7)
    panel.set_aspect("equal")
    panel.set_title(cell.cell.pressed(pressure(cell.cell.mean_pressure)).replace(", ", ",\n"), fontsize=7)
    panel.set_xlabel(f"$x/l$, $l$ = {length(l)} (sliding towards $+x$)")
    panel.set_ylabel("$y/l$")
    figure: Figure = panel.figure
    figure.set_layout_engine("compressed")  # the other one cuts labels beside a panel of fixed aspect
    if outlines:
        legend_above(figure, outlines, [str(each.get_label()) for each in outlines])
    return figure
