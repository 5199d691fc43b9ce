"""Five relaxation times over six decades: from a master curve to friction over twelve decades of velocity.

    python tools/five_times.py [--solver FOLDER] [--out tools/five_times.png] [--strips 40]

A model that nobody prepared. The master curve is that of a rubber whose modulus rises by a factor of 3000 through the
glass transition, as omega^0.7 (a fractional Zener solid, which has no five times); five times a decade and a half apart
are fitted to it. The tool writes the model's file, derives and emits its solver (two minutes; or give a folder that has
it), compares random strips of this very material with the 50-digit march, and draws mu over velocity with and without
adhesion. It fails if a strip misses its tolerance, or if a curve has not exactly one peak.

One broad peak is not a matter of course. A series of discrete times is a staircase: each adds a step of its own to the
modulus and a maximum of its own to the loss tangent, little more than a decade wide, and friction in partial contact
follows the loss tangent. Times a decade and a half apart run together only if the next branch is so much stiffer that
its loss already counts where its neighbour's fades. On the level below, branches each 4 times as stiff as the next
slower one give three maxima on one hump (the dips up to 10 % deep), 8 times two (3 to 8 %), those of the fit, 8 to 13
times, one with shoulders. That is physics of the series, not of the solver: closer times, or another strength, take it
away.
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
from hystrip.dma import fit_prony
from hystrip.dma.read import DynamicModulus

MODEL = 'from hystrip.derivation import prony_model\n\nMODEL = prony_model("rubber", modes=5)\n'
TIMES = np.geomspace(1e-6, 1.0, 5)
#: the foundation is a layer: its stiffness per area is the modulus over this
THICKNESS = 1e-3
LEVEL, PRESSURE = hystrip.Level(l=1e-5, h=1e-6), 300.0
CASES = {"no adhesion": hystrip.Dugdale(gamma=0), "adhesion, 25 µJ/m²": hystrip.Dugdale(gamma=2.5e-5, delta_0=5e-8)}
VELOCITIES = np.geomspace(1e-9, 1e3, 73)


def master_curve():
    """Storage and loss modulus over ten decades, Pa: ``E_0 + (E_g - E_0) x/(1 + x)``, ``x = (i omega tau)^0.7``."""
    omega = np.geomspace(1e-2, 1e8, 101)
    x = (1j * omega * TIMES[0]) ** 0.7
    modulus = 1e6 * (1 + 2999 * x / (1 + x))
    return DynamicModulus(omega, modulus.real, modulus.imag)


def regenerated(folder):
    """Path of the solver, emitted into ``folder``."""
    (folder / "rubber.py").write_text(MODEL)
    command = [sys.executable, "-m", "hystrip", "regenerate", folder / "rubber.py", "--out", folder / "solver"]
    subprocess.run(command, check=True)
    return folder / "solver"


def against_the_march(material, solver, count):
    """Largest error of random strips of the material at random speeds, in units of the natural scales; and what misses
    its tolerance."""
    rng = np.random.default_rng(2)
    worst, bad = 0.0, []
    for _ in range(count):
        scene = ms.draw(rng, 5, False)
        rate = ms.log_uniform(rng, 1e-1, 1e7)
        scene |= {"m": np.array(material.moduli) / material.K, "theta": np.array(material.times) * rate}
        for branch in ms.BRANCHES:
            error, allowed, sequence = ms.compare(scene, branch, ms.solve([scene], branch, solver), 0)
            worst = max(worst, error)
            if error > allowed:
                bad.append((sequence, branch, scene))
    return worst, bad


def friction(material):
    """mu over velocity, for each case."""
    run = {"pressure": PRESSURE, "velocity": VELOCITIES, "edge": "constitutive", "rtol": 1e-3}
    return {label: hystrip.solve(material, adhesion, [LEVEL], **run).mu for label, adhesion in CASES.items()}


def draw(measured, series, curves, path):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 7), layout="constrained")
    above, below = figure.subplots(2)
    fitted = series.modulus(measured.omega)
    for color, each, fit, name in (("C0", measured.storage, fitted.real, "storage"), ("C1", measured.loss, fitted.imag, "loss")):
        above.loglog(measured.omega, each, ".", color=color, markersize=4, label=f"{name}, master curve")
        above.loglog(measured.omega, fit, color=color, linewidth=1, label="five times")
    above.set(xlabel=r"$\omega$, rad/s", ylabel="modulus, Pa", title="Five times over six decades, fitted to a master curve")
    above.legend(frameon=False, ncols=2)
    for label, mu in curves.items():
        below.semilogx(VELOCITIES, mu, label=label)
    for time in TIMES:
        below.axvline(LEVEL.l / (2 * np.pi * time), color="0.8", linewidth=0.8, zorder=0)
    below.set(
        xlabel=r"sliding velocity V, m/s (lines: $V = l/2\pi\tau_i$)",
        ylabel=r"friction coefficient $\mu$",
        xlim=(VELOCITIES[0], VELOCITIES[-1]),
        ylim=(0, None),
        title=f"One level, {LEVEL.l * 1e6:g} µm long and {LEVEL.h * 1e6:g} µm high, at {PRESSURE:g} Pa",
    )
    below.legend(frameon=False)
    figure.savefig(path, dpi=120)


def peaks(mu):
    """Velocities of the maxima."""
    return VELOCITIES[1:-1][(mu[1:-1] > mu[:-2]) & (mu[1:-1] > mu[2:])]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--solver", type=Path, help="folder of a solver for five times, to save deriving it")
    parser.add_argument("--out", type=Path, default=ROOT / "tools" / "five_times.png")
    parser.add_argument("--strips", type=int, default=40, help="random strips to compare with the march")
    options = parser.parse_args()
    measured = master_curve()
    series = fit_prony(measured, times=TIMES)
    with tempfile.TemporaryDirectory() as folder:
        solver = hystrip.load_solver(options.solver or regenerated(Path(folder)))
        foundation = series.foundation(THICKNESS)
        material = hystrip.Prony(foundation.K, foundation.moduli, foundation.times, solver=solver)
        worst, bad = against_the_march(material, solver, options.strips)
        print(
            f"{options.strips} strips, both branches: largest error {worst:.1e} of the natural scale, "
            f"{len(bad)} miss their tolerance"
        )
        for each in bad:
            print(" ", each)
        curves = friction(material)
    draw(measured, series, curves, options.out)
    several = False
    for label, mu in curves.items():
        found = peaks(mu)
        high = VELOCITIES[mu > 0.5 * mu.max()]
        wide = np.log10(high[-1] / high[0])
        print(f"{label}: mu {mu[0]:.2g} at {VELOCITIES[0]:g} m/s, {mu[-1]:.2g} at {VELOCITIES[-1]:g} m/s; peak {mu.max():.3f} at "
              f"{', '.join(f'{V:.2g}' for V in found)} m/s, {wide:.1f} decades wide at half its height")  # fmt: skip
        several |= found.size != 1
    print(f"wrote {options.out}")
    return 1 if bad or several else 0


if __name__ == "__main__":
    sys.exit(main())
