"""Where transitions along y are to be expected at one penetration, from where they lie at others."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from .panels import Hints

#: brackets narrower or wider than this are no use
_NARROWEST, _WIDEST = 1e-10, 0.03
#: a zone narrower than this might be passed over between two nodes: a strip in its middle is looked at
_NARROW = 0.1


def boundaries(zones: np.ndarray) -> np.ndarray:
    """Thetas between neighbouring zones, rows (code, low, high) of ``Averages.zones``, (..., zones, 3)."""
    return 0.5 * (zones[..., :-1, 2] + zones[..., 1:, 1])


def expect(x: np.ndarray, zones: list[np.ndarray], x_new: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Sequence of codes (k + 1,), thetas of its transitions and half widths of their brackets (points, k) at ``x_new``; None if
    unknown.

    ``x``: ascending parameters at which ``zones`` are known; those with the sequence met most often count.
    """
    sequences = [z[:, 0].tobytes() for z in zones]
    common = max(dict.fromkeys(sequences), key=sequences.count)
    pick = [i for i, s in enumerate(sequences) if s == common]
    codes = zones[pick[0]][:, 0].astype(int)
    if codes.size < 2 or len(pick) < 3:
        return None
    theta, new = boundaries(np.array([zones[i] for i in pick])), tuple(x_new.tolist())
    known = tuple(x[pick].tolist())
    at = _lagrange(known, new) @ theta
    other = _lagrange(known[::2], new) @ theta[::2] if len(pick) > 4 else _lagrange(known[1:], new) @ theta[1:]
    # leaving out every other point costs digits: with all of them there are more
    miss = np.abs(at - other)
    width = np.maximum(np.where(miss < 1, 3 * miss ** (1.3 if len(pick) > 4 else 1.0), np.inf), _NARROWEST)
    return codes, at, width


@lru_cache(maxsize=256)
def _lagrange(x: tuple[float, ...], x_new: tuple[float, ...]) -> np.ndarray:
    """Matrix from values at ``x`` to values at ``x_new`` of the polynomial through them."""
    known = np.array(x)
    apart = known[:, None] - known
    np.fill_diagonal(apart, 1.0)
    factors = (np.array(x_new)[:, None, None] - known) / apart
    every = np.arange(known.size)
    factors[:, every, every] = 1.0
    return factors.prod(axis=2)


def hints(columns: np.ndarray, expected: list, witnesses: list[tuple[float, ...]], size: np.ndarray) -> Hints | None:
    """``panels.Hints`` for ``columns[i]`` (points of one interval each) from what ``expect`` said of each and the thetas
    ``witnesses[i]``; ``size`` (all columns, q)."""
    none = np.empty(0)
    transitions, zones, looks = [[none] * 5], [[none] * 3], [[none] * 2]
    for column, e, known in zip(columns, expected, witnesses, strict=True):
        if known:
            looks.append([np.repeat(column, len(known)), np.tile(known, column.size)])
        if e is not None:
            codes, theta, width = e
            k = codes.size - 1
            sides = np.tile(codes[:-1], column.size), np.tile(codes[1:], column.size)
            transitions.append([np.repeat(column, k), theta.ravel(), width.ravel(), *sides])
            zones.append([np.repeat(column, k - 1), theta[:, :-1].ravel(), theta[:, 1:].ravel()])
    column, theta, width, code_low, code_high = (np.concatenate(v) for v in zip(*transitions, strict=True))
    low, high = theta - width, theta + width
    usable = np.flatnonzero((width < _WIDEST) & (low > 0) & (high < np.pi))
    column, low, high, code_low, code_high = (v[usable] for v in (column, low, high, code_low, code_high))
    zone_column, start, end = (np.concatenate(v) for v in zip(*zones, strict=True))
    middle, extent = 0.5 * (start + end), end - start
    # interpolation may put a zone next to the crest or the flat edge beyond it
    narrow = np.flatnonzero((extent > 0) & (extent < _NARROW) & (middle > 0) & (middle < np.pi))
    looks.append([zone_column[narrow], middle[narrow]])
    look_column, theta = (np.concatenate(v) for v in zip(*looks, strict=True))
    if not column.size and not theta.size:
        return None
    whole = (v.astype(int) for v in (column, code_low, code_high, look_column))
    column, code_low, code_high, look_column = whole
    return Hints(column, low, high, code_low, code_high, size, look_column, theta)
