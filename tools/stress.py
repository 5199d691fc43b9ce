"""Solve random strips over the extremes of parameter space, and say what went wrong, if anything did.

    python tools/stress.py [--seed 1] [--size 1000000] [--chunk 20000] [--worst 5]
    python tools/stress.py --replay 'edge=continuous branch=loading l=... A=... D=... V=... K=... T_eps=... ...'

Runs under ``numpy.errstate(over="raise", divide="raise", invalid="raise")``. A strip fails if it raises, is refused as
uncertified, has a NaN where a number belongs (or a number where NaN does), or breaks a bound that every solution obeys.
Every failure and the strips that took the most work, or have the largest last correction, are printed as lines to
replay. Exit status 1 if any strip failed.
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

import hystrip
from hystrip.generated import standard_linear_solid as kernel

UNKNOWNS = {"acaf": "dbac", "afc": "dac", "af": "dc", "ac": "ba", "cf": "ba"}
EPS = np.finfo(float).eps
PRESENT = {"acaf": "abcd", "afc": "abc", "af": "cd", "ac": "ab", "cf": "ab", "c": "", "a": "", "f": ""}


@dataclass
class Outcome:
    """What a survey found. ``failures``: (what, line); ``corrections``: the largest, (amount, line), descending."""

    solved: int = 0
    regimes: Counter = field(default_factory=Counter)
    failures: list = field(default_factory=list)
    corrections: list = field(default_factory=list)


def survey(size, seed, chunk=20000, worst=5, draw=scenes.extreme, report=None):
    """Draw and solve ``size`` strips, ``chunk`` at a time: memory does not grow with the size."""
    outcome = Outcome()
    for number, start in enumerate(range(0, size, chunk)):
        rng = np.random.default_rng((seed, number))
        drawn = draw(rng, min(chunk, size - start))
        kind = rng.integers(0, 4, drawn["l"].size)
        for i in range(4):
            edge, branch = scenes.EDGES[i % 2], scenes.BRANCHES[i // 2]
            _group(scenes.take(drawn, kind == i), edge, branch, outcome, worst)
        if report:
            report(outcome)
    return outcome


def _group(scene, edge, branch, outcome, worst):
    count = scene["l"].size
    outcome.solved += count
    for index, solution, error in _solutions(scene, np.arange(count), edge, branch):
        if error is not None:
            kind = "uncertified" if isinstance(error, hystrip.SolverError) else f"{type(error).__name__}: {error}"
            outcome.failures.append((kind, scenes.line(scene, index[0], edge, branch)))
            continue
        outcome.regimes.update(solution.regime.tolist())
        part = scenes.take(scene, index)
        for what, wrong in broken(solution, part).items():
            outcome.failures += [(what, scenes.line(part, i, edge, branch)) for i in np.flatnonzero(wrong)]
        last = corrections(solution)
        outcome.corrections += [(float(last[i]), scenes.line(part, i, edge, branch)) for i in np.argsort(last)[-worst:]]
        outcome.corrections.sort(reverse=True)
        del outcome.corrections[worst:]


def _solutions(scene, index, edge, branch):
    """(indices, solution, None) of what can be solved, (index, None, error) of each strip that cannot, found by halving."""
    try:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            yield index, scenes.solve(scenes.take(scene, index), edge, branch), None
    except Exception as error:  # whatever it is, it is what we are looking for
        if index.size == 1:
            yield index, None, error
            return
        half = index.size // 2
        yield from _solutions(scene, index[:half], edge, branch)
        yield from _solutions(scene, index[half:], edge, branch)


def broken(s, scene):
    """Bounds that every solution obeys, and where they are broken."""
    slack = 1e-12
    p_0, unit = scene["p_0"], scene["K"] * scene["A"]
    engaged = s.contact_fraction + s.adhesion_fraction
    scale = np.abs(s.p_mean) + p_0 + unit
    values = (s.p_mean, s.tau_mean, s.contact_fraction, s.adhesion_fraction)
    absent = np.array([[name not in PRESENT[r] for r in s.regime] for name in "abcd"]).reshape(4, -1)
    edges = np.array([s.a, s.b, s.c, s.d])
    touching = np.array(["c" in regime for regime in s.regime])
    return {
        "mean or fraction not finite": ~np.all(np.isfinite(values), axis=0),
        "edge missing or too many": np.any(np.isnan(edges) != absent, axis=0) | np.any(np.isinf(edges), axis=0),
        "fraction outside [0, 1]": (s.contact_fraction < 0) | (s.adhesion_fraction < 0) | (engaged > 1 + slack),
        "pressure below the adhesive traction": s.p_mean + p_0 * engaged < -slack * scale,
        "pressure without contact": ~touching & (s.p_mean > 0),
        "edges out of order": _disordered(s, scene["l"]),
    }


def _disordered(s, wavelength):
    """Where the edges that exist are not met in the order d, b, -a, -c within one wavelength (x falls in time)."""
    met = np.array([s.d, s.b, -s.a, -s.c])
    wrong = np.zeros(wavelength.size, bool)
    for i in range(4):
        for j in range(i):
            later, earlier = met[i], met[j]
            both = ~np.isnan(later) & ~np.isnan(earlier)
            span = np.where(both, earlier, 0.0) - np.where(both, later, 0.0)
            wrong |= both & ((span < -1e-12 * wavelength) | (span > (1 + 1e-12) * wavelength))
    return wrong


def corrections(s):
    """Newton step that the boundary equations would still take from the returned edges, in units of what rounding
    leaves uncertain."""
    strips, solved, out = s._strips, s._solved, np.zeros(s.p_mean.size)
    for regime, names in UNKNOWNS.items():
        index = np.flatnonzero((s.regime == regime) & (strips.beta > 0))
        if not index.size:
            continue
        g = strips.take(index)
        groups = [getattr(g, name) for name in kernel.PARAMETERS]
        edges = [getattr(solved, name)[index] for name in names]
        solver = "ac" if regime == "cf" else regime
        with np.errstate(all="ignore"):
            residual, jacobian = _residual(getattr(kernel, f"residual_{solver}"), np.array(edges), groups)
            rounding = EPS * (1 + np.abs(g.D) + g.p_0 + g.delta_0 + kernel.modulus_ratio(g.alpha, g.beta))
            size = np.abs(jacobian).max(axis=2, keepdims=True)
            jacobian = jacobian / np.where(size > 0, size, 1.0)
            usable = np.abs(np.linalg.det(jacobian)) > 1e-14  # otherwise two edges all but coincide
            inverse = np.cumsum(np.linalg.inv(jacobian[usable]) / size[usable].transpose(0, 2, 1), axis=1)
            step = np.abs(inverse @ residual.T[usable, :, None]).max(axis=(1, 2))
            uncertain = np.abs(inverse).sum(axis=2).max(axis=1) * rounding[usable] + 4 * EPS
        out[index[usable]] = step / uncertain
    return np.nan_to_num(out)


def _residual(function, edges, groups):
    """What the boundary equations leave (k, n), and central differences of it by the first edge and by the zones (n, k, k)."""
    value = np.array(function(*edges, *groups))
    widths = np.concatenate((np.ones((1, edges.shape[1])), np.diff(edges, axis=0)))
    columns = []
    for i, width in enumerate(widths):
        moved = np.where(np.arange(len(edges))[:, None] >= i, 1e-4 * np.minimum(width, 1.0), 0.0)
        above, below = (np.array(function(*(edges + sign * moved), *groups)) for sign in (1, -1))
        columns.append((above - below) / (2 * moved[-1]))
    return value, np.array(columns).transpose(2, 1, 0)


def replay(text):
    """Solve the one strip of a printed line and show everything known of it."""
    scene, edge, branch = scenes.parse(text)
    with np.errstate(over="raise", divide="raise", invalid="raise"):
        s = scenes.solve(scene, edge, branch)
    for name in ("regime", "p_mean", "tau_mean", "contact_fraction", "adhesion_fraction", "a", "b", "c", "d"):
        print(f"{name:18} {getattr(s, name)[0]}")
    print(f"{'last correction':18} {corrections(s)[0]:.2g}")
    wrong = [what for what, where in broken(s, scene).items() if where[0]]
    print("\n".join(wrong) if wrong else "every bound holds")
    return 1 if wrong else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--size", type=int, default=1_000_000, help="number of strips")
    parser.add_argument("--chunk", type=int, default=20_000, help="strips drawn at a time")
    parser.add_argument("--worst", type=int, default=5, help="how many of the worst to print")
    parser.add_argument("--replay", metavar="LINE", help="solve the strip of a printed line instead")
    options = parser.parse_args()
    if options.replay:
        return replay(options.replay)
    start = time.perf_counter()

    def report(outcome):
        print(f"\r{outcome.solved} strips, {len(outcome.failures)} failures", end="", file=sys.stderr, flush=True)

    outcome = survey(options.size, options.seed, options.chunk, options.worst, report=report)
    print(file=sys.stderr)
    show(outcome, time.perf_counter() - start)
    return 1 if outcome.failures else 0


def show(outcome, seconds):
    """Print an outcome."""
    print(f"{outcome.solved} strips in {seconds:.1f} s")
    print("regimes: " + ", ".join(f"{name} {count}" for name, count in outcome.regimes.most_common()))
    print("largest last corrections, in units of what rounding leaves uncertain:")
    for amount, text in outcome.corrections:
        print(f"  {amount:.2g}  {text}")
    print(f"failures: {len(outcome.failures)}", dict(Counter(what for what, _ in outcome.failures)))
    for what, text in outcome.failures[:50]:
        print(f"  {what}:  {text}")


if __name__ == "__main__":
    sys.exit(main())
