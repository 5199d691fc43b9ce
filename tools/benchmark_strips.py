"""Time per strip: the batched solver against strip-by-strip scripts, in one run.

    python tools/benchmark_strips.py [--strips 100000] [--levels 250] [--repeat 3] [--memory]

The batch is mixed: levels of the paper's material and two wavelengths at random velocity, penetration and energy of adhesion, cut
into 100 strips each as in the paper. The scripts are what a user would write for the same strips: the boundary equations in
scalar ``math``, ``scipy.optimize.root`` (hybr, analytic Jacobian), each strip started from its neighbour's solution, strips in
complete contact by their threshold.

* ``told``: is told the regime of every strip, and given the solution as a start where the regime changes: it never has to find
  anything.
* ``finding``: finds the regime as well. It takes the neighbour's zones and edges, solves, checks the inequalities, and where they
  fail tries the
  other regimes from rough starts, the library's medians and the elastic strip's. Outwards of a free strip that is out of reach it
  takes the strips to be free. It proves nothing: what it finds may be another orbit than the one asked for.

Times are CPU seconds; medians over the repeats. ``--memory`` solves 1e7 strips and reports the peak of the process instead.
"""

import argparse
import math
import time

import numpy as np

import hystrip
from hystrip.orbit.regimes import SEQUENCES

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
DELTA_0 = 1e-8
PER_LEVEL = 100
TWO_PI = 2 * math.pi
#: where the script starts from, medians over random strips: place of the onset in its arc, -1 to 1, by log10 of beta; the end of
#: contact behind the start of its arc, as a share of it, on slow foundations; and that of adhesion
DECADES = (-2.0, -1.0, 0.0, 1.0, 2.0, 3.0)
ONSET = {"adhesive": (-0.99, -0.9, -0.4, -0.05, -0.1, -0.15), "bare": (-0.99, -0.95, -0.7, -0.4, -0.25, -0.15), "af": (0.9,) * 6}
CONTACT_END, SLOW, RELEASE = 0.45, 60.0, 0.1


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
    """Boundary equations of one strip, continuous closure, dimensionless; edges d, b, a, c as phases in the order they are
    met."""

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

    def saturated(self):
        return self.D - 1 + self.p_0 >= math.hypot(self.storage, self.loss)

    def admissible(self, sequence, edges):
        """Edges in order within a period, each where its event can happen, and gaps within their bounds at the ends of the
        arcs."""
        H = lambda s: self.u(s) - self.beta * math.sin(s)  # noqa: E731
        order = [*edges, edges[0] + TWO_PI]
        if any(later < earlier for earlier, later in zip(order, order[1:], strict=False)):
            return False
        p, reach, named = self.p_0, self.delta_0, dict(zip(EDGES[sequence], edges, strict=True))
        if "d" in named and (H(named["d"]) + reach < 0 or H(named["c"]) + reach + p > 0):
            return False
        if "b" in named and (H(named["b"]) + p < 0 or H(named["a"]) + p > 0):
            return False
        if sequence == "acaf":
            return True
        centre, amplitude = -math.atan(self.beta), math.hypot(1, self.beta)
        level = self.D - 1 + p + (reach if sequence == "ac" else 0.0)
        if level <= -amplitude:
            return sequence == "af"
        half = math.acos(max(-level / amplitude, -1.0))
        if sequence == "af":
            end = max(centre + half, named["d"])
            return self.gap(named["d"], end, self.u(named["d"]) + reach + p, -p)[0] >= 0
        end = max(centre + TWO_PI - half, named["a"])
        return self.gap(named["a"], end, self.u(named["a"]) + p, -p)[0] <= reach

    def starts(self, sequence):
        """Rough edges in these zones: where they mostly lie in the arcs of their events (as the library starts), then the elastic
        strip's."""
        p, reach, lag = self.p_0, self.delta_0, math.atan(self.beta)
        amplitude = math.hypot(1, self.beta)
        arc = lambda excess: math.acos(min(max((1 - self.D - excess) / amplitude, -1.0), 1.0))  # noqa: E731
        kind = "af" if sequence == "af" else "bare" if sequence == "ac" else "adhesive"
        x = -lag + float(np.interp(math.log10(self.beta), DECADES, ONSET[kind])) * arc(p if sequence == "ac" else reach)
        half = arc(p)
        a = half - lag + CONTACT_END * self.beta / (self.beta + SLOW) * (TWO_PI - 2 * half)
        low = max(a if sequence == "acaf" else x, arc(p + reach) - lag)
        c = low + RELEASE * max(TWO_PI - lag - arc(p + reach) - low, 0.0)
        b = min(x + reach, 0.5 * (x + half - lag)) if sequence == "acaf" else x
        yield [{"d": x, "b": b, "a": max(a, b), "c": c}[e] for e in EDGES[sequence]]
        elastic = lambda level: math.acos(min(max(1 - level, -0.99), 0.99))  # noqa: E731
        near, far = elastic(self.D + p), elastic(self.D + p + reach)
        edges = {"d": -elastic(self.D + reach), "b": -near, "a": near, "c": max(far, near)}
        edges["d"] = min(edges["d"], edges["b"] if sequence == "acaf" else 0.0)
        yield [edges[e] for e in EDGES[sequence]]


EDGES = {"acaf": "dbac", "af": "dc", "ac": "ba"}


class Outcome:
    """Regimes (n levels of 100), number of solves by hybr, and of those that failed."""

    def __init__(self):
        self.regimes, self.solves, self.failures = [], 0, 0

    def root(self, strip, sequence, guess):
        """Edges in these zones from a guess, None where hybr finds none."""
        from scipy.optimize import root

        self.solves += 1
        try:
            found = root(getattr(strip, sequence), guess, jac=True, method="hybr")
        except OverflowError:  # edges far out of order
            found = None
        if found is None or not found.success:
            self.failures += 1
            return None
        return found.x.tolist()


def groups(inputs, p_0):
    """Dimensionless groups of every strip, nested lists."""
    k = 2 * np.pi / inputs["l"]
    scale = MATERIAL.K * inputs["A"]
    columns = (
        k * inputs["V"] * MATERIAL.T_sigma,
        k * inputs["V"] * MATERIAL.T_eps,
        p_0 / scale,
        DELTA_0 / inputs["A"],
        inputs["D"] / inputs["A"],
    )
    return np.stack([np.broadcast_to(v, scale.shape) for v in columns], -1).tolist()


def told(strips, given, regimes):
    """The script that knows the regimes and has ``given`` edges (by sequence) where they change."""
    outcome = Outcome()
    for i, row in enumerate(regimes):
        before = edges = None
        for j, regime in enumerate(row):
            strip = Script(*strips[i][j])
            if regime in EDGES:
                edges = outcome.root(strip, regime, edges if regime == before else given[regime][i][j]) or given[regime][i][j]
            elif regime == "c":
                strip.c()
            before = regime
    return outcome


def finding(strips):
    """The script that finds the regimes."""
    outcome = Outcome()
    for row in strips:
        before, edges, found = None, None, []
        for numbers in row:
            before, edges = _found(Script(*numbers), before, edges, outcome)
            found.append(before)
        outcome.regimes.append(found)
    return outcome


def _found(strip, before, edges, outcome):
    """Regime and edges of one strip, from those of its neighbour; "?" where nothing was found."""
    if strip.saturated():
        strip.c()
        return "c", None
    out_of_reach = strip.D <= -strip.delta_0
    if before == "f" and out_of_reach:
        return "f", None
    if edges is not None:
        closer = outcome.root(strip, before, edges)
        if closer and strip.admissible(before, closer):
            return before, closer
    if strip.D <= -strip.p_0 and 2 - strip.D - strip.p_0 <= strip.delta_0:
        return "a", None
    for sequence in ("ac", "acaf", "af"):
        # nothing adheres all along that cannot reach the valley
        if sequence == "ac" and 2 - strip.D - strip.p_0 > strip.delta_0:
            continue
        for guess in strip.starts(sequence):
            closer = outcome.root(strip, sequence, guess)
            if closer and strip.admissible(sequence, closer):
                return sequence, closer
    return ("f" if out_of_reach else "?"), None


def timed(run, *given):
    """CPU seconds and outcome."""
    start = time.process_time()
    outcome = run(*given)
    return time.process_time() - start, outcome


def compare(options, rng):
    inputs, p_0 = levels(options.strips // PER_LEVEL, rng)
    some = slice(0, options.levels)
    few = {n: v[some] for n, v in inputs.items()}
    batch({n: v[:5] for n, v in inputs.items()}, p_0[:5])  # imports
    strips, number = groups(few, p_0[some]), options.levels * PER_LEVEL
    rows = []
    for _ in range(options.repeat):
        batched, solution = batch(inputs, p_0)
        regimes, k = solution.regime[some], 2 * np.pi / few["l"]
        phase = {e: sign * getattr(solution, e)[some] * k for e, sign in (("d", -1), ("b", -1), ("a", 1), ("c", 1))}
        given = {r: np.stack([phase[e] for e in names], -1).tolist() for r, names in EDGES.items()}
        seconds, known = timed(told, strips, given, regimes.tolist())
        longer, found = timed(finding, strips)
        lone = np.median([batch({n: v[i, :1] for n, v in inputs.items()}, p_0[i, :1])[0] for i in range(30)])
        rows.append((batched, seconds / number, longer / number, seconds / number / batched, longer / number / batched, lone))
    batched, seconds, longer, ratio, ratio_finding, lone = np.median(rows, axis=0)
    share = {r: float(np.mean(solution.regime == r)) for r in SEQUENCES if np.any(solution.regime == r)}
    other = np.mean(np.array(found.regimes) != regimes)
    print(f"{options.strips} strips: " + ", ".join(f"{r} {100 * v:.0f} %" for r, v in share.items()))
    print(
        f"medians of {options.repeat} runs, CPU microseconds per strip: batch {batched * 1e6:.2f}, a lone strip {lone * 1e6:.0f}"
    )
    print(
        f"  script, told the regimes: {seconds * 1e6:.1f} ({100 * known.failures / known.solves:.1f} % of {known.solves} solves "
        f"fail): ratio {ratio:.1f}"
    )
    print(
        f"  script, finding them: {longer * 1e6:.1f} ({100 * found.failures / found.solves:.1f} % of {found.solves} solves fail, "
        f"{100 * other:.1f} % of the strips come out in another regime): ratio {ratio_finding:.1f}"
    )


#: shares of the regimes in a mix that is held over alpha, about those of the strips in the middle of the range
HELD = {"acaf": 0.35, "ac": 0.05, "c": 0.3, "f": 0.3}


def flatness(options, rng):
    """Time per strip over alpha, beta = 100 alpha.

    Three measures of the same random levels: all their strips, whose mix of regimes depends on alpha; strips with edges alone;
    and a mix that is held (``HELD``), of strips drawn from each regime with replacement. The batches of the last two are of the
    same size at every alpha.
    """
    print("alpha: microseconds per strip of mixed levels, of strips with edges, of a mix that is held")
    measured = []
    for exponent in range(-6, 7, 2):
        inputs, p_0 = levels(options.strips // PER_LEVEL, rng, alpha=10.0**exponent)
        mixed = [batch(inputs, p_0) for _ in range(options.repeat)]
        regime = mixed[0][1].regime.ravel()
        partial, size = np.isin(regime, list(EDGES)), options.strips // 4
        edged = np.resize(np.flatnonzero(partial), size)
        held = np.concatenate([rng.choice(np.flatnonzero(regime == r), round(share * size)) for r, share in HELD.items()])
        times = [np.median([t for t, _ in mixed])]
        for pick in (edged, rng.permutation(held)):
            drawn = {n: v.ravel()[pick] for n, v in inputs.items()}, p_0.ravel()[pick]
            times.append(np.median([batch(*drawn)[0] for _ in range(options.repeat)]))
        measured.append(np.array(times) * 1e6)
        print(
            f"  1e{exponent:+d}: " + ", ".join(f"{t:.2f}" for t in measured[-1]) + f" ({100 * partial.mean():.0f} % have edges)"
        )
    print("largest over smallest: " + ", ".join(f"{ratio:.2f}" for ratio in np.max(measured, axis=0) / np.min(measured, axis=0)))


def memory(rng):
    """Peak memory of 1e7 strips in one call."""
    import resource

    inputs, p_0 = levels(100_000, rng)
    one = {n: np.ascontiguousarray(v) if n in ("A", "D") else float(v[0, 0]) for n, v in inputs.items()}
    start = time.process_time()
    solution = hystrip.solve_strip(MATERIAL, hystrip.Dugdale(p_0=float(p_0[0, 0]), delta_0=DELTA_0), **one)
    seconds = time.process_time() - start
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(f"{solution.p_mean.size} strips in {seconds:.0f} s, peak memory {peak:.2f} GiB")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--strips", type=int, default=100_000)
    parser.add_argument("--levels", type=int, default=250, help="levels that the script solves")
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
