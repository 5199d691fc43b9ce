"""A master curve: what was measured at each temperature, where it was shifted to, and the shift factors."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..extras import require
from .style import COLUMN, OKABE_ITO, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..dma.master import MasterCurve


@styled
def master_curve(found: MasterCurve) -> Figure:
    """Draw a :class:`hystrip.dma.MasterCurve`: the isotherms, the curve they make, and log a_T over temperature with its law."""
    figure = require("matplotlib.figure", "plot", "drawing").Figure(figsize=(COLUMN, 2.1 * COLUMN), layout="constrained")
    raw, master, factors = figure.subplots(3, 1, gridspec_kw={"height_ratios": (1, 1, 0.75)})
    colours = require("matplotlib", "plot", "drawing").colormaps["cividis"](np.linspace(0, 0.92, len(found.isotherms)))
    mark = {"linestyle": "none", "markersize": 2.2, "markeredgewidth": 0.6}
    for colour, each, a, b in zip(colours, found.isotherms, found.a_T, found.b_T, strict=True):
        for panel, at in ((raw, each), (master, each.shifted(a, b))):
            panel.loglog(at.frequency, at.storage, marker="o", color=colour, **mark)
            panel.loglog(at.frequency, at.loss, marker="^", markerfacecolor="none", color=colour, **mark)
    kind = found.data.kind
    for panel, title in ((raw, "measured"), (master, f"master curve at {found.T_ref - 273.15:.1f} °C")):
        of_b_T = "/b_T" if panel is master and found.shift.vertical else ""
        panel.set_ylabel(f"modulus ${kind}{of_b_T}$ (Pa)")
        panel.set_xlabel("frequency $f$ (Hz)" if panel is raw else "reduced frequency $a_T f$ (Hz)")
        panel.set_title(title, fontsize=8)
    raw.plot([], [], "o", color="0.3", label=f"storage ${kind}'$", **mark)
    raw.plot([], [], "^", color="0.3", markerfacecolor="none", label=f"loss ${kind}''$", **mark)
    # lines of two colours stand for the coldest and the hottest isotherm
    for index in (0, -1):
        raw.plot([], [], color=colours[index], label=f"{found.temperatures[index] - 273.15:.0f} °C")
    raw.legend(loc="best", ncols=2)
    T = np.linspace(found.temperatures[0], found.temperatures[-1], 200)
    factors.plot(T - 273.15, np.log10(found.shift.factor(T)), color=OKABE_ITO[0], label=type(found.shift).__name__)
    factors.plot(
        found.temperatures - 273.15, np.log10(found.a_T), "ko", markersize=3, markerfacecolor="none", label="shift factors"
    )
    factors.set_xlabel("temperature (°C)")
    factors.set_ylabel("$\\log_{10}\\, a_T$")
    factors.legend(loc="best")
    return figure
