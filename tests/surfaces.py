"""Random surfaces of one to three levels: both closures and branches, hardly touching to nearly saturated. Heights of Eq. 4."""

from dataclasses import dataclass

import numpy as np
from scenes import BRANCHES, EDGES, log_uniform

import hystrip


@dataclass(frozen=True)
class Surface:
    """Inputs of ``hystrip.solve``, but for the accuracy."""

    material: hystrip.StandardLinearSolid
    adhesion: hystrip.Dugdale
    levels: tuple
    pressure: float
    velocity: np.ndarray
    edge: str
    branch: str

    def solve(self, rtol, **options):
        """``hystrip.solve`` to ``rtol``."""
        how = {"pressure": self.pressure, "velocity": self.velocity, "edge": self.edge, "branch": self.branch, **options}
        return hystrip.solve(self.material, self.adhesion, self.levels, rtol=rtol, **how)

    @property
    def floor(self):
        """What is added to the size of the friction where an accuracy is relative, Pa."""
        level = self.levels[0]
        return 1e-3 * (self.material.K * level.h + self.adhesion.p_0) * level.h / level.l


def draw(rng, velocities=3, levels=None):
    """A random surface at some velocities; ``levels``: how many, from one to three if not given."""
    one = lambda low, high: float(log_uniform(rng, low, high, 1)[0])  # noqa: E731
    count = levels or int(rng.choice((1, 2, 3), p=(0.35, 0.55, 0.1)))
    K, T_eps = 1e9, 1e-2
    material = hystrip.StandardLinearSolid(K, T_eps, T_eps / one(1.5, 1e3) if rng.random() < 0.95 else 0.0)
    length, height = 1e-5, one(0.01, 0.2)
    surface = []
    for _ in range(count):
        surface.append(hystrip.Level(length, height * length))
        length /= one(5, 30)
        height = one(0.02, 0.3)
    h = surface[0].h
    sticky = rng.random() < 0.8
    p_0 = one(1e-3, 3) * K * h if sticky else 0.0
    adhesion = hystrip.Dugdale(p_0=p_0, delta_0=one(1e-3, 0.3) * h) if sticky else hystrip.Dugdale(gamma=0)
    pressure = one(1e-3, 1) * K * h
    if sticky and rng.random() < 0.25:
        pressure = -0.3 * rng.random() * p_0
    velocity = surface[0].l / (2 * np.pi * T_eps) * log_uniform(rng, 0.03, 300, velocities)
    return Surface(
        material, adhesion, tuple(surface), pressure, velocity, str(rng.choice(EDGES)), str(rng.choice(BRANCHES, p=(0.8, 0.2)))
    )


def eq4(levels, size, n):
    """Eq. 4, summed over the levels, on a grid of n by n points."""
    x = np.arange(n) * (size / n)
    out = np.zeros((n, n))
    for wavelength, height in levels:
        wave = np.cos(2 * np.pi / wavelength * x) + 1
        out += height - height / 4 * np.multiply.outer(wave, wave)
    return out
