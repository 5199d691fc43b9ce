"""Friction with fourteen relaxation times over twelve decades: what adhesion costs, level by level.

    python tools/many_times.py [--levels 1 2] [--velocities 1e-4 1.78e-3 3.16e-2 0.562 10]

A log-normal spectrum from 1e-10 to 100 s, the levels (1 mm, 20 um) and (0.1 mm, 2 um), 10 kPa, p_0 = 2 kPa over 10 nm,
rtol 1e-3. Prints mu, CPU seconds and strips with adhesion and without; exits with 1 where a point did not converge.
"""

import argparse
import sys
import time

import numpy as np

import hystrip

TIMES = 10.0 ** np.linspace(-10, 2, 14)
LEVELS = [hystrip.Level(l=1e-3, h=2e-5), hystrip.Level(l=1e-4, h=2e-6)]
ADHESION = {"without adhesion": hystrip.Dugdale(gamma=0), "with adhesion": hystrip.Dugdale(p_0=2e3, delta_0=1e-8)}


def rubber():
    """E = 2 MPa when relaxed, scaled to a foundation of 1 GPa/m."""
    moduli = 8e7 * np.exp(-(((np.log10(TIMES) + 7) / 2.2) ** 2) / 2) + 1e5
    return hystrip.Prony(1e9, moduli * (1e9 / 2e6), TIMES)


def solve(count, adhesion, velocities):
    """Friction of so many of the levels."""
    how = {"rtol": 1e-3, "edge": "constitutive"}
    return hystrip.solve(rubber(), adhesion, LEVELS[:count], pressure=1e4, velocity=velocities, **how)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--levels", type=int, nargs="+", default=[1, 2], choices=[1, 2])
    parser.add_argument("--velocities", type=float, nargs="+", default=np.geomspace(1e-4, 10, 5).tolist(), help="m/s")
    options = parser.parse_args()
    converged = True
    solve(1, ADHESION["without adhesion"], [1.0])  # imports
    for count in options.levels:
        base = None
        for name, adhesion in ADHESION.items():
            start = time.process_time()
            result = solve(count, adhesion, options.velocities)
            spent = time.process_time() - start
            base = base or spent
            converged &= bool(result.converged.all())
            mu = " ".join(f"{each:.5f}" for each in result.mu)
            well = np.count_nonzero(result.converged)
            print(f"{count} level{'s' * (count > 1)} {name}: {spent:.2f} s, {spent / base:.0f} times; mu {mu};", end=" ")
            print(f"{result.counts['strips_solved']} strips; {well} of {result.mu.size} converged", flush=True)
    return 0 if converged else 1


if __name__ == "__main__":
    sys.exit(main())
