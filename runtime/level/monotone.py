"""From nominal pressure to penetration where there is no adhesion.

Without adhesion the order of orbits is that of w: at a larger penetration w is larger everywhere, and so is ``p_mean = K w_mean``
(Eq. 5 averaged). There is one penetration for a pressure, whatever the branch, and no turn to look for. As ``3 h/4`` is the mean
depth of the profile under its crests and w lies between the profile and its crest, ``K (D - 3 h/4) <= p_mean <= K D``.
"""

from __future__ import annotations

import numpy as np

from .means import level_means
from .strips import LevelBatch

#: penetrations of the first look, and of the second one close around the root
_FIRST, _SECOND = 9, 5
_ROUGH, _FINE, _WINDOW = 0.05, 1e-6, 0.02


def enclosed(columns: LevelBatch, p: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Penetrations near those that carry ``p`` > 0 (Pa, (n,)), the slopes d(p)/dD and d(tau)/dp there, and the ends of brackets
    of the roots."""
    K, h = columns.material.K, columns.level.h
    low, high = p / K, p / K + 0.75 * h
    D = low[:, None] * (high / low)[:, None] ** np.linspace(0, 1, _FIRST)
    x, y, tau = _curve(columns, D, _ROUGH)
    x_root = _root(x, y, np.log(p))
    D = np.clip(np.exp(x_root), low, high)[:, None] * (1 + _WINDOW * np.cos(np.pi * np.arange(_SECOND) / (_SECOND - 1))[::-1])
    x, y, tau = _curve(columns, D, _FINE)
    x_root = _root(x, y, np.log(p))
    rise = (y[:, -1] - y[:, 0]) / (x[:, -1] - x[:, 0])
    D_root = np.clip(np.exp(x_root), low, high)
    slope = rise * p / D_root
    friction_slope = (tau[:, -1] - tau[:, 0]) / (np.exp(y[:, -1]) - np.exp(y[:, 0]))
    return D_root, slope, friction_slope, low, high


def _curve(columns: LevelBatch, D, rtol):
    """Logarithms of penetration and pressure, and friction, at the penetrations ``D`` (n, m), each (n, m)."""
    rows = np.repeat(np.arange(D.shape[0]), D.shape[1])
    values = level_means(columns.at(rows, D.ravel()), np.full(D.size, rtol)).values
    pressure, tau = (values[:, i].reshape(D.shape) for i in (0, 1))
    return np.log(D), np.log(np.maximum(pressure, np.finfo(float).tiny)), tau


def _root(x, y, goal):
    """Where the polynomials ``x(y)`` through up to five of the points (n, m) nearest to ``goal`` (n,) pass it; ``y`` rises."""
    first = np.clip((y < goal[:, None]).sum(axis=1) - 2, 0, y.shape[1] - 4)
    at = first[:, None] + np.arange(4) if y.shape[1] > _SECOND else np.broadcast_to(np.arange(y.shape[1]), y.shape)
    x, y = np.take_along_axis(x, at, axis=1), np.take_along_axis(y, at, axis=1)
    out = np.zeros(goal.size)
    for i in range(x.shape[1]):
        weight = np.ones(goal.size)
        for j in range(x.shape[1]):
            if j != i:
                # pressures that underflow are alike: what comes of them is a start only
                apart = y[:, i] - y[:, j]
                weight *= np.divide(goal - y[:, j], apart, out=np.zeros_like(apart), where=apart != 0)
        out += weight * x[:, i]
    return np.clip(out, x[:, 0], x[:, -1])
