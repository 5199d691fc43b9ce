"""Zones along y: runs of neighbouring strips with one code."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Zones:
    """Zones of one column in order of theta: ``code``, ends ``low`` and ``high``, (k,); and the values averaged, next to both
    ends (``first``, ``last``) and on the ``mean``, (k, q)."""

    code: np.ndarray
    low: np.ndarray
    high: np.ndarray
    first: np.ndarray
    last: np.ndarray
    mean: np.ndarray

    def standing_out(self, k: int) -> np.ndarray:
        """How far the mean of zone ``k`` is from the values next to it in the neighbouring zones, (q,)."""
        beside = [*self.last[max(k - 1, 0) : k], *self.first[k + 1 : k + 2]]
        return np.abs(self.mean[k] - beside).max(axis=0, initial=0.0) if beside else np.zeros(self.mean.shape[1])


def zones_of(columns: int, state, code, low, high, first, last, total) -> list[Zones]:
    """Zones of every column from panels (m,) of the columns ``state``: codes, ends, values at both, and integrals ``total``."""
    order = np.lexsort((low, state))
    state, code, low, high, first, last, total = (v[order] for v in (state, code, low, high, first, last, total))
    start = np.flatnonzero(np.append(True, (state[1:] != state[:-1]) | (code[1:] != code[:-1])))
    stop = np.append(start[1:], state.size) - 1
    width = np.add.reduceat(high - low, start)[:, None]
    every = Zones(code[start], low[start], high[stop], first[start], last[stop], np.add.reduceat(total, start) / width)
    ends = np.searchsorted(state[start], np.arange(columns + 1))
    return [
        Zones(*(v[here] for v in vars(every).values()))
        for here in (slice(*pair) for pair in zip(ends[:-1], ends[1:], strict=True))
    ]
