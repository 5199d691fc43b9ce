"""What ``hystrip.solve_level`` returns."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import os

    from xarray import Dataset

    from .inputs.adhesion import Dugdale
    from .inputs.surface import Level
    from .orbit.materials import Material
    from .typing import Bools, Branch, Edge, Floats


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
        from .storage.write import save

        return save(self.to_dataset(), path)
