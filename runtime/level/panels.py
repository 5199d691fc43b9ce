"""Panels of theta, what cuts them, and what is known of their ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(slots=True)
class Panels:
    """Panels [low, high] of columns, arrays (m,), with the ``codes`` (m, 2) and ``values`` (m, 2, q) at their ends where these
    are known (NaN: not). Where values are known codes are."""

    column: np.ndarray
    low: np.ndarray
    high: np.ndarray
    codes: np.ndarray
    values: np.ndarray

    @classmethod
    def unknown(cls, column, low, high, q: int):
        """Panels of whose ends nothing is known."""
        return cls(column, low, high, np.full((column.size, 2), np.nan), np.full((column.size, 2, q), np.nan))

    @classmethod
    def joined(cls, parts):
        return cls(*(np.concatenate([getattr(p, f) for p in parts]) for f in ("column", "low", "high", "codes", "values")))

    def take(self, index):
        return Panels(self.column[index], self.low[index], self.high[index], self.codes[index], self.values[index])

    @property
    def size(self):
        return self.column.size

    @property
    def known(self):
        """Which ends (m, 2) are known, (m, 2)."""
        return ~np.isnan(self.values[:, :, 0])


def between(n: int, cuts: Panels) -> Panels:
    """The panels that the cuts leave of every column."""
    cuts = cuts.take(np.lexsort((cuts.low, cuts.column)))
    q = cuts.values.shape[2]
    every, nothing = np.arange(n), (np.full(n, np.nan), np.full((n, q), np.nan))
    after = (
        np.concatenate(v)
        for v in zip((every, np.zeros(n), *nothing), (cuts.column, cuts.high, cuts.codes[:, 1], cuts.values[:, 1]), strict=True)
    )
    before = (
        np.concatenate(v)
        for v in zip(
            (cuts.column, cuts.low, cuts.codes[:, 0], cuts.values[:, 0]), (every, np.full(n, np.pi), *nothing), strict=True
        )
    )
    (column, *starts), (last, *ends) = after, before
    starts = [v[np.argsort(column, kind="stable")] for v in starts]
    ends = [v[np.argsort(last, kind="stable")] for v in ends]
    codes, values = (np.stack(pair, axis=1) for pair in zip(starts[1:], ends[1:], strict=True))
    return Panels(np.sort(column, kind="stable"), starts[0], ends[0], codes, values)


def hold_none(column, low, high, other, known) -> np.ndarray:
    """Which brackets [low, high] of a ``column`` hold none of the transitions ``known`` of the columns ``other``."""
    # theta is below 4: columns apart
    keys = np.sort(4.0 * other + known)
    return np.searchsorted(keys, 4.0 * column + low, "left") == np.searchsorted(keys, 4.0 * column + high, "right")


def apart(column, low, high) -> np.ndarray:
    """Which brackets of a column do not overlap, in order."""
    order = np.lexsort((low, column))
    tight = np.flatnonzero((column[order[1:]] == column[order[:-1]]) & (low[order[1:]] <= high[order[:-1]]))
    return np.delete(order, np.union1d(tight, tight + 1))


@dataclass(slots=True)
class Sights:
    """Strips that are asked for first, arrays (k,): at ``theta`` of a ``column``, for what ends at ``place``; their ``codes`` and
    ``values`` (k, q) once they are known. What is narrower than a panel's first step shows up there."""

    column: np.ndarray
    theta: np.ndarray
    place: np.ndarray
    codes: np.ndarray | None = None
    values: np.ndarray | None = None

    def add(self, column, place) -> None:
        """Ask for the strips at each ``place`` of a ``column`` too."""
        self.column, self.theta, self.place = (
            np.concatenate(v) for v in ((self.column, column), (self.theta, place), (self.place, place))
        )

    def at(self, column, place) -> np.ndarray:
        """Which one lies at each ``place`` of a column, -1 for none."""
        return beside(column, place, self.column, self.place)


def beside(column, place, owner, ends) -> np.ndarray:
    """Which of the ``owner``s' ``ends`` lies at each ``place`` of a column, -1 for none."""
    keys = owner + 1j * ends
    order = np.argsort(keys)
    at = np.minimum(np.searchsorted(keys[order], column + 1j * place), order.size - 1)
    found = order[at]
    return np.where((owner[found] == column) & (ends[found] == place), found, -1)
