"""Where curves of the plane of strips turn back over E: two crossings of a level meet there, and the island between them ends.

Just beyond no strip of the level is on the curve, but one is next to it: where orbits end on the curve the strips' means bend
there like ``sqrt(s^2 + distance)``, as sharp as any kink.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ..numerics.roots import falling_root
from ..orbit.batch import Batch
from . import plane
from .plane import Boundary, CurvePoints

if TYPE_CHECKING:
    from .strips import LevelBatch

#: how closely a turn is placed on its curve, of A: its E is known to the square; and how far apart the points are that tell the
#: slope of the curve
_PLACED, _APART = 1e-7, 1e-5


@dataclass
class Turns(Batch):
    """Turns of curves, (n,): ``velocity`` (m/s), ``A`` and ``E`` (m); ``way``: 1 where E is greatest, -1 where it is least."""

    velocity: np.ndarray
    A: np.ndarray
    E: np.ndarray
    way: np.ndarray


def together(points: CurvePoints) -> np.ndarray:
    """Which points stand on the same curve as the next one."""
    return (np.diff(points.velocity) == 0) & (np.diff(points.index) == 0)


def turning(points: CurvePoints) -> np.ndarray:
    """Numbers of the points between whose neighbours their curve turns."""
    one, steps = together(points), np.diff(points.E)
    return 1 + np.flatnonzero(one[:-1] & one[1:] & (steps[:-1] != 0) & (steps[:-1] * steps[1:] <= 0))


def locate_turns(columns: LevelBatch, boundary: Boundary, known: CurvePoints, had: Turns) -> Turns:
    """Turns of the curves through the points ``known``, where their slope vanishes, beside those that are ``had``; those that are
    found."""
    middle = turning(known)
    low, high = known.A[middle - 1, None], known.A[middle + 1, None]
    new = ~((known.velocity[middle, None] == had.velocity) & (low < had.A) & (had.A < high)).any(axis=1)
    before, near, after = (known.take(middle[new] + k) for k in (-1, 0, 1))
    way, found = np.where((before.E < near.E) | (near.E > after.E), 1.0, -1.0), np.ones(near.size, bool)

    def slope(A, index):
        """Of E over A, from two points; the next ones start from there."""
        at = replace(near.take(np.tile(index, 2)), A=np.concatenate((A, A * (1 + _APART))))
        points, good = plane.locate(columns, boundary, at, "E")
        found[index] = good.reshape(2, -1).all(axis=0)
        here = np.flatnonzero(found[index])
        near[index[here]] = points.take(here)
        # what is lost on the way is dropped in the end
        E = np.where(good, points.E, 0.0).reshape(2, -1)
        return way[index] * (E[1] - E[0]) / (A * _APART)

    if near.size:
        A = falling_root(slope, before.A, after.A, near.A, _PLACED * near.A.min())
        slope(A, np.arange(A.size))
    return Turns(near.velocity, near.A, near.E, way).take(np.flatnonzero(found))
