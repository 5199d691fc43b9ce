"""Pressure, displacement and rigid profile of one strip over a period."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InputError
from .style import COLUMN, DASHES, OKABE_ITO, stacked, styled


@styled
def strip_fields(strip: Any, points: int = 1001) -> Any:
    """Draw a single strip of a :class:`hystrip.StripSolution`: pressure above, foundation and profile below, contact shaded.

    Returns
    -------
    matplotlib Figure
    """
    if np.size(strip.p_mean) != 1:
        raise InputError("strip", f"{np.size(strip.p_mean)} strips", "a solution of one strip")
    period = 2 * np.pi / float(np.ravel(strip._scales["k"])[0])
    x = np.linspace(-0.5, 0.5, points) * period
    p, w, gap = (np.ravel(each(x)) for each in (strip.pressure, strip.displacement, strip.gap))
    upper, lower = stacked(2, COLUMN, 1.2 * COLUMN)
    share = x / period
    upper.plot(share, p, color="black")
    upper.axhline(0, color="0.6", linewidth=0.5, zorder=0)
    upper.set_ylabel("pressure $p$ (Pa)")
    # positive displacement goes into the foundation: drawn downwards, the profile lies above it
    lower.plot(share, -(w - gap) * 1e9, color=OKABE_ITO[1], linestyle=DASHES[0], label="rigid profile")
    lower.plot(share, -w * 1e9, color="black", label="foundation")
    for panel in (upper, lower):
        low, high = panel.get_ylim()
        panel.fill_between(share, low, high, where=gap <= 0, color="0.9", linewidth=0, zorder=-1)
        panel.set_ylim(low, high)
    lower.set_ylabel("height (nm)")
    lower.set_xlabel("$x/l$ (sliding towards $+x$)")
    lower.set_xlim(-0.5, 0.5)
    lower.legend(loc="best")
    return upper.figure
