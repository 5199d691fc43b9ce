"""Fig. 3: contact area and friction of one level over nominal pressure, with the parts where several solutions exist."""

from typing import Any

import numpy as np

from ..plots.style import COLUMN, OKABE_ITO, stacked, styled

_RTOL = 1e-3
_POINTS = 40
_BEYOND = 700.0  # Pa drawn above the highest saturation pressure
_QUANTITIES = ("pressure [Pa]", "friction stress [Pa]", "contact fraction", "adhesion fraction")
_KINDS = ("unloading, reachable", "unloading, not reachable", "loading")


def data() -> dict[str, Any]:
    """Curves over penetration at every velocity of the scene ``paper_fig3``, in pieces; NaN rows stand between the pieces.

    ``reachable``: met by pulling back slowly under load control; the rest of the unloading curve needs control of penetration.
    """
    from ..level.branches import branches_of
    from ..level.curve import trace
    from ..level.strips import LevelBatch
    from ..scene import load_scene

    scene = load_scene("paper_fig3")
    V = np.sort(np.atleast_1d(scene.velocity))
    rows: list[tuple] = []
    for branch in ("unloading", "loading"):
        columns = LevelBatch(scene.material, scene.adhesion, scene.levels[0], scene.edge, branch, V, np.zeros(V.size))
        saturated = columns.saturated.D_sat
        # the threshold decides the unloading orbit only; coming from no contact, all of the surface is met when the edge is
        top = saturated if branch == "unloading" else np.maximum(saturated, 1.5 * scene.levels[0].h)
        rtol = np.full(V.size, _RTOL)
        for v, D_top, curve in zip(V, top, trace(columns, rtol, columns.atol(rtol), top)[0], strict=True):
            parts = [(b.piece, b.t_low, b.t_high) for b in branches_of([curve], branch == "unloading")[0]]
            for piece in sorted(curve, key=lambda piece: -piece.low):
                inside = sorted((low, high) for p, low, high in parts if p is piece)
                ends = sorted({0.0, 1.0, *(t for pair in inside for t in pair)})
                for low, high in zip(ends[:-1], ends[1:], strict=True):
                    ends_p = piece.values(np.array([low, high]))[:, 0]
                    if abs(ends_p[1] - ends_p[0]) < 1e-6 * columns.scales[0]:
                        continue
                    reached = any(a <= low and high <= b for a, b in inside)
                    kind = _KINDS[2] if branch == "loading" else _KINDS[0] if reached else _KINDS[1]
                    t = np.linspace(low, high, _POINTS)
                    for D, values in zip(piece.penetration(t), piece.values(t), strict=True):
                        rows.append((v, kind, D, *values[:4]))
                    rows.append((v, kind, *[np.nan] * 5))
            rows += _above(scene, columns, v, D_top, _KINDS[0] if branch == "unloading" else _KINDS[2])
    names = ("velocity [m/s]", "part", "penetration [m]", *_QUANTITIES)
    return {
        name: [row[i] for row in rows] if name == "part" else np.array([row[i] for row in rows]) for i, name in enumerate(names)
    }


def _above(scene: Any, columns: Any, v: float, D_top: float, kind: str) -> list[tuple]:
    """Saturated contact from the penetration ``D_top`` on."""
    from ..level.saturated import saturated_level

    level = scene.levels[0]
    each = saturated_level(scene.material, scene.adhesion, level, columns.V)
    i = int(np.searchsorted(columns.V, v))
    p = np.linspace(scene.material.K * (D_top - 0.75 * level.h), each.p_sat.max() + _BEYOND, 2)
    rows = [(v, kind, pressure / scene.material.K + 0.75 * level.h, pressure, each.tau_sat[i], 1.0, 0.0) for pressure in p]
    return [*rows, (v, kind, *[np.nan] * 5)]


@styled
def paint(table: dict[str, Any]) -> Any:
    """Area above, friction below; solid: reachable under load control, dashed: not, dotted: loading, dot: pull-off."""
    panels = stacked(2, COLUMN, 1.55 * COLUMN)
    kinds = np.array(table["part"])
    p = table["pressure [Pa]"] / 1e3
    styles = dict(zip(_KINDS, (("-", 1.3), ((0, (3, 1.5)), 0.9), ((0, (1, 1.3)), 0.9)), strict=True))
    inset = panels[0].inset_axes([0.5, 0.16, 0.45, 0.4])
    for index, v in enumerate(np.unique(table["velocity [m/s]"])):
        color = OKABE_ITO[index % len(OKABE_ITO)]
        coming = (table["velocity [m/s]"] == v) & (kinds == _KINDS[2])
        inset.plot(1e3 * p[coming], table["contact fraction"][coming], color=color, linestyle=(0, (1, 1)), linewidth=1.0)
        for panel, name in zip(panels, ("contact fraction", "friction stress [Pa]"), strict=True):
            y = table[name] / (1e3 if "Pa" in name else 1)
            for kind, (line, width) in styles.items():
                here = (table["velocity [m/s]"] == v) & (kinds == kind)
                label = f"$V$ = {v * 1e3:g} mm/s" if kind == _KINDS[0] else None
                panel.plot(p[here], y[here], color=color, linestyle=line, linewidth=width, label=label)
            here = np.flatnonzero((table["velocity [m/s]"] == v) & (kinds == _KINDS[0]) & np.isfinite(p))
            off = here[np.argmin(p[here])]
            panel.plot(p[off], y[off], "o", color=color, markersize=3.5, zorder=4, clip_on=False)
    inset.set_xlim(-20, 30)
    inset.set_ylim(0, 1.05)
    inset.tick_params(labelsize=6)
    inset.set_xlabel("$p$ (Pa), loading", fontsize=6.5, labelpad=1)
    for kind, (line, width) in list(styles.items())[1:]:
        if not (kinds == kind).any():
            continue
        text = "loading" if kind == _KINDS[2] else "not reached under load control"
        panels[1].plot([], [], color="0.3", linestyle=line, linewidth=width, label=text)
    panels[1].plot([], [], "o", color="0.3", markersize=3.5, label="pull-off")
    panels[0].set_ylabel("contact fraction")
    panels[0].set_ylim(0, 1.05)
    panels[1].set_ylabel(r"friction stress $\tau$ (kPa)")
    panels[1].set_xlabel("nominal pressure $p$ (kPa)")
    panels[1].axvline(0, color="0.7", linewidth=0.5, zorder=0)
    panels[0].axvline(0, color="0.7", linewidth=0.5, zorder=0)
    # coming from no contact, saturation is certain only far beyond where unloading leaves it: nothing happens there any more
    panels[1].set_xlim(np.nanmin(p) - 0.15, np.nanmax(p[kinds != _KINDS[2]]))
    panels[1].legend(loc="upper center", bbox_to_anchor=(0.5, -0.22), ncols=2, fontsize=6.5)
    return panels[0].figure
