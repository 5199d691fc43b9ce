"""What is solved, by whom, and what came of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

import hystrip


@dataclass(frozen=True)
class Contestant:
    """``work(scene, adhesion, p, V)`` gives the frictions (Pa) at points p, V (n,), and the strips solved and the failures, as
    far as it counts them.

    ``points``: how many points per adhesion it is given, spread evenly (the time is scaled to all); None for all.
    """

    method: str
    setting: str
    work: Callable
    points: int | None = None


def _evenly(of: np.ndarray, count: int) -> np.ndarray:
    return of[((np.arange(count) + 0.5) / count * of.size).astype(int)]


@dataclass(frozen=True)
class Scene:
    """Points (pressure, velocity) on a surface, for one or several adhesions. ``reference``: rtol of the reference, None for no
    errors;
    ``looked_at``: points per adhesion at which errors are measured, spread evenly."""

    name: str
    material: hystrip.StandardLinearSolid
    adhesions: tuple[hystrip.Dugdale, ...]
    levels: tuple[hystrip.Level, ...]
    pressure: np.ndarray
    velocity: np.ndarray
    reference: float | None
    contestants: tuple[Contestant, ...]
    looked_at: int = 20

    @property
    def points(self) -> int:
        return len(self.adhesions) * self.velocity.size

    def spread(self, points: int | None) -> np.ndarray:
        """Indices of so many points, evenly spread: some of those looked at, or, if more are wanted, all of those and others."""
        every = np.arange(self.velocity.size)
        if points is None or points >= every.size:
            return every
        looked_at = _evenly(every, min(self.looked_at, every.size))
        return _evenly(looked_at, points) if points <= looked_at.size else np.union1d(looked_at, _evenly(every, points))

    def scale(self) -> np.ndarray:
        """Of friction, Pa, that counts beside its own size: (adhesions, 1)."""
        level = self.levels[0]
        return np.array([[1e-3 * (self.material.K * level.h + a.p_0) * level.h / level.l] for a in self.adhesions])

    def exact(self) -> np.ndarray:
        """Friction at the points looked at, (adhesions, points), by this solver far below the tolerances compared."""
        at = self.spread(self.looked_at)
        return np.array([solve(self.reference)(self, a, self.pressure[at], self.velocity[at])[0] for a in self.adhesions])


@dataclass(frozen=True)
class Row:
    """A measurement. ``points`` of the scene, ``solved`` of them; ``seconds`` of processor time for all points; ``error``:
    largest relative error of friction at the points looked at (NaN: no reference); ``strips`` and ``failures`` as counted."""

    scene: str
    method: str
    setting: str
    points: int
    solved: int
    seconds: float
    error: float
    strips: int = 0
    failures: int = 0

    @property
    def per_point(self) -> float:
        """Milliseconds."""
        return 1e3 * self.seconds / self.points


def solve(rtol: float) -> Callable:
    """This solver as a contestant's work."""

    def work(scene, adhesion, p, V):
        result = hystrip.solve(scene.material, adhesion, scene.levels, pressure=p, velocity=V, rtol=rtol)
        return result.tau, result.counts["strips_solved"], 0

    return work
