"""Friction laws of several velocities as one table, evaluated for any mixture of them at once."""

from collections.abc import Sequence

import numpy as np

from ..numerics.chebyshev import clenshaw
from .cells import SLOTS, slot, within
from .law import Law
from .piece import graded, parameter

#: breaks closer than this, relative to the largest, are one
_SAME = 1e-12


class LawTable:
    """Laws stacked by group; ``breaks`` (groups, B), padded with inf, ``p_sat`` (groups,), ``saturated`` (groups, q).

    ``jumps`` (groups, B): change of friction, its own and what it carries, at each break; ``break_error`` (groups, B): how well
    the break's pressure is known, Pa. ``frictions``: where those frictions stand among the quantities after pressure. ``top``,
    ``most`` (groups,): the pressure up to which a law is known, and the greatest of its frictions, Pa.
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
        counts = [len(law.segments) for law in laws]
        self._start = np.concatenate(([0], np.cumsum(counts)[:-1]))
        self._last = np.maximum(np.array(counts) - 1, 0)
        self._upper = _padded([np.array([s.p_high for s in law.segments]) for law in laws], np.inf)
        every = [s for law in laws for s in law.segments]
        self._low, self._high = np.array([s.p_low for s in every]), np.array([s.p_high for s in every])
        columns = 1 + self.frictions
        # of friction, then of pressure, in the middle of every slot
        share = graded((np.arange(SLOTS) + 0.5) / SLOTS)
        middles = [s.p_low + (s.p_high - s.p_low) * share for s in every]
        known = [[s.errors.along(p, which) for which in (columns, 0)] for s, p in zip(every, middles, strict=True)]
        self._errors = np.concatenate(known, axis=1) if known else np.zeros((2, 0))
        cells = [s.cells for s in every]
        first = np.cumsum([0, *(c.start.size for c in cells)])
        joined = lambda values: np.concatenate(values) if cells else np.zeros(0)  # noqa: E731
        self._from, self._size = joined([c.start for c in cells]), joined([c.size for c in cells])
        self._cell = joined([c.of + at for c, at in zip(cells, first[:-1], strict=True)]).astype(np.intp)
        every = np.concatenate([c.coefficients[:, :, 1:] for c in cells], axis=1) if cells else np.zeros((1, 0, 0))
        self._coefficients = np.ascontiguousarray(every.swapaxes(1, 2))
        self._first, self._final = self._segments_between()
        top = np.array([law.p_top for law in laws])
        self.top = top + _SAME * np.where(np.isfinite(top), np.abs(top), 0.0)
        self.most = np.array([np.abs(law(law.supports)[:, 1 + self.frictions]).max(axis=0).sum() for law in laws])

    def _segments_between(self):
        """The first and the last segment between each break and the next, (groups, B) both."""
        breaks = np.concatenate((self.breaks, np.full((self.breaks.shape[0], 1), np.inf)), axis=1)
        apart = _SAME * np.abs(np.where(np.isfinite(breaks), breaks, 0.0)).max(axis=1, keepdims=True)
        below = lambda p: np.count_nonzero(self._upper[:, None] < p[:, :, None], axis=2)  # noqa: E731
        ends = below(breaks[:, :-1] + apart), below(breaks[:, 1:] - apart)
        return (self._start[:, None] + np.minimum(count, self._last[:, None]) for count in ends)

    def __call__(self, group: np.ndarray, interval: np.ndarray, p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Quantities after pressure (q - 1, nodes, m), and errors of friction and pressure (2, nodes, m).

        At pressures ``p`` (nodes, m) of the laws ``group`` (m,), between their breaks ``interval`` (m,) and the next ones.
        """
        which, final = self._first[group, interval], self._final[group, interval]
        # mostly there is one segment between two breaks
        for _ in range((final - which).max(initial=0)):
            which = which + ((which < final) & (p > self._high[which]))
        low = self._low[which]
        share = (p - low) / (self._high[which] - low)
        u = parameter(np.minimum(np.maximum(share, 0.0, out=share), 1.0, out=share))
        at = which * SLOTS + slot(u)
        cell = self._cell[at]
        x = within(u, self._from[cell], self._size[cell])
        return clenshaw(self._coefficients, cell, x), self._errors[:, at]


def _padded(rows, value):
    width = max((row.size for row in rows), default=0)
    out = np.full((len(rows), max(width, 1)), value)
    for row, values in zip(out, rows, strict=True):
        row[: values.size] = values
    return out
