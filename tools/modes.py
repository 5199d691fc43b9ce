"""Solve random strips on foundations with several relaxation times and compare each with the 50-digit march of tests/oracle.

    python tools/modes.py [--seed 1] [--scenes 300] [--times 0 2 3] [--solver FOLDER]

0 times stands for Kelvin-Voigt, with a retardation time and no relaxation time.

Prints how many strips could be certified, the errors in units of the natural scales (``|p| + K A + p_0`` and so on) and
every strip that misses its tolerance. Exits with 1 if one does. With ``--solver`` the solver of a generated folder, for
its number of times.
"""

import argparse
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

import mode_scenes as ms
from oracle.orbits import Unresolved

import hystrip


def attempt(scenes, branch, solver):
    """Solutions scene by scene, None where one could not be certified."""
    try:
        found = ms.viscous(scenes, branch) if scenes[0].get("viscous") else ms.solve(scenes, branch, solver)
        return [(found, i) for i in range(len(scenes))]
    except hystrip.SolverError:
        if len(scenes) == 1:
            return [None]
        half = len(scenes) // 2
        return attempt(scenes[:half], branch, solver) + attempt(scenes[half:], branch, solver)


def survey(seed, count, n, wide, solver=None, report=None):
    """Errors, tolerances missed, and counts of a run of ``count`` scenes with n times."""
    rng = np.random.default_rng((seed, n, wide))
    scenes = [ms.draw(rng, n or 1, wide) | {"viscous": not n} for _ in range(count)]
    errors, bad, counts = [], [], Counter()
    for branch in ms.BRANCHES:
        for k, (scene, found) in enumerate(zip(scenes, attempt(scenes, branch, solver), strict=True)):
            if found is None:
                counts["uncertified"] += 1
                bad.append(("uncertified", branch, scene))
                continue
            try:
                error, allowed, sequence = ms.compare(scene, branch, *found)
            except (Unresolved, ArithmeticError) as failure:
                counts["march undecided"] += 1
                counts[str(failure)] += 1
                continue
            counts[sequence] += 1
            errors.append(error)
            counts["beyond 1e-11, ill-conditioned"] += error > ms.TOLERANCE and error <= allowed
            if error > allowed:
                bad.append((f"error {error:.2g} > {allowed:.2g}", branch, scene))
            if report:
                report(f"n={n} {'wide' if wide else 'near 1'} {branch} {k + 1}/{count}, {len(bad)} bad")
    return np.array(errors), bad, counts


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scenes", type=int, default=300, help="scenes for each number of times; half of them over wide ranges")
    parser.add_argument("--times", type=int, nargs="+", default=[0, 2, 3])
    parser.add_argument("--solver", help="folder of a generated solver to use instead of the package's")
    options = parser.parse_args()
    solver = hystrip.load_solver(options.solver) if options.solver else None
    failed = 0
    for n in options.times:
        for wide in (False, True):
            start = time.perf_counter()
            say = lambda text: print("\r" + text, end="", file=sys.stderr, flush=True)  # noqa: E731
            errors, bad, counts = survey(options.seed, options.scenes // 2, n, wide, solver, say)
            print(file=sys.stderr)
            seconds = time.perf_counter() - start
            print(f"n = {n}, {'wide' if wide else 'near 1'}: {errors.size} orbits compared in {seconds:.0f} s, {dict(counts)}")
            print(
                f"  error: median {np.median(errors):.1e}, 99 % {np.quantile(errors, 0.99):.1e}, "
                f"largest {errors.max():.1e}; bad: {len(bad)}"
            )
            for what, branch, scene in bad:
                print(f"  {what}: {branch} {scene}")
            failed += len(bad)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
