"""The foundation with one relaxation time and its generated solver, as ``orbit.abstract_foundation.Foundation``."""

from __future__ import annotations

from types import ModuleType

import numpy as np

from ..inputs.material import StandardLinearSolid
from .abstract_foundation import Foundation, every
from .chain import gap_zones, links, step
from .engine import solve_strips
from .groups import Strips, adhesive_cycle, bare_cycle
from .regimes import ZONES

#: alpha from which a strip is taken as the limit of a foundation that stands still: pressures differ from it by 1/alpha of the
#: glassy pressure, and what a period changes is lost in the rounding of the edges soon after (1e14)
_STANDS_STILL = 1e12


class SingleTime(Foundation):
    """With one relaxation time. ``fastest`` is reached where the instantaneous compliance is next to none: contact narrows down
    to a crest then, whose distance from the surface is lost in the rounding of D."""

    fastest = 1e18

    def __init__(self, kernel: ModuleType, material: StandardLinearSolid):
        self.kernel, self.material, self.K, self.J, self.L = kernel, material, material.K, material.J, material.L
        self.parameters, self.longest_time = (material.K, material.T_eps, material.T_sigma), material.T_eps
        self.times = material.T_eps, material.T_sigma

    @property
    def lossiest_rate(self):
        return 1 / self.material.T_sigma if self.material.T_sigma > 0 else np.inf

    def flat(self, shape) -> SingleTime:
        """The same with array parameters broadcast to ``shape`` and flattened, like everything else."""
        if not any(np.ndim(v) for v in self.parameters):
            return self
        return SingleTime(self.kernel, StandardLinearSolid(*(np.broadcast_to(v, shape).ravel() for v in self.parameters)))

    def solve_strips(self, strips, unloading):
        return solve_strips(self.kernel, strips, unloading)

    def pace(self, rate):
        alpha = rate * self.material.T_sigma
        return np.divide(_STANDS_STILL, alpha, out=np.ones_like(alpha), where=alpha > _STANDS_STILL)

    def at_rate(self, rate):
        return rate * self.material.T_sigma, rate * self.material.T_eps

    def strips(self, rate, D, p_0, delta_0, edge, snaps):
        steps = edge == "constitutive"
        shared = (every(v, D.shape) for v in (*self.at_rate(rate * self.pace(rate)), self.J, self.L))
        return Strips(*shared, p_0, delta_0, D, every(float(steps), D.shape), snaps & steps)

    def fold(self, sequence, edges, strips):
        """The numerator of ``T'`` less its denominator, products of loads: all but linear next to where adhesion ends. With a
        short memory, which leaves nothing of a load but next to an edge, of the rates at which gaps pass their thresholds."""
        loads, short = getattr(self.kernel, f"onset_slope_{sequence}")(*edges, *strips.arguments)[-1], strips.beta < 1
        if not short.any():
            return loads
        cycle = adhesive_cycle(self.kernel, strips)
        linked = links(self.kernel, cycle, sequence, gap_zones(cycle, sequence), np.array(np.broadcast_arrays(*edges)))
        return np.where(short, (step(*linked)[1] - 1) * linked[2, -1] * linked[2, -2], loads)

    def moduli(self, strips):
        s = strips
        return self.kernel.storage(s.alpha, s.beta), self.kernel.loss(s.alpha, s.beta, s.L), s.J

    def zones(self, sequence, edges, strips):
        cycle = (bare_cycle if sequence in ("ac", "cf") else adhesive_cycle)(self.kernel, strips)
        gaps = iter(gap_zones(cycle, sequence))
        for zone, start in zip(ZONES[sequence][0], edges, strict=False):
            yield zone, start, cycle.q_on if zone == "c" else next(gaps)[0]

    def excess(self, start, entry, strips):
        return self.kernel.excess_entry(start, entry, strips.p_0, strips.D, strips.alpha, strips.beta, strips.L)

    def gap(self, start, entry, pressure, strips):
        return self.kernel.gap_entry(start, entry, pressure, strips.D, strips.beta)

    def _forced(self, l, h, V):  # noqa: E741
        return 0.5 * h * (1 + np.hypot(1.0, 2 * np.pi / l * V * self.material.T_eps))
