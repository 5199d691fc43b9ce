"""Parts of the contact of strips in which the law of the level below is smooth.

They lie between the phases where the pressure passes its breaks.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

import numpy as np

#: a peak this close below a break, as a share of its height above the one before: the law ends there like a root, nearly
_CLOSE = 2.0


@dataclass(frozen=True)
class Parts:
    """Parts [low, high] of the contacts ``rows`` in phase, where the pressure lies between the breaks ``interval`` and the next
    ones; all (m,).

    ``times``: how often each counts, since in saturated contact the pressure falls as it rises. ``share``: of the error allowed
    to its contact.
    """

    rows: np.ndarray
    interval: np.ndarray
    low: np.ndarray
    high: np.ndarray
    times: np.ndarray
    share: np.ndarray

    @classmethod
    def joined(cls, some: list[Parts]) -> Parts:
        """All of them, those of a contact together."""
        every = cls(*(np.concatenate([getattr(parts, f.name) for parts in some]) for f in fields(cls)))
        return every.take(np.argsort(every.rows, kind="stable"))

    def take(self, index) -> Parts:
        return Parts(*(getattr(self, f.name)[index] for f in fields(self)))

    @property
    def size(self) -> int:
        return self.rows.size

    @property
    def width(self) -> np.ndarray:
        return self.high - self.low

    def sharing(self) -> Parts:
        """The same, what is allowed to a contact divided evenly among its parts."""
        return replace(self, share=1 / np.bincount(self.rows)[self.rows])

    def halves(self) -> Parts:
        """Both halves of each."""
        middle, share = 0.5 * (self.low + self.high), 0.5 * self.share
        return Parts.joined([replace(self, high=middle, share=share), replace(self, low=middle, share=share)])

    def chunks(self, size: int) -> Iterator[Parts]:
        """About ``size`` at a time, those of a contact together."""
        ends = np.searchsorted(self.rows, self.rows[size::size])
        for some in np.split(np.arange(self.size), np.unique(ends)):
            yield self.take(some)


def between(contact, interval: int, which: np.ndarray, up, down, next_up, next_down) -> list[Parts]:
    """Where the pressure of the contacts ``which`` passes from a break to the next and back: phases as of ``Contact.passes``."""
    full = contact.full
    return [
        _parts(which & (next_up > up), interval, up, next_up, times=1 + full),
        _parts(which & ~full & (down > next_down), interval, next_down, down),
    ]


def around(contact, interval: int, which: np.ndarray, up, down, over, under) -> list[Parts]:
    """About the peaks of the contacts ``which``, that lie ``over`` the last break and ``under`` the next one, Pa: both sides by
    themselves where it is close, or where one is the mirror image of the other."""
    full, inside = contact.full, which & (down > up)
    apart = full | (under < _CLOSE * over)
    return [
        _parts(inside & ~apart, interval, up, down),
        # a pressure that falls all along, or rises, has its peak at an end
        _parts(inside & apart & (contact.top > up), interval, up, contact.top, times=1 + full),
        _parts(inside & apart & ~full & (down > contact.top), interval, contact.top, down),
    ]


def _parts(which, interval, low, high, times=None):
    rows = np.flatnonzero(which)
    return Parts(
        rows,
        np.full(rows.size, interval),
        low[rows],
        high[rows],
        np.ones(rows.size) if times is None else times[rows].astype(float),
        np.ones(rows.size),
    )
