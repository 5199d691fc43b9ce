"""One point of a result, looked into: the contact of a level, and the stresses along a strip."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from .arguments import check_level_number, point_index
from .contact_map import Cell
from .errors import InputError
from .inputs.checks import number
from .level_solution import solve_level

if TYPE_CHECKING:
    from .result import Result
    from .typing import Floats

#: accuracy of the penetration of a lower level, and of the friction of the levels below; enough for a picture
_RTOL = 1e-3
#: points along a strip
_X = 601


def index_of(result: Result, at: int | tuple[int, ...] | None) -> int:
    """Flat index of a point: the given one, or that of the largest friction coefficient (the first, if there is none)."""
    if not np.size(result.mu):
        raise InputError("result", "no points", "a result with a point to look at")
    if at is None:
        mu = np.abs(np.ravel(result.mu))
        return int(np.nanargmax(mu)) if np.isfinite(mu).any() else 0
    return point_index(at, result.mu.shape)


def cell_of(result: Result, at: int | tuple[int, ...] | None, number_of_level: int) -> Cell:
    """A level at a point of a result; one below the first at the mean pressure in the contact of the level above.

    Raises InputError where there is no contact to look into, or no such level.
    """
    number_of_level = check_level_number(number_of_level, len(result.levels))
    index = index_of(result, at)
    V, D, p = (float(np.ravel(each)[index]) for each in (result.velocity, result.penetration, result.pressure))
    if not np.isfinite(D):
        raise InputError("at", index, f"a point in contact: at {p:g} Pa and {V:g} m/s the surface is pulled off")
    of, how = (result.material, result.adhesion), {"edge": result.edge, "branch": result.branch}
    for upper, level in pairwise(result.levels[:number_of_level]):
        # at the penetration of the level above, and of that the exact means: contact may be of a few points of a map
        above = solve_level(*of, upper, V=V, D=D, rtol=_RTOL, **how)
        if not above.contact_fraction > 0:
            raise InputError("level", number_of_level, "a level that the contact of the one above reaches")
        p = float((above.p_mean + result.adhesion.p_0 * above.adhesion_fraction) / above.contact_fraction)
        D = float(solve_level(*of, level, V=V, pressure=p, rtol=_RTOL, **how).D)
        if not np.isfinite(D):
            allowed = f"a level that is not pulled off by the mean pressure in the contact of the one above, {p:.4g} Pa"
            raise InputError("level", number_of_level, allowed)
    return Cell(*of, result.levels[number_of_level - 1], D, V, result.edge, result.branch, p, number_of_level)


def stresses_along(result: Result, cell: Cell, y: float) -> tuple[Floats, list[Floats]]:
    """Tangential stress along a strip of level 1 at ``y`` (m): x (m), and its own and that of all lower levels, Pa (Fig. 5)."""
    from .flat_levels import solve_points
    from .level.strips import WorkCounters
    from .multilevel import Surface

    level = cell.level
    x = np.linspace(-0.5, 0.5, _X) * level.l
    strip = cell.strip(np.asarray(number("y", y, "m")))
    p, gap = strip.fields(x)
    A, _ = level.strip(y, 0.0)
    own = p * A * level.k * np.sin(level.k * x)
    if len(result.levels) == 1:
        return x, [own]
    below = np.zeros(x.size)
    inside = gap <= 0
    of, how = (result.material, result.adhesion), (cell.edge, cell.branch, _RTOL, True, WorkCounters())
    if result.adhesion.p_0 > 0 and not any(level.is_flat for level in result.levels):
        # the laws that the strip carries: each pressure by itself would be looked for along the whole curve
        surface, V = Surface(*of, result.levels, *how, laws=_RTOL), np.array([cell.V])
        columns = replace(surface.columns(0, V), D=np.array([cell.D]))
        laws = surface.carrying(V, np.zeros(1, int), columns).carry.laws
        below[inside] = laws(np.zeros(np.count_nonzero(inside), int), p[inside])[:, 1 + laws.frictions].sum(axis=1)
    else:
        lower = Surface(*of, result.levels[1:], *how)
        below[inside] = solve_points(lower, np.full(np.count_nonzero(inside), cell.V), p[inside], True).tau.sum(axis=0)
    return x, [own, below]
