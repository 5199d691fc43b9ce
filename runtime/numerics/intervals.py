"""Intervals of the members of a batch, each smooth inside, with the strengths of its ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from . import endpoints


@dataclass(frozen=True)
class Intervals:
    """Intervals [low, high] of a ``member`` each, arrays (k,); ``strength_low``, ``strength_high``: see ``endpoints``."""

    member: np.ndarray
    low: np.ndarray
    high: np.ndarray
    strength_low: np.ndarray
    strength_high: np.ndarray

    @classmethod
    def make(cls, member, low, high, strength_low=1, strength_high=1) -> Intervals:
        """Intervals from arrays and numbers that broadcast."""
        arrays = np.broadcast_arrays(member, low, high, strength_low, strength_high)
        kinds = (np.intp, float, float, np.intp, np.intp)
        return cls(*(np.array(v, kind).ravel() for v, kind in zip(arrays, kinds, strict=True)))

    @classmethod
    def between(cls, breakpoints: Sequence[np.ndarray], strength=1, outer=None) -> Intervals:
        """The intervals between the ascending ``breakpoints`` of each member, their two ends included; those of no width are left
        out. ``strength``: of all ends; ``outer``: of the first and the last one of every member, if another."""
        counts = [max(len(points) - 1, 0) for points in breakpoints]
        low = np.concatenate([points[:-1] for points in breakpoints])
        high = np.concatenate([points[1:] for points in breakpoints])
        every = cls.make(np.repeat(np.arange(len(counts)), counts), low, high, strength, strength)
        if outer is not None:
            last = np.cumsum(counts)[np.array(counts, int) > 0] - 1
            every.strength_low[np.append(0, last[:-1] + 1) if last.size else []] = outer
            every.strength_high[last] = outer
        return every.take(every.high > every.low)

    @classmethod
    def joined(cls, some: Sequence[Intervals]) -> Intervals:
        """All of them in one."""
        return cls(*(np.concatenate([getattr(part, field.name) for part in some]) for field in fields(cls)))

    def take(self, index) -> Intervals:
        """Those of an ``index`` or a mask."""
        return Intervals(*(getattr(self, field.name)[index] for field in fields(self)))

    @property
    def size(self) -> int:
        return self.member.size

    @property
    def width(self) -> np.ndarray:
        return self.high - self.low

    def kinds(self) -> list[tuple[int, int, np.ndarray | slice]]:
        """The strengths that occur, low and high, and the intervals that have them."""
        key = 16 * self.strength_low + self.strength_high
        if not key.size or (key == key[0]).all():
            return [(*divmod(int(k), 16), slice(None)) for k in key[:1]]
        return [(*divmod(int(k), 16), key == k) for k in np.unique(key)]

    def points(self, t: np.ndarray) -> np.ndarray:
        """The points (k, n) of the parameters ``t`` (n,) or (k, n) in (0, 1), never an end if there is a number between."""
        t = np.broadcast_to(t, (self.size, np.shape(t)[-1]))
        x = self.low[:, None] + self.width[:, None] * endpoints.share(t, self.strength_low, self.strength_high)
        inner = np.nextafter(self.low, self.high)[:, None], np.nextafter(self.high, self.low)[:, None]
        return np.minimum(np.maximum(x, inner[0]), np.maximum(*inner))

    def slopes(self, t: np.ndarray) -> np.ndarray:
        """Derivatives (k, n) of ``points`` by t."""
        t = np.broadcast_to(t, (self.size, np.shape(t)[-1]))
        return self.width[:, None] * endpoints.slope(t, self.strength_low, self.strength_high)

    def cut(self, below: np.ndarray, above: np.ndarray, strength: int = 1) -> Intervals:
        """The parts up to ``below`` and from ``above`` (k,) on, first all lower, then all upper ones; none without width."""
        inner = np.full(self.size, strength)
        lower = Intervals(self.member, self.low, below, self.strength_low, inner)
        upper = Intervals(self.member, above, self.high, inner, self.strength_high)
        both = Intervals.joined((lower, upper))
        return both.take(both.high > both.low)

    def halves(self, strength: int = 1) -> Intervals:
        """Both halves of each, with this strength where they meet."""
        middle = 0.5 * (self.low + self.high)
        return self.cut(middle, middle, strength)
