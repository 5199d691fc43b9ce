"""Random strips over the whole space of parameters, in SI, degenerate ones among them; and their one-line text form.

A scene is a dictionary of arrays, one entry for each strip: the inputs of ``hystrip.solve_strip`` with the fields of
its material and adhesion.
"""

import numpy as np

import hystrip

FIELDS = ("l", "A", "D", "V", "K", "T_eps", "T_sigma", "p_0", "delta_0")
EDGES, BRANCHES = ("continuous", "constitutive"), ("unloading", "loading")


def log_uniform(rng, low, high, n=None):
    return 10.0 ** rng.uniform(np.log10(low), np.log10(high), n)


def thresholds(alpha, beta, P0, Delta):
    """Penetrations over A where something can change: free, adhesion, release, saturation, no onset, ends of the profile."""
    ratio = np.hypot(1, beta) / np.hypot(1, alpha)
    zero = np.zeros_like(beta)
    return np.array([-Delta, -P0, 2 - P0 - Delta, 1 + ratio - P0, 1 - np.hypot(1, beta) - Delta, zero, zero + 2])


def penetrations(rng, marks):
    """Penetrations over A from below no interaction to above saturation: anywhere, next to a threshold, or exactly on it."""
    n = marks.shape[1]
    low, high = marks[:4].min(axis=0) - 1, marks[:4].max(axis=0) + 1
    mark = marks[rng.integers(0, len(marks), n), np.arange(n)]
    side = rng.choice((-1.0, 1.0), n)
    far, close = log_uniform(rng, 1e-6, 10, n), log_uniform(rng, 1e-15, 1e-3, n)
    ways = [low + (high - low) * rng.random(n), mark + side * far, mark + side * close, mark * (1 + side * close), mark]
    return np.choose(rng.choice(5, n, p=(0.45, 0.25, 0.1, 0.1, 0.1)), ways)


def extreme(rng, n):
    """Strips with all groups log-uniform over the ranges of the truths, and a fifth of them degenerate in some way."""
    alpha = log_uniform(rng, 1e-8, 1e8, n)
    beta = alpha * (1 + 10 ** rng.uniform(-9, np.minimum(9, 9 - np.log10(alpha))))
    P0, Delta = log_uniform(rng, 1e-6, 1e6, n), log_uniform(rng, 1e-6, 1e3, n)
    few = lambda share: rng.random(n) < share  # noqa: E731
    alpha[few(0.02)] = 0.0
    alpha = np.where(few(0.02), beta, alpha)
    P0[few(0.08)] = 0.0
    P0[few(0.01)] *= 1e9
    Delta[few(0.01)] *= 1e-9
    Delta[few(0.01)] *= 1e9
    D = penetrations(rng, thresholds(alpha, beta, P0, Delta))
    scene = si(rng, alpha, beta, P0, Delta, D)
    scene["A"][few(0.02)] = 0.0
    scene["A"][few(0.01)] *= 1e-15
    scene["V"][few(0.02)] = 0.0
    scene["V"][few(0.01)] *= 1e9
    rigid = few(0.01)
    scene["T_eps"][rigid] = scene["T_sigma"][rigid] = 0.0
    return scene


def moderate(rng, n, longest=1e3):
    """Strips with groups near 1, ``beta`` at most ``longest``, none within rounding of a threshold: many have several orbits."""
    beta = log_uniform(rng, 1e-2, longest, n)
    alpha = np.where(rng.random(n) < 0.05, 0.0, beta / (1 + log_uniform(rng, 1e-2, 1e4, n)))
    P0, Delta = log_uniform(rng, 1e-2, 1e2, n), log_uniform(rng, 1e-3, 1e1, n)
    P0[rng.random(n) < 0.05] = 0.0
    marks = thresholds(alpha, beta, P0, Delta)
    D = penetrations(rng, marks)
    close = np.abs(D - marks).min(axis=0) < 1e-6 * (1 + np.abs(marks).max(axis=0))
    D = np.where(close, rng.uniform(marks[:4].min(axis=0), marks[:4].max(axis=0)), D)
    return si(rng, alpha, beta, P0, Delta, D)


def si(rng, alpha, beta, P0, Delta, D):
    """The groups at random units: a scene."""
    n = alpha.size
    K, A = log_uniform(rng, 1e-3, 1e12, n), log_uniform(rng, 1e-12, 1, n)
    l, V = A * log_uniform(rng, 1, 1e6, n), log_uniform(rng, 1e-9, 1e3, n)  # noqa: E741
    rate = 2 * np.pi / l * V
    T_eps = beta / rate
    # a difference of the times that is zero has to stay zero
    T_sigma = np.where(alpha == beta, T_eps, np.minimum(alpha / rate, T_eps))
    times = {"T_eps": T_eps, "T_sigma": T_sigma}
    return {"l": l, "A": A, "D": D * A, "V": V, "K": K, **times, "p_0": P0 * (K * A), "delta_0": Delta * A}


def solve(scene, edge, branch):
    """``hystrip.solve_strip`` of a scene."""
    material = hystrip.StandardLinearSolid(scene["K"], scene["T_eps"], scene["T_sigma"])
    adhesion = hystrip.Dugdale(p_0=scene["p_0"], delta_0=scene["delta_0"])
    return hystrip.solve_strip(
        material, adhesion, l=scene["l"], A=scene["A"], D=scene["D"], V=scene["V"], edge=edge, branch=branch
    )


def take(scene, index):
    return {name: values[index] for name, values in scene.items()}


def line(scene, i, edge, branch):
    """Strip ``i`` as text that ``parse`` reads back to the last bit."""
    return " ".join([f"edge={edge} branch={branch}"] + [f"{name}={float(scene[name][i])!r}" for name in FIELDS])


def parse(text):
    """Scene of one strip, edge and branch, from a line."""
    given = dict(part.split("=", 1) for part in text.split())
    missing = {"edge", "branch", *FIELDS} - set(given)
    if missing:
        raise ValueError(f"the line lacks {', '.join(sorted(missing))}")
    return {name: np.array([float(given[name])]) for name in FIELDS}, given["edge"], given["branch"]
