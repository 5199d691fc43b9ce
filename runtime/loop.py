"""The loop of pressure over penetration: a level pressed in and pulled back while it slides."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
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

#: penetrations of the first look, and of another one where adhesion lets go
_FIRST, _NEAR = 80, 40
#: intervals are divided at these parts of them, so many times, where a pressure changes by more than a part of its range (at the
#: finest width, a part of all penetrations, that is a jump), or where the area between the curves errs by more than a part of it
_PARTS, _ROUNDS, _STEEP, _FINEST, _AREA = (0.25, 0.5, 0.75), 12, 0.015, 1e-4, 2e-4


@dataclass(frozen=True, eq=False)
class Loop:
    """A level over penetration, sliding at one velocity: pressed in from no contact, and pulled back from full contact.

    Attributes
    ----------
    loading, unloading : penetration (m), mean pressure (Pa), friction stress (Pa) and contact fraction, each (n,), ascending in
        penetration, as :class:`hystrip.LevelSolution`
    pull_off : least mean pressure when pulled back, Pa: where the level comes off under load control; 0 without adhesion
    pull_off_penetration : penetration at which that is, m, also where it lies beyond ``D_max``
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
    K = float(at_level.K)
    above = reach(adhesion, K)
    full = float(saturated_level(material, adhesion, level, np.array([V])).D_sat[0])
    usual = max(min(1.1 * full + 0.1 * level.h, 2 * level.h + 0.3 * above), 1.5 * level.h) if level.h > 0 else above or 1e-9
    top = usual if D_max is None else number("D_max", D_max, "m")
    if top <= -above:
        raise InputError("D_max", D_max, f"more than {0.0 - above:g} m, below which nothing touches")
    low, sticks = -above - 0.05 * (level.h or max(top, usual)), bool(adhesion.p_0 > 0)
    near = min(top, usual)
    rest = np.linspace(near, max(top, usual), _FIRST)
    first = np.unique([*np.linspace(low, near, _FIRST), *np.linspace(-above, min(2 * above, usual), _NEAR), *rest])

    found: dict[Branch, list[LevelSolution]] = {"loading": [], "unloading": []}

    def solved(branch: Branch, D: Floats) -> LevelSolution:
        found[branch].append(solve_level(material, adhesion, level, V=V, D=D, edge=edge, branch=branch, rtol=rtol))
        return found[branch][-1]

    least = 1e-3 * rtol * (K * level.h + float(adhesion.p_0)) * (usual - low)
    D, p, at = _sampled(solved, first, near, top, least, sticks)
    kept = D <= top
    loading, unloading = (_in_order(parts, top) for parts in found.values())
    apart = p[0, kept] - p[1, kept]
    work = float(np.sum(0.5 * (apart[1:] + apart[:-1]) * np.diff(D[kept])))
    pull_off = 0.0
    if sticks:  # the least of the curve itself, of which the points are only near
        pull_off = friction_law(material, adhesion, level, V=V, edge=edge, rtol=rtol, below=0.0).pull_off
    return Loop(loading, unloading, pull_off, float(D[at]) if sticks else 0.0, work)


def _in_order(parts: list[LevelSolution], top: float) -> LevelSolution:
    """One solution of all ``parts``, ascending in penetration, up to ``top``."""
    first, D = parts[0], np.concatenate([part.D for part in parts])
    order = np.argsort(D)[: np.count_nonzero(D <= top)]
    arrays = [f.name for f in fields(first) if isinstance(getattr(first, f.name), np.ndarray)]
    every = {name: np.concatenate([getattr(part, name) for part in parts], axis=-1)[..., order] for name in arrays}
    inputs = replace(first.inputs, velocity=np.full(order.size, first.inputs.velocity[0]))
    return replace(first, strips=sum(part.strips for part in parts), inputs=inputs, **every)


def _sampled(
    solved: Callable[[Branch, Floats], LevelSolution], D: Floats, near: float, top: float, least: float, sticks: bool
) -> tuple[Floats, Floats, int]:
    """Penetrations (n,), more of them where a curve is steep up to ``near``, where the area between both up to ``top`` bends (to
    no less than ``least``, J/m^2) and where unloading pulls most; pressures (2, n), loading and unloading; where the least is."""
    seen, p, finest = np.empty(0), np.empty((2, 0)), _FINEST * (near - D[0])
    for _ in range(_ROUNDS):
        p = np.concatenate((p, [solved("loading", D).p_mean, solved("unloading", D).p_mean]), axis=1)
        seen = np.concatenate((seen, D))
        order = np.argsort(seen)
        seen, p = seen[order], p[:, order]
        width, apart, at = np.diff(seen), np.where(seen <= top, p[0] - p[1], 0.0), int(np.argmin(p[1]))
        # trapezoids err as what they are put under bends
        bends = np.pad(np.abs(np.diff(np.diff(apart) / width)), 1)
        area = float(np.sum(np.abs(apart[1:] + apart[:-1]) * width)) / 2
        split = width**2 * (bends[1:] + bends[:-1]) / 12 > _AREA * max(area, least)
        fine = (np.abs(np.diff(p)).max(axis=0) > _STEEP * np.ptp(p[:, seen <= near])) & (seen[1:] <= near)
        fine[max(at - 1, 0) : at + 1] |= sticks
        split |= fine & (width > finest)
        D = np.setdiff1d((seen[:-1] + np.multiply.outer(_PARTS, width))[:, split], seen)
        if not D.size:
            break
    return seen, p, at
