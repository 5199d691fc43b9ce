"""The curves that divide the plane of strips into regimes, as equations.

At one velocity, with one material, adhesion and closure, a strip is a point of a plane: its amplitude ``A`` and
``E = D - h``, the penetration of the valley of its level; its own penetration is ``D_j = E + 2 A``. Where an orbit of one
regime ceases to exist its edges obey one equation more than the boundary equations of its regime (physics: a fold, where
the return map has the slope one, or a grazing event). That is one point on every line across the plane: with A given E is
unknown, with E given A is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..numerics.linear import solved
from ..orbit.batch import Batch
from ..orbit.foundation import foundation_of

if TYPE_CHECKING:
    from .strips import LevelBatch

TWO_PI = 2 * np.pi
#: Newton: iterations at most; a step of the edges this small leaves an error of its square; the largest step taken whole
_ITERATIONS, _SMALL, _LONGEST = 16, 1e-8, 0.5
#: differences that stand for derivatives, of edges and relative ones of A or E: far enough for the determinant of zones of 1e-8
#: radians, which keeps 8 digits, so that Newton's method gains 5 digits a step; a zone's are a share of it, and at least so much
_FAR, _SHARE, _LEAST = 1e-5, 1e-2, 1e-13
#: a zone shrinks at most to this share in a step: fast modes make zones of 1e-8 radians whose edges move by far more than that
_SHRINKS = 0.1


@dataclass(frozen=True)
class Boundary:
    """A kind of curve in the plane: the orbits of ``sequence`` end by an ``event``, "fold", "release" or "closing"; or their
    greatest pressure passes a break of the law below ("peak")."""

    sequence: str
    event: str


#: every way in which the orbit of a regime with edges ends, but for thresholds that are straight lines (``thresholds``)
BOUNDARIES = (
    Boundary("acaf", "fold"),
    Boundary("afc", "fold"),
    Boundary("af", "fold"),
    Boundary("ac", "release"),
    Boundary("af", "closing"),
)


@dataclass
class Points(Batch):
    """Points of curves: ``velocity`` (m/s), ``A`` and ``E`` (m), ``edges`` (n, k) of the orbit that ends there, and the
    ``pressure`` (Pa) that it passes, break number ``index`` of its law."""

    velocity: np.ndarray
    A: np.ndarray
    E: np.ndarray
    edges: np.ndarray
    pressure: np.ndarray
    index: np.ndarray


def locate(columns: LevelBatch, boundary: Boundary, start: Points, unknown: str) -> tuple[Points, np.ndarray]:
    """Points of a curve by Newton from ``start``, with ``unknown`` "A" or "E" and the other one kept; and which were found.

    ``start`` holds orbits of the boundary's sequence nearby. Points that are not found are no numbers to be used.
    """
    edges, plane = start.edges.T.copy(), {"A": start.A.copy(), "E": start.E.copy()}
    k, n = edges.shape
    found, active = np.zeros(n, bool), np.arange(n)
    system = _System(columns, boundary, start)
    for _ in range(_ITERATIONS):
        if not active.size:
            break
        with np.errstate(all="ignore"):  # what is lost is no number, and is dropped
            step = system.step(active, edges[:, active], plane["A"][active], plane["E"][active], unknown)
        share = np.abs(step[k]) / (plane["A"][active] + np.abs(plane["E"][active]))
        size = np.maximum(np.abs(np.cumsum(step[:k], axis=0)).max(axis=0), share)
        usable = np.isfinite(step).all(axis=0)
        active, step, size = active[usable], step[:, usable], size[usable]
        damping = np.minimum(1.0, _LONGEST / np.maximum(size, 1e-300))
        # the zone behind the last edge, too, changes by a factor at most
        rest, grows = TWO_PI - (edges[-1] - edges[0])[active], -damping * step[1:k].sum(axis=0)
        most = rest * np.where(grows > 0, 1 / _SHRINKS - 1, 1 - _SHRINKS)
        damping *= np.where((rest > 0) & (np.abs(grows) > most), most / np.maximum(np.abs(grows), 1e-300), 1.0)
        edges[:, active] = _moved(edges[:, active], damping * step[:k])
        moved = damping * step[k]
        if unknown == "A":
            moved = np.clip(moved, -_LONGEST * plane["A"][active], _LONGEST * plane["A"][active])
        plane[unknown][active] += moved
        done = size < _SMALL
        found[active[done]] = True
        active = active[~done]
    found &= (np.diff(edges, axis=0) >= -_SMALL).all(axis=0) & (edges[-1] <= edges[0] + TWO_PI)
    return Points(start.velocity, plane["A"], plane["E"], edges.T, start.pressure, start.index), found


def _moved(edges: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Edges (k, n) after a ``step`` of the first and of the zones behind it; of each zone that has a width some is left."""
    widths = np.diff(edges, axis=0)
    after = widths + step[1:]
    after = np.where(widths > 0, np.maximum(after, _SHRINKS * widths), after)
    return np.cumsum(np.append((edges + step)[:1], after, axis=0), axis=0)


class _System:
    """Boundary equations of a sequence and the equation of an event."""

    def __init__(self, columns: LevelBatch, boundary: Boundary, start: Points):
        self.columns, self.boundary, self.velocity = columns, boundary, start.velocity
        self.stretch = start.pressure / columns.material.K
        self.foundation = foundation_of(columns.material)
        # contact without adhesion is contact with saturated adhesion of no strength
        equations = "ac" if boundary.sequence == "cf" else boundary.sequence
        self.residual = getattr(self.foundation.kernel, f"residual_{equations}")

    def step(self, index, edges, A, E, unknown: str) -> np.ndarray:
        """Newton step (k + 1, n) of the first edge, of the zones behind it, and of the unknown of the plane."""
        k, n = edges.shape
        own = A if unknown == "A" else E
        zones = np.clip(_SHARE * np.diff(edges, axis=0), _LEAST, _FAR)
        length = np.concatenate((np.full((1, n), _FAR), zones, _FAR * np.maximum(np.abs(own), A)[None]))
        # the point itself, then one copy for each unknown that is moved a little: all edges, those behind a zone, the plane's
        moved = np.concatenate((edges, own[None]))[:, None].repeat(k + 2, axis=1)
        for i in range(k):
            moved[i:k, i + 1] += length[i]
        moved[k, k + 1] += length[k]
        moved, other = moved.reshape(k + 1, -1), np.tile(E if unknown == "A" else A, k + 2)
        A_, E_ = (moved[k], other) if unknown == "A" else (other, moved[k])
        groups = self.columns.groups(np.tile(self.velocity[index], k + 2), A_, E_ + 2 * A_)
        values = np.array((*self.residual(*moved[:k], *groups), self._event(moved[:k], groups, A_, index)))
        values = values.reshape(k + 1, k + 2, n)
        matrix = ((values[:, 1:] - values[:, :1]) / length).transpose(2, 0, 1)
        return solved(matrix, -values[:, 0].T[:, :, None])[:, :, 0].T

    def _event(self, edges, groups, A, index) -> np.ndarray:
        """What vanishes at the event, for the copies of the points ``index``."""
        if self.boundary.event == "fold":
            return self.foundation.fold(self.boundary.sequence, edges, groups)
        if self.boundary.event == "peak":
            pressure = np.tile(self.stretch[index], A.size // index.size) / A
            return self.foundation.peak(self.boundary.sequence, edges, groups, pressure)
        return getattr(self.foundation, self.boundary.event)(edges, groups)
