"""Writing a result as netCDF."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from ..extras import require
from ..files import Outputs

if TYPE_CHECKING:
    from xarray import Dataset


def save(data: Dataset, path: str | os.PathLike[str]) -> Path:
    """Write a dataset as netCDF, aside and then renamed: at no time is there half a file. Returns the path.

    Needs the extra ``dataset``.
    """
    require("h5netcdf", "dataset", "writing netCDF")
    target = Path(path)
    with Outputs(target.parent) as files:
        data.to_netcdf(files.path(target.name), engine="h5netcdf")
    return target
