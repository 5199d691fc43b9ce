"""Strips that are free because a strip that is pressed deeper is: the order of orbits along the penetration.

Claim. Of two strips of the same velocity and amplitude (the same theta of a level) the one with the larger D is the
more engaged, on either branch and at every phase: engaged wherever the other is, in contact wherever it is. Hence
where the orbit is free at D', it is free at every ``D <= D'``.

Proof. Let ``y = w - J_0 p - u``. Eq. 1 says ``T_eps y' + y = (L/K) p - G``, ``G = u + T_eps u'``, and p follows from
y and from whether the point is engaged: engaged ``p = max(-y/J_0, -p_0)`` (contact up to ``y = J_0 p_0``, a gap ``y -
J_0 p_0`` beyond), free ``p = 0``, gap y. A larger D adds the same constant to u, hence to G, everywhere, and changes
nothing else. Order states by engaged before free, then by y. Between steps two engaged points obey one scalar
equation, and two free ones another, with right-hand sides that differ by that constant: the one with the larger D
keeps the smaller y. Release comes with y growing past ``delta_0 + J_0 p_0``, the onset with the gap of a free point,
y, falling to delta_0: of two engaged points the one with the larger y is released first, of two free ones the one
with the smaller y is engaged first. Where p steps, y stays as it is (``constitutive``), or the gap does
(``continuous``): then both step by the same ``J_0 p_0``. An engaged and a free point need no comparing under
``continuous``: what is released has the least gap a free point can have, what is engaged the largest y an engaged one
can have. Under ``constitutive`` they compare only where the engaged one has the smaller y, and keep it: where both y
are alike, at least delta_0, the engaged one has the smaller p, and y falls faster. (``J_0 = 0`` is the limit; for
several relaxation times ``modes.order`` shows the same of every dashpot.) So the period map takes ordered states to
ordered states. The branches are the limits of its iterates from the deepest contact and from infinitely far, where
both strips begin alike: the limits are ordered too.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..orbit.regimes import CODE

if TYPE_CHECKING:
    from .effort import WorkCounters
    from .strips import Columns

#: thetas of the finest grid over (0, pi), and how many a panel has to hold at least
_FINEST, _LEAST = 256, 7
#: least width of a panel that holds so many
NARROWEST = np.pi * (_LEAST + 1) / _FINEST
#: code of a free strip: nothing of what is carried can be crossed without contact
FREE = CODE["f"]


class FreeBelow:
    """For every velocity met so far and every theta of a grid, the largest penetration at which that strip is known to be free.

    Belongs to one level with one material, adhesion, closure and branch.
    """

    def __init__(self):
        self._rows: dict[float, int] = {}
        self.largest = np.empty((0, _FINEST))

    def asked(self, columns: Columns, column: np.ndarray, low: np.ndarray, high: np.ndarray) -> Question:
        """Whether panels [low, high] of the columns ``column``, all (m,), none narrower than ``NARROWEST``, are free: on a grid
        at least as dense as the nodes of a panel are in its middle.

        Of the penetrations at one velocity and theta only the largest not yet known is asked for: the others follow from it.
        """
        coarseness = np.floor(np.log2((high - low) / NARROWEST)).astype(int)
        panel, place = _points(low, high, coarseness)
        row, D = self._rows_of(columns.V)[column[panel]], columns.D[column[panel]]
        unknown = np.flatnonzero(D > self.largest[row, place])
        order = unknown[np.lexsort((D[unknown], place[unknown], row[unknown]))]
        key = row[order] * _FINEST + place[order]
        strips = order[np.append(key[1:] != key[:-1], True)] if order.size else order
        return Question(self, columns.work, low.size, panel, row, place, D, column[panel[strips]], strips)

    def _rows_of(self, V: np.ndarray) -> np.ndarray:
        values, which = np.unique(V, return_inverse=True)
        rows = np.array([self._rows.setdefault(float(v), len(self._rows)) for v in values], int)
        fresh = len(self._rows) - len(self.largest)
        if fresh:
            self.largest = np.concatenate((self.largest, np.full((fresh, _FINEST), -np.inf)))
        return rows[which]


@dataclass(frozen=True)
class Question:
    """Panels of which it is asked whether they are free all along. To be solved for: the strips of the columns ``column`` at
    ``theta``, both (k,)."""

    known: FreeBelow
    work: WorkCounters
    size: int
    panel: np.ndarray
    row: np.ndarray
    place: np.ndarray
    D: np.ndarray
    column: np.ndarray
    strips: np.ndarray

    @property
    def theta(self) -> np.ndarray:
        return np.pi * self.place[self.strips] / _FINEST

    def answered(self, codes: np.ndarray) -> np.ndarray:
        """Which panels (m,) are free all along, by the ``codes`` (k,) of the strips."""
        free = self.strips[codes == FREE]
        self.known.largest[self.row[free], self.place[free]] = self.D[free]
        out = np.ones(self.size, bool)
        out[self.panel[self.D > self.known.largest[self.row, self.place]]] = False
        self.work.ordered += int(np.count_nonzero(out[self.panel]) - np.count_nonzero(out[self.panel[self.strips]]))
        return out


def _points(low, high, coarseness) -> tuple[np.ndarray, np.ndarray]:
    """Every ``2^coarseness``-th place of the finest grid that lies inside each panel: panels and places, one for each point."""
    stride = 2**coarseness
    spacing = np.pi / _FINEST * stride
    first = np.floor(low / spacing).astype(int) + 1
    many = np.ceil(high / spacing).astype(int) - first
    panel = np.repeat(np.arange(low.size), many)
    nth = np.arange(panel.size) - np.repeat(np.cumsum(many) - many, many)
    return panel, (first[panel] + nth) * stride[panel]
