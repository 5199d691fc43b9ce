"""Friction laws of several velocities as one table, evaluated for any mixture of them at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .cells import SLOTS, clenshaw, slot, within
from .chebyshev import parameter
from .law import Law

_CHUNK = 4096


class LawTable:
    """Laws stacked by group; ``breaks`` (groups, B), padded with inf, ``p_sat`` (groups,), ``saturated`` (groups, q).

    ``jumps`` (groups, B): change of friction, its own and what it carries, at each break; ``break_error`` (groups, B): how well
    the break's pressure is known, Pa. ``frictions``: where those frictions stand among the quantities after pressure.
    """

    def __init__(self, laws: Sequence[Law]):
        self.p_sat = np.array([law.p_sat for law in laws])
        self.pull_off = np.array([law.pull_off for law in laws])
        self.saturated = np.array([law.saturated for law in laws])
        self.frictions = laws[0].friction_columns
        self.breaks = _padded([law.breaks for law in laws], np.inf)
        sides = [law.at_breaks() for law in laws]
        self.jumps = _padded([jumps for jumps, _ in sides], 0.0)
        self.break_error = _padded([errors for _, errors in sides], 0.0)
        counts = [len(law.branches) for law in laws]
        self._start = np.concatenate(([0], np.cumsum(counts)[:-1]))
        self._last = np.maximum(np.array(counts) - 1, 0)
        self._upper = _padded([np.array([b.p_high for b in law.branches]) for law in laws], np.inf)
        every = [b for law in laws for b in law.branches]
        self._low, self._high = np.array([b.p_low for b in every]), np.array([b.p_high for b in every])
        error = np.array([b.piece.error for b in every]).reshape(len(every), -1)
        self._error = np.stack((error[:, 1 + self.frictions].sum(axis=1), error[:, 0]), axis=1) if every else np.zeros((0, 2))
        cells = [b.cells for b in every]
        first = np.cumsum([0, *(c.start.size for c in cells)])
        joined = lambda values: np.concatenate(values) if cells else np.zeros(0)  # noqa: E731
        self._coefficients = np.concatenate([c.coefficients[:, :, 1:] for c in cells], axis=1) if cells else np.zeros((1, 0, 0))
        self._from, self._size = joined([c.start for c in cells]), joined([c.size for c in cells])
        self._cell = np.array([c.of + at for c, at in zip(cells, first[:-1], strict=True)]).reshape(-1, SLOTS)

    def __call__(self, group: np.ndarray, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Quantities after pressure (m, q - 1) at pressures ``p`` (m,) of the laws ``group`` (m,), and errors of friction and
        pressure (m, 2)."""
        out, errors = np.zeros((p.size, self.saturated.shape[1] - 1)), np.zeros((p.size, 2))
        high = p >= self.p_sat[group]
        out[high] = self.saturated[group[high], 1:]
        rest = np.flatnonzero(~high & (p >= self.pull_off[group]))
        if not self._low.size:
            return out, errors
        # few at a time: their coefficients stay in the cache
        for start in range(0, rest.size, _CHUNK):
            some = rest[start : start + _CHUNK]
            out[some], errors[some] = self._between(group[some], p[some])
        return out, errors

    def _between(self, g, p):
        which = self._start[g] + np.minimum(np.count_nonzero(self._upper[g] < p[:, None], axis=1), self._last[g])
        share = np.clip((p - self._low[which]) / (self._high[which] - self._low[which]), 0.0, 1.0)
        u = parameter(share)
        cell = self._cell[which, slot(u)]
        return clenshaw(self._coefficients[:, cell], within(u, self._from[cell], self._size[cell])), self._error[which]


def _padded(rows, value):
    width = max((row.size for row in rows), default=0)
    out = np.full((len(rows), max(width, 1)), value)
    for row, values in zip(out, rows, strict=True):
        row[: values.size] = values
    return out
