"""Where transitions along y are to be expected at one penetration, from where they lie at others."""

from __future__ import annotations

import numpy as np

from .panels import Hints

#: brackets narrower or wider than this are no use
_NARROWEST, _WIDEST = 1e-10, 0.03
#: a zone narrower than this might be passed over between two nodes: a strip in its middle is looked at
_NARROW = 0.1


def boundaries(zones: np.ndarray) -> np.ndarray:
    """Thetas between neighbouring zones (rows code, low, high) of ``Averages.zones``."""
    return 0.5 * (zones[:-1, 2] + zones[1:, 1])


def expect(x: np.ndarray, zones: list[np.ndarray], x_new: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Sequence of codes (k + 1,), thetas of its transitions and half widths of their brackets (points, k) at ``x_new``; None if
    unknown.

    ``x``: ascending parameters at which ``zones`` are known; those with the sequence met most often count.
    """
    sequences = [tuple(z[:, 0].astype(int)) for z in zones]
    common = max(set(sequences), key=sequences.count)
    pick = [i for i, s in enumerate(sequences) if s == common]
    if len(common) < 2 or len(pick) < 3:
        return None
    x, theta = x[pick], np.array([boundaries(zones[i]) for i in pick])
    at = _lagrange(x, x_new) @ theta
    other = _lagrange(x[::2], x_new) @ theta[::2] if len(pick) > 4 else _lagrange(x[1:], x_new) @ theta[1:]
    # leaving out every other point costs digits: with all of them there are more
    miss = np.abs(at - other)
    width = np.maximum(np.where(miss < 1, 3 * miss ** (1.3 if len(pick) > 4 else 1.0), np.inf), _NARROWEST)
    return np.array(common), at, width


def _lagrange(x, x_new):
    """Matrix from values at ``x`` to values at ``x_new`` of the polynomial through them."""
    apart = x[:, None] - x
    np.fill_diagonal(apart, 1.0)
    factors = (x_new[:, None, None] - x) / apart
    every = np.arange(x.size)
    factors[:, every, every] = 1.0
    return factors.prod(axis=2)


def hints(columns: np.ndarray, expected: list, witnesses: list[tuple[float, ...]], size: np.ndarray) -> Hints | None:
    """``panels.Hints`` for ``columns[i]`` (points of one interval each) from what ``expect`` said of each and the thetas
    ``witnesses[i]``; ``size`` (all columns, q)."""
    transitions, looks = [[np.empty(0)] * 5], [[np.empty(0)] * 2]
    for column, e, known in zip(columns, expected, witnesses, strict=True):
        looks.append([np.repeat(column, len(known)), np.tile(known, column.size)])
        if e is None:
            continue
        codes, theta, width = e
        at, where = np.nonzero((width < _WIDEST) & (theta - width > 0) & (theta + width < np.pi))
        ends = (theta - width)[at, where], (theta + width)[at, where]
        transitions.append([column[at], *ends, codes[where], codes[where + 1]])
        middle, extent = 0.5 * (theta[:, 1:] + theta[:, :-1]), np.diff(theta, axis=1)
        # interpolation may put a zone next to the crest or the flat edge beyond it
        at, where = np.nonzero((extent > 0) & (extent < _NARROW) & (middle > 0) & (middle < np.pi))
        looks.append([column[at], middle[at, where]])
    column, low, high, code_low, code_high = (np.concatenate(v) for v in zip(*transitions, strict=True))
    look_column, theta = (np.concatenate(v) for v in zip(*looks, strict=True))
    if not column.size and not theta.size:
        return None
    whole = (v.astype(int) for v in (column, code_low, code_high, look_column))
    column, code_low, code_high, look_column = whole
    return Hints(column, low, high, code_low, code_high, size, look_column, theta)
