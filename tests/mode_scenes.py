"""Random strips on foundations with several relaxation times, and the agreement of the library with the reference march.

A scene is a dictionary: ``m`` (relative moduli), ``theta`` (times by k V), ``P0``, ``Delta``, ``delta``, in the units
of A and K A.
"""

import numpy as np
from marches import MEANS, marched
from oracle import modes
from oracle.flow import CONSTITUTIVE
from oracle.orbits import Unresolved
from scenes import log_uniform

import hystrip

BRANCHES = ("unloading", "loading")
#: as for the single time: of the natural scale, and how many times the spread that rounding of the inputs makes
TOLERANCE, CONDITION = 1e-11, 16
#: relative change of a group that its rounding in double precision is taken for
ROUNDING = 1e-15


def draw(rng, n, wide):
    """A scene; ``wide``: groups over the ranges of the stored truths, else near 1, where several orbits coexist."""
    if wide:
        theta = np.sort(log_uniform(rng, 1e-6, 1e7, n))
        m = log_uniform(rng, 1e-3, 1e3, n)
        P0, Delta = log_uniform(rng, 1e-6, 1e6), log_uniform(rng, 1e-6, 1e3)
    else:
        theta = np.sort(log_uniform(rng, 1e-2, 1e2, n))
        m = log_uniform(rng, 1e-1, 1e2, n)
        P0, Delta = log_uniform(rng, 3e-2, 1e1), log_uniform(rng, 3e-2, 3)
    if rng.random() < 0.08:
        P0 = 0.0
    squares = theta**2
    storage = 1 + np.sum(m * squares / (1 + squares))
    ratio = np.hypot(storage, np.sum(m * theta / (1 + squares)))
    marks = np.array([-Delta, -P0, 2 - P0 - Delta, 1 + ratio - P0, 0.0, 2.0])
    low, high = marks.min() - 1, marks.max() + 1
    if rng.random() < 0.5:
        delta = rng.uniform(low, high)
    else:
        delta = rng.choice(marks) + rng.choice((-1, 1)) * log_uniform(rng, 1e-6, 10)
    return {"m": m, "theta": theta, "P0": P0, "Delta": Delta, "delta": delta}


def solve(scenes, branch, solver=None):
    """The library's solution of scenes with one number of times, as one batch: K = A = 1, l = 2 pi, V = 1."""
    column = lambda name: [np.array([s[name][i] for s in scenes]) for i in range(len(scenes[0][name]))]  # noqa: E731
    material = hystrip.Prony(1.0, column("m"), column("theta"), solver=solver)
    P0, Delta, delta = (np.array([s[name] for s in scenes]) for name in ("P0", "Delta", "delta"))
    adhesion = hystrip.Dugdale(p_0=P0, delta_0=Delta)
    return hystrip.solve_strip(material, adhesion, l=2 * np.pi, A=1.0, D=delta, V=1.0, edge="constitutive", branch=branch)


def viscous(scenes, branch):
    """The library's solution of scenes with one time as if that were the retardation time of a Kelvin-Voigt foundation."""
    beta, P0, Delta, delta = (np.array([np.ravel(s[name])[0] for s in scenes]) for name in ("theta", "P0", "Delta", "delta"))
    adhesion = hystrip.Dugdale(p_0=P0, delta_0=Delta)
    return hystrip.solve_strip(
        hystrip.KelvinVoigt(1.0, beta), adhesion, l=2 * np.pi, A=1.0, D=delta, V=1.0, edge="constitutive", branch=branch
    )


def exact(scene, branch, digits=modes.DIGITS):
    """The reference march's solution; that of a Kelvin-Voigt foundation for a scene that says ``viscous``."""
    if scene.get("viscous"):
        of = "solve_viscous", 0, scene["theta"][0], scene["P0"], scene["Delta"], scene["delta"], CONSTITUTIVE
    else:
        of = "solve", scene["theta"], scene["m"], scene["P0"], scene["Delta"], scene["delta"]
    return marched(*of, branch, digits)


def misfit(scene, found, i, true):
    """Largest error of a mean or a fraction of strip ``i``, in units of its natural scale."""
    p, tau = float(true.p_mean), float(true.tau_mean)
    scale = 1 + scene["P0"]
    return max(
        abs(found.p_mean[i] - p) / (abs(p) + scale),
        abs(found.tau_mean[i] - tau) / (abs(tau) + scale),
        abs(found.contact_fraction[i] - float(true.contact_fraction)),
        abs(found.adhesion_fraction[i] - float(true.adhesion_fraction)),
    )


def spread(scene, branch, true):
    """How far the exact solution moves when a group is off by its rounding, in the units of ``misfit``; inf where its
    sequence changes."""
    worst = 0.0
    for name in ("theta", "m", "P0", "Delta", "delta"):
        for sign in (1, -1):
            near = scene | {name: scene[name] * (1 + sign * ROUNDING)}
            try:
                moved = exact(near, branch)
            except (Unresolved, ArithmeticError):
                return np.inf
            if moved.sequence != true.sequence:
                return np.inf
            one = lambda each: type("One", (), {k: [float(getattr(each, k))] for k in MEANS})  # noqa: E731
            worst = max(worst, misfit(scene, one(moved), 0, true))
    return worst


def compare(scene, branch, found, i):
    """(error, allowed, sequence of the march) of strip ``i``; allowed is more than the tolerance only where rounding of
    the inputs demands it."""
    true = exact(scene, branch)
    error = misfit(scene, found, i, true)
    same = found.regime.reshape(-1)[i] == true.sequence
    allowed = TOLERANCE
    if error > allowed or not same:
        allowed += CONDITION * spread(scene, branch, true)
    return (error if same or np.isinf(allowed) else np.inf), allowed, true.sequence
