"""One level: ``hystrip.solve_level`` and what it returns."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, overload

import numpy as np

from .arguments import check_on_level, check_strips, point_index, refuse_faint
from .errors import InputError
from .inputs.adhesion import Dugdale
from .inputs.checks import broadcast, choice, number, numbers
from .inputs.surface import Level
from .level.averages import level_means, look_below
from .level.inverse import invert
from .level.strips import QUANTITIES, LevelBatch, WorkCounters
from .points import warn_unconverged

if TYPE_CHECKING:
    import os

    from matplotlib.figure import Figure
    from xarray import Dataset

    from .contact_map import Cell, ContactMap
    from .inputs.materials import Material
    from .typing import Bools, Branch, Edge, Floats, LevelPlot, Numbers


@dataclass(frozen=True)
class Inputs:
    """What a level was solved with; ``velocity`` has the shape of the solution, m/s."""

    material: Material
    adhesion: Dugdale
    level: Level
    velocity: Floats
    edge: Edge
    branch: Branch
    rtol: float
    strips: int | None


@dataclass(frozen=True, eq=False, repr=False)
class LevelSolution:
    """Means of a level; arrays have the broadcast shape of V and D (or pressure), SI units.

    Below pull-off (``pulled_off``) ``D`` is NaN, ``p_mean`` the pressure that was given, and the other means are zero.
    ``error_estimate``: of ``p_mean``, ``tau_mean``, ``contact_fraction``, ``adhesion_fraction``, absolute, shape (4, ...).
    ``converged``: bool, all four errors are within ``rtol``. ``strips``: strips evaluated, in all.
    ``inputs``: the material, the adhesion, the level, the velocities and the options it was solved with.
    """

    D: Floats
    p_mean: Floats
    tau_mean: Floats
    contact_fraction: Floats
    adhesion_fraction: Floats
    error_estimate: Floats
    pulled_off: Bools
    converged: Bools
    strips: int
    inputs: Inputs

    def __repr__(self) -> str:
        from .display import as_text, of_level

        return as_text(of_level(self))

    def _repr_html_(self) -> str:
        from .display import as_html, of_level

        return as_html(of_level(self))

    def to_dataset(self) -> Dataset:
        """The solution as an xarray Dataset: labelled dimensions, units, long names, inputs and versions in the attributes.

        Needs the extra ``dataset``.
        """
        from .dataset import level_dataset

        return level_dataset(self)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the solution as netCDF; ``hystrip.load(path)`` gives it back, equal to the bit. Returns the path.

        Needs the extra ``dataset``.
        """
        from .files import save

        return save(self.to_dataset(), path)

    def plot(self, kind: LevelPlot = "map", *, at: int | tuple[int, ...] | None = None, y: float = 0.0) -> Figure:
        """A matplotlib Figure of the contact at one point. Needs the extra ``plot``.

        Parameters
        ----------
        kind : ``"map"``, the pressure over the cell with contact and adhesion outlined; or ``"strip"``, pressure, foundation
            and profile along the strip at ``y``
        at : which point, a flat index or a tuple; needed where there are several
        y : place of the strip, m; 0 is the crest

        Raises ``InputError`` for an unknown kind, or a point that is pulled off.
        """
        if choice("kind", kind, ("map", "strip")) == "map":
            return self.contact_map(at).plot()
        return self._cell(at).strip(np.asarray(number("y", y, "m"))).plot()

    def contact_map(self, at: int | tuple[int, ...] | None = None) -> ContactMap:
        """Pressure, gap and zones over the cell at a point. Raises ``InputError`` where the level is pulled off."""
        from .contact_map import map_of

        return map_of(self._cell(at))

    def _cell(self, at: int | tuple[int, ...] | None) -> Cell:
        from .contact_map import Cell

        size = np.size(self.D)
        if at is None and size > 1:
            raise InputError("at", at, f"which of the {size} points to look at")
        index = point_index(at, self.D.shape)
        D, V, p = (float(np.ravel(each)[index]) for each in (self.D, self.inputs.velocity, self.p_mean))
        if not np.isfinite(D):
            raise InputError("at", at, "a point in contact: at this one the level is pulled off")
        asked = self.inputs
        return Cell(asked.material, asked.adhesion, asked.level, D, V, asked.edge, asked.branch, p)


@overload
def solve_level(
    material: Material, adhesion: Dugdale, level: Level, *, V: Numbers, D: Numbers, pressure: None = None,
    edge: Edge = ..., branch: Branch = ..., rtol: float = ..., strips: int | None = None,
) -> LevelSolution: ...  # fmt: skip
@overload
def solve_level(
    material: Material, adhesion: Dugdale, level: Level, *, V: Numbers, D: None = None, pressure: Numbers,
    edge: Edge = ..., branch: Branch = ..., rtol: float = ..., strips: None = None,
) -> LevelSolution: ...  # fmt: skip
def solve_level(
    material: Material,
    adhesion: Dugdale,
    level: Level,
    *,
    V: Numbers,
    D: Numbers | None = None,
    pressure: Numbers | None = None,
    edge: Edge = "continuous",
    branch: Branch = "unloading",
    rtol: float = 1e-9,
    strips: int | None = None,
) -> LevelSolution:
    """Means of a level over its strips (Eq. 11) at penetration ``D`` (m) or nominal ``pressure`` (Pa) and velocity ``V`` (m/s).

    ``strips=N``: the paper's equal strips (midpoints of N strips of half a cell) instead of adaptive panels; with ``D`` only.
    ``rtol`` is relative to ``|value| + 1e-3 scale``, scale ``K h + p_0`` for pressure, times ``h/l`` for friction, 1 for
    fractions.

    Raises ``InputError`` for inputs out of range, ``SolverError`` for a strip that could not be certified; warns with a
    ``ConvergenceWarning`` of points that are not ``converged``, as the work on each is bounded.

    >>> import hystrip
    >>> material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
    >>> adhesion = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
    >>> level = hystrip.solve_level(material, adhesion, hystrip.Level(l=1e-5, h=1e-6), V=5e-3, D=6e-7, rtol=1e-6)
    >>> print(f"{float(level.p_mean):.4g} Pa, {float(level.tau_mean):.4g} Pa, {float(level.contact_fraction):.4g}")
    42.54 Pa, 23.53 Pa, 0.4357
    """
    material, V, level, edge, branch, rtol = check_on_level(material, adhesion, level, V, edge, branch, rtol)
    if (D is None) == (pressure is None):
        raise InputError("D, pressure", {"D": D, "pressure": pressure}, "exactly one of the two")
    strips = check_strips(strips)
    if strips is not None and D is None:
        raise InputError("strips", strips, "None where the pressure is given: equal strips need D")
    name, load = ("D", numbers("D", D, "m")) if pressure is None else ("pressure", numbers("pressure", pressure, "Pa"))
    if name == "pressure":
        refuse_faint(load, material, adhesion, level)
    shape = broadcast(**{"V": V, name: load})
    V, load = (np.broadcast_to(v, shape).ravel() for v in (V, load))
    work = WorkCounters()
    inputs = Inputs(material, adhesion, level, V.reshape(shape), edge, branch, rtol, strips)
    columns = LevelBatch(material, adhesion, level, edge, branch, V, load, strips=strips, work=work)
    if name == "D":
        columns = replace(columns, D=columns.not_just_released(load))
    D, values, errors = _means(columns, load if D is None else None, rtol)
    pulled_off = np.isnan(D)
    allowed = rtol * np.abs(values) + columns.atol(np.full(load.size, rtol))
    converged = pulled_off | (errors <= allowed).all(axis=1)
    if strips is None:
        warn_unconverged(converged, rtol, lambda i: work.reason(V[i]), **{name: load, "V": V})
    one = lambda v: v.reshape(shape)  # noqa: E731
    return LevelSolution(
        one(D),
        *(one(v) for v in values.T),
        error_estimate=errors.T.reshape(len(QUANTITIES), *shape),
        pulled_off=one(pulled_off),
        converged=one(converged),
        strips=work.solved + work.decided,
        inputs=inputs,
    )


def _means(columns: LevelBatch, p: np.ndarray | None, rtol: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Penetrations (n,), NaN below pull-off, means and errors (n, 4), at the columns' penetrations or at the pressures ``p``."""
    accuracy = np.full(columns.size, rtol)
    if not columns.size:
        return columns.D, *np.zeros((2, 0, len(QUANTITIES)))
    if p is None:
        look_below(columns)
        means = level_means(columns, accuracy)
        return columns.D, means.values, means.errors
    found, (values, errors) = invert(columns, p, 0.3 * rtol), np.zeros((2, p.size, len(QUANTITIES)))
    values[:, 0], touching = p, np.flatnonzero(~np.isnan(found.D))
    if touching.size:
        at = found.take(touching)
        columns, accuracy = columns.at(touching, at.D), rtol / at.steep
        means = level_means(columns, accuracy, columns.atol(accuracy, pressure=1e-3 if columns.adhesion.p_0 > 0 else 0.0))
        values[touching], errors[touching] = at.meeting(p[touching], means)
    return found.D, values, errors
