"""Fig. 6 of the paper: in which range its two maxima of friction over velocity exist.

    python tools/figure6.py [--dry]

The paper draws two curves of the friction coefficient over velocity, each with two maxima, for two energies of adhesion
of which its text gives one. Here the energy is scanned, under both edge closures and on both branches, and Eq. 13 is
read in both ways: the law of the lower level over the contact alone, and over the whole cell as printed. The table goes
into the measured figures of the audit (generated/audit/measured.json), from which the page is made; ``--dry`` prints it
only. About six minutes of CPU time.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np

import hystrip
from hystrip.commands.measurements.readings import GAMMA as GIVEN
from hystrip.commands.measurements.readings import both
from hystrip.derivation.folder import MEASURED, dumped, generated_folder, read_measured, write_files

MODEL, TABLE = "standard_linear_solid", "figure_6"
ENERGIES = (0.0, 5e-6, 1.2e-5, 1.8e-5, 2.2e-5, GIVEN, 2.8e-5, 3.1e-5, 3.4e-5, 3.8e-5, 4.4e-5, 5e-5, 7e-5, 1e-4)
FEWER = {  # where a curve costs three to six times as much
    ("constitutive", "unloading"): (5e-6, 1.2e-5, 1.8e-5, 2.2e-5, GIVEN, 3.1e-5, 3.8e-5, 5e-5),
    ("continuous", "loading"): (5e-6, 1.8e-5, GIVEN, 3.8e-5, 5e-5),
    ("constitutive", "loading"): (1.8e-5, GIVEN, 3.8e-5, 5e-5),
}
#: dense where the maxima stand, from a first look
VELOCITIES = np.concatenate([np.geomspace(1e-5, 2e-4, 8)[:-1], np.geomspace(2e-4, 4e-3, 48), np.geomspace(4e-3, 0.1, 10)[1:]])
CLOSER = np.array([-0.75, -0.5, -0.25, 0.25, 0.5, 0.75])  # further velocities about a maximum, in steps to its neighbours
RTOL = 3e-4
CERTAIN = 3.0  # a dip counts that is deeper than so many error estimates


def curve(gamma: float, edge: str, branch: str) -> dict[str, np.ndarray]:
    """Friction over velocity in both readings of Eq. 13, with more velocities about its maxima."""
    first = both(VELOCITIES, gamma, edge, branch, RTOL)
    peaks = {V for reading in ("contact", "cell") for V, _ in maxima(first, reading)}
    steps = np.log(VELOCITIES)
    more = []
    for V in peaks:
        n = int(np.argmin(abs(steps - np.log(V))))
        gaps = np.where(CLOSER < 0, steps[n] - steps[n - 1], steps[n + 1] - steps[n])
        more.append(np.exp(steps[n] + CLOSER * gaps))
    if not more:
        return first
    second = both(np.unique(np.concatenate(more)), gamma, edge, branch, RTOL)
    order = np.argsort(np.concatenate([first["velocity"], second["velocity"]]))
    return {name: np.concatenate([first[name], second[name]])[order] for name in first}


def maxima(found: dict[str, np.ndarray], reading: str) -> list[tuple[float, float]]:
    """(velocity, mu) of the maxima, each parted from every higher one by a dip deeper than the error."""
    mu, error, velocity = found[reading], found["error"], found["velocity"]
    peaks = []
    for n in range(1, mu.size - 1):
        if not mu[n - 1] < mu[n] >= mu[n + 1]:
            continue
        sides = []
        for part in (mu[:n][::-1], mu[n + 1 :]):
            higher = np.flatnonzero(part > mu[n])
            if higher.size:
                sides.append(mu[n] - part[: higher[0] + 1].min())
        if not sides or min(sides) > CERTAIN * error[n]:
            peaks.append((float(velocity[n]), float(mu[n])))
    return peaks


def scan() -> dict[str, Any]:
    """The table of the audit."""
    rows: list[list[str]] = []
    several: dict[tuple[str, str, str], list[tuple[float, int]]] = {}
    for branch in ("unloading", "loading"):
        for edge in ("continuous", "constitutive"):
            for gamma in FEWER.get((edge, branch), ENERGIES):
                try:
                    found = curve(gamma, edge, branch)
                except (ArithmeticError, hystrip.SolverError) as problem:
                    rows.append([f"{gamma:g}", edge, branch, f"not solved: {problem}", ""])
                    print(*rows[-1], sep=" | ", flush=True)
                    continue
                row = [f"{gamma:g}", edge, branch]
                for reading in ("contact", "cell"):
                    peaks = maxima(found, reading)
                    row.append("; ".join(f"{mu:.4g} at {V:.3g}" for V, mu in peaks) or "none")
                    several.setdefault((edge, branch, reading), []).append((gamma, len(peaks)))
                rows.append(row)
                print(*row, f"{time.process_time():.0f} s", sep=" | ", flush=True)
    return {
        "caption": "Maxima of the friction coefficient over velocity (mu at V in m/s) for the two levels of the "
        "paper's Fig. 6 at "
        f"100 Pa, delta_0 = 10 nm, over {VELOCITIES.size} velocities from {VELOCITIES[0]:g} to {VELOCITIES[-1]:g} m/s and more "
        f"about each maximum, at rtol {RTOL:g}. A maximum counts that is parted from every higher one by a dip deeper than "
        f"{CERTAIN:g} error estimates. Eq. 13 is read over the contact alone, and over the whole cell as printed. The "
        f"paper's text "
        f"gives one energy, {GIVEN:g} N/m.",
        "shown": _ranges(several),
        "head": ["gamma, N/m", "closure", "branch", "contact alone", "whole cell"],
        "rows": rows,
    }


def _ranges(several: dict[tuple[str, str, str], list[tuple[float, int]]]) -> str:
    """For each way of reading, the scanned energies at which there are two maxima."""
    names = {"contact": "contact alone", "cell": "whole cell"}
    parts = []
    for (edge, branch, reading), counts in several.items():
        two = [f"{gamma:g}" for gamma, number in counts if number == 2]
        parts.append(f"{edge}, {branch}, {names[reading]}: {', '.join(two) or 'none'}")
    return "Energies (N/m) with two maxima. " + ". ".join(parts) + "."


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--dry", action="store_true", help="print the table and write nothing")
    chosen = parser.parse_args()
    table = scan()
    print(table["shown"])
    if chosen.dry:
        return
    folder = generated_folder()
    stored = read_measured(folder)
    stored[MODEL]["tables"][TABLE] = table
    write_files(folder, {MEASURED: dumped(stored)})


if __name__ == "__main__":
    main()
