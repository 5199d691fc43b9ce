"""Strips without adhesion over a foundation with several relaxation times, as ``orbit.nonadhesive.Waves``."""

from __future__ import annotations

import numpy as np

from ..nonadhesive import Waves
from .problem import take_modes


class ModeWaves(Waves):
    """``m``: the kernel's ``Modes`` at the strips' speeds."""

    def __init__(self, kernel, m):
        self.kernel, self.m = kernel, m

    def take(self, index):
        return ModeWaves(self.kernel, take_modes(self.m, index))

    def residual(self, b, a, D):
        none = np.zeros(D.size)
        return self.kernel.residual_ac(b, a, self.m, none, none, D)

    def means(self, b, a, D):
        none = np.zeros(D.size)
        return self.kernel.means_ac(b, a, self.m, none, none, D)

    def local_pressure(self, orbits):
        none = np.zeros(orbits.D.size)
        state = self.kernel.state_ac(orbits.b, orbits.a, self.m, none, none, orbits.D)
        entry = self.kernel.overstress(state, 0.0, self.m)

        def local(rows, phase):
            m = type(self.m)(*(v[..., None] if np.ndim(v) else v for v in take_modes(self.m, rows)))
            after = self.kernel.overstress_after(orbits.b[rows, None], phase, entry[:, rows, None], m)
            return self.kernel.contact_pressure(phase, after, orbits.D[rows, None])

        return local
