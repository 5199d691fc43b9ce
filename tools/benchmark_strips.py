"""Time per strip: the batched solver against a strip-by-strip script, in one run.

    python tools/benchmark_strips.py [--strips 100000] [--repeat 3]

The script is what a user would write: the same four boundary equations of partial contact with discrete adhesion zones in scalar
``math``, ``scipy.optimize.root`` (hybr, analytic Jacobian), each strip started from its neighbour's solution. It is spared the choice of the
regime: it is only given strips of that one, with the first solution. The batch decides regime and branch itself.
"""

import argparse
import math
import time

import numpy as np

import hystrip

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
ADHESION = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
LEVEL = hystrip.Level(l=10e-6, h=1e-6)
V, D = 5e-3, 6.6e-7


def equations(edges, alpha, beta, p_0, delta_0, D):
    """Boundary equations of edges d, b, a, c, continuous closure; dimensionless."""
    d, b, a, c = edges
    u = lambda s: D - 1 + math.cos(s)  # noqa: E731
    storage, loss = (1 + alpha * beta) / (1 + alpha**2), (beta - alpha) / (1 + alpha**2)
    field = lambda s: D - 1 + storage * math.cos(s) - loss * math.sin(s)  # noqa: E731
    w = -p_0 + (u(d) + delta_0 + p_0) * math.exp(-(b - d) / beta)
    p = field(a) - (field(b) + p_0) * math.exp(-(a - b) / alpha)
    v = -p_0 + (u(a) + p_0) * math.exp(-(c - a) / beta)
    free = (u(c) + delta_0) * math.exp(-(d + 2 * math.pi - c) / beta)
    return [w - u(b), p + p_0, v - u(c) - delta_0, free - u(d) - delta_0]


def jacobian(edges, alpha, beta, p_0, delta_0, D):
    """Its derivatives by the edges."""
    d, b, a, c = edges
    storage, loss = (1 + alpha * beta) / (1 + alpha**2), (beta - alpha) / (1 + alpha**2)
    slope = lambda s: -math.sin(s)  # noqa: E731
    u = lambda s: D - 1 + math.cos(s)  # noqa: E731
    field = lambda s: D - 1 + storage * math.cos(s) - loss * math.sin(s)  # noqa: E731
    field_slope = lambda s: -storage * math.sin(s) - loss * math.cos(s)  # noqa: E731
    first = math.exp(-(b - d) / beta)
    second = math.exp(-(a - b) / alpha)
    third = math.exp(-(c - a) / beta)
    last = math.exp(-(d + 2 * math.pi - c) / beta)
    lag, excess, trail, free = u(d) + delta_0 + p_0, field(b) + p_0, u(a) + p_0, u(c) + delta_0
    return [
        [first * (slope(d) + lag / beta), -first * lag / beta - slope(b), 0.0, 0.0],
        [0.0, -second * (field_slope(b) + excess / alpha), field_slope(a) + second * excess / alpha, 0.0],
        [0.0, 0.0, third * (slope(a) + trail / beta), -third * trail / beta - slope(c)],
        [-last * free / beta - slope(d), 0.0, 0.0, last * (slope(c) + free / beta)],
    ]


def script(thetas):
    """Solve strips one by one; returns seconds per strip and failures."""
    from scipy.optimize import root

    k = LEVEL.k
    alpha, beta = k * V * MATERIAL.T_sigma, k * V * MATERIAL.T_eps
    first = hystrip.solve_strip(MATERIAL, ADHESION, l=LEVEL.l, A=LEVEL.amplitude(thetas[0]), D=D - LEVEL.drop(thetas[0]), V=V)
    edges = k * np.array([-first.d, -first.b, first.a, first.c])
    failures = 0
    start = time.perf_counter()
    for theta in thetas:
        A = LEVEL.amplitude(theta)
        groups = (alpha, beta, ADHESION.p_0 / (MATERIAL.K * A), ADHESION.delta_0 / A, (D - LEVEL.drop(theta)) / A)
        found = root(equations, edges, groups, jac=jacobian, method="hybr")
        if found.success:
            edges = found.x
        else:
            failures += 1
    return (time.perf_counter() - start) / len(thetas), failures


def batch(thetas):
    """Solve the same strips at once; seconds per strip."""
    start = time.perf_counter()
    solution = hystrip.solve_strip(MATERIAL, ADHESION, l=LEVEL.l, A=LEVEL.amplitude(thetas), D=D - LEVEL.drop(thetas), V=V)
    return (time.perf_counter() - start) / len(thetas), solution


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--strips", type=int, default=100_000)
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    partial = np.linspace(0.0, 2.2, 1000)
    whole = np.linspace(0.0, np.pi, options.strips)
    rows = []
    for _ in range(options.repeat):
        scripted, failures = script(partial)
        rows.append((scripted, batch(np.linspace(0.0, 2.2, options.strips))[0], batch(whole)[0], batch(whole[:1])[0], failures))
    scripted, same, mixed, lone, failures = np.median(rows, axis=0)
    print(f"medians of {options.repeat} runs, microseconds per strip")
    print(f"script, one regime:                  {scripted * 1e6:10.1f}   ({failures:g} of {partial.size} failed)")
    print(f"batch of {options.strips}, same regime:      {same * 1e6:10.1f}   {scripted / same:6.1f} times faster")
    print(f"batch of {options.strips}, a whole level:    {mixed * 1e6:10.1f}   {scripted / mixed:6.1f} times faster")
    print(f"a lone strip:                        {lone * 1e6:10.1f}")


if __name__ == "__main__":
    main()
