"""A level's means as a function of penetration, from the first contact to saturation, one curve per velocity.

The crest strip (y = 0) has everywhere the highest profile, so by the order of orbits it is the most engaged of its level: it is the
last to let go, and the means lose smoothness at the penetrations where it changes regime, and where the flat edge does.
Between these the curve is interpolated; pieces that do not converge are halved. All velocities advance together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .appearance import is_inside, island, vanishing
from .chebyshev import Piece, coefficients, lobatto, refinement
from .means import level_means
from .strips import Columns, saturation_depth
from .transitions import locate

_FIRST, _LAST = 4, 32
_ROUNDS = 40
#: how much the last doubling of nodes may be trusted to have gained over the one before
_GAIN = 0.1
_SCAN = 48
_EPS = np.finfo(float).eps


@dataclass(frozen=True)
class Curve:
    """Pieces in order of falling D; above ``D_top`` (saturation, or the cut) nothing is stored. ``strips``: strips evaluated."""

    pieces: list[Piece]
    D_top: float
    strips: int


def first_contact(columns: Columns) -> float:
    """A penetration at and below which every strip of the level is free."""
    a = columns.adhesion
    reach = a.delta_0 if a.p_0 > 0 else 0.0
    if columns.branch == "loading":
        return -reach
    # w is never above -p_0/K where it adheres, and after a step it recovers by J_0 p_0 <= p_0/K at most
    return -(2 * a.p_0 / columns.material.K + reach) * (1 + 1e-9)


def breakpoints(columns: Columns, top: np.ndarray) -> list[np.ndarray]:
    """Penetrations between first contact and ``top`` (n,) where the curve may not be smooth, ascending, ends included."""
    n, h = columns.size, columns.level.h
    a, K = columns.adhesion, columns.material.K
    bottom = first_contact(columns)
    # dense where regimes follow one another, geometric above: saturation may be far up
    share = np.linspace(0, 1, _SCAN)
    found = [[] for _ in range(n)]
    near = bottom + np.minimum(2 * h + a.delta_0 + 2 * a.p_0 / K, top - bottom)[:, None] * share
    ratio = np.maximum((top - bottom) / np.maximum(near[:, -1] - bottom, 1e-300), 1.0)
    far = bottom + (near[:, -1] - bottom)[:, None] * ratio[:, None] ** np.linspace(0, 1, _SCAN // 4 + 1)
    D = np.concatenate((near, far[:, 1:]), axis=1)
    rows = np.repeat(np.arange(n), D.shape[1])
    codes = _crest_codes(columns, rows, D.ravel()).reshape(D.shape)
    row, node = np.nonzero(codes[:, 1:] != codes[:, :-1])
    low, high = D[row, node], D[row, node + 1]
    width = 16 * _EPS * np.maximum(np.maximum(np.abs(low), np.abs(high)), h)
    transitions = locate(
        lambda line, x: _crest_codes(columns, line, x), row, low, high, codes[row, node], codes[row, node + 1], width
    )
    for r, D_break in zip(transitions.line, transitions.high, strict=True):
        found[r].append(D_break)
    edge = [h - a.p_0 / K, h - a.p_0 / K - a.delta_0, h - (a.delta_0 if a.p_0 > 0 else 0.0)]
    out = []
    for r in range(n):
        points = np.array([*found[r], *edge, far[r, 0], top[r]])
        start = min(found[r], default=bottom)
        points = np.unique(points[(points >= start) & (points <= top[r])])
        points = points[np.concatenate(([True], np.diff(points) > 1e-12 * h))] if points.size else points
        out.append(points)
    return out


def _crest_codes(columns: Columns, column, D):
    return columns.at(column, D).codes(np.arange(D.size), np.zeros(D.size))


def trace(columns: Columns, rtol: np.ndarray, top: np.ndarray | None = None) -> list[Curve]:
    """Curves of every column (its ``D`` is not used) up to penetration ``top`` (saturation if not given), to ``rtol``."""
    n = columns.size
    top = saturation_depth(columns) if top is None else top
    points = breakpoints(columns, top)
    column = np.repeat(np.arange(n), [max(p.size - 1, 0) for p in points])
    # just inside its breaks a piece does not see strips that sit on a threshold but for rounding
    inside = threshold_width(columns, top)
    low = np.concatenate([p[:-1] for p in points]) + inside[column] if n else np.empty(0)
    high = np.concatenate([p[1:] for p in points]) - inside[column] if n else np.empty(0)
    proper = high > low
    column, low, high = column[proper], low[proper], high[proper]
    pieces: list[list[Piece]] = [[] for _ in range(n)]
    strips = np.zeros(n, int)
    for _ in range(_ROUNDS):
        if not column.size:
            break
        column, low, high = _interpolate(columns, rtol, column, low, high, pieces, strips)
    else:
        raise ArithmeticError("the curve over penetration did not converge")
    return [Curve(sorted(pieces[i], key=lambda piece: -piece.low), float(top[i]), int(strips[i])) for i in range(n)]


def threshold_width(columns: Columns, top):
    """Distance in D from a threshold below which rounding may decide it the other way."""
    a = columns.adhesion
    return 64 * _EPS * (columns.level.h + np.abs(top) + 2 * a.p_0 / columns.material.K + a.delta_0)


def _interpolate(columns, rtol, column, low, high, pieces, strips):
    """Interpolate each interval on doubled nodes; append what converges to ``pieces``, return the parts of what does not."""
    sample = _Sample(columns, rtol, column, low, high, strips)
    values, errors, zones = sample.at(lobatto(_FIRST))
    n, previous = _FIRST, None
    floor = 1e-3 * columns.scales
    parts = []
    while column.size and n < _LAST:
        n *= 2
        predicted = np.einsum("ij,pjq->piq", refinement(n), values)
        fresh = sample.at(lobatto(n)[1::2])
        miss = np.abs(fresh[0] - predicted).max(axis=1)
        values, errors = _merge(values, fresh[0]), _merge(errors, fresh[1])
        zones = [
            [z for pair in zip(old, new + [None], strict=True) for z in pair][:-1]
            for old, new in zip(zones, fresh[2], strict=True)
        ]
        goal = rtol[column][:, None] * (np.abs(values).min(axis=1) + floor)
        # the interpolant through twice the nodes is better than the miss of the one before, by what that doubling gained
        gain = np.divide(miss, previous, out=np.ones_like(miss), where=previous > miss) if previous is not None else 0.3
        error = miss * np.maximum(gain, _GAIN)
        previous = miss
        done = (error <= 0.5 * goal).all(axis=1) | (high - low <= 1e-11 * np.maximum(np.abs(high), columns.level.h))
        for i in np.flatnonzero(done):
            bound = error[i] + errors[i].max(axis=0)
            pieces[column[i]].append(Piece(low[i], high[i], coefficients(values[i]), bound))
        split = np.zeros(column.size, bool)
        if n > _FIRST * 2:
            # what appears or vanishes between two nodes, away from the crest, is a break of its own
            todo = [(i, island(int(column[i]), sample.penetrations(i, lobatto(n)), zones[i])) for i in np.flatnonzero(~done)]
            todo = [(i, found) for i, found in todo if found is not None]
            breaks = vanishing(columns, [found for _, found in todo], strips) if todo else []
            for (i, _), D_break in zip(todo, breaks, strict=True):
                if is_inside(D_break, low[i], high[i]):
                    split[i] = True
                    parts += [(column[i], low[i], D_break), (column[i], D_break, high[i])]
        rest = np.flatnonzero(~done & ~split)
        column, low, high, values, errors, previous = (v[rest] for v in (column, low, high, values, errors, previous))
        zones = [zones[i] for i in rest]
        sample = _Sample(columns, rtol, column, low, high, strips)
    middle = 0.5 * (low + high)
    parts += [*zip(column, low, middle, strict=True), *zip(column, middle, high, strict=True)]
    column, low, high = (np.array([part[j] for part in parts], dtype) for j, dtype in enumerate((int, float, float)))
    return column, low, high


def _merge(old, fresh):
    out = np.empty((old.shape[0], old.shape[1] + fresh.shape[1], old.shape[2]))
    out[:, 0::2], out[:, 1::2] = old, fresh
    return out


@dataclass
class _Sample:
    """Intervals of D to be sampled, with the count of strips it takes."""

    columns: Columns
    rtol: np.ndarray
    column: np.ndarray
    low: np.ndarray
    high: np.ndarray
    strips: np.ndarray

    def penetrations(self, i, t):
        """D of interval ``i`` (or of all, with a slice) at the parameters ``t``."""
        low, high = self.low[i], self.high[i]
        return np.expand_dims(low, -1) + np.expand_dims(high - low, -1) * np.sin(0.5 * np.pi * t) ** 2

    def at(self, t):
        """Means and errors (intervals, nodes, q) at the nodes ``t`` of every interval, and the zones met at each."""
        q = self.columns.scales.size
        if not self.column.size:
            return np.empty((0, t.size, q)), np.empty((0, t.size, q)), []
        D = self.penetrations(slice(None), t).ravel()
        rows = np.repeat(self.column, t.size)
        means = level_means(self.columns.at(rows, D), 0.1 * self.rtol[rows])
        np.add.at(self.strips, rows, means.strips)
        shape = (self.column.size, t.size, -1)
        zones = [means.zones[i : i + t.size] for i in range(0, rows.size, t.size)]
        return means.values.reshape(shape), means.errors.reshape(shape), zones
