"""An interval of penetration on which a curve is interpolated, and what is known of its ends beforehand."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..numerics.endpoints import GENTLE, STEEP, EndpointMap

#: part of an interval's error above which that of a half says that means are in error, not the interpolant; and how much finer
#: they are made then, and at most
_STALLED, _FINER, _FINEST = 0.5, 0.1, 1e-3


@dataclass(frozen=True)
class Interval:
    """An interval of D of one column; ``inner_low``, ``inner_high``: the curve goes on smoothly beyond that end; ``smooth_low``,
    ``smooth_high``: it seems to end smoothly enough there. ``tolerance_factor``: how much coarser than what is asked of the
    column it may be; ``fractions``: what errors of fractions are relative to, more than 1 where its pressures are rare.
    ``even``: its parameters are shares of it, not graded towards its ends: enough for a look. ``mean_factor``: how much finer
    its means are than usual. ``missed``: error over goal of what it is a half of."""

    column: int
    low: float
    high: float
    inner_low: bool = False
    inner_high: bool = False
    smooth_low: bool = False
    smooth_high: bool = False
    tolerance_factor: float = 1.0
    fractions: float = 1.0
    even: bool = False
    mean_factor: float = 1.0
    missed: float = np.inf

    def split(self, D: float, soft: bool) -> list[Interval]:
        """The two parts below and above D."""
        return [replace(self, high=D, inner_high=soft, smooth_high=False), replace(self, low=D, inner_low=soft, smooth_low=False)]

    @property
    def halves(self) -> list[Interval]:
        """The two halves; the curve goes on smoothly between them."""
        return self.split(0.5 * (self.low + self.high), soft=True)

    def missing(self, missed: float) -> Interval:
        """The same, to be divided as it ``missed`` its goal by that factor: with finer means where dividing did not help."""
        finer = max(_FINER * self.mean_factor, _FINEST) if missed > _STALLED * self.missed else self.mean_factor
        return replace(self, missed=missed, mean_factor=finer)

    @property
    def endpoint_map(self) -> EndpointMap:
        """Of its nodes."""
        if self.even:
            return EndpointMap(1, 1)
        ends = (self.inner_low or self.smooth_low, self.inner_high or self.smooth_high)
        return EndpointMap(*(GENTLE if gentle else STEEP for gentle in ends))

    def penetrations(self, t):
        """D at the parameters ``t`` of a piece."""
        return self.low + (self.high - self.low) * self.endpoint_map.share(t)
