"""A batch of strips on a foundation with n relaxation times, in dimensionless form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..batch import Batch, pick
from ..groups import snaps_in

#: the greatest rate of decay
_FASTEST = 1e13


@dataclass(frozen=True, slots=True, eq=False)
class ModeStrips(Batch):
    """Dimensionless groups of N strips: lengths in A, pressures in K A, times in 1/(k V).

    ``m``: the kernel's ``Modes`` at the strips' speeds, per-mode arrays (n, N) or, where all strips share one material,
    (n, 1) and matrices (n, n, 1). ``p_0``, ``delta_0``, ``D``: shape (N,). ``snaps``: see ``groups.Strips``. ``bare``: nothing is
    ever released.
    """

    m: tuple
    p_0: np.ndarray
    delta_0: np.ndarray
    D: np.ndarray
    snaps: np.ndarray | None = None
    bare: bool = False

    def __post_init__(self):
        if self.snaps is None:
            object.__setattr__(self, "snaps", snaps_in(self.step, self.delta_0))

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
        return np.broadcast_to(self.m.J_0 * self.p_0, self.D.shape)

    @property
    def start(self) -> np.ndarray:
        """Where periods are counted from, in the middle of the valley: free where a strip is free at all, (N,)."""
        return np.full(self.size, np.pi)

    def take(self, index) -> ModeStrips:
        """The strips at ``index``; of ``Modes`` the last axis."""
        m = type(self.m)(*(pick(each, index) for each in self.m))
        return ModeStrips(m, self.p_0[index], self.delta_0[index], self.D[index], self.snaps[index], self.bare)


def rates(times):
    """Rates of decay ``1/times``, capped: beyond, an exponential is gone before the next double precision phase."""
    return np.minimum(np.divide(1.0, times, out=np.full(times.shape, _FASTEST), where=times > 1 / _FASTEST), _FASTEST)
