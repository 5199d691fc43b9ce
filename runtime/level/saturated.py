"""Closed forms of a level in saturated contact (physics: Eq. 15 averaged, and the thresholds that bring it about)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..inputs.adhesion import Dugdale
from ..inputs.materials import Material
from ..inputs.surface import Level
from ..orbit.foundation import Foundation, foundation_of

#: velocities of a block of the closed form: its temporaries stay in the cache
_BLOCK = 4096


@dataclass(frozen=True)
class SaturatedLevel:
    """Saturated contact of one level at velocities V (n,): arrays (n,), SI, evaluated when first asked for.

    ``p_sat``: nominal pressure from which the branch is in saturated contact. ``tau_sat``: its friction. ``D_sat``: penetration
    at ``p_sat``. ``lift``: nominal pressure over the least local pressure in saturated contact, ``K h (2R - 1)/4``. All but
    ``tau_sat`` grow with V: they follow ``|K*(i omega)|``, a product of factors ``(1 + lambda^2 omega^2)/(1 + tau^2 omega^2)``,
    the retardation time lambda of each longer than its relaxation time tau.
    """

    foundation: Foundation
    p_0: float
    level: Level
    V: np.ndarray
    branch: str

    @cached_property
    def _unloading_p_sat(self) -> np.ndarray:
        return self.foundation.saturation_pressure(self.p_0, self.level.l, self.level.h, self.V)

    @property
    def _loads_later(self) -> bool:
        return self.branch == "loading" and self.p_0 > 0

    @cached_property
    def p_sat(self) -> np.ndarray:
        return self.foundation.K * (self.D_sat - 0.75 * self.level.h) if self._loads_later else self._unloading_p_sat

    @cached_property
    def D_sat(self) -> np.ndarray:
        of = self.foundation.surely_saturated if self._loads_later else self.foundation.saturation_penetration
        return of(self.p_0, self.level.l, self.level.h, self.V)

    @cached_property
    def lift(self) -> np.ndarray:
        return self._unloading_p_sat + self.p_0

    @cached_property
    def tau_sat(self) -> np.ndarray:
        return self.foundation.saturation_friction(self.level.l, self.level.h, self.V)


def saturated_level(
    material: Material, adhesion: Dugdale, level: Level, V: np.ndarray, branch: str = "unloading"
) -> SaturatedLevel:
    """Thresholds and friction of a level in saturated contact at velocities ``V`` (m/s), shape (n,).

    Unloading leaves saturated contact exactly at ``p_sat``. Loading may reach it later than unloading leaves it, at a penetration
    with no closed form; the threshold given for it is one above which nothing else can be.
    """
    return SaturatedLevel(foundation_of(material.at_wavelength(level.l)), adhesion.p_0, level, V, branch)


def saturated_friction(material: Material, levels: Sequence[Level], V: np.ndarray) -> np.ndarray:
    """Friction of every level in saturated contact (Eq. 16) at velocities ``V`` (m/s), shape (n,): (levels, n), Pa."""
    foundations = [foundation_of(material.at_wavelength(level.l)) for level in levels]
    first, K = foundations[0], np.array([each.K for each in foundations])
    l, h = (np.array([getattr(level, name) for level in levels])[:, None] for name in ("l", "h"))  # noqa: E741
    tau = np.empty((len(levels), V.size))
    for start in range(0, V.size, _BLOCK):
        block = slice(start, start + _BLOCK)
        tau[:, block] = first.saturation_friction(l, h, V[block])
    # foundations of different levels differ in scale alone
    return tau if (K == first.K).all() else tau * (K / first.K)[:, None]
