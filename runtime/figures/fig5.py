"""Fig. 5: tangential stress along strips of level 1: its own, and what level 2 adds in its contact.

The paper shows strips 0 and 63 and calls the latter saturated. With the energy of adhesion that its text gives the
first saturated strip is a later one, so that one is drawn too.
"""

from typing import Any

import numpy as np

from ..plots.style import COLUMN, DASHES, OKABE_ITO, stacked, styled
from .fig4 import state, strips_at

_STRIPS = (0, 63)  # the paper's
_N = 100  # the paper's strips in half a cell
_X = 1201


def data() -> dict[str, Any]:
    """Stress over x in the paper's strips and in the first saturated one, by level, with the regime of the strip."""
    import hystrip

    scene, D = state()
    level = scene.levels[0]
    all_theta = (np.arange(_N) + 0.5) * np.pi / _N
    saturated = np.flatnonzero(strips_at(scene, D, all_theta).regime == "c")
    shown = [*_STRIPS, *saturated[:1]]
    theta = all_theta[shown]
    x = np.linspace(-0.5, 0.5, _X) * level.l
    strips = strips_at(scene, D, theta[:, None])
    p, gap = strips.fields(x[None, :])
    own = p * level.amplitude(theta)[:, None] * level.k * np.sin(level.k * x)
    law = hystrip.friction_law(
        scene.material, scene.adhesion, scene.levels[1], V=float(scene.velocity), edge=scene.edge, branch=scene.branch, rtol=1e-4
    )
    below = np.where(gap <= 0, law(p), 0.0)
    columns: dict[str, Any] = {
        "strip": np.repeat(np.array(shown, float), _X),
        "regime": [str(name) for name in np.repeat(strips.regime_name.ravel(), _X)],
        "x [m]": np.tile(x, len(shown)),
        "pressure [Pa]": p.ravel(),
        "tangential stress of level 1 [Pa]": own.ravel(),
        "tangential stress of level 2 [Pa]": below.ravel(),
    }
    return columns


@styled
def paint(table: dict[str, Any]) -> Any:
    """One panel for each strip."""
    shown = np.unique(table["strip"])
    panels = stacked(shown.size, COLUMN, 0.6 * shown.size * COLUMN)
    l = np.ptp(table["x [m]"])  # noqa: E741 - the paper's symbol
    for panel, strip in zip(panels, shown, strict=True):
        here = np.flatnonzero(table["strip"] == strip)
        for level in (1, 2):
            stress = table[f"tangential stress of level {level} [Pa]"][here] / 1e3
            panel.plot(
                table["x [m]"][here] / l,
                stress,
                color=OKABE_ITO[level - 1],
                linestyle=("-", DASHES[0])[level - 1],
                label=f"level {level}",
            )
        panel.axhline(0, color="0.7", linewidth=0.5, zorder=0)
        panel.set_title(f"strip {strip:.0f}: {table['regime'][here[0]]}", fontsize=7)
        panel.set_ylabel("tangential stress (kPa)")
    panels[0].legend(loc="best")
    panels[-1].set_xlabel("$x/l_1$ (sliding towards $+x$)")
    panels[-1].set_xlim(-0.5, 0.5)
    return panels[0].figure
