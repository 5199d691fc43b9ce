"""An interval of penetration on which a curve is interpolated, and what is known of its ends beforehand."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..numerics.endpoints import GENTLE, STEEP, EndpointMap
from .accuracy import Accuracy


@dataclass(frozen=True)
class Interval:
    """An interval of D of one column; ``inner_low``, ``inner_high``: the curve goes on smoothly beyond that end. ``asked``: how
    accurate it has to be beside what is asked of the column. ``even``: its parameters are shares of it, not graded towards its
    ends: enough for a look."""

    column: int
    low: float
    high: float
    inner_low: bool = False
    inner_high: bool = False
    asked: Accuracy = Accuracy()
    even: bool = False

    def split(self, D: float, soft: bool) -> list[Interval]:
        """The two parts below and above D."""
        return [replace(self, high=D, inner_high=soft), replace(self, low=D, inner_low=soft)]

    @property
    def halves(self) -> list[Interval]:
        """The two halves; the curve goes on smoothly between them."""
        return self.split(0.5 * (self.low + self.high), soft=True)

    @property
    def endpoint_map(self) -> EndpointMap:
        """Of its nodes."""
        if self.even:
            return EndpointMap(1, 1)
        return EndpointMap(*(GENTLE if inner else STEEP for inner in (self.inner_low, self.inner_high)))

    def penetrations(self, t):
        """D at the parameters ``t`` of a piece."""
        return self.low + (self.high - self.low) * self.endpoint_map.share(t)
