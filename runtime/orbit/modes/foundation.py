"""The foundation with several relaxation times and its generated solver, as ``orbit.abstract_foundation.Foundation``."""

from __future__ import annotations

from functools import lru_cache
from types import ModuleType

import numpy as np

from ...inputs.model import ModelMaterial, modes_of
from ..abstract_foundation import Foundation
from .engine import solve_modes
from .problem import ModeStrips, zones_of


class ManyTimes(Foundation):
    """With several relaxation times. ``modes``: the kernel's ``Modes`` in seconds, last axis strips or of length one."""

    def __init__(self, kernel: ModuleType, material, K=None, modes=None):
        self.kernel, self.material = kernel, material
        if modes is None and isinstance(material, ModelMaterial):
            K, modes = material.K, material.modes
        elif modes is None:
            found, K = _found if _varies(material) else _found_once, material.K
            modes = found(kernel, K, material.moduli, material.times)[1]
        self.K, self.modes, self.parameters, self.J, self.longest_time = K, modes, (K, modes), modes.J_0, modes.beta.max(axis=0)
        self.times = *modes.beta, *modes.alpha

    @property
    def lossiest_rate(self):
        """By a grid in the logarithm of the rate, refined about its largest value."""
        times = self.modes.alpha[self.modes.alpha > 0]  # a branch at rest has none
        low, high = np.log(0.1 / times.max()), np.log(10 / times.min())
        for _ in range(6):
            grid = np.linspace(low, high, 401)
            top = grid[np.argmax(self.kernel.loss(self.kernel.at_speed(self.modes, np.exp(grid))))]
            width = grid[1] - grid[0]
            low, high = top - width, top + width
        return float(np.exp(top))

    def flat(self, shape) -> ManyTimes:
        m = self.material
        if isinstance(m, ModelMaterial) or not _varies(m):
            return self
        spread = lambda v: np.broadcast_to(v, shape).ravel()  # noqa: E731
        each = [spread(v) for v in m.moduli], [spread(v) for v in m.times]
        return ManyTimes(self.kernel, m, *_found(self.kernel, spread(m.K), *each))

    def solve_strips(self, strips, unloading):
        return solve_modes(self.kernel, strips, unloading)

    def at_rate(self, rate):
        return (self.kernel.at_speed(self.modes, np.atleast_1d(np.asarray(rate, float))),)

    def strips(self, rate, D, p_0, delta_0, edge, snaps):
        return ModeStrips(*self.at_rate(np.broadcast_to(rate, D.shape)), p_0, delta_0, D, snaps)

    def fold(self, sequence, edges, strips):
        """Determinant of the boundary equations' derivatives by the edges."""
        _, rows = getattr(self.kernel, f"residual_and_jacobian_{sequence}")(*edges, *strips.arguments)
        return np.linalg.det(np.array([np.broadcast_arrays(edges[0], *row)[1:] for row in rows]).transpose(2, 0, 1))

    def moduli(self, strips):
        return self.kernel.storage(strips.m), self.kernel.loss(strips.m), strips.m.J_0

    def zones(self, sequence, edges, strips):
        return (zone[:3] for zone in zones_of(self.kernel, sequence, strips, edges))

    def excess(self, start, entry, strips):
        return self.kernel.excess_entry(start, entry, strips.p_0, strips.D, strips.m)

    def gap(self, start, entry, pressure, strips):
        return self.kernel.gap_entry(start, entry, pressure, strips.D, strips.m)


def _varies(material) -> bool:
    return any(np.ndim(v) for v in (material.K, *material.moduli, *material.times))


def _found(kernel, K, moduli, times):
    column = lambda v: np.stack(np.broadcast_arrays(*v)).reshape(len(v), -1)  # noqa: E731
    K, modes = modes_of(kernel, {"K": np.ravel(K), "K_i": column(moduli), "tau_i": column(times)})
    for shared in (K, *modes):
        shared.setflags(write=False)
    return K, modes


#: once for all strips of a foundation: with fourteen times it takes as long as hundreds of strips
_found_once = lru_cache(maxsize=256)(_found)
