"""Fig. 4: pressure on level 1 over one cell of the two-level surface."""

from typing import Any

import numpy as np

from ..plots.style import COLUMN, axes, styled

_X, _Y = 401, 241
_FIRST, _LAST = "contact from x [m]", "contact to x [m]"


def state() -> tuple[Any, float]:
    """The scene ``paper_fig5`` and the penetration of its level 1, m, at the nominal pressure."""
    import hystrip

    from ..scene import load_scene

    scene = load_scene("paper_fig5")
    # what level 2 carries is tangential: it does not change the pressure of level 1
    load = dict(pressure=float(scene.pressure), velocity=float(scene.velocity), rtol=1e-6)
    result = hystrip.solve(scene.material, scene.adhesion, scene.levels[:1], edge=scene.edge, branch=scene.branch, **load)
    return scene, float(result.penetration)


def strips_at(scene: Any, D: float, theta: np.ndarray) -> Any:
    """Strips of level 1 at ``theta = k y``."""
    import hystrip

    level = scene.levels[0]
    return hystrip.solve_strip(
        scene.material, scene.adhesion, l=level.l, A=level.amplitude(theta), D=D - level.drop(theta), V=float(scene.velocity),
        edge=scene.edge, branch=scene.branch,
    )  # fmt: skip


def data() -> dict[str, Any]:
    """Pressure and gap at every point of a grid over one cell, and where its strip is in contact; slides towards +x.

    Contact from ``first`` to ``last``: NaN in a strip in saturated contact, and in one without contact.
    """
    scene, D = state()
    level = scene.levels[0]
    x, y = np.linspace(-0.5, 0.5, _X) * level.l, np.linspace(-0.5, 0.5, _Y) * level.l
    strips = strips_at(scene, D, np.abs(level.k * y)[:, None])
    p, gap = strips.fields(x[None, :])
    X, Y = np.meshgrid(x, y)
    table = {"x [m]": X, "y [m]": Y, "pressure [Pa]": p, "gap [m]": gap, _FIRST: -strips.a, _LAST: strips.b}
    return {name: np.broadcast_to(values, X.shape).ravel() for name, values in table.items()}


@styled
def paint(table: dict[str, Any]) -> Any:
    """Map of the pressure with the border of the contact; x and y over the wavelength."""
    grid = (_Y, _X)
    x, y, p = (np.reshape(table[name], grid) for name in ("x [m]", "y [m]", "pressure [Pa]"))
    edges = [np.reshape(table[name], grid)[:, 0] for name in (_FIRST, _LAST)]
    l = x.max() - x.min()  # noqa: E741 - the paper's symbol
    panel = axes(COLUMN, 0.85 * COLUMN)
    p = p / 1e3
    reach = np.abs(p).max()
    mesh = panel.pcolormesh(x / l, y / l, p, cmap="PuOr_r", vmin=-reach, vmax=reach, shading="gouraud", rasterized=True)
    for edge, side in zip(edges, (-0.5, 0.5), strict=True):
        # out to the border of the cell, where strips with an edge end and saturated ones begin
        partial = np.flatnonzero(np.isfinite(edge))
        outline = np.concatenate(([side], edge[partial] / l, [side]))
        heights = y[partial[[0, *range(partial.size), -1]], 0] / l
        panel.plot(outline, heights, color="black", linewidth=0.7, label="edge of contact" if side > 0 else None)
    panel.set_xlim(-0.5, 0.5)
    panel.legend(loc="center left", fontsize=6, handlelength=1.2, borderaxespad=0.3)
    bar = panel.figure.colorbar(mesh, ax=panel, label="pressure on level 1 (kPa)", fraction=0.05)
    bar.ax.set_ylim(p.min(), p.max())
    bar.ax.tick_params(labelsize=7)
    panel.set_aspect("equal")
    panel.figure.set_layout_engine("compressed")  # the other one cuts labels beside a panel of fixed aspect
    panel.set_xlabel("$x/l_1$ (sliding towards $+x$)")
    panel.set_ylabel("$y/l_1$")
    return panel.figure
