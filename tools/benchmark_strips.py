"""Time per strip: the batched solver against a strip-by-strip script, in one run.

    python tools/benchmark_strips.py [--strips 100000] [--levels 40] [--repeat 3] [--memory]

The batch is mixed: levels of the paper's material and two wavelengths at random velocity, penetration and energy of adhesion, cut into
100 strips each as in the paper. The script is what a user would write for the same strips: the boundary equations in scalar ``math``,
``scipy.optimize.root`` (hybr, analytic Jacobian), each strip started from its neighbour's solution. It is spared what the batch has to
decide: it is told the regime of every strip, and given the solution as a start where the regime changes. Times are CPU seconds; medians over the repeats.
``--memory`` solves 1e7 strips and reports the peak of the process instead.
"""

import argparse
import math
import time

import numpy as np

import hystrip
from hystrip.strip.solution import SEQUENCES

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
DELTA_0 = 1e-8
PER_LEVEL = 100
TWO_PI = 2 * math.pi


def levels(number, rng, alpha=None):
    """SI inputs of the strips of ``number`` random levels, (number, 100) each; ``alpha`` fixes k V T_sigma."""
    fine = rng.random((number, 1)) < 0.5
    l, h = np.where(fine, 500e-9, 10e-6), np.where(fine, 100e-9, 1e-6)  # noqa: E741
    k = 2 * np.pi / l
    V = 10 ** rng.uniform(-5, -1, (number, 1)) if alpha is None else alpha / (k * MATERIAL.T_sigma)
    p_0 = 10 ** rng.uniform(-6, -4.3, (number, 1)) / DELTA_0
    ratio = np.hypot(1, k * V * MATERIAL.T_eps) / np.hypot(1, k * V * MATERIAL.T_sigma)
    D = -DELTA_0 + rng.random((number, 1)) ** 2 * (1.1 * (h / 2 * (1 + ratio)) + DELTA_0)
    y = np.pi * (np.arange(PER_LEVEL) + 0.5) / PER_LEVEL
    A = h / 4 * (1 + np.cos(y))
    wide = lambda v: np.broadcast_to(v, (number, PER_LEVEL))  # noqa: E731
    return {"l": wide(l), "A": A, "D": D - h / 2 * (1 - np.cos(y)), "V": wide(V)}, wide(p_0)


def batch(inputs, p_0):
    """CPU seconds per strip, and the solution."""
    adhesion = hystrip.Dugdale(p_0=p_0, delta_0=DELTA_0)
    start = time.process_time()
    solution = hystrip.solve_strip(MATERIAL, adhesion, **inputs)
    return (time.process_time() - start) / solution.p_mean.size, solution


class Script:
    """Boundary equations of one strip, continuous closure, dimensionless; edges d, b, a, c as phases in the order they are met."""

    def __init__(self, alpha, beta, p_0, delta_0, D):
        self.alpha, self.beta, self.p_0, self.delta_0, self.D = alpha, beta, p_0, delta_0, D
        self.storage, self.loss = (1 + alpha * beta) / (1 + alpha**2), (beta - alpha) / (1 + alpha**2)

    def u(self, s):
        return self.D - 1 + math.cos(s)

    def gap(self, start, end, lag, p):
        """w - u at ``end`` after ``lag`` = w - p at ``start``, and its derivatives by start, end and lag."""
        fade = math.exp(-(end - start) / self.beta)
        return p + lag * fade - self.u(end), lag * fade / self.beta, math.sin(end) - lag * fade / self.beta, fade

    def contact(self, start, end):
        """Pressure over -p_0 at the end of contact, and its derivatives by start and end."""
        field = lambda s: self.D - 1 + self.storage * math.cos(s) - self.loss * math.sin(s)  # noqa: E731
        slope = lambda s: -self.storage * math.sin(s) - self.loss * math.cos(s)  # noqa: E731
        fade = math.exp(-(end - start) / self.alpha)
        excess = field(start) + self.p_0
        return (
            field(end) - excess * fade + self.p_0,
            -fade * (slope(start) + excess / self.alpha),
            slope(end) + fade * excess / self.alpha,
        )

    def acaf(self, edges):
        d, b, a, c = edges
        p, reach = self.p_0, self.delta_0
        on, on_d, on_b, fade = self.gap(d, b, self.u(d) + reach + p, -p)
        q, q_b, q_a = self.contact(b, a)
        off, off_a, off_c, trail = self.gap(a, c, self.u(a) + p, -p)
        free, free_c, free_d, last = self.gap(c, d + TWO_PI, self.u(c) + reach, 0.0)
        values = [on, q, off - reach, free - reach]
        return values, [
            [on_d - math.sin(d) * fade, on_b, 0, 0],
            [0, q_b, q_a, 0],
            [0, 0, off_a - math.sin(a) * trail, off_c],
            [free_d, 0, 0, free_c - math.sin(c) * last],
        ]

    def af(self, edges):
        d, c = edges
        p, reach = self.p_0, self.delta_0
        off, off_d, off_c, fade = self.gap(d, c, self.u(d) + reach + p, -p)
        free, free_c, free_d, last = self.gap(c, d + TWO_PI, self.u(c) + reach, 0.0)
        jacobian = [[off_d - math.sin(d) * fade, off_c], [free_d, free_c - math.sin(c) * last]]
        return [off - reach, free - reach], jacobian

    def ac(self, edges):
        b, a = edges
        q, q_b, q_a = self.contact(b, a)
        gap, gap_a, gap_b, fade = self.gap(a, b + TWO_PI, self.u(a) + self.p_0, -self.p_0)
        return [gap, q], [[gap_b, gap_a - math.sin(a) * fade], [q_b, q_a]]

    def c(self):
        return self.D - 1, self.loss / 2


EDGES = {"acaf": "dbac", "af": "dc", "ac": "ba"}


def script(inputs, p_0, solution):
    """CPU seconds per strip and share of failures, over the strips of these levels one by one."""
    from scipy.optimize import root

    k = 2 * np.pi / inputs["l"]
    scale = MATERIAL.K * inputs["A"]
    columns = (k * inputs["V"] * MATERIAL.T_sigma, k * inputs["V"] * MATERIAL.T_eps, p_0 / scale, DELTA_0 / inputs["A"], inputs["D"] / inputs["A"])
    groups = np.stack([np.broadcast_to(v, scale.shape) for v in columns], -1).tolist()
    phase = {"d": -solution.d * k, "b": -solution.b * k, "a": solution.a * k, "c": solution.c * k}
    given = {r: np.stack([phase[e] for e in names], -1).tolist() for r, names in EDGES.items()}
    regimes = solution.regime.tolist()
    failures = solved = 0
    start = time.process_time()
    for i, row in enumerate(regimes):
        before = edges = None
        for j, regime in enumerate(row):
            strip = Script(*groups[i][j])
            if regime in EDGES:
                guess = edges if regime == before else given[regime][i][j]
                found = root(getattr(strip, regime), guess, jac=True, method="hybr")
                solved += 1
                failures += not found.success
                edges = found.x if found.success else given[regime][i][j]
            elif regime == "c":
                strip.c()
            before = regime
    return (time.process_time() - start) / scale.size, failures / max(solved, 1)


def compare(options, rng):
    inputs, p_0 = levels(options.strips // PER_LEVEL, rng)
    batch({n: v[:5] for n, v in inputs.items()}, p_0[:5])  # imports
    rows, work = [], None
    for _ in range(options.repeat):
        batched, solution = batch(inputs, p_0)
        some = slice(0, options.levels)
        scripted, failed = script({n: v[some] for n, v in inputs.items()}, p_0[some], _Part(solution, some))
        lone = np.median([batch({n: v[i, :1] for n, v in inputs.items()}, p_0[i, :1])[0] for i in range(30)])
        rows.append((batched, scripted, scripted / batched, lone, failed))
        work = solution._solved.evaluations
    batched, scripted, ratio, lone, failed = np.median(rows, axis=0)
    share = {r: float(np.mean(solution.regime == r)) for r in SEQUENCES if np.any(solution.regime == r)}
    partial = np.isin(solution.regime.ravel(), list(EDGES))
    print(f"{options.strips} strips: " + ", ".join(f"{r} {100 * v:.0f} %" for r, v in share.items()))
    print(f"medians of {options.repeat} runs, CPU microseconds per strip: batch {batched * 1e6:.2f}, script {scripted * 1e6:.1f} "
          f"({100 * failed:.1f} % of its solves fail); a lone strip {lone * 1e6:.0f}")  # fmt: skip
    print(f"ratio: {ratio:.1f}")
    print("evaluations of residuals, Jacobians and events of map segments per strip: median %g, 99th percentile %g; strips with edges: median %g, 99th "
          "percentile %g" % (*np.percentile(work, (50, 99)), *np.percentile(work[partial], (50, 99))))  # fmt: skip


class _Part:
    """Regimes and edges of some rows of a solution."""

    def __init__(self, solution, rows):
        self.regime = solution.regime[rows]
        self.a, self.b, self.c, self.d = (getattr(solution, e)[rows] for e in "abcd")


def flatness(options, rng):
    """Time per strip over alpha, beta = 100 alpha."""
    print("alpha: microseconds per strip")
    for exponent in range(-6, 7, 2):
        inputs, p_0 = levels(options.strips // PER_LEVEL, rng, alpha=10.0**exponent)
        times = [batch(inputs, p_0)[0] for _ in range(options.repeat)]
        print(f"  1e{exponent:+d}: {np.median(times) * 1e6:.2f}")


def memory(rng):
    """Peak memory of 1e7 strips in one call."""
    import resource

    inputs, p_0 = levels(100_000, rng)
    one = {n: np.ascontiguousarray(v) if n in ("A", "D") else float(v[0, 0]) for n, v in inputs.items()}
    start = time.process_time()
    solution = hystrip.solve_strip(MATERIAL, hystrip.Dugdale(p_0=float(p_0[0, 0]), delta_0=DELTA_0), **one)
    seconds = time.process_time() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(f"{solution.contact_fraction.size} strips in {seconds:.0f} s, peak memory {peak:.2f} GiB")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--strips", type=int, default=100_000)
    parser.add_argument("--levels", type=int, default=40, help="levels that the script solves")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--memory", action="store_true", help="1e7 strips: peak memory")
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    if options.memory:
        memory(rng)
    else:
        compare(options, rng)
        flatness(options, rng)


if __name__ == "__main__":
    main()
