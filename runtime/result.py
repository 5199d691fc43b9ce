"""What ``hystrip.solve`` returns."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    import os

    from matplotlib.figure import Figure
    from pandas import DataFrame
    from xarray import Dataset

    from .contact_map import ContactMap
    from .inputs.adhesion import Dugdale
    from .inputs.materials import Material
    from .inputs.surface import Level
    from .typing import Bools, Branch, Edge, Floats, ResultPlot


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """Friction of a surface; arrays have the broadcast shape of pressure (or penetration) and velocity, SI units.

    Attributes
    ----------
    mu : friction coefficient ``tau/pressure`` (Eq. 14); NaN at zero pressure, 0 below pull-off
    tau : friction stress, Pa; ``tau_by_level`` : the share of each level, shape (levels, ...), summing to ``tau``
    pressure : nominal pressure, Pa; penetration : D of level 1, m (NaN below pull-off)
    contact_fraction : fraction of the nominal area in contact on every level: the real contact
    contact_by_level, adhesion_by_level : fractions of the nominal area in contact and in adhesion on each level, (levels, ...),
        within ``rtol`` of that area; without adhesion within the larger of ``rtol`` and 1e-4 of it,
        which small ones are not to as many digits: ``solve_level`` tells what those of one level err by
    pulled_off : the pressure lies below pull-off: no contact, mu = 0
    closed_form : the point was solved by the closed form of saturated contact on all levels
    error_estimate : estimated absolute error of mu: of tau over the pressure, and of that where a penetration was given (inf
        where it may be zero); NaN at zero pressure
    tau_error : estimated absolute error of tau, Pa; pressure_error : that of the pressure, Pa, 0 where it was given
    converged : bool; the estimated error of tau is within ``rtol``, that of mu not inf. If not the work came to its limit and the
        estimate says what is known; with ``strips`` it says whether the equal strips happen to be as accurate
    strips : equal strips that level 1 was averaged over, None for adaptive panels
    load : which of the two was given, "pressure" or "penetration"; scene : the TOML text it came from, if it did;
        temperature : K, if one was given
    counts : strips solved, and decided by a threshold; points solved in closed form, points below pull-off
    """

    mu: Floats
    tau: Floats
    tau_by_level: Floats
    pressure: Floats
    velocity: Floats
    penetration: Floats
    contact_fraction: Floats
    contact_by_level: Floats
    adhesion_by_level: Floats
    pulled_off: Bools
    closed_form: Bools
    error_estimate: Floats
    tau_error: Floats
    pressure_error: Floats
    converged: Bools
    counts: dict[str, int]
    material: Material
    adhesion: Dugdale
    levels: tuple[Level, ...]
    edge: Edge
    branch: Branch
    rtol: float
    strips: int | None = None
    load: Literal["pressure", "penetration"] = "pressure"
    scene: str = ""
    temperature: float | None = None

    def __repr__(self) -> str:
        from .display import as_text, of_result

        return as_text(of_result(self))

    def _repr_html_(self) -> str:
        from .display import as_html, of_result

        return as_html(of_result(self))

    @cached_property
    def p_sat(self) -> Floats:
        """Nominal pressure from which level 1 is in saturated contact, Pa; on the loading branch one that suffices.
        Shape of ``mu``."""
        from .level.saturated import saturated_level

        V = self.velocity.ravel()
        return saturated_level(self.material, self.adhesion, self.levels[0], V, self.branch).p_sat.reshape(self.velocity.shape)

    @property
    def notes(self) -> list[str]:
        """What about the inputs may be beyond the model or the material, one sentence each; mostly none."""
        from .plausibility import notes

        return notes(self.material, self.levels, self.velocity, self.temperature)

    def to_dataset(self) -> Dataset:
        """The result as an xarray Dataset: labelled dimensions, units, long names, inputs and versions in the attributes.

        Needs the extra ``dataset``.
        """
        from .dataset import to_dataset

        return to_dataset(self)

    def to_dataframe(self) -> DataFrame:
        """The result as a pandas DataFrame: a row for every point in its order, the columns of the CSV file.

        Needs the extra ``dataset``, which brings pandas.
        """
        from .extras import require
        from .tables import friction_rows

        frame: DataFrame = require("pandas", "dataset", "a data frame").DataFrame(friction_rows(self))
        return frame

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the result as netCDF; ``hystrip.load(path)`` gives it back, equal to the bit. Returns the path.

        Needs the extra ``dataset``. At no time is there half a file.
        """
        from .files import save

        return save(self.to_dataset(), path)

    def summary(self) -> str:
        """Where the friction comes from, as text: levels, shares of mu, real contact, saturation, what was skipped; and
        the pull-off where the branch is ``unloading``."""
        from .summary import summary

        return summary(self)

    def plot(
        self,
        kind: ResultPlot | None = None,
        *,
        at: int | tuple[int, ...] | None = None,
        level: int = 1,
        y: float = 0.0,
    ) -> Figure:
        """A matplotlib Figure; ``hystrip.plots.save(figure, path)`` writes it. Needs the extra ``plot``.

        Parameters
        ----------
        kind : what is drawn. None: mu over velocity, with the contact below it for a single load; over the load, if there is one
            velocity, tau, contact, penetration and mu.
            ``"mu"``, ``"tau"``, ``"contact"``: that alone, with every level's part.
            ``"map"``: the pressure over the cell of a level, contact and adhesion outlined.
            ``"strip"``: pressure, gap and tangential stresses along the strip of level 1 at ``y``.
            ``"loop"``: pressure over penetration of a level, pressed in and pulled back, pull-off marked
        at : which point to look into, a flat index or a tuple; by default that of the largest friction coefficient
        level : which level, 1 the largest; one below is looked at under the mean pressure in the contact of the one above
        y : place of the strip, m; 0 is the crest

        Raises ``InputError`` for an unknown kind, a point that is pulled off, or a curve of a single point.
        """
        from .inputs.checks import choice

        choice("kind", kind or "mu", ("mu", "tau", "contact", "map", "strip", "loop"))
        if kind in ("map", "strip", "loop"):
            from .plots.point import look_into

            return look_into(self, str(kind), at, level, y)
        from .plots import friction

        return friction(self, kind)

    def contact_map(self, at: int | tuple[int, ...] | None = None, level: int = 1) -> ContactMap:
        """Pressure, gap and zones over the cell of a level at a point; arguments as of ``plot``.

        Raises ``InputError`` where the surface is pulled off.
        """
        from .at_point import cell_of
        from .contact_map import map_of

        return map_of(cell_of(self, at, level))
