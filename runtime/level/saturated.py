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
    k, h, K = level.k, level.h, material.K
    alpha, beta = k * V * material.T_sigma, k * V * material.T_eps
    R = kernel.modulus_ratio(alpha, beta)
    lift = 0.25 * K * h * (2 * R - 1)
    # mean of A^2 over the strips: (h/4)^2 times 3/2
    tau = 0.5 * k * K * kernel.loss(alpha, beta, material.L) * 1.5 * (0.25 * h) ** 2
    return SaturatedLevel(
        p_sat=lift - adhesion.p_0, tau_sat=tau, D_sat=0.5 * h * (1 + R) - adhesion.p_0 / K, lift=lift
    )
