"""What ``hystrip.solve_level`` returns."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import os

    from matplotlib.figure import Figure
    from xarray import Dataset

    from .contact_map import Cell, ContactMap
    from .inputs.adhesion import Dugdale
    from .inputs.surface import Level
    from .orbit.materials import Material
    from .typing import Bools, Branch, Edge, Floats, LevelPlot


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

    ``D`` and means are NaN and zero below pull-off (``pulled_off``). ``error_estimate``: of ``p_mean``, ``tau_mean``,
    ``contact_fraction``, ``adhesion_fraction``, absolute, shape (4, ...). ``converged``: bool, all four errors are within
    ``rtol``. ``strips``: strips evaluated, in all.
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
        from .inputs.checks import choice

        if choice("kind", kind, ("map", "strip")) == "map":
            return self.contact_map(at).plot()
        return self._cell(at).strip(np.asarray(float(y))).plot()

    def contact_map(self, at: int | tuple[int, ...] | None = None) -> ContactMap:
        """Pressure, gap and zones over the cell at a point. Raises ``InputError`` where the level is pulled off."""
        from .contact_map import map_of

        return map_of(self._cell(at))

    def _cell(self, at: int | tuple[int, ...] | None) -> Cell:
        from .contact_map import Cell
        from .errors import InputError

        size = np.size(self.D)
        if at is None and size > 1:
            raise InputError("at", at, f"which of the {size} points to look at")
        try:
            index = np.ravel_multi_index(at, self.D.shape) if isinstance(at, tuple) and at else range(size)[at or 0]
        except (IndexError, ValueError, TypeError):
            raise InputError("at", at, f"an index into the {size} points, of shape {self.D.shape}") from None
        D, V = float(np.ravel(self.D)[index]), float(np.ravel(self.inputs.velocity)[index])
        if not np.isfinite(D):
            raise InputError("at", at, "a point in contact: at this one the level is pulled off")
        asked = self.inputs
        return Cell(asked.material, asked.adhesion, asked.level, D, V, asked.edge, asked.branch)
