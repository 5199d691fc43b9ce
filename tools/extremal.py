"""Check the branch of random strips against plain iteration of the period map (tests/oracle/iterate.py).

    python tools/extremal.py [--seed 1] [--scenes 10000] [--chunk 2000] [--longest 300] [--periods 4000]

A scene is one strip and one closure, iterated twice: from deep contact (unloading) and from far below (loading). beta
is at most ``--longest``. A fifth of the scenes are moved next to the end of a branch, by fold or by grazing, on the
side where it exists. An orbit agrees if the sequence of zones, both fractions (1e-6) and the mean pressure (1e-6 of
``|p_mean| + K A + p_0``) do. A strip that has not settled is next to a fold; its iterates are then compared to what the
time of settling allows.

Iteration in doubles can itself settle on the wrong side of a contact that is only just grazed. Each strip that differs
is therefore put before the 50-digit march (tests/oracle/march.py). Exit status 1 if that does not side with the solver,
to 1e-9, on any of them.
"""

import argparse
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

import scenes
from oracle import march
from oracle.iterate import iterate

AGREE = 1e-6
#: how closely the 50-digit march has to confirm a strip on which iteration differs
CONFIRMED = 1e-9


@dataclass
class Outcome:
    """Counts of scenes, and the strips that differ: (what, line). ``worst``: largest difference of a fraction that was
    let pass, with its line."""

    scenes: int = 0
    coexisting: int = 0
    ends: Counter = field(default_factory=Counter)
    strips: int = 0
    settled: int = 0
    slowest: float = 0.0
    worst: tuple = (0.0, "")
    differ: list = field(default_factory=list)


def groups(scene):
    """alpha, beta, P0, Delta, delta of a scene."""
    rate, unit = 2 * np.pi / scene["l"] * scene["V"], scene["A"]
    return (
        rate * scene["T_sigma"],
        rate * scene["T_eps"],
        scene["p_0"] / (scene["K"] * unit),
        scene["delta_0"] / unit,
        scene["D"] / unit,
    )


def compare(scene, edge, outcome, periods):
    """Solve and iterate both branches of a scene; returns both solutions."""
    _, _, P0, _, delta = groups(scene)
    n = delta.size
    # a period takes as long for few points as for many
    deep = np.repeat([branch == "unloading" for branch in scenes.BRANCHES], n)
    both = iterate(*np.tile(groups(scene), 2), np.full(2 * n, edge == "constitutive"), deep, periods)
    found = {}
    for number, branch in enumerate(scenes.BRANCHES):
        s = found[branch] = scenes.solve(scene, edge, branch)
        r = both.take(slice(number * n, (number + 1) * n))
        settled = np.isfinite(r.remaining) & (r.remaining < AGREE * (1 + np.abs(delta) + P0))
        fractions = np.maximum(np.abs(r.contact - s.contact_fraction), np.abs(r.adhesion - s.adhesion_fraction))
        p = s.p_mean / (scene["K"] * scene["A"])
        pressure = np.abs(r.pressure - p) / (np.abs(p) + 1 + P0)
        differs = (r.sequence != s.regime) | (fractions > AGREE) | (pressure > AGREE)
        outcome.strips += n
        outcome.settled += int(settled.sum())
        outcome.slowest = max(outcome.slowest, float(np.nanmax(np.where(settled, r.contraction, 0.0))))
        for i in np.flatnonzero(settled & differs):
            outcome.differ.append((f"{r.sequence[i]}, not {s.regime[i]}", scenes.line(scene, i, edge, branch)))
        i = np.argmax(np.where(settled & ~differs, fractions, 0.0))
        outcome.worst = max(
            outcome.worst, (float(fractions[i] if settled[i] and not differs[i] else 0.0), scenes.line(scene, i, edge, branch))
        )
    one, two = found.values()
    apart = np.abs(one.contact_fraction - two.contact_fraction) + np.abs(one.adhesion_fraction - two.adhesion_fraction)
    outcome.scenes += n
    outcome.coexisting += int(np.count_nonzero((apart > AGREE) | (one.regime != two.regime)))
    return found


def next_to_an_end(rng, scene, edge, branch):
    """Strips moved to within 1e-9..1e-2 of the penetration where the sequence of their branch changes, found by
    bisection, on either side; and how it ends."""
    size = scene["A"]
    span = size + scene["delta_0"] + scene["p_0"] / scene["K"]
    low, high = -span - size, scene["D"].copy()
    at = lambda D: scenes.solve(scene | {"D": D}, edge, branch).regime  # noqa: E731
    there = at(high)
    useful = at(low) != there
    for _ in range(40):
        middle = low + 0.5 * (high - low)
        same = at(middle) == there
        high, low = np.where(same, middle, high), np.where(same, low, middle)
    away = span * scenes.log_uniform(rng, 1e-9, 1e-2, span.size)
    D = np.where(rng.random(span.size) < 0.7, high + away, low - away)
    return scene | {"D": np.where(useful, D, scene["D"])}, scene | {"D": high}, useful


def kind_of_end(scene, i, edge, branch):
    """Whether the branch that ends at this strip does so by a fold (the slope of its map tends to one) or by grazing."""
    inputs = {name: float(scene[name][i]) for name in scenes.FIELDS}
    try:
        orbit = march.solve_si(**inputs, edge=edge, branch=branch, digits=40)
    except ArithmeticError:
        return "fold"
    return "fold" if abs(1 - orbit.slope) < 1e-3 else "graze"


def survey(count, seed, chunk=2000, longest=300.0, periods=4000, report=None, classify=20):
    """Compare ``count`` scenes, ``chunk`` at a time."""
    outcome = Outcome()
    for number, start in enumerate(range(0, count, chunk)):
        rng = np.random.default_rng((seed, number))
        n = min(chunk, count - start)
        for edge, size in zip(scenes.EDGES, (n - n // 2, n // 2), strict=True):
            drawn = scenes.moderate(rng, size, longest)
            fifth = size // 5
            if fifth:
                branch = scenes.BRANCHES[number % 2]
                moved, ends, useful = next_to_an_end(rng, scenes.take(drawn, np.arange(fifth)), edge, branch)
                outcome.ends.update(kind_of_end(ends, i, edge, branch) for i in np.flatnonzero(useful)[:classify])
                drawn = {name: np.concatenate((moved[name], drawn[name][fifth:])) for name in drawn}
            compare(drawn, edge, outcome, periods)
            if report:
                report(outcome)
    return outcome


def confirmed(text):
    """Whether the 50-digit march finds the solver's orbit for the strip of a line: its sequence, fractions and mean
    pressure to ``CONFIRMED``."""
    scene, edge, branch = scenes.parse(text)
    s = scenes.solve(scene, edge, branch)
    orbit = march.solve_si(**{name: float(scene[name][0]) for name in scenes.FIELDS}, edge=edge, branch=branch)
    scale = abs(float(orbit.p_mean)) + float(scene["K"][0] * scene["A"][0] + scene["p_0"][0])
    apart = (
        float(s.contact_fraction[0] - orbit.contact_fraction),
        float(s.adhesion_fraction[0] - orbit.adhesion_fraction),
        float(s.p_mean[0] - orbit.p_mean) / scale,
    )
    return s.regime[0] == orbit.sequence and max(map(abs, apart)) <= CONFIRMED


def show(outcome, seconds):
    """Print an outcome; returns the number of strips on which the 50-digit march does not side with the solver."""
    print(
        f"{outcome.scenes} scenes in {seconds:.0f} s, {outcome.coexisting} with coexisting orbits; "
        f"ends of branches looked at: {dict(outcome.ends)}"
    )
    print(f"{outcome.strips} orbits, {outcome.settled} settled, the slowest contracting by {outcome.slowest:.6f} per period")
    print(f"largest difference of a fraction among those that agree: {outcome.worst[0]:.2g}\n  {outcome.worst[1]}")
    print(f"orbits that differ: {len(outcome.differ)}")
    refuted = 0
    for what, text in outcome.differ:
        sides = confirmed(text)
        refuted += not sides
        print(f"  {what}; the 50-digit march {'sides' if sides else 'does not side'} with the solver:  {text}")
    print(f"of these the 50-digit march does not confirm the solver in {refuted}")
    return refuted


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scenes", type=int, default=10_000)
    parser.add_argument("--chunk", type=int, default=2_000, help="scenes iterated at a time")
    parser.add_argument("--longest", type=float, default=300.0, help="largest beta = k V T_eps")
    parser.add_argument("--periods", type=int, default=4_000, help="most periods to wait for a repeat")
    options = parser.parse_args()
    start = time.perf_counter()

    def report(outcome):
        print(f"\r{outcome.scenes} scenes, {len(outcome.differ)} differ", end="", file=sys.stderr, flush=True)

    outcome = survey(options.scenes, options.seed, options.chunk, options.longest, options.periods, report)
    print(file=sys.stderr)
    return 1 if show(outcome, time.perf_counter() - start) else 0


if __name__ == "__main__":
    sys.exit(main())
