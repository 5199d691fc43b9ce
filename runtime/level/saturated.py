"""Closed forms of a level in saturated contact (physics: Eq. 15 averaged, and the thresholds that bring it about)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hystrip.inputs.adhesion import Dugdale
from hystrip.inputs.surface import Level
from hystrip.solver import Material, foundation_of


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
    material: Material, adhesion: Dugdale, level: Level, V: np.ndarray, branch: str = "unloading"
) -> SaturatedLevel:
    """Thresholds and friction of a level in saturated contact at velocities ``V`` (m/s), shape (n,).

    Unloading leaves saturated contact exactly at ``p_sat``. Loading may reach it later than unloading leaves it, at a penetration with no closed
    form; the threshold given for it is one above which nothing else can be.
    """
    foundation, K, h = foundation_of(material), material.K, level.h
    p_sat, tau_sat, D_sat = foundation.saturation(adhesion.p_0, level.l, h, V)
    lift = p_sat + adhesion.p_0
    if branch == "loading" and adhesion.p_0 > 0:
        D_sat = foundation.surely_saturated(adhesion.p_0, level.l, h, V)
        p_sat = K * (D_sat - 0.75 * h)
    return SaturatedLevel(p_sat, tau_sat, D_sat, lift)
