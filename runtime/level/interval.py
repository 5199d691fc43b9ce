"""An interval of penetration on which a curve is interpolated, and what is known of it beforehand."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from .expected import expect
from .grading import GENTLE, STEEP, Grading


@dataclass(frozen=True)
class Seen:
    """Zones (``Averages.zones``) at the parameters ``t`` of an interval, and the least size of the means there, (q,)."""

    interval: Interval
    t: np.ndarray
    zones: list[np.ndarray]
    size: np.ndarray

    def expected(self, D: np.ndarray):
        """``expected.expect`` at penetrations inside."""
        return expect(self.t, self.zones, self.interval.parameter(D))


@dataclass(frozen=True)
class Interval:
    """An interval of D of one column; ``soft_low``, ``soft_high``: the curve goes on smoothly beyond that end; ``gentle_low``,
    ``gentle_high``: it seems to end smoothly enough there. ``witnesses``: thetas at which some regime is met in next to no strips
    towards an end. ``ease``: how much coarser than what is asked of the column it may be. ``even``: its parameters are shares of
    it, not graded towards its ends: enough for a look."""

    column: int
    low: float
    high: float
    soft_low: bool = False
    soft_high: bool = False
    gentle_low: bool = False
    gentle_high: bool = False
    witnesses: tuple[float, ...] = ()
    ease: float = 1.0
    even: bool = False
    #: what was seen on the interval that this one is a part of
    seen: Seen | None = field(default=None, compare=False, repr=False)

    def split(self, D: float, soft: bool, *witnesses: float) -> list[Interval]:
        """The two parts below and above D; what is new about their strips in ``witnesses``."""
        every = self.witnesses + witnesses
        return [
            replace(self, high=D, soft_high=soft, gentle_high=False, witnesses=every),
            replace(self, low=D, soft_low=soft, gentle_low=False, witnesses=every),
        ]

    @property
    def halves(self) -> list[Interval]:
        """The two halves; the curve goes on smoothly between them."""
        return self.split(0.5 * (self.low + self.high), soft=True)

    @property
    def grading(self) -> Grading:
        """Of its nodes."""
        if self.even:
            return Grading(1, 1)
        ends = (self.soft_low or self.gentle_low, self.soft_high or self.gentle_high)
        return Grading(*(GENTLE if gentle else STEEP for gentle in ends))

    def penetrations(self, t):
        """D at the parameters ``t`` of a piece."""
        return self.low + (self.high - self.low) * self.grading.share(t)

    def parameter(self, D):
        """Parameters of the penetrations ``D`` inside."""
        return self.grading.parameter((D - self.low) / (self.high - self.low))
