"""Strips without adhesion over a foundation with several relaxation times, as ``orbit.nonadhesive.Waves``."""

import numpy as np

from ..nonadhesive import Waves
from .problem import take_modes


class ModeWaves(Waves):
    """``groups``: the kernel's ``Modes`` at the strips' speeds."""

    def take(self, index):
        return ModeWaves(self.kernel, take_modes(self.groups, index))

    def _arguments(self, D):
        none = np.zeros(D.size)
        return self.groups, none, none, D

    def local_pressure(self, orbits):
        state = self.kernel.state_ac(orbits.b, orbits.a, *self._arguments(orbits.D))
        entry = self.kernel.overstress(state, 0.0, self.groups)

        def local(rows, phase):
            m = type(self.groups)(*(v[..., None] if np.ndim(v) else v for v in take_modes(self.groups, rows)))
            after = self.kernel.overstress_after(orbits.b[rows, None], phase, entry[:, rows, None], m)
            return self.kernel.contact_pressure(phase, after, orbits.D[rows, None])

        return local
