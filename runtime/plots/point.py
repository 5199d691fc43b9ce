"""Pictures of one point of a result."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..arguments import check_level_number
from ..at_point import cell_of, index_of, stresses_along
from ..contact_map import map_of
from ..errors import InputError
from ..inputs.checks import number
from ..loop import loading_loop
from .cell import contact_map
from .loop import loading_loop as draw_loop
from .strip import strip_stresses
from .units import length

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..result import Result


def look_into(result: Result, kind: str, at: int | tuple[int, ...] | None, level: int, y: float) -> Figure:
    """Draw the ``"map"`` or the ``"loop"`` of a level, or the ``"strip"`` of level 1 at ``y`` (m)."""
    if kind == "loop":
        V = float(np.ravel(result.velocity)[index_of(result, at)])
        of = result.levels[check_level_number(level, len(result.levels)) - 1]
        return draw_loop(loading_loop(result.material, result.adhesion, of, V=V, edge=result.edge))
    cell = cell_of(result, at, level)
    if kind == "map":
        return contact_map(map_of(cell))
    if level != 1:
        raise InputError("level", level, "1 for a strip: lower levels rub along it")
    strip = cell.strip(np.asarray(y := number("y", y, "m")))
    x, stresses = stresses_along(result, cell, y)
    return strip_stresses(strip, x, stresses, f"$y$ = {length(y) if y else '0'}: {strip.regime_name.item()}")
