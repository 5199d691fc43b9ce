"""A batch of strips on a foundation with n relaxation times, in dimensionless form; zones and states of their orbits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..batch import Batch
from ..groups import TWO_PI
from ..regimes import EQUATIONS, ZONES

#: the greatest rate of decay
_FASTEST = 1e13


@dataclass(frozen=True, slots=True, eq=False)
class ModeStrips(Batch):
    """Dimensionless groups of N strips: lengths in A, pressures in K A, times in 1/(k V).

    ``m``: the kernel's ``Modes`` at the strips' speeds, per-mode arrays (n, N) or, where all strips share one material, (n, 1)
    and matrices (n, n, 1). The others (N,). ``snaps``: see ``groups.Strips``. ``bare``: nothing is ever released.
    """

    m: tuple
    p_0: np.ndarray
    delta_0: np.ndarray
    D: np.ndarray
    snaps: np.ndarray
    bare: bool = False

    @property
    def arguments(self) -> tuple:
        """What the kernel's functions of a regime take after the edges."""
        return self.m, self.p_0, self.delta_0, self.D

    @property
    def size(self) -> int:
        return self.D.size

    @property
    def modes(self) -> int:
        return self.m.alpha.shape[0]

    @property
    def step(self) -> np.ndarray:
        """Width of the relay: the step ``J_0 p_0`` of w where the pressure steps by ``p_0``, (N,)."""
        return self.m.J_0 * self.p_0

    @property
    def start(self) -> np.ndarray:
        """Where periods are counted from, in the middle of the valley: free where a strip is free at all, (N,)."""
        return np.full(self.size, np.pi)

    def take(self, index) -> ModeStrips:
        """The strips at ``index``; of ``Modes`` the last axis, one of length one is shared and stays."""
        m = type(self.m)(*[each if each.shape[-1] == 1 else each[..., index] for each in self.m])
        return ModeStrips(m, self.p_0[index], self.delta_0[index], self.D[index], self.snaps[index], self.bare)


def rates(times):
    """Rates of decay ``1/times``, capped: beyond, an exponential is gone before the next double precision phase."""
    return np.minimum(np.divide(1.0, times, out=np.full(times.shape, _FASTEST), where=times > 1 / _FASTEST), _FASTEST)


def zones_of(kernel, sequence, s: ModeStrips, edges):
    """Zones of an orbit in the order met: letter, start, overstress (contact) or state z (elsewhere) there, state; (n, N)."""
    zones, _ = ZONES[sequence]
    z = getattr(kernel, f"state_{EQUATIONS[sequence]}")(*edges, *s.arguments)
    for i, (zone, start) in enumerate(zip(zones, edges, strict=True)):
        end = edges[i + 1] if i + 1 < len(edges) else edges[0] + TWO_PI
        if zone == "c":
            snapped = sequence == "afc"
            overstress = kernel.overstress(z, -s.delta_0 / s.m.J_0 if snapped else -s.p_0, s.m)
            yield zone, start, overstress, z
            z = z + kernel.contact_increment(start, end, overstress, s.m)
        else:
            yield zone, start, z, z
            z = z + kernel.relaxation_increment(start, end, z, -s.p_0 if zone == "a" else 0.0, s.m)


def state_at(kernel, sequence, s: ModeStrips, edges, phase):
    """State z (n, N) of orbits at a ``phase`` (N,)."""
    phase, state = edges[0] + np.mod(phase - edges[0], TWO_PI), np.empty((s.modes, s.size))
    for zone, start, entry, z in zones_of(kernel, sequence, s, edges):
        later = np.maximum(phase, start)
        if zone == "c":
            change = kernel.contact_increment(start, later, entry, s.m)
        else:
            change = kernel.relaxation_increment(start, later, z, -s.p_0 if zone == "a" else 0.0, s.m)
        state = np.where(phase >= start, z + change, state)
    return state
