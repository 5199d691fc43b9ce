"""The loop of pressure over penetration: a level pressed in and pulled back while it slides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .arguments import check_on_level
from .errors import InputError
from .inputs.checks import number
from .level.breaks import reach
from .level.saturated import saturated_level
from .level_law import friction_law
from .level_solution import solve_level

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .inputs.adhesion import Dugdale
    from .inputs.materials import Material
    from .inputs.surface import Level
    from .level_solution import LevelSolution
    from .typing import Branch, Edge, Floats, Number

#: penetrations of the first look; then the middle of every interval over which the pressure changes by more than this part
#: of its range, so many times: what is still steep after that is a jump
_FIRST, _STEEP, _ROUNDS = 80, 0.015, 7


@dataclass(frozen=True, eq=False)
class Loop:
    """A level over penetration, sliding at one velocity: pressed in from no contact, and pulled back from full contact.

    Attributes
    ----------
    loading, unloading : penetration (m), mean pressure (Pa), friction stress (Pa) and contact fraction, each (n,), ascending in
        penetration, as :class:`hystrip.LevelSolution`
    pull_off : least mean pressure when pulled back, Pa: where the level comes off under load control; 0 without adhesion
    pull_off_penetration : penetration at which that is, m
    work : area between the two curves, J/m^2: what a slow cycle of pressing in and pulling back costs, sliding apart
    """

    loading: LevelSolution
    unloading: LevelSolution
    pull_off: float
    pull_off_penetration: float
    work: float

    def __repr__(self) -> str:
        return (
            f"Loop: {self.loading.D.size} and {self.unloading.D.size} penetrations, pull-off at {self.pull_off:.4g} Pa, "
            f"D = {self.pull_off_penetration:.4g} m; work of a cycle {self.work:.4g} J/m^2"
        )

    def plot(self) -> Figure:
        """A matplotlib Figure of pressure and friction over penetration, pull-off marked. Needs the extra ``plot``."""
        from .plots.loop import loading_loop

        return loading_loop(self)


def loading_loop(
    material: Material,
    adhesion: Dugdale,
    level: Level,
    *,
    V: Number,
    D_max: Number | None = None,
    edge: Edge = "continuous",
    rtol: float = 1e-3,
) -> Loop:
    """Press a sliding level in and pull it back: mean pressure and friction over penetration, on both branches.

    Parameters
    ----------
    material, adhesion, level : single values
    V : sliding velocity, m/s, >= 0
    D_max : greatest penetration, m; by default a little beyond where unloading leaves saturated contact, at least
        1.5 h, at most 2 h and a part of the reach of the adhesion
    edge, rtol : as in ``solve_level``

    Raises ``InputError`` for inputs out of range, ``SolverError`` for a strip that could not be certified.

    >>> import hystrip
    >>> material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
    >>> adhesion = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
    >>> loop = hystrip.loading_loop(material, adhesion, hystrip.Level(l=500e-9, h=100e-9), V=1e-3, rtol=1e-2)
    >>> print(f"{loop.pull_off:.0f} Pa, {loop.work:.2g} J/m^2")
    -707 Pa, 0.0014 J/m^2
    """
    at_level, *_ = check_on_level(material, adhesion, level, V := number("V", V, "m/s", 0), edge, "loading", rtol)
    above = reach(adhesion, at_level.K)
    if D_max is None:
        full = float(saturated_level(material, adhesion, level, np.array([V])).D_sat[0])
        top = max(min(1.1 * full + 0.1 * level.h, 2 * level.h + 0.3 * above), 1.5 * level.h) if level.h > 0 else above or 1e-9
    else:
        top = number("D_max", D_max, "m")
        if top <= -above:
            raise InputError("D_max", D_max, f"more than {-above:g} m, below which nothing touches")
    low = -above - 0.05 * (level.h or top)
    curves = [
        _curve(material, adhesion, level, V, np.linspace(low, top, _FIRST), edge, b, rtol) for b in ("loading", "unloading")
    ]
    loading, unloading = curves
    at = int(np.argmin(unloading.p_mean))
    sticks = bool(adhesion.p_0 > 0)
    joint = np.union1d(loading.D, unloading.D)
    pressures = [np.interp(joint, each.D, each.p_mean) for each in (loading, unloading)]
    apart = pressures[0] - pressures[1]
    work = float(np.sum(0.5 * (apart[1:] + apart[:-1]) * np.diff(joint)))
    pull_off = 0.0
    if sticks:  # the least of the curve itself, of which the points are only near
        pull_off = friction_law(material, adhesion, level, V=V, edge=edge, rtol=rtol, below=0.0).pull_off
    return Loop(loading, unloading, pull_off, float(unloading.D[at]) if sticks else 0.0, work)


def _curve(
    material: Material, adhesion: Dugdale, level: Level, V: float, D: Floats, edge: Edge, branch: Branch, rtol: float
) -> LevelSolution:
    """A branch over penetrations, more of them where the pressure is steep."""
    p = np.empty(0)
    seen = np.empty(0)
    for _ in range(_ROUNDS):
        new = np.setdiff1d(D, seen)
        values = solve_level(material, adhesion, level, V=V, D=new, edge=edge, branch=branch, rtol=rtol).p_mean
        seen, p = np.concatenate((seen, new)), np.concatenate((p, values))
        order = np.argsort(seen)
        seen, p = seen[order], p[order]
        steep = np.abs(np.diff(p)) > _STEEP * np.ptp(p)
        if not steep.any():
            break
        D = 0.5 * (seen[:-1] + seen[1:])[steep]
    return solve_level(material, adhesion, level, V=V, D=seen, edge=edge, branch=branch, rtol=rtol)
