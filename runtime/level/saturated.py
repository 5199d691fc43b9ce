"""Closed forms of a level in saturated contact: Eq. 15 averaged, and the thresholds that bring it about."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..inputs.adhesion import Dugdale
from ..inputs.materials import Material
from ..inputs.surface import Level
from ..orbit.foundation import foundation_of

#: velocities of a block of the closed form: its temporaries stay in the cache
_BLOCK = 4096


@dataclass(frozen=True)
class SaturatedLevel:
    """Saturated contact of one level at velocities V (n,): arrays (n,), SI.

    ``p_sat``: nominal pressure from which the branch is in saturated contact. ``tau_sat``: its friction. ``D_sat``: penetration
    at ``p_sat``. ``lift``: nominal pressure over the least local pressure in saturated contact, ``K h (2R - 1)/4``. All but
    ``tau_sat`` grow with V: they follow ``|K*(i omega)|``, a product of factors ``(1 + lambda^2 omega^2)/(1 + tau^2 omega^2)``,
    the retardation time lambda of each longer than its relaxation time tau.
    """

    p_sat: np.ndarray
    D_sat: np.ndarray
    lift: np.ndarray
    tau_sat: np.ndarray


class Saturation(NamedTuple):
    """Pressure ``p`` and penetration ``D`` (n,) from which on a level and all below it are saturated, and the ``means`` (n, q)
    then, in the order of its columns: own, then carried."""

    p: np.ndarray
    D: np.ndarray
    means: np.ndarray


def saturated_level(
    material: Material, adhesion: Dugdale, level: Level, V: np.ndarray, branch: str = "unloading"
) -> SaturatedLevel:
    """Thresholds and friction of a level in saturated contact at velocities ``V`` (m/s), shape (n,).

    Unloading leaves saturated contact exactly at ``p_sat``. Loading may reach it later than unloading leaves it, at a penetration
    with no closed form; the threshold given for it is one above which nothing else can be.
    """
    foundation, p_0, of = foundation_of(material.at_wavelength(level.l)), adhesion.p_0, (level.l, level.h, V)
    p_sat, D_sat = foundation.saturation(p_0, *of)
    lift = p_sat + p_0
    if branch == "loading" and p_0 > 0:
        D_sat = foundation.surely_saturated(p_0, *of)
        p_sat = foundation.K * (D_sat - level.mean_plane)
    return SaturatedLevel(p_sat, D_sat, lift, foundation.saturation_friction(*of))


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
