"""Reading measured topographies, in any format that SurfaceTopography knows."""

import os
from typing import Any

import numpy as np

from ..errors import InputError
from ..extras import require
from ..files import path_of
from .scan import Scan


def read_surface(
    path: str | os.PathLike[str],
    *,
    channel: str | None = None,
    unit: str | None = None,
    sizes: tuple[float, ...] | None = None,
    height_factor: float | None = None,
) -> Scan:
    """Read a scan with SurfaceTopography (extra ``roughness``).

    Points that the instrument left undefined are filled by its harmonic interpolation; a line with uneven steps is
    interpolated to even ones.

    Parameters
    ----------
    path : the file; its format is found out
    channel : name of the channel; the file's default without it
    unit : length unit of heights and sizes, for a file that does not say
    sizes : lengths of the scan, in that unit, for a file that does not say
    height_factor : what heights in the file have to be multiplied with to be in that unit, for a file that does not say

    Raises
    ------
    InputError : the file cannot be read, or lacks something; names it
    MissingExtra : SurfaceTopography is not installed
    """
    topographies = require("SurfaceTopography", "roughness", "reading a measured surface")
    where = str(path_of(path, "path", "a file with a measured surface"))
    if not os.path.isfile(where):
        is_other = ": this is a folder, a pipe or a device" if os.path.exists(where) else ""
        raise InputError(where, where, f"a file with a measured surface{is_other}")
    given = {"physical_sizes": sizes, "height_scale_factor": height_factor, "unit": unit}
    options = {key: each for key, each in given.items() if each is not None}
    try:
        with topographies.open_topography(where) as reader:
            if channel is not None:
                options |= _channel(reader, channel, where)
            return Scan(*_even(reader.topography(**options), where))
    except InputError:
        raise
    except Exception as error:  # readers of forty formats end in errors of as many kinds
        said = (str(error).strip() or type(error).__name__).splitlines()[0]
        if type(error).__name__ == "CannotDetectFileFormat":
            said = "no format that SurfaceTopography knows"
        allowed = "a measured surface, with sizes and unit in the file or else given (--size, --unit), not both"
        raise InputError(where, said, allowed) from None


def _channel(reader: Any, name: str, where: str) -> dict[str, int]:
    names = [each.name for each in reader.channels]
    if name not in names:
        raise InputError(f"{where}, channel", name, f"one of {', '.join(map(repr, names))}")
    index = names.index(name)
    return {} if index == reader.default_channel.index else {"channel_index": index}


def _even(topography: Any, where: str) -> tuple[np.ndarray, tuple[float, ...], bool]:
    """Heights and lengths in metres, on an even grid without gaps."""
    if topography.unit is None:
        raise InputError(f"{where}, unit", None, "a length unit such as 'um', since the file does not say (--unit)")
    topography = topography.to_unit("m")
    if not topography.is_uniform:
        topography = topography.to_uniform(nb_points=len(topography.heights()))
    if topography.has_undefined_data:
        topography = topography.interpolate_undefined_data()
    return (
        np.array(topography.heights(), dtype=float),
        tuple(map(float, topography.physical_sizes)),
        bool(topography.is_periodic),
    )
