"""A level's means as a function of penetration, from the first contact to saturation, one curve per velocity.

The crest strip (y = 0) has everywhere the highest profile, so by the order of orbits it is the most engaged of its level: it is the
last to let go, and the means lose smoothness at the penetrations where it changes regime, and where the flat edge does.
Between these the curve is interpolated; pieces that do not converge are halved. All velocities advance together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .chebyshev import Piece, coefficients, lobatto, refinement
from .means import level_means
from .strips import Columns, saturation_depth

_FIRST, _LAST = 8, 32
_ROUNDS = 40
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
    column, breaks = _locate(columns, row, D[row, node], D[row, node + 1], codes[row, node], codes[row, node + 1])
    for r, D_break in zip(column, breaks, strict=True):
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


def _locate(columns: Columns, column, low, high, code_low, code_high):
    """Penetrations where the crest's code changes, from brackets in which it does at least once; with their columns."""
    found_column, found = [], []
    for _ in range(60):
        narrow = high - low <= 16 * _EPS * np.maximum(np.maximum(np.abs(low), np.abs(high)), columns.level.h)
        found_column.append(column[narrow])
        found.append(high[narrow])
        column, low, high, code_low, code_high = (v[~narrow] for v in (column, low, high, code_low, code_high))
        if not column.size:
            break
        # many points at once: rounds, not strips, are what costs here
        m = int(np.clip(256 // column.size, 1, 15))
        D = low[:, None] + (high - low)[:, None] * np.arange(1, m + 1) / (m + 1)
        codes = _crest_codes(columns, np.repeat(column, m), D.ravel()).reshape(D.shape)
        points = np.concatenate((low[:, None], D, high[:, None]), axis=1)
        codes = np.concatenate((code_low[:, None], codes, code_high[:, None]), axis=1)
        row, node = np.nonzero(codes[:, 1:] != codes[:, :-1])
        column, low, high = column[row], points[row, node], points[row, node + 1]
        code_low, code_high = codes[row, node], codes[row, node + 1]
    return np.concatenate(found_column), np.concatenate(found)


def _crest_codes(columns: Columns, column, D):
    codes, _ = columns.at(column, D).integrand(np.arange(D.size), np.zeros(D.size))
    return codes


def trace(columns: Columns, rtol: np.ndarray, top: np.ndarray | None = None) -> list[Curve]:
    """Curves of every column (its ``D`` is not used) up to penetration ``top`` (saturation if not given), to ``rtol``."""
    n = columns.size
    top = saturation_depth(columns) if top is None else top
    points = breakpoints(columns, top)
    column = np.repeat(np.arange(n), [max(p.size - 1, 0) for p in points])
    low = np.concatenate([p[:-1] for p in points]) if n else np.empty(0)
    high = np.concatenate([p[1:] for p in points]) if n else np.empty(0)
    pieces: list[list[Piece]] = [[] for _ in range(n)]
    strips = np.zeros(n, int)
    for _ in range(_ROUNDS):
        if not column.size:
            break
        column, low, high = _interpolate(columns, rtol, column, low, high, pieces, strips)
    else:
        raise ArithmeticError("the curve over penetration did not converge")
    return [
        Curve(sorted(pieces[i], key=lambda piece: -piece.low), float(top[i]), int(strips[i])) for i in range(n)
    ]


def _interpolate(columns, rtol, column, low, high, pieces, strips):
    """Interpolate each interval on doubled nodes; append what converges to ``pieces``, return halves of what does not."""
    values = _sample(columns, rtol, column, low, high, lobatto(_FIRST), strips)
    n = _FIRST
    floor = 1e-3 * columns.scales
    while column.size and n < _LAST:
        n *= 2
        predicted = np.einsum("ij,pjq->piq", refinement(n), values[0])
        new = _sample(columns, rtol, column, low, high, lobatto(n)[1::2], strips)
        merged = [_merge(old, fresh) for old, fresh in zip(values, new, strict=True)]
        miss = np.abs(new[0] - predicted).max(axis=1)
        size = np.abs(merged[0]).max(axis=1)
        noise = merged[1].max(axis=1)
        goal = rtol[column][:, None] * (np.abs(merged[0]).min(axis=1) + floor)
        # the interpolant through twice the nodes is better than the miss of the one before: at least by its square root
        error = miss * np.minimum(np.sqrt(np.divide(miss, size, out=np.zeros_like(miss), where=size > 0)), 1.0)
        done = (error <= 0.5 * goal).all(axis=1) | (high - low <= 1e-11 * np.maximum(np.abs(high), columns.level.h))
        for i in np.flatnonzero(done):
            pieces[column[i]].append(Piece(low[i], high[i], coefficients(merged[0][i]), error[i] + noise[i]))
        rest = ~done
        column, low, high = column[rest], low[rest], high[rest]
        values = [m[rest] for m in merged]
    middle = 0.5 * (low + high)
    return np.tile(column, 2), np.concatenate((low, middle)), np.concatenate((middle, high))


def _merge(old, fresh):
    out = np.empty((old.shape[0], old.shape[1] + fresh.shape[1], old.shape[2]))
    out[:, 0::2], out[:, 1::2] = old, fresh
    return out


def _sample(columns, rtol, column, low, high, t, strips):
    """Means and their errors at the nodes ``t`` of every interval, shape (intervals, nodes, q) each."""
    if not column.size:
        return np.empty((0, t.size, columns.scales.size)), np.empty((0, t.size, columns.scales.size))
    D = (low[:, None] + (high - low)[:, None] * np.sin(0.5 * np.pi * t) ** 2).ravel()
    rows = np.repeat(column, t.size)
    means = level_means(columns.at(rows, D), 0.1 * rtol[rows])
    np.add.at(strips, rows, means.strips)
    shape = (column.size, t.size, -1)
    return means.values.reshape(shape), means.errors.reshape(shape)
