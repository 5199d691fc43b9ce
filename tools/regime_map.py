"""Draw the regime of a strip over penetration and speed, for both branches of a closure, with the known thresholds.

    python tools/regime_map.py [--edge continuous] [--out tools/regimes-continuous.png] [--points 500]

The strip has p_0 = 5 K A, delta_0 = A/25 (under the constitutive closure it snaps into contact) and T_eps = 100
T_sigma. Speed enters as alpha = k V T_sigma.
"""

import argparse
from pathlib import Path

import matplotlib
import numpy as np

import hystrip
from hystrip.orbit.regimes import REGIMES

P_0, DELTA_0, RATIO = 5.0, 0.04, 100.0
ORDER = ("f", "af", "a", "cf", "ac", "afc", "acaf", "c")
COLOURS = {"f": "#f4f4f2", "af": "#cfe3f3", "a": "#8fb8de", "ac": "#e3a857", "afc": "#b85c8e", "acaf": "#6aaa7f", "c": "#7d4b3a"}


def regimes(alpha, D, edge, branch):
    """Sequences on the grid, (D, alpha)."""
    material = hystrip.StandardLinearSolid(K=1.0, T_eps=RATIO, T_sigma=1.0)
    adhesion = hystrip.Dugdale(p_0=P_0, delta_0=DELTA_0)
    D, alpha = np.meshgrid(D, alpha, indexing="ij")
    return hystrip.solve_strip(material, adhesion, l=2 * np.pi, A=1.0, D=D, V=alpha, edge=edge, branch=branch).regime


def saturation(alpha):
    """D from which saturated contact exists: the unloading branch ends nowhere above it."""
    return 1 + np.hypot(1, RATIO * alpha) / np.hypot(1, alpha) - P_0


def draw(edge, points):
    matplotlib.use("Agg")
    from matplotlib import pyplot as plt
    from matplotlib.colors import BoundaryNorm, ListedColormap
    from matplotlib.patches import Patch

    alpha = np.geomspace(1e-6, 1e6, points)
    # fine about the wave's own height, coarse up to the glassy saturation
    D = np.concatenate([np.linspace(-12, 3, points), np.geomspace(3, 2 * RATIO, points // 2)[1:]])
    names = [name for name in ORDER if name in COLOURS]
    palette = ListedColormap([COLOURS[name] for name in names])
    norm = BoundaryNorm(np.arange(len(names) + 1) - 0.5, len(names))
    figure, axes = plt.subplots(1, 2, figsize=(9.0, 4.4), sharey=True, layout="constrained")
    present = set()
    for axis, branch in zip(axes, ("unloading", "loading"), strict=True):
        found = regimes(alpha, D, edge, branch)
        present |= set(np.unique(found))
        code = np.select([found == name for name in names], range(len(names)))
        axis.pcolormesh(alpha, D, code, cmap=palette, norm=norm, shading="nearest", rasterized=True)
        axis.plot(alpha, saturation(alpha), "k-", lw=1, label="$D = A(1 + R) - p_0/K$: saturated contact exists")
        axis.axhline(-DELTA_0, color="k", ls=":", lw=1, label=r"$D = -\delta_0$: the free strip exists below")
        axis.set(xscale="log", title=branch, xlabel=r"$\alpha = k V T_\sigma$")
        axis.set_yscale("symlog", linthresh=3, linscale=1.5)
    axes[0].set_ylabel("penetration $D_j/A$")
    handles = [Patch(fc=COLOURS[n], ec="0.5", label=f"{n}: {REGIMES[n]}") for n in names if n in present]
    handles += axes[0].get_legend_handles_labels()[0]
    figure.legend(handles=handles, loc="outside lower center", ncols=2, fontsize=7, frameon=False)
    figure.suptitle(rf"{edge}: $p_0 = {P_0:g} K A$, $\delta_0 = {DELTA_0:g} A$, $T_\epsilon = {RATIO:g} T_\sigma$", fontsize=10)
    return figure


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--edge", choices=("continuous", "constitutive"), default="continuous")
    parser.add_argument("--out", type=Path, help="picture to write; default regimes-EDGE.png beside this file")
    parser.add_argument("--points", type=int, default=500)
    options = parser.parse_args()
    out = options.out or Path(__file__).with_name(f"regimes-{options.edge}.png")
    draw(options.edge, options.points).savefig(out, dpi=130)
    print(out)


if __name__ == "__main__":
    main()
