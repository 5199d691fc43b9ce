"""A model that nobody prepared: five relaxation times over six decades, from its file to friction over twelve decades of velocity.

    python tools/five_times.py [--solver FOLDER] [--out tools/five_times.png] [--strips 40]

Writes the model's file, derives and emits its solver (about a minute; or give a folder that has it), compares random strips of this very
material with the 50-digit march, and draws mu over velocity in full and in partial contact.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

import mode_scenes as ms

import hystrip

MODEL = 'from hystrip.derivation import prony_model\n\nMODEL = prony_model("rubber", modes=5)\n'
#: a master curve in steps of a decade and a half: the shorter the time, the stiffer the branch
K, MODULI, TIMES = 1e9, (1e8, 4e8, 1.6e9, 6.4e9, 2.56e10), (1.0, 3e-2, 1e-3, 3e-5, 1e-6)
LEVEL = hystrip.Level(l=1e-5, h=1e-6)
#: every strip in contact at every speed, and a pressure under which contact is partial
CASES = {"30 kPa: full contact": 3e4, "50 Pa: partial contact": 50.0}


def regenerated(folder):
    """Path of the solver, emitted into ``folder``."""
    (folder / "rubber.py").write_text(MODEL)
    subprocess.run(["hystrip", "regenerate", folder / "rubber.py", "--out", folder / "solver"], check=True)
    return folder / "solver"


def against_the_march(solver, count):
    """Largest error of random strips of the material at random speeds, in units of the natural scales; and what misses its tolerance."""
    rng = np.random.default_rng(2)
    order = np.argsort(TIMES)
    worst, bad = 0.0, []
    for _ in range(count):
        scene = ms.draw(rng, 5, False)
        rate = ms.log_uniform(rng, 1e-1, 1e7)
        scene |= {"m": np.array(MODULI)[order] / K, "theta": np.array(TIMES)[order] * rate}
        for branch in ms.BRANCHES:
            error, allowed, sequence = ms.compare(scene, branch, ms.solve([scene], branch, solver), 0)
            worst = max(worst, error)
            if error > allowed:
                bad.append((sequence, branch, scene))
    return worst, bad


def draw(material, path):
    """mu over twelve decades of velocity; returns the curves."""
    from matplotlib.figure import Figure

    V = np.geomspace(1e-9, 1e3, 73)
    figure = Figure(figsize=(7, 6), layout="constrained")
    curves = {}
    for (label, pressure), axes in zip(CASES.items(), figure.subplots(2, sharex=True), strict=True):
        result = hystrip.solve(material, hystrip.Dugdale(gamma=0), [LEVEL], pressure=pressure, velocity=V, edge="constitutive", rtol=1e-4)
        curves[label] = result.mu
        axes.semilogx(V, result.mu)
        for time in TIMES:
            axes.axvline(LEVEL.l / (2 * np.pi * time), color="0.8", linewidth=0.8, zorder=0)
        axes.set(title=label, ylabel=r"friction coefficient $\mu$", xlim=(V[0], V[-1]))
    axes.set_xlabel(r"sliding velocity V, m/s (lines: $V = l/2\pi\tau_i$)")
    figure.savefig(path, dpi=120)
    return curves


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--solver", type=Path, help="folder of a solver for five times, to save deriving it")
    parser.add_argument("--out", type=Path, default=ROOT / "tools" / "five_times.png")
    parser.add_argument("--strips", type=int, default=40, help="random strips to compare with the march")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        solver = hystrip.load_solver(options.solver or regenerated(Path(folder)))
        worst, bad = against_the_march(solver, options.strips)
        print(f"{options.strips} strips, both branches: largest error {worst:.1e} of the natural scale, {len(bad)} miss their tolerance")
        for each in bad:
            print(" ", each)
        curves = draw(hystrip.Prony(K, MODULI, TIMES, solver=solver), options.out)
    for label, mu in curves.items():
        peaks = np.flatnonzero((mu[1:-1] > mu[:-2]) & (mu[1:-1] > mu[2:]))
        print(f"{label}: mu from {mu.min():.3g} to {mu.max():.3g}, {peaks.size} peak(s)")
    print(f"wrote {options.out}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
