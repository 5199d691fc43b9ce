"""Checks of arguments that ``solve``, ``solve_level``, ``friction_law`` and ``solve_strip`` share."""

from __future__ import annotations

import math
import operator
from typing import TYPE_CHECKING

import numpy as np

from .errors import InputError
from .inputs.adhesion import Dugdale
from .inputs.checks import SMALLEST, choice, integer, number, numbers, sequence
from .inputs.materials import check_edge, check_material, parameters
from .inputs.surface import Level

if TYPE_CHECKING:
    from .inputs.materials import Material

#: least pressure over ``K h`` without adhesion: the contact under a smaller one is lost in rounding
_FAINTEST = 1e-22


def check_branch(branch: str) -> str:
    """``branch`` if it is one."""
    return choice("branch", branch, ("unloading", "loading"))


def refuse_faint(pressure: np.ndarray, material: Material, adhesion: Dugdale, level: Level) -> None:
    """Refuse pressures, Pa, not zero but too near it for a friction coefficient or for the contact they make on ``level``."""
    faintest = 0.0 if adhesion.p_0 > 0 else _FAINTEST * material.at_wavelength(level.l).K * level.h
    faint = (pressure != 0) & (np.abs(pressure) < SMALLEST) | (pressure > 0) & (pressure < faintest)
    if faint.any():
        allowed = f"0, or a magnitude from {max(SMALLEST, faintest):g} Pa on"
        raise InputError("pressure", float(pressure[faint].flat[0]), allowed)


def check_levels(levels) -> tuple[Level, ...]:
    """``levels`` as a tuple of at least one, the largest first."""
    if isinstance(levels, Level):
        return (levels,)
    given, levels = levels, tuple(sequence("levels", levels, "a sequence of hystrip.Level, the largest first"))
    if not levels:
        raise InputError("levels", given, "at least one hystrip.Level")
    for i, level in enumerate(levels):
        if not isinstance(level, Level):
            raise InputError(f"levels[{i}]", level, "a hystrip.Level")
        if i and level.l > levels[i - 1].l:
            above = f"levels[{i - 1}].l = {levels[i - 1].l:g} m"
            raise InputError(f"levels[{i}].l", level.l, f"at most {above}: the largest wave comes first")
    return levels


def check_types(material, adhesion) -> None:
    """Refuse anything but a material and an adhesion law."""
    check_material(material)
    if not isinstance(adhesion, Dugdale):
        raise InputError("adhesion", adhesion, "a hystrip.Dugdale (gamma=0: no adhesion)")


def check_single(material, adhesion) -> None:
    """Refuse anything but one material and one adhesion law with single values."""
    check_types(material, adhesion)
    given = {f"material.{name}": value for name, value in parameters(material).items()}
    given |= {f"adhesion.{name}": getattr(adhesion, name) for name in ("p_0", "delta_0")}
    for name, value in given.items():
        if np.ndim(value):
            raise InputError(name, value, "a single number (arrays are for solve_strip)")


def check_strips(strips) -> int | None:
    """``strips`` as an int >= 1, or None."""
    allowed = "an integer >= 1, at most 1000000, or None for adaptive panels"
    return None if strips is None else integer("strips", strips, 1, 1_000_000, allowed)


def check_rtol(rtol) -> float:
    """``rtol`` as a float between 1e-12 and 0.1."""
    rtol = number("rtol", rtol, "", 1e-12)
    if rtol > 0.1:
        raise InputError("rtol", rtol, "a number from 1e-12 to 0.1")
    return rtol


def point_index(at: int | tuple[int, ...], shape: tuple[int, ...]) -> int:
    """Flat index of the point ``at``, an index or a tuple of them, among points of a ``shape``."""
    index, sizes = (at, shape) if isinstance(at, tuple) else ((0 if at is None else at,), (math.prod(shape),))
    try:
        flat = 0
        for place, size in zip(index, sizes, strict=True):
            if isinstance(place, bool):
                raise TypeError
            flat = flat * size + range(size)[operator.index(place)]
        return flat
    except (IndexError, ValueError, TypeError):
        raise InputError("at", at, f"an index into the {math.prod(shape)} points, of shape {shape}") from None


def check_level_number(level, levels: int) -> int:
    """The number of a level, the first being 1, as an int."""
    return integer("level", level, 1, levels, f"the number of a level, 1 to {levels}")


def check_on_level(material, adhesion, level, V, edge, branch, rtol) -> tuple[Material, np.ndarray, Level, str, str, float]:
    """Arguments of one level, checked: the material at its wavelength, velocities, level, closure, branch and ``rtol``."""
    check_single(material, adhesion)
    if not isinstance(level, Level):
        raise InputError("level", level, "a hystrip.Level")
    V, edge = numbers("V", V, "m/s", 0), check_edge(material, edge)
    return material.at_wavelength(level.l), V, level, edge, check_branch(branch), check_rtol(rtol)
