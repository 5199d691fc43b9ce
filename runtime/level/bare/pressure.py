"""Pressure in the contact of strips without adhesion, for any foundation."""

from __future__ import annotations

import numpy as np

from ...orbit.modes.problem import take_modes
from .orbit import Orbits, Wave


class ContactPressure:
    """Of ``orbits`` under a ``wave``, in K A."""

    def __init__(self, wave: Wave, orbits: Orbits):
        self.wave, self.orbits = wave, orbits
        self.entry = None
        if wave.many:
            none = np.zeros(orbits.D.size)
            state = wave.kernel.state_ac(orbits.b, orbits.a, wave.m, none, none, orbits.D)
            self.entry = wave.kernel.overstress(state, 0.0, wave.m)

    def at(self, share: np.ndarray, rows: np.ndarray | None = None) -> np.ndarray:
        """At these shares (k, nodes), between entry and exit, of the contacts ``rows`` (k,), or of all."""
        o, kernel = self.orbits, self.wave.kernel
        row = np.arange(o.D.size) if rows is None else rows
        b, D = o.b[row, None], o.D[row, None]
        phase = b + (o.a - o.b)[row, None] * share
        if self.wave.many:
            m = take_modes(self.wave.m, row)
            m = type(m)(*(v[..., None] if np.ndim(v) else v for v in m))
            p = kernel.contact_pressure(phase, kernel.overstress_after(b, phase, self.entry[:, row, None], m), D)
        else:
            alpha, beta, _, L = (v[row, None] for v in self.wave.times)
            p = kernel.excess_after(b, phase, 0.0, 0.0, D, alpha, beta, L)
        return np.maximum(p, 0.0)
