"""How far the foundation model is from a viscoelastic half-space: tables and pictures.

    python tools/validation.py [--out tools/validation] [--points 32] [--steps 32]

(a) several levels in complete contact against the formula of the half-space, to rounding;
(b) one level in partial contact, over pressures (elastic) and velocities (one relaxation time), beside Tamaas (extra `bench`),
    which solves the half-space; its backward Euler steps are extrapolated from two step lengths;
(c) the three levels of the example `hystrip init --example rubber`, beside Persson's theory, which is drawn in (b) too.

Exits with 1 where (a) differs by more than rounding.
"""

import argparse
import csv
import math
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

from peers import half_space, persson

import hystrip
from hystrip.dma import fit_prony, read_dma
from hystrip.example import rubber
from hystrip.extras import require
from hystrip.plots.style import COLUMN, OKABE_ITO, save, stacked, styled
from hystrip.roughness import levels_of, read_surface

NONE = hystrip.Dugdale(gamma=0)
ROUNDING = 1e-12
#: (b): in units in which the relaxed shear modulus is one, as Tamaas needs it; Poisson ratio 0, ten times as stiff when fast
LEVEL = hystrip.Level(l=1.0, h=0.02)
TAU = 1.0
ELASTIC = hystrip.HalfSpace(E=2.0, nu=0.0)
RUBBER = hystrip.HalfSpace(E=2.0, nu=0.0, moduli=[18.0], times=[TAU])
#: nominal pressure over E/(1 - nu^2) h/l
PRESSURES = (0.03, 0.1, 0.3, 0.6, 1.0, 1.5)
SLIDING = (0.3, 1.0)
VELOCITIES = (0.01, 0.03, 0.1, 0.3, 1.0)


def complete_contact():
    """(a): largest relative difference from the half-space formula, and its curve."""
    V = np.geomspace(1e-5, 1e3, 200)
    material = hystrip.HalfSpace(E=2e6, nu=0.49, moduli=[3e7, 8e6, 2e6], times=[1e-6, 1e-4, 1e-2])
    levels = [hystrip.Level(1e-3, 2e-5), hystrip.Level(1e-4, 3e-6), hystrip.Level(1e-5, 2e-7)]
    p = 1e9
    mu = hystrip.solve(material, NONE, levels, pressure=p, velocity=V, edge="constitutive").mu
    formula = np.zeros(V.size)
    for q, along, square in persson.waves(levels):
        x = 1j * np.multiply.outer(along * V, material.times)
        formula += along * ((x / (1 + x)) @ material.moduli).imag / (1 - material.nu**2) * q / 2 * square / p
    return V, mu, formula


def elastic(points):
    """(b): contact fraction over pressure: this model, Tamaas, Persson."""
    scale = LEVEL.h / LEVEL.l * ELASTIC.E
    rows = []
    for share in PRESSURES:
        p = share * scale
        ours = hystrip.solve(ELASTIC, NONE, [LEVEL], pressure=p, velocity=0.0, rtol=1e-6).contact_fraction
        tamaas = half_space.elastic_contact(LEVEL, p, points) if half_space.available() else math.nan
        rows.append((share, float(ours), tamaas, float(persson.friction(ELASTIC, [LEVEL], p, [0.0])[1][0])))
    return rows


def sliding(points, steps):
    """(b): friction coefficient and contact fraction over velocity at each pressure."""
    scale = LEVEL.h / LEVEL.l * RUBBER.E
    rows = []
    for share in SLIDING:
        p = share * scale
        ours = hystrip.solve(RUBBER, NONE, [LEVEL], pressure=p, velocity=VELOCITIES, rtol=1e-6, edge="constitutive")
        theory = persson.friction(RUBBER, [LEVEL], p, VELOCITIES)
        for i, V in enumerate(VELOCITIES):
            if half_space.available():
                coarse, fine = (half_space.viscoelastic(LEVEL, 9.0, TAU, p, V, points, n) for n in (steps, 2 * steps))
                tau, contact = (2 * f - c for f, c in zip(fine, coarse, strict=True))
            else:
                tau, contact = math.nan, math.nan
            rows.append(
                (share, V, float(ours.mu[i]), tau / p, theory[0][i], float(ours.contact_fraction[i]), contact, theory[1][i])
            )
    return rows


def tread():
    """(c): the example's compound and road: velocities, our result, Persson's friction and contact."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in rubber().items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        material = fit_prony(read_dma(Path(folder) / "rubber.csv")).half_space(0.49)
        levels = levels_of(read_surface(Path(folder) / "scan.txt"), count=3).levels
    V, p = np.geomspace(1e-4, 10, 16), 3e5
    result = hystrip.solve(material, NONE, levels, pressure=p, velocity=V, rtol=1e-3, edge="constitutive")
    return V, result, persson.friction(material, levels, p, V)


@styled
def draw_complete(V, mu, formula):
    upper, lower = stacked(2, COLUMN, 1.0 * COLUMN)
    upper.loglog(V, formula, color=OKABE_ITO[1], label="half-space, formula")
    upper.loglog(V[::10], mu[::10], "ko", markersize=3, markerfacecolor="none", label="hystrip, three levels")
    upper.set_ylabel(r"friction coefficient $\mu$")
    upper.legend(loc="best")
    lower.semilogx(V, np.abs(mu / formula - 1) / np.finfo(float).eps, color="black", linewidth=0.8)
    lower.set_ylabel("difference\n(units of rounding)")
    lower.set_xlabel("sliding velocity $V$ (m/s)")
    return upper.figure


@styled
def draw_one_level(over_pressure, over_velocity):
    figure = require("matplotlib.figure", "plot", "drawing").Figure(figsize=(COLUMN, 1.9 * COLUMN), layout="constrained")
    first, second, third = figure.subplots(3, 1)
    third.sharex(second)
    share, _, tamaas, _ = np.array(over_pressure).T
    fine = np.linspace(0.01, share[-1], 120)
    p = fine * LEVEL.h / LEVEL.l * ELASTIC.E
    ours = hystrip.solve(ELASTIC, NONE, [LEVEL], pressure=p, velocity=0.0, rtol=1e-4).contact_fraction
    first.plot(fine, ours, "k-", label="hystrip")
    first.plot(share, tamaas, "o", color=OKABE_ITO[1], markersize=4, label="half-space (Tamaas)")
    first.plot(
        fine, [persson.friction(ELASTIC, [LEVEL], each, [0.0])[1][0] for each in p], "--", color=OKABE_ITO[0], label="Persson"
    )
    first.set(xlabel=r"$p\,l/(E^* h)$, elastic", ylabel="contact fraction", ylim=(0, 1.05))
    first.legend(loc="lower right")
    rows = np.array(over_velocity)
    for number, each in enumerate(np.unique(rows[:, 0])):
        _, V, mu, mu_t, mu_p, c, c_t, c_p = rows[rows[:, 0] == each].T
        for panel, curves in ((second, (mu, mu_t, mu_p)), (third, (c, c_t, c_p))):
            x = 2 * np.pi * V * TAU / LEVEL.l
            filled = {} if number else {"markerfacecolor": "none"}
            panel.semilogx(x, curves[0], "k-", linewidth=0.9 + 0.6 * number, label=f"$p\\,l/(E^* h)$ = {each:g}")
            panel.semilogx(x, curves[1], "o", color=OKABE_ITO[1], markersize=4, **filled)
            panel.semilogx(x, curves[2], "--", color=OKABE_ITO[0], linewidth=0.9 + 0.6 * number)
    second.set_ylabel(r"friction coefficient $\mu$")
    second.legend(loc="best")
    third.set(xlabel=r"$k V \tau$, ten times as stiff when fast", ylabel="contact fraction", ylim=(0, 1.05))
    return figure


@styled
def draw_tread(V, result, theory):
    upper, lower = stacked(2, COLUMN, 1.2 * COLUMN)
    for panel, ours, other in ((upper, result.mu, theory[0]), (lower, result.contact_fraction, theory[1])):
        panel.semilogx(V, ours, "k-", label="hystrip")
        panel.semilogx(V, other, "--", color=OKABE_ITO[0], label="Persson")
        panel.set_ylim(0, None)
    upper.set_ylabel(r"friction coefficient $\mu$")
    upper.legend(loc="best")
    lower.set(ylabel="contact fraction", xlabel="sliding velocity $V$ (m/s)")
    return upper.figure


def written(path, heads, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(heads)
        writer.writerows([f"{each:.5g}" for each in row] for row in rows)
    print("\n" + "  ".join(f"{head:>14}" for head in heads))
    for row in rows:
        print("  ".join(f"{each:14.4g}" for each in row))
    print(f"wrote {path}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(""), help="folder of tables and pictures")
    parser.add_argument("--points", type=int, default=32, help="points of Tamaas along a wavelength")
    parser.add_argument("--steps", type=int, default=32, help="its coarser steps a wavelength")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    V, mu, formula = complete_contact()
    off = float(np.abs(mu / formula - 1).max())
    print(f"(a) complete contact, three levels, three times, 200 velocities: largest relative difference {off:.1e}")
    save(draw_complete(V, mu, formula), options.out / "complete_contact.png")
    written(options.out / "complete_contact.csv", ("V [m/s]", "mu", "half-space"), list(zip(V, mu, formula, strict=True))[::20])
    if not half_space.available():
        print("(b) Tamaas is not installed (extra `bench`): its columns are empty")
    pressed = elastic(2 * options.points)
    written(options.out / "elastic.csv", ("p l/(E* h)", "contact", "half-space", "Persson"), pressed)
    slid = sliding(options.points, options.steps)
    heads = ("p l/(E* h)", "V tau/l", "mu", "mu half-space", "mu Persson", "contact", "c. half-space", "c. Persson")
    written(options.out / "sliding.csv", heads, slid)
    save(draw_one_level(pressed, slid), options.out / "one_level.png")
    V, result, theory = tread()
    rows = list(zip(V, result.mu, theory[0], result.contact_fraction, theory[1], strict=True))
    written(options.out / "tread.csv", ("V [m/s]", "mu", "mu Persson", "contact", "c. Persson"), rows)
    save(draw_tread(V, result, theory), options.out / "tread.png")
    return 0 if off < ROUNDING else 1


if __name__ == "__main__":
    sys.exit(main())
