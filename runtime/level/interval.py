"""An interval of penetration on which a curve is interpolated, and what is known of its ends beforehand."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..numerics.endpoints import GENTLE, STEEP, Grading


@dataclass(frozen=True)
class Interval:
    """An interval of D of one column; ``soft_low``, ``soft_high``: the curve goes on smoothly beyond that end; ``gentle_low``,
    ``gentle_high``: it seems to end smoothly enough there. ``tolerance_factor``: how much coarser than what is asked of the
    column it may be. ``even``: its parameters are shares of it, not graded towards its ends: enough for a look."""

    column: int
    low: float
    high: float
    soft_low: bool = False
    soft_high: bool = False
    gentle_low: bool = False
    gentle_high: bool = False
    tolerance_factor: float = 1.0
    even: bool = False

    def split(self, D: float, soft: bool) -> list[Interval]:
        """The two parts below and above D."""
        return [replace(self, high=D, soft_high=soft, gentle_high=False), replace(self, low=D, soft_low=soft, gentle_low=False)]

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
