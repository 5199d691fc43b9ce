"""Fig. 7: friction coefficient of three levels in saturated contact over velocity."""

from typing import Any

import numpy as np

from ..plots.style import COLUMN, DASHES, OKABE_ITO, axes, styled


def data() -> dict[str, Any]:
    """Rows of the scene ``paper_fig7``."""
    from ..scene import load_scene
    from ..tables import friction_rows

    return friction_rows(load_scene("paper_fig7").solve())


@styled
def paint(table: dict[str, Any]) -> Any:
    """Total and level parts over log velocity and log friction: the peaks differ by a factor of 20."""
    panel = axes(COLUMN, 0.78 * COLUMN)
    V = table["velocity [m/s]"]
    panel.plot(V, table["mu"], color="black", label="total", zorder=3)
    for level in (1, 2, 3):
        part = table[f"mu of level {level}"]
        color, dash = OKABE_ITO[level - 1], DASHES[level - 1]
        panel.plot(V, part, color=color, linestyle=dash, label=f"level {level}")
        top = int(np.argmax(part))
        panel.plot(V[top], part[top], "v", color=color, markersize=3)
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.set_xlim(V.min(), V.max())
    panel.set_ylim(1e-6, 1e-3)
    panel.set_xlabel("sliding velocity $V$ (m/s)")
    panel.set_ylabel(r"friction coefficient $\mu$")
    panel.legend(loc="best", handlelength=2.6)
    return panel.figure
