"""A scene, checked and in SI, ready to be solved."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from ..inputs.adhesion import Dugdale
    from ..inputs.materials import Material
    from ..inputs.surface import Level
    from ..result import Result
    from ..typing import Branch, Edge, Floats, Progress


@dataclass(frozen=True, eq=False)
class Scene:
    """Everything that determines a run.

    Attributes
    ----------
    name : short name, used for file names
    title, description : text of the file
    material, adhesion, levels : the library's objects; levels from the largest to the smallest
    pressure : nominal pressure, shape () or (P,) [Pa]; None if `penetration` is given
    penetration : penetration of level 1, shape () or (P,) [m]; None if `pressure` is given
    velocity : sliding velocity, shape () or (V,) [m/s]
    edge, branch : closure where the pressure steps, and which of several solutions
    rtol : accuracy asked for, as in :func:`hystrip.solve`; strips : equal strips of level 1, None for adaptive panels
    text : the TOML text it was read from
    temperature : K, for a material with a shift; None for the material as it is given
    source : the file or built-in scene it was read from, named in errors
    """

    name: str
    title: str
    description: str
    material: Material
    adhesion: Dugdale
    levels: tuple[Level, ...]
    pressure: Floats | None
    penetration: Floats | None
    velocity: Floats
    edge: Edge
    branch: Branch
    rtol: float
    strips: int | None
    text: str
    source: str = ""
    temperature: float | None = None

    @property
    def load(self) -> tuple[Literal["pressure", "penetration"], Floats]:
        """``("pressure", values)`` or ``("penetration", values)``, whichever the scene gives."""
        return ("penetration", self.penetration) if self.pressure is None else ("pressure", self.pressure)

    def solve(self, progress: Progress | None = None) -> Result:
        """Solve every combination of load and velocity.

        Returns the result of :func:`hystrip.solve`, arrays of shape load.shape + velocity.shape (a level axis in front where
        there is one). ``progress`` is called with (done, total) as the work goes on. Raises as :func:`hystrip.solve`.
        """
        import hystrip

        from .errors import located

        name, load = self.load
        options: dict[str, Any] = {name: load.reshape(load.shape + (1,) * self.velocity.ndim)}
        options |= {key: getattr(self, key) for key in ("velocity", "edge", "branch", "rtol", "strips", "temperature")}
        if progress is not None:
            options["progress"] = progress
        with located(self.source):
            result = hystrip.solve(self.material, self.adhesion, self.levels, **options)
        return dataclasses.replace(result, scene=self.text)
