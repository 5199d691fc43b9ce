"""The curves that divide the plane of strips into regimes, as equations.

At one velocity, with one material, adhesion and closure, a strip is a point of a plane: its amplitude ``A`` and ``E = D - h``,
the penetration of the valley of its level; its own is ``D_j = E + 2 A``. Where an orbit of one regime ceases to exist its edges
obey one equation more than its boundary equations (a fold, where the return map has the slope one, or a grazing event).
That is one point on every line across the plane: with A given E is unknown, with E given A is.

Where a curve turns back over E two crossings of a level meet, and the island between them ends. Just beyond, one strip is next to
the curve: where orbits end on it the strips' means bend like ``sqrt(s^2 + distance)``, as sharp as any kink.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ..numerics.linear import solve_each
from ..numerics.roots import falling_root
from ..numerics.rounding import EPS
from ..orbit.batch import Batch
from ..orbit.foundation import foundation_of
from ..orbit.groups import TWO_PI
from ..orbit.march import turn
from ..orbit.regimes import EQUATIONS, ZONES

if TYPE_CHECKING:
    from .strips import LevelBatch

#: Newton's iterations, and how much less the step of each may be than before: nearly all that is found falls faster
_ITERATIONS, _FALLS = 16, 0.46
#: how closely a turn is placed, of A: its E is known to the square; and how far apart two points are that tell a slope
_PLACED, _APART = 1e-7, 1e-5


@dataclass(frozen=True)
class Boundary:
    """A kind of curve in the plane: the orbits of ``sequence`` end by an ``event``, "fold", "release" or "closing"; or their
    greatest pressure passes a break of the law below ("peak")."""

    sequence: str
    event: str

    @property
    def zone(self) -> int:
        """Number of the zone in which the pressure, or the gap, turns as it grazes what it passes; not of a fold."""
        return {"peak": ZONES[self.sequence][0].find("c"), "release": 1, "closing": 0}[self.event]


#: every way in which the orbit of a regime with edges ends, but for thresholds that are straight lines (``thresholds``); first
#: that nothing happens to it but to its pressure
BOUNDARIES = (
    *(Boundary(sequence, "peak") for sequence in ("acaf", "afc", "ac", "cf")),
    Boundary("acaf", "fold"),
    Boundary("afc", "fold"),
    Boundary("af", "fold"),
    Boundary("ac", "release"),
    Boundary("af", "closing"),
)


@dataclass
class CurvePoints(Batch):
    """Points of curves: ``velocity`` (m/s), ``A`` and ``E`` (m), ``edges`` (n, k) of the orbit that ends there, with the phase of
    what it grazes in order (``grazing``), and the ``pressure`` (Pa) that it passes, break number ``index`` of its law."""

    velocity: np.ndarray
    A: np.ndarray
    E: np.ndarray
    edges: np.ndarray
    pressure: np.ndarray
    index: np.ndarray


def grazing(columns: LevelBatch, boundary: Boundary, at: CurvePoints) -> CurvePoints:
    """Orbits that are ``at`` these places with the phase at which their pressure or gap turns as one more edge, but at a fold."""
    if boundary.event == "fold":
        return at
    edges, number = at.edges.T, boundary.zone
    strips = columns.dimensionless(at.velocity, at.A, at.E + 2 * at.A)
    event = foundation_of(columns.material).event(boundary.sequence, number, edges, strips)
    end = edges[number + 1] if number + 1 < len(edges) else edges[0] + TWO_PI
    phase = turn(*event, -1 if boundary.event == "closing" else 1, edges[number], end)
    return replace(at, edges=np.insert(at.edges, number + 1, phase, axis=1))


def locate(columns: LevelBatch, boundary: Boundary, start: CurvePoints, unknown: str) -> tuple[CurvePoints, np.ndarray]:
    """Points of a curve by Newton from ``start``, with ``unknown`` "A" or "E" and the other one kept; and which were found.

    ``start`` holds orbits of the boundary's sequence nearby, ``grazing``. Points that are not found are no numbers to be used."""
    at = replace(start, A=start.A.copy(), E=start.E.copy(), edges=start.edges.copy())
    edges, own = at.edges.T, getattr(at, unknown)
    k, n = edges.shape
    found, active = np.zeros(n, bool), np.arange(n)
    with np.errstate(all="ignore"):  # what is lost is no number, and is dropped
        for largest in 10 * _FALLS ** np.arange(_ITERATIONS):
            if not active.size:
                break
            step = _step(columns, boundary, at.take(active), unknown)
            share = np.abs(step[k]) / (at.A[active] + np.abs(at.E[active]))
            size = np.maximum(np.abs(np.cumsum(step[:k], axis=0)).max(axis=0), share)
            usable = np.isfinite(step).all(axis=0) & (size < largest)
            active, step, size = active[usable], step[:, usable], size[usable]
            damping = 1 / np.maximum(size, 1.0)  # no edge moves by more than a radian, A and E by no more than their size
            edges[:, active] = _moved(edges[:, active], damping * step[:k])
            moved = damping * step[k]
            own[active] = _added(own[active], moved) if unknown == "A" else own[active] + moved
            done = size < np.sqrt(EPS)  # a step this small leaves an error of its square
            found[active[done]] = True
            active = active[~done]
    return at, found & (np.diff(edges, axis=0) >= -np.sqrt(EPS)).all(axis=0) & (edges[-1] <= edges[0] + TWO_PI)


def _moved(edges: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Edges (k, n) after a ``step`` of the first and of the zones behind it, each of which keeps some of its width."""
    return np.cumsum(np.append((edges + step)[:1], _added(np.diff(edges, axis=0), step[1:]), axis=0), axis=0)


def _added(value: np.ndarray, step: np.ndarray) -> np.ndarray:
    """``value + step``; what is positive stays so: steps down by more than nine tenths of it leave a part that falls like a
    reciprocal. Fast modes make zones of 1e-8 radians whose edges move by far more than that."""
    down = (step < 0) & (value > 0)
    share = np.divide(-step, value, out=np.zeros_like(value), where=down)
    left = np.where(share <= 0.9, 1 - share, 0.01 / np.maximum(share - 0.8, 0.1))
    return np.where(down, value * left, value + step)


def _step(columns: LevelBatch, boundary: Boundary, at: CurvePoints, unknown: str) -> np.ndarray:
    """Newton step (k + 1, n) of the first edge, of the zones behind it, and of the unknown of the plane, for the boundary
    equations of a sequence and the equation of its event."""
    foundation, edges, own, A = foundation_of(columns.material), at.edges.T, getattr(at, unknown), at.A
    k, n = edges.shape
    # differences that stand for derivatives: of zones of 1e-8 radians a determinant keeps 8 digits, so they are no shorter
    zones = np.maximum(np.diff(edges, axis=0), np.sqrt(EPS))
    length = np.cbrt(EPS) * np.concatenate((np.ones((1, n)), zones, np.maximum(np.abs(own), A)[None]))
    # the point itself, then copies with each unknown moved a little to both sides: all edges, those behind a zone, the plane's
    moved = np.concatenate((edges, own[None]))[:, None].repeat(2 * k + 3, axis=1)
    for i in range(k + 1):
        unknowns = slice(i, max(k, i + 1))
        moved[unknowns, 1 + i] += length[i]
        moved[unknowns, k + 2 + i] -= length[i]
    moved, every = moved.reshape(k + 1, -1), at.take(np.tile(np.arange(n), 2 * k + 3))
    edges, A, E = moved[:k], *((moved[k], every.E) if unknown == "A" else (every.A, moved[k]))
    strips = columns.dimensionless(every.velocity, A, E + 2 * A)
    # and what vanishes at the event
    if boundary.event == "fold":
        events = (foundation.fold(boundary.sequence, edges, strips),)
    else:
        edges, phase = np.delete(edges, boundary.zone + 1, axis=0), edges[boundary.zone + 1]
        function, constants = foundation.event(boundary.sequence, boundary.zone, edges, strips)
        value, slope = function(phase, *constants)
        peak = strips.p_0 + every.pressure / columns.material.K / A
        events = value - {"peak": peak, "release": strips.delta_0, "closing": 0.0}[boundary.event], slope
    values = getattr(foundation.kernel, f"residual_{EQUATIONS[boundary.sequence]}")(*edges, *strips.arguments)
    values = np.array((*values, *events)).reshape(k + 1, 2 * k + 3, n)
    matrix = ((values[:, 1 : k + 2] - values[:, k + 2 :]) / (2 * length)).transpose(2, 0, 1)
    return solve_each(matrix, -values[:, 0].T[:, :, None])[:, :, 0].T


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


def locate_turns(columns: LevelBatch, boundary: Boundary, known: CurvePoints, had: Turns) -> tuple[Turns, CurvePoints]:
    """Turns of the curves through the points ``known``, where their slope vanishes, that are found beside those ``had``; and the
    points there."""
    middle = turning(known)
    low, high = known.A[middle - 1, None], known.A[middle + 1, None]
    new = ~((known.velocity[middle, None] == had.velocity) & (low < had.A) & (had.A < high)).any(axis=1)
    before, near, after = (known.take(middle[new] + k) for k in (-1, 0, 1))
    way, found = np.where((before.E < near.E) | (near.E > after.E), 1.0, -1.0), np.ones(near.size, bool)

    def slope(A, index):
        """Of E over A, from two points; the next ones start from there."""
        at = replace(near.take(np.tile(index, 2)), A=np.concatenate((A, A * (1 + _APART))))
        points, good = locate(columns, boundary, at, "E")
        found[index] = good.reshape(2, -1).all(axis=0)
        here = np.flatnonzero(found[index])
        near[index[here]] = points.take(here)
        # what is lost on the way is dropped in the end
        E = np.where(good, points.E, 0.0).reshape(2, -1)
        return way[index] * (E[1] - E[0]) / (A * _APART)

    if near.size:
        A = falling_root(slope, before.A, after.A, near.A, _PLACED * near.A.min())
        slope(A, np.arange(A.size))
    turns, found = Turns(near.velocity, near.A, near.E, way), np.flatnonzero(found)
    return turns.take(found), near.take(found)
