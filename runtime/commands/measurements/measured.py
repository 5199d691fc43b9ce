"""What has to be measured or drawn: solved strips and levels, by the installed solver, which must be the one that is audited.

The figures may differ in their last digits between processors, so they are stored and not compared.
"""

import platform
from importlib.metadata import version
from typing import Any

import numpy as np

from .pictures import MATERIALS, picture, scenes, solved
from .readings import readings
from .two_levels import two_levels
from .worked import worked

TOOLS = ("matplotlib", "mpmath", "numpy", "scipy")
RATIOS = (1.1, 1.5, 2.0, 10.0, 100.0)  # T_eps/T_sigma
OWN = "standard_linear_solid"  # the paper's
NODES = 60  # Gauss points in each zone


def measured(model: str) -> dict[str, Any] | None:
    """Pictures by regime, tables by name, and the versions that made them; None for a model of which nothing is drawn.

    The tables are those of the paper's foundation.
    """
    if model not in MATERIALS:
        return None
    pictures: dict[str, list[dict[str, Any]]] = {}
    tables: dict[str, Any] = {}
    if model == OWN:
        tables = {
            "worked": worked(),
            "balance": _balance(),
            "branches": _branches(),
            "two_levels": two_levels(),
            "readings": readings(),
        }
    for scene in scenes(model):
        pictures.setdefault(scene["of"], []).append(picture(scene))
    return {
        "versions": {"python": platform.python_version(), **{tool: version(tool) for tool in TOOLS}},
        "pictures": pictures,
        "tables": tables,
    }


def _balance() -> dict[str, Any]:
    """By how much ``continuous`` breaks the energy balance, over T_eps/T_sigma."""
    rows = []
    first = scenes(OWN)[0]
    for ratio in RATIOS:
        for edge in ("continuous", "constitutive"):
            scene = {**first, "T_sigma": first["T_eps"] / ratio, "edge": edge}
            strip = solved(scene)
            friction, loss = float(strip.tau_mean) * scene["l"], _dashpot_loss(scene, strip)
            left, extra = friction - loss, _extra(scene, strip)
            rows.append(
                [f"{ratio:g}", edge, f"{friction:.4e}", f"{loss:.4e}", f"{left:.4e}", f"{left / loss:+.2%}",
                 f"{abs(left - extra) / abs(friction):.0e}"]
            )  # fmt: skip
    return {
        "caption": "Friction against the dashpot's loss, per cycle and width, in J/m², for the strip of the first picture below "
        "with other relaxation times. Under constitutive what is left is the energy that a detachment costs; under continuous it "
        "has no physical meaning. Last column: how far it is from the derived X, over the friction; the loss is integrated "
        "numerically.",
        "shown": "Friction less the dashpot's loss, over the loss, with w continuous: "
        + ", ".join(f"{row[5]} at T_eps/T_sigma = {row[0]}" for row in rows if row[1] == "continuous")
        + ".",
        "head": ["T_eps/T_sigma", "closure", "friction", "loss", "left", "left/loss", "left against X"],
        "rows": rows,
    }


def _extra(scene: dict[str, Any], strip: Any) -> float:
    """X of the friction balance, from the edges alone."""
    p_0, delta_0, J = scene["p_0"], scene["delta_0"], scene["T_sigma"] / scene["T_eps"]
    if scene["edge"] == "continuous":
        w_d, w_c = (_profile(scene, float(x)) for x in (strip.d, -strip.c))
        return -J / (1 - J) * p_0 * (w_d - w_c)
    glassy = scene["K"] / J
    if str(strip.regime) == "afc":
        return p_0 * delta_0 + p_0**2 / (2 * glassy) - glassy * delta_0**2 / 2
    return p_0**2 / glassy


def _profile(scene: dict[str, Any], x: float) -> float:
    return scene["D"] - scene["A"] * (1 - np.cos(2 * np.pi * x / scene["l"]))


def _dashpot_loss(scene: dict[str, Any], strip: Any) -> float:
    """Loss of one cycle per area of the foundation: Gauss quadrature of ``z'^2`` in each zone, from the fields."""
    T, K, V, length = scene["T_eps"], scene["K"], scene["V"], scene["l"]
    edges = sorted(float(x) for x in (-strip.c, -strip.a, strip.b, strip.d) if np.isfinite(x))
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    total = 0.0
    for low, high in zip(edges, (*edges[1:], edges[0] + length), strict=True):
        x = 0.5 * (low + high) + 0.5 * (high - low) * nodes
        drag = strip.pressure(x) / K - strip.displacement(x)  # T dz/dt
        total += 0.5 * (high - low) * float(np.sum(weights * drag**2))
    stiffness = K / (1 - scene["T_sigma"] / T)  # of the spring beside the dashpot, whose viscosity is stiffness T
    return stiffness / (V * T) * total


def _branches() -> dict[str, Any]:
    """Both extremal orbits of one strip, over its penetration."""
    scene = {**scenes(OWN)[0], "l": 500e-9, "A": 50e-9, "T_sigma": 1e-4, "p_0": 2500.0, "delta_0": 1e-8, "V": 1e-4}
    rows = []
    for D in (-40e-9, -20e-9, 0.0, 20e-9):
        row = [f"{D * 1e9:g}"]
        for branch in ("unloading", "loading"):
            strip = solved({**scene, "D": D, "branch": branch})
            row += [str(strip.regime), f"{float(strip.p_mean):.4g}", f"{float(strip.tau_mean):.4g}"]
        rows.append(row)
    return {
        "caption": "The middle strip of the paper's Fig. 3 (l = 500 nm, h = 100 nm, gamma = 2.5e-5 N/m) at V = 0.1 mm/s, "
        "where its curve is multivalued. Pressures in Pa.",
        "shown": f"One strip at D_j = {rows[1][0]} nm: mean friction {rows[1][3]} Pa on unloading, {rows[1][6]} Pa on loading.",
        "head": ["D_j, nm", "unloading", "p", "tau", "loading", "p", "tau"],
        "rows": rows,
    }
