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

    ``p_sat``: nominal pressure from which the branch is in saturated contact. ``tau_sat``: its friction. ``D_sat``: penetration at
    ``p_sat``. ``lift``: nominal pressure over the least local pressure in saturated contact, ``K h (2R - 1)/4``.
    """

    p_sat: np.ndarray
    tau_sat: np.ndarray
    D_sat: np.ndarray
    lift: np.ndarray


def saturated_level(
    material: StandardLinearSolid, adhesion: Dugdale, level: Level, V: np.ndarray, branch: str = "unloading"
) -> SaturatedLevel:
    """Thresholds and friction of a level in saturated contact at velocities ``V`` (m/s), shape (n,).

    Unloading leaves saturated contact exactly at ``p_sat``. Loading may reach it later than unloading leaves it, at a penetration with no closed
    form; the threshold given for it is one above which nothing else can be: the forcing ``H + p_0`` is positive all along
    every strip, so contact once made is never left, and no strip is out of reach.
    """
    kernel = kernel_of(material)
    K, h, times = material.K, level.h, (material.T_eps, material.T_sigma)
    p_sat = kernel.level_saturation_pressure(K, *times, adhesion.p_0, level.l, h, V)
    tau_sat = kernel.level_saturation_friction(K, *times, level.l, h, V)
    D_sat = kernel.level_saturation_penetration(K, *times, adhesion.p_0, level.l, h, V)
    lift = p_sat + adhesion.p_0
    if branch == "loading" and adhesion.p_0 > 0:
        steepest = np.hypot(1.0, level.k * V * material.T_eps)
        D_sat = np.maximum(0.5 * h * (1 + steepest) - adhesion.p_0 / K, h)
        p_sat = K * (D_sat - 0.75 * h)
    return SaturatedLevel(p_sat, tau_sat, D_sat, lift)
