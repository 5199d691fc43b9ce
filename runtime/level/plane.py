"""The curves that divide the plane of strips into regimes, as equations.

At one velocity, with one material, adhesion and closure, a strip is a point of a plane: its amplitude ``A`` and
``E = D - h``, the penetration of the valley of its level; its own penetration is ``D_j = E + 2 A``. Where an orbit of one
regime ceases to exist its edges obey one equation more than the boundary equations of its regime (physics: a fold, where
their Jacobian is singular, or a grazing event). That is one point on every line across the plane: with A given E is
unknown, with E given A is.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

from ..orbit.materials import kernel_of

if TYPE_CHECKING:
    from .strips import Columns

TWO_PI = 2 * np.pi
#: Newton: iterations at most; a step of the edges this small leaves an error of its square; the largest step taken whole
_ITERATIONS, _SMALL, _LONGEST = 16, 1e-8, 0.5
#: relative step of the differences that stand for derivatives of the last equation: the root of the rounding
_STEP = 1.5e-8


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
class Points:
    """Points of curves: ``velocity`` (m/s), ``A`` and ``E`` (m), ``edges`` (k, n) of the orbit that ends there, and the
    ``pressure`` (Pa) that it passes, break number ``index`` of its law."""

    velocity: np.ndarray
    A: np.ndarray
    E: np.ndarray
    edges: np.ndarray
    pressure: np.ndarray
    index: np.ndarray

    def take(self, which) -> Points:
        return Points(*(getattr(self, f.name)[..., which] for f in fields(self)))

    @classmethod
    def joined(cls, one: Points, two: Points) -> Points:
        return cls(*(np.concatenate((getattr(one, f.name), getattr(two, f.name)), axis=-1) for f in fields(cls)))


def locate(columns: Columns, boundary: Boundary, start: Points, unknown: str) -> tuple[Points, np.ndarray]:
    """Points of a curve by Newton from ``start``, with ``unknown`` "A" or "E" and the other one kept; and which were found.

    ``start`` holds orbits of the boundary's sequence nearby. Points that are not found are no numbers to be used.
    """
    edges, plane = start.edges.copy(), {"A": start.A.copy(), "E": start.E.copy()}
    k, n = edges.shape
    found, active = np.zeros(n, bool), np.arange(n)
    system = _System(columns, boundary, start)
    for _ in range(_ITERATIONS):
        if not active.size:
            break
        with np.errstate(all="ignore"):  # what is lost is no number, and is dropped
            step = system.step(active, edges[:, active], plane["A"][active], plane["E"][active], unknown)
        size = np.maximum(np.abs(step[:k]).max(axis=0), np.abs(step[k]) / (plane["A"][active] + np.abs(plane["E"][active])))
        usable = np.isfinite(step).all(axis=0)
        active, step, size = active[usable], step[:, usable], size[usable]
        damping = np.minimum(1.0, _LONGEST / np.maximum(size, 1e-300))
        edges[:, active] += damping * step[:k]
        moved = damping * step[k]
        if unknown == "A":
            moved = np.clip(moved, -_LONGEST * plane["A"][active], _LONGEST * plane["A"][active])
        plane[unknown][active] += moved
        done = size < _SMALL
        found[active[done]] = True
        active = active[~done]
    found &= (np.diff(edges, axis=0) >= -_SMALL).all(axis=0) & (edges[-1] <= edges[0] + TWO_PI)
    return Points(start.velocity, plane["A"], plane["E"], edges, start.pressure, start.index), found


class _System:
    """Boundary equations of a sequence and the equation of an event, with their derivatives by edges and A or E."""

    def __init__(self, columns: Columns, boundary: Boundary, start: Points):
        self.columns, self.boundary, self.velocity = columns, boundary, start.velocity
        self.stretch = start.pressure / columns.material.K
        self.kernel = kernel_of(columns.material)
        # contact without adhesion is contact with saturated adhesion of no strength
        equations = "ac" if boundary.sequence == "cf" else boundary.sequence
        self.residual, self.jacobian = (getattr(self.kernel, f"{name}_{equations}") for name in ("residual", "jacobian"))
        self.event = {"release": self._release, "closing": self._closing, "peak": self._peak}.get(boundary.event)

    def step(self, index, edges, A, E, unknown: str) -> np.ndarray:
        """Newton step (k + 1, n) of the edges and of the unknown of the plane."""
        k, n = edges.shape
        # the point itself, then one copy for each unknown that is moved a little
        shift = np.zeros((k + 1, k + 2))
        shift[np.arange(k + 1), np.arange(1, k + 2)] = 1.0
        length = _STEP * np.concatenate((np.ones((k, n)), [A if unknown == "A" else np.maximum(np.abs(E), A)]))
        moved = np.concatenate((edges, [A if unknown == "A" else E]))[:, None] + shift[:, :, None] * length[:, None]
        length = moved[np.arange(k + 1), np.arange(1, k + 2)] - moved[:, 0]
        flat = moved.reshape(k + 1, -1)
        other = np.tile(E if unknown == "A" else A, k + 2)
        A_, E_ = (flat[k], other) if unknown == "A" else (other, flat[k])
        groups = self.columns.groups(np.tile(self.velocity[index], k + 2), A_, E_ + 2 * A_)
        values = np.array(self.residual(*flat[:k], *groups)).reshape(k, k + 2, n)
        if self.event is None:
            slopes = self._matrix(flat[:k], groups)
            scale = np.abs(slopes[:n]).max(axis=2)
            last = np.linalg.det(slopes / np.tile(scale, (k + 2, 1))[:, :, None])
        else:
            last = self.event(flat[:k], groups, np.tile(self.stretch[index], k + 2) / A_)
        values = np.concatenate((values, last.reshape(1, k + 2, n)))
        matrix = (values[:, 1:] - values[:, :1]) / length
        matrix, value = matrix.transpose(2, 0, 1), values[:, 0].T
        scale = np.abs(matrix).max(axis=2, keepdims=True)
        solvable = np.isfinite(matrix).all(axis=(1, 2)) & np.isfinite(value).all(axis=1) & (scale > 0).all(axis=(1, 2))
        step = np.full((n, k + 1), np.nan)
        for rows in (np.flatnonzero(solvable),):
            step[rows] = -_solved(matrix[rows] / scale[rows], value[rows] / scale[rows, :, 0])
        return step.T

    def _matrix(self, edges, groups) -> np.ndarray:
        rows = self.jacobian(*edges, *groups)
        return np.array([[np.broadcast_to(v, edges.shape[1]) for v in row] for row in rows]).transpose(2, 0, 1)

    def _release(self, edges, groups, _):
        """Greatest gap of an orbit that is engaged all along over delta_0: where the load harmonic rises through
        ``-p_0 - delta_0`` a gap of delta_0 turns."""
        _, beta, _, _, p_0, delta_0, D, _ = groups
        centre, half = self.kernel.forcing_arc(p_0 + delta_0, D, beta)
        last = edges[-1]
        return self.kernel.gap_after(last, np.maximum(centre + TWO_PI - half, last), 0 * D, -p_0, D, beta) - delta_0

    def _closing(self, edges, groups, _):
        """Least gap of an orbit without contact: where the load harmonic falls through ``-p_0`` a gap of nothing turns."""
        _, beta, J, _, p_0, delta_0, D, chi = groups
        centre, half = self.kernel.forcing_arc(p_0, D, beta)
        first = edges[0]
        return self.kernel.gap_after(first, np.maximum(centre + half, first), delta_0 - J * chi * p_0, -p_0, D, beta)

    def _peak(self, edges, groups, pressure):
        """Greatest pressure over ``pressure``: where the load harmonic falls through a pressure, a pressure of that turns."""
        alpha, beta, J, L, p_0, delta_0, D, _ = groups
        centre, half = self.kernel.forcing_arc(-pressure, D, beta)
        start = edges[0 if self.boundary.sequence in ("ac", "cf", "afc") else 1]
        q_on = p_0 - delta_0 / J if self.boundary.sequence == "afc" else 0 * D
        return self.kernel.excess_after(start, np.maximum(centre + half, start), q_on, p_0, D, alpha, beta, L) - p_0 - pressure


def _solved(matrix, value):
    """Solutions of small linear systems (n, k, k) and (n, k); no numbers where one is singular."""
    try:
        return np.linalg.solve(matrix, value[:, :, None])[:, :, 0]
    except np.linalg.LinAlgError:
        regular = np.abs(np.linalg.det(matrix)) > 0
        out = np.full(value.shape, np.nan)
        out[regular] = np.linalg.solve(matrix[regular], value[regular, :, None])[:, :, 0]
        return out
