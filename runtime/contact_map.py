"""The contact of one level over its cell: pressure, gap and zones at every point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .errors import InputError
from .strip_solution import solve_strip

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .inputs.adhesion import Dugdale
    from .inputs.materials import Material
    from .inputs.surface import Level
    from .strip_solution import StripSolution
    from .typing import Bools, Branch, Edge, Floats

#: points over a cell, along x and along y
_POINTS = (601, 401)


@dataclass(frozen=True)
class Cell:
    """One level pressed in by ``D`` (m) at velocity ``V`` (m/s), with all that determines its strips; its mean pressure (Pa), and
    which level of a surface it is."""

    material: Material
    adhesion: Dugdale
    level: Level
    D: float
    V: float
    edge: Edge
    branch: Branch
    mean_pressure: float
    number: int | None = None

    def pressed(self, pressure: str) -> str:
        """Which level it is and what presses it, in words; ``pressure``: the mean one as text."""
        of = f"level {self.number} at " if self.number else ""
        above = f", that in the contact of level {self.number - 1}" if (self.number or 1) > 1 else ""
        return f"{of}a mean pressure of {pressure}{above}"

    def strip(self, y: Floats) -> StripSolution:
        """Strips at ``y`` (m); shape of ``y``."""
        A, depth = self.level.strip(y, self.D)
        return solve_strip(
            self.material, self.adhesion, l=self.level.l, A=A, D=depth, V=self.V, edge=self.edge, branch=self.branch
        )


@dataclass(frozen=True, eq=False)
class ContactMap:
    """Contact of a level over one cell; it slides towards +x. SI units.

    Attributes
    ----------
    x, y : coordinates, m, shapes (nx,) and (ny,); the crest stands at the origin
    pressure : p(x, y), Pa, shape (ny, nx)
    gap : gap between foundation and surface, m, (ny, nx); zero in contact
    contact, adhesion : bool, (ny, nx): where they touch, and where they attract each other across the gap
    first, last : where contact begins and ends along each strip, m, (ny,); NaN in saturated contact and without contact
    cell : the level, its penetration and mean pressure, the velocity, material and adhesion
    """

    x: Floats
    y: Floats
    pressure: Floats
    gap: Floats
    contact: Bools
    adhesion: Bools
    first: Floats
    last: Floats
    cell: Cell

    def __repr__(self) -> str:
        # the last row and column are the first ones again; so many points tell two digits
        level, shares = self.cell.level, [100 * float(np.mean(each[:-1, :-1])) for each in (self.contact, self.adhesion)]
        contact, adhesion = (f"{float(f'{share:.2g}'):g} %" for share in shares)
        return (
            f"ContactMap: {self.x.size} x {self.y.size} points, l = {level.l:g} m, h = {level.h:g} m, D = {self.cell.D:.4g} m, "
            f"V = {self.cell.V:g} m/s, "
            f"{self.cell.pressed(f'{self.cell.mean_pressure:.4g} Pa')}: {contact} in contact, {adhesion} in adhesion"
        )

    def plot(self) -> Figure:
        """A matplotlib Figure of the pressure with the borders of contact and adhesion. Needs the extra ``plot``."""
        from .plots.cell import contact_map

        return contact_map(self)


def map_of(cell: Cell) -> ContactMap:
    """The contact of a cell, at points all over it. Raises InputError where the level is pulled off."""
    if not np.isfinite(cell.D):
        raise InputError("D", cell.D, "a finite penetration: below pull-off there is no contact to look into")
    half = 0.5 * cell.level.l
    x, y = (np.linspace(-half, half, each) for each in _POINTS)
    strips = cell.strip(np.abs(y)[:, None])
    p, gap = strips.fields(x[None, :])
    contact = gap <= 0
    return ContactMap(x, y, p, gap, contact, ~contact & (p < 0), -strips.a[:, 0], strips.b[:, 0], cell)
