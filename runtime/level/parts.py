"""Parts of the contact of strips in which the law of the level below is smooth.

They lie between the phases where the pressure passes its breaks.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..orbit.batch import Batch
from ..orbit.contact import Contact


@dataclass
class Parts(Batch):
    """Parts [low, high] of the contacts ``rows``, ascending, in phase, where the pressure lies between the breaks ``interval``
    and the next ones; all (m,). ``times``: how often each counts, since in saturated contact the pressure falls as it rises."""

    rows: np.ndarray
    interval: np.ndarray
    low: np.ndarray
    high: np.ndarray
    times: np.ndarray

    @property
    def width(self) -> np.ndarray:
        return self.high - self.low

    def chunks(self, size: int) -> Iterator[Parts]:
        """About ``size`` at a time, those of a contact together."""
        ends = np.searchsorted(self.rows, self.rows[size::size])
        for some in np.split(np.arange(self.size), np.unique(ends)):
            if some.size:
                yield self.take(some)


def parts_between(contact: Contact, inside: np.ndarray, ups: np.ndarray, downs: np.ndarray) -> Parts:
    """Parts of all contacts, (n,), from the breaks ``inside`` (n, B) on: between the phases ``ups`` and ``downs`` (n, B + 1), the
    last of which is the peak, at which the pressure passes the breaks."""
    # on the way up, then down
    low, high = np.stack((ups[:, :-1], downs[:, 1:])), np.stack((ups[:, 1:], downs[:, :-1]))
    there = inside & (high > low)
    there[1] &= ~contact.full[:, None]
    row, interval, way = np.nonzero(np.moveaxis(there, 0, 2))
    times = np.where(contact.full[row], 2.0, 1.0)
    return Parts(row, interval, low[way, row, interval], high[way, row, interval], times)
