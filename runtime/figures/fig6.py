"""Fig. 6: friction coefficient of the two-level surface over velocity for two energies of adhesion."""

from typing import Any

import numpy as np

from ..plots.style import COLUMN, DASHES, OKABE_ITO, stacked, styled

#: The paper's text gives the smaller energy; the larger is not given, and taken as twice that (N/m).
ENERGIES = (2.5e-5, 5e-5)
_POINTS = 81
_PEAKS = (3e-4, 3e-3, 100)  # m/s: the peaks are sharp


def data() -> dict[str, Any]:
    """Rows of the scene ``paper_fig6`` for both energies, with more velocities about the peaks."""
    import hystrip

    from ..scene import load_scene
    from ..tables import friction_rows

    scene = load_scene("paper_fig6")
    velocity = np.union1d(np.geomspace(scene.velocity.min(), scene.velocity.max(), _POINTS), np.geomspace(*_PEAKS))
    tables = []
    for gamma in ENERGIES:
        adhesion = hystrip.Dugdale(gamma=gamma, delta_0=scene.adhesion.delta_0)
        result = hystrip.solve(
            scene.material, adhesion, scene.levels, pressure=float(scene.pressure), velocity=velocity,
            edge=scene.edge, branch=scene.branch, rtol=scene.rtol,
        )  # fmt: skip
        rows = friction_rows(result)
        tables.append({"gamma [J/m^2]": np.full(rows["mu"].size, gamma), **rows})
    return {name: np.concatenate([table[name] for table in tables]) for name in tables[0]}


@styled
def paint(table: dict[str, Any]) -> Any:
    """Total and level parts for each energy, over log velocity, in one pair of panels with the same scale."""
    panels = stacked(2, COLUMN, 1.3 * COLUMN, sharey=True)
    for panel, gamma in zip(panels, ENERGIES, strict=True):
        here = table["gamma [J/m^2]"] == gamma
        V = table["velocity [m/s]"][here]
        panel.plot(V, table["mu"][here], color="black", label="total")
        for level in (1, 2):
            color, dash = OKABE_ITO[level - 1], DASHES[level - 1]
            panel.plot(V, table[f"mu of level {level}"][here], color=color, linestyle=dash, label=f"level {level}")
        panel.set_title(rf"$\gamma$ = {gamma * 1e6:g} µJ/m²", fontsize=7)
        panel.set_ylabel(r"friction coefficient $\mu$")
        panel.axhline(0, color="0.7", linewidth=0.5, zorder=0)
    panels[0].legend(loc="best", handlelength=2.6)
    panels[1].set_xscale("log")
    panels[1].set_xlim(table["velocity [m/s]"].min(), table["velocity [m/s]"].max())
    panels[1].set_xlabel("sliding velocity $V$ (m/s)")
    return panels[0].figure
