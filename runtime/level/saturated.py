"""Closed forms of a level in saturated contact (physics: Eq. 15 averaged, and the thresholds that bring it about)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hystrip.inputs.adhesion import Dugdale
from hystrip.inputs.material import StandardLinearSolid
from hystrip.inputs.surface import Level
from hystrip.solver import kernel_of


@dataclass(frozen=True)
class SaturatedLevel:
    """Saturated contact of one level at velocities V (n,): arrays (n,), SI.

    ``p_sat``: least nominal pressure of saturated contact. ``tau_sat``: its friction. ``D_sat``: penetration at ``p_sat``.
    ``lift``: nominal pressure over the least local pressure in saturated contact, ``K h (2R - 1)/4``.
    """

    p_sat: np.ndarray
    tau_sat: np.ndarray
    D_sat: np.ndarray
    lift: np.ndarray


def saturated_level(material: StandardLinearSolid, adhesion: Dugdale, level: Level, V: np.ndarray) -> SaturatedLevel:
    """Thresholds and friction of a level in saturated contact at velocities ``V`` (m/s), shape (n,)."""
    kernel = kernel_of(material)
    K, times = material.K, (material.T_eps, material.T_sigma)
    p_sat = kernel.level_saturation_pressure(K, *times, adhesion.p_0, level.l, level.h, V)
    return SaturatedLevel(
        p_sat=p_sat,
        tau_sat=kernel.level_saturation_friction(K, *times, level.l, level.h, V),
        D_sat=kernel.level_saturation_penetration(K, *times, adhesion.p_0, level.l, level.h, V),
        lift=p_sat + adhesion.p_0,
    )
