"""Draw random scenes and solve each under a time limit: how many take long, and which.

    python tools/survey.py [--scenes 200] [--seed 1] [--demos 10]
    python tools/survey.py --seed 1 --only 17          # one scene again
    python tools/survey.py --seed 1 --wide             # ranges wider than anybody's

A scene has one to four levels, adhesive or not, either closure, either branch, an accuracy of 1e-1 to 1e-6, pressures of either
sign, and in one of five cases round numbers, as people type them. Times are CPU seconds of a process of its own, over those of
the demonstration's scene, measured first in the same run; a scene ends after ``--demos`` times that. Printed are the shares that
end below one and below ``--demos`` of it, the slowest with the line that replays them, and every scene that ended in an error, a
warning other than of convergence, or a number that is none. Exit status 1 if there is one of those.
"""

from __future__ import annotations

import argparse
import math
import multiprocessing
import random
import sys
import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

import hystrip

#: retardation over relaxation time, Deborah number, nominal pressures and tractions over K h of the first level; each level's
#: wavelength over the next one's, heights over wavelengths, ranges of adhesion over heights: usual ones and wide ones
_USUAL = {"stiffening": (1.5, 1e5), "speed": (1e-2, 1e4), "pressure": (1e-5, 2.0), "traction": (1e-4, 3.0)}
_USUAL |= {"next": (1.5, 30.0), "slope": (0.01, 0.3), "range": (1e-4, 0.3)}
_WIDE = {"stiffening": (1.001, 1e7), "speed": (1e-6, 1e8), "pressure": (1e-6, 3.0), "traction": (1e-6, 30.0)}
_WIDE |= {"next": (1.2, 100.0), "slope": (1e-4, 0.5), "range": (1e-6, 3.0)}
#: seconds that the reference scene is given, and how often it is timed
_PATIENCE, _REFERENCES = 600.0, 2


def draw(seed: int, number: int, wide: bool = False) -> dict[str, Any]:
    """Arguments of ``hystrip.solve`` for scene ``number`` of a seed."""
    rng, ranges = random.Random(f"survey {seed} {number}"), _WIDE if wide else _USUAL
    round_numbers = rng.random() < 0.2

    def between(low: float, high: float) -> float:
        value = math.exp(rng.uniform(math.log(low), math.log(high)))
        return float(f"{value:.0e}") if round_numbers else float(f"{value:.6g}")

    K, T_eps = 1e9, 1e-2
    material = hystrip.StandardLinearSolid(K, T_eps, T_eps / between(*ranges["stiffening"]))
    length, levels = 1e-5, []
    for _ in range(rng.choice((1, 2, 2, 3, 3, 4))):
        levels.append(hystrip.Level(length, float(f"{between(*ranges['slope']) * length:.6g}")))
        length = float(f"{length / between(*ranges['next']):.6g}")
    h = levels[0].h
    p_0 = float(f"{between(*ranges['traction']) * K * h:.6g}") if rng.random() < 0.85 else 0.0
    delta_0 = float(f"{between(*ranges['range']) * h:.6g}")
    if p_0 and rng.random() < 0.05:
        delta_0 = p_0 / K * material.T_sigma / T_eps  # the tie: whether a point snaps in is decided by a rounding
    pressure = float(f"{between(*ranges['pressure']) * K * h:.6g}")
    if p_0 and rng.random() < 0.15:
        pressure = -0.3 * rng.random() * p_0
    velocity = levels[0].l / (2 * math.pi * T_eps) * between(*ranges["speed"])
    return {
        "material": material,
        "adhesion": hystrip.Dugdale(p_0=p_0, delta_0=delta_0) if p_0 else hystrip.Dugdale(gamma=0),
        "levels": levels,
        "pressure": pressure,
        "velocity": float(f"{velocity:.6g}"),
        "edge": rng.choice(("continuous", "constitutive")),
        "branch": rng.choice(("unloading", "unloading", "loading")),
        "rtol": rng.choice((1e-1, 1e-2, 1e-3, 1e-3, 1e-4, 1e-6)),
    }


def demonstration() -> dict[str, Any]:
    """The scene of tools/demo.py."""
    return {
        "material": hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4),
        "adhesion": hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8),
        "levels": [hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9)],
        "pressure": 100.0,
        "velocity": np.geomspace(1e-5, 0.1, 60),
        "rtol": 1e-4,
    }


def _answer(pipe: Any, scene: dict[str, Any], seconds: float) -> None:
    import resource

    resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(seconds), math.ceil(seconds) + 1))
    start, problem, converged, strips = time.process_time(), "", True, 0
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", hystrip.ConvergenceWarning)
            result = hystrip.solve(**scene)
        converged, strips = bool(np.all(result.converged)), int(result.counts["strips_solved"])
        if not np.isfinite([result.mu, result.error_estimate, result.tau, result.contact_fraction]).all():
            problem = "a number that is none"
    except Exception as error:  # whatever it is, it is what the survey is for
        problem = f"{type(error).__name__}: {error}"
    pipe.send((time.process_time() - start, converged, strips, problem))


def solve(scene: dict[str, Any], seconds: float) -> tuple[float, bool, int, str]:
    """CPU seconds (inf: the limit ended it), whether all points converged, strips solved, what was wrong (or "")."""
    here, there = multiprocessing.Pipe(duplex=False)
    # a fork of a server, which has the library already and no threads
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["hystrip"])
    process = context.Process(target=_answer, args=(there, scene, seconds))
    process.start()
    there.close()
    try:
        answer: tuple[float, bool, int, str] = here.recv()
    except EOFError:
        answer = (math.inf, False, 0, "")
    process.join()
    return answer


def survey(seed: int, numbers: list[int], demos: float, say: Callable[[str], None], wide: bool = False) -> int:
    """Solve scenes of a seed and report; returns how many were wrong."""
    timed = [solve(demonstration(), _PATIENCE) for _ in range(_REFERENCES)]
    demo = min(seconds for seconds, *_ in timed)
    say(f"the demonstration: {demo:.2f} s")
    answers, replay = {}, f"python tools/survey.py --seed {seed}{' --wide' * wide} --only"
    for number in numbers:
        answers[number] = solve(draw(seed, number, wide), demos * demo)
        if not math.isfinite(answers[number][0]):  # at once: whoever waits may look into it
            say(f"did not end: {replay} {number}")
    times = np.array([seconds / demo for seconds, *_ in answers.values()])
    wrong = {number: problem for number, (*_, problem) in answers.items() if problem}
    open_ = [number for number, (seconds, converged, _, problem) in answers.items() if not (converged or problem)]
    missed = sum(math.isfinite(answers[number][0]) for number in open_)
    above, slow = np.count_nonzero(times >= demos), np.count_nonzero(times >= 1)
    say(f"{times.size} scenes: {above} above {demos:g} demonstrations, {slow} above one")
    say(f"median {np.median(times):.3g} of it; {missed} ended without converging")
    for i in np.argsort(-times)[:10].tolist():
        number, (_, converged, strips, _) = list(answers.items())[i]
        state = "" if converged else ", not converged"
        took = f"{times[i]:6.2f} demonstrations, {strips} strips{state}" if math.isfinite(times[i]) else "did not end"
        say(f"{took}: {replay} {number}")
    for number, problem in wrong.items():
        say(f"{problem}: {replay} {number}")
    return len(wrong)


def main(argv: list[str] | None = None) -> int:
    """The command. Returns its exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--demos", type=float, default=10.0)
    parser.add_argument("--wide", action="store_true", help="draw from wider ranges")
    parser.add_argument("--only", type=int, nargs="+", metavar="NUMBER", help="these scenes alone")
    options = parser.parse_args(argv)
    numbers = options.only or list(range(options.scenes))
    say = lambda text: print(text, flush=True)  # noqa: E731
    for number in options.only or []:
        say(", ".join(f"{name}={value!r}" for name, value in draw(options.seed, number, options.wide).items()))
    return 1 if survey(options.seed, numbers, options.demos, say, options.wide) else 0


if __name__ == "__main__":
    sys.exit(main())
