"""From nominal pressure to penetration along a branch of loading, and how far up a curve has to be known for that."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .breaks import breakpoints, first_contact, threshold_width
from .means import level_means
from .strips import Columns

_COARSE = 1e-2
_GRID = 5
_REFINEMENTS = 4
_STEPS = 60
_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class Inverse:
    """Penetrations that carry given pressures, arrays (n,): ``D`` (NaN below pull-off) and the slope d(tau)/dp of the level there."""

    D: np.ndarray
    slope: np.ndarray


def cut_penetration(columns: Columns, p_max: np.ndarray, full: np.ndarray) -> np.ndarray:
    """A penetration above the one that carries ``p_max`` (Pa, (n,)) on the unloading path, at most ``full`` (m, (n,)).

    Doubles the distance from first contact until the level carries clearly more than ``p_max`` there and at the next two
    doublings (or up to saturation), so that a local minimum of the curve is not taken for its rise.
    """
    # the curve turns where the crest touches, about -delta_0; from there doubling steps
    base = max(first_contact(columns), -columns.adhesion.delta_0 - 0.5 * columns.level.h)
    scale = 1e-3 * columns.scales[0]
    n = columns.size
    step, lead = np.full(n, columns.level.h), np.zeros(n, int)
    candidate = full.copy()
    active = np.flatnonzero(base + step < full)
    while active.size:
        D = base + step[active]
        p = level_means(columns.at(active, D), np.full(active.size, _COARSE)).values[:, 0]
        enough = p > p_max[active] + 2 * _COARSE * (np.abs(p) + scale)
        lead[active] = np.where(enough, lead[active] + 1, 0)
        candidate[active] = np.where(enough, np.where(lead[active] == 1, D, candidate[active]), full[active])
        step[active] *= 2
        active = active[(lead[active] < 3) & (base + step[active] < full[active])]
    return candidate


def invert(columns: Columns, p: np.ndarray, full: np.ndarray, rtol: float) -> Inverse:
    """Largest penetration (``unloading``) or smallest (``loading``) at which each column carries ``p`` (Pa, (n,)), below saturation.

    The curve is scanned from the end its branch comes from; a local turn that may reach ``p`` is resolved before it is passed. ``full``
    (n,): penetration of saturated contact. The root is refined with averages to ``rtol``.
    """
    scan = _Scan(columns, p, cut_penetration(columns, p, full))
    bracketed = scan.run()
    D, slope = np.full(p.size, np.nan), np.zeros(p.size)
    if bracketed.size:
        D[bracketed], slope[bracketed] = _refine(columns, p, bracketed, scan.near[bracketed], scan.far[bracketed], rtol)
    return Inverse(D, slope)


def _grid(points: np.ndarray, inside: float) -> np.ndarray:
    """Penetrations of a first look at a curve whose pieces end at ``points``, the last free one below included."""
    rows = [np.array([points[0] - inside])]
    for low, high in zip(points[:-1], points[1:], strict=True):
        if high - low > 4 * inside:
            rows.append(low + inside + (high - low - 2 * inside) * np.sin(0.5 * np.pi * np.arange(_GRID + 1) / _GRID) ** 2)
    rows.append(points[-1:])
    return np.concatenate(rows)


class _Scan:
    """Coarse samples of the curve of every column, refined where it turns close to the pressure asked for."""

    def __init__(self, columns: Columns, p, top):
        self.columns, self.p = columns, p
        self.unloading = columns.branch == "unloading"
        # between the breaks of the curve, and just inside them: however narrow a piece is, it is looked at
        inside = threshold_width(columns, top)
        self.D = [_grid(points, width) for points, width in zip(breakpoints(columns, top), inside, strict=True)]
        counts = [row.size for row in self.D]
        P = self._sample(np.repeat(np.arange(p.size), counts), np.concatenate(self.D))
        self.P = np.split(P, np.cumsum(counts)[:-1])
        self.near, self.far = np.full(p.size, np.nan), np.full(p.size, np.nan)

    def _sample(self, column, D):
        return level_means(self.columns.at(column, D), np.full(D.size, _COARSE)).values[:, 0]

    def run(self) -> np.ndarray:
        """Brackets (near the end the branch comes from, and beyond the root); returns the columns that have one."""
        for _ in range(_REFINEMENTS):
            wanted = [(i, *gap) for i in range(self.p.size) for gap in self._doubtful(i)]
            if not wanted:
                break
            column = np.repeat([w[0] for w in wanted], 3)
            D = np.concatenate([w[1] + (w[2] - w[1]) * np.array([0.25, 0.5, 0.75]) for w in wanted])
            P = self._sample(column, D)
            for i in np.unique(column):
                mine = column == i
                order = np.argsort(np.concatenate((self.D[i], D[mine])), kind="stable")
                self.D[i] = np.concatenate((self.D[i], D[mine]))[order]
                self.P[i] = np.concatenate((self.P[i], P[mine]))[order]
        for i in range(self.p.size):
            k = self._crossing(i)
            if k is not None:
                ends = self.D[i][k], self.D[i][k + 1]
                self.near[i], self.far[i] = ends[::-1] if self.unloading else ends
        return np.flatnonzero(np.isfinite(self.near))

    def _crossing(self, i) -> int | None:
        """Interval in which the branch first meets the pressure."""
        below = self.P[i] < self.p[i]
        change = np.flatnonzero(below[:-1] & ~below[1:])
        if not change.size:
            return None
        return int(change[-1] if self.unloading else change[0])

    def _doubtful(self, i):
        """Gaps beside a turn of the curve that lies before the crossing and may reach the pressure between samples."""
        P, D, p = self.P[i], self.D[i], self.p[i]
        k = self._crossing(i)
        gaps = set()
        for j in range(1, P.size - 1):
            if self.unloading:
                turn = P[j] <= P[j - 1] and P[j] <= P[j + 1] and P[j] >= p
                passed = k is None or j > k
                margin = P[j] - p
            else:
                turn = P[j] >= P[j - 1] and P[j] >= P[j + 1] and P[j] < p
                passed = k is None or j <= k
                margin = p - P[j]
            # between samples a smooth turn goes beyond its lowest sample by less than the neighbours rise above it
            reach = 0.5 * max(abs(P[j - 1] - P[j]), abs(P[j + 1] - P[j]))
            if turn and passed and margin <= reach + 2 * _COARSE * (abs(P[j]) + 1e-3 * self.columns.scales[0]):
                gaps.update({(D[j - 1], D[j]), (D[j], D[j + 1])})
        return sorted(gaps)


def _refine(columns: Columns, p, index, near, far, rtol):
    """Root of p_mean(D) - p in each bracket: false position with halving of stale ends (Illinois), averages ever finer."""
    goal = p[index]
    scale = 1e-3 * columns.scales[0]
    n = index.size

    def sample(pick, D, accuracy):
        values = level_means(columns.at(index[pick], D), np.full(pick.size, accuracy)).values
        return values[:, 0] - goal[pick], values[:, 1]

    every = np.arange(n)
    ends = [near.copy(), far.copy()]
    value, tau = zip(*(sample(every, D, rtol) for D in ends), strict=True)
    value, tau = [v.copy() for v in value], [t.copy() for t in tau]
    weight = [v.copy() for v in value]
    root, slope = near.copy(), np.zeros(n)
    # an end on the wrong side by the coarse scan's error is the root itself, to that accuracy: widen it
    active = every[(value[0] * value[1] < 0)]
    for side in (0, 1):
        exact = value[side] == 0
        root[exact] = ends[side][exact]
    stray = every[(value[0] * value[1] > 0)]
    if stray.size:
        best = np.where(np.abs(value[0]) < np.abs(value[1]), ends[0], ends[1])
        root[stray] = best[stray]
    last = np.full(n, -1)
    for _ in range(_STEPS):
        if not active.size:
            break
        a, b, wa, wb = ends[0][active], ends[1][active], weight[0][active], weight[1][active]
        D = (a * wb - b * wa) / (wb - wa)
        edge = np.minimum(a, b) + 1e-3 * np.abs(b - a), np.maximum(a, b) - 1e-3 * np.abs(b - a)
        D = np.clip(D, *edge)
        v, t = sample(active, D, rtol)
        side = np.where(v * value[0][active] > 0, 0, 1)
        for k in (0, 1):
            mine = active[side == k]
            other = 1 - k
            run = last[mine] == k
            weight[other][mine[run]] *= 0.5
            for store, new in ((ends, D), (value, v), (weight, v), (tau, t)):
                store[k][mine] = new[side == k]
        last[active] = side
        root[active] = D
        rise = value[1][active] - value[0][active]
        slope[active] = np.divide(tau[1][active] - tau[0][active], rise, out=np.zeros(active.size), where=np.abs(rise) > 0)
        done = (np.abs(v) <= 0.3 * rtol * (np.abs(goal[active]) + scale)) | (
            np.abs(ends[1] - ends[0])[active] <= 8 * _EPS * np.maximum(np.abs(D), columns.level.h)
        )
        active = active[~done]
    return root, slope
