"""Results read back from the files that ``save`` has written: equal to the bit, with everything they were solved from."""

from __future__ import annotations

import json
import os
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, overload

import numpy as np

from .dataset import FORMAT, check_levels_of
from .errors import InputError
from .extras import require
from .files import path_of
from .inputs.as_json import adhesion_of, levels_of, material_of
from .level_solution import Inputs, LevelSolution
from .result import Result

if TYPE_CHECKING:
    from xarray import Dataset

    from .loading import Solver

T = TypeVar("T")
_WHOLE = "a netCDF file that save() of a hystrip result has written"


@overload
def load(path: str | os.PathLike[str], kind: type[T], *, solver: Solver | None = None) -> T: ...
@overload
def load(path: str | os.PathLike[str], kind: None = None, *, solver: Solver | None = None) -> Any: ...
def load(path: str | os.PathLike[str], kind: Any = None, *, solver: Solver | None = None) -> Any:
    """Read a result that its ``save`` has written: equal to the bit.

    Parameters
    ----------
    path : the netCDF file
    kind : :class:`hystrip.Result`, :class:`hystrip.LevelSolution` or :class:`hystrip.Sweep`, to be sure of it; None for
        whatever the file holds
    solver : from ``hystrip.load_solver``, for a material that was solved with a solver of one's own

    Needs the extra ``dataset``.

    Raises
    ------
    InputError : no such file, no result in it, one of a version that cannot be read, another kind, or the wrong solver

    Examples
    --------
    >>> import tempfile, os, hystrip
    >>> result = hystrip.load_scene("paper_fig7").solve()
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = result.save(os.path.join(folder, "fig7.nc"))
    ...     again = hystrip.load(path, hystrip.Result)
    >>> bool((again.mu == result.mu).all())
    True
    """
    data = _opened(path)
    found = str(data.attrs["hystrip_kind"])
    if found not in _READ:
        raise InputError("path", os.fspath(path), f"a file that holds one of {', '.join(_READ)}; this holds {found!r}")
    made, read = _READ[found]
    if kind is not None and made != kind.__name__:
        raise InputError("path", os.fspath(path), f"a file that holds a {kind.__name__}; this holds a {made}")
    try:
        return read(data, solver)
    except InputError:
        raise
    except (KeyError, TypeError, ValueError) as error:  # a part of it, which xarray has cut out and written
        raise InputError("path", os.fspath(path), f"{_WHOLE}, with all that is in it: {_first_line(error)}") from None


def _opened(path: str | os.PathLike[str]) -> Dataset:
    """The dataset in a file, in memory. Raises InputError unless it is one of ours, and of a version that can be read."""
    xarray = require("xarray", "dataset", "reading a result")
    require("h5netcdf", "dataset", "reading netCDF")
    shown = str(path_of(path, "path", "a netCDF file"))
    if not os.path.isfile(path):
        raise InputError("path", shown, "a file that exists")
    try:
        with xarray.open_dataset(path, engine="h5netcdf") as file:
            data = file.load()
    except (OSError, ValueError, KeyError, RuntimeError) as error:  # what HDF5 makes of a file that is none, or is damaged
        raise InputError("path", shown, f"{_WHOLE}: {_first_line(error)}") from None
    version, written = data.attrs.get("hystrip_version"), data.attrs.get("hystrip_format")
    if version is None:
        raise InputError("path", shown, f"{_WHOLE}; this is netCDF of something else")
    if written is None or int(written) != FORMAT:
        this = "this one has none" if written is None else f"this is format {written}"
        allowed = f"a file of format {FORMAT}; {this}, of hystrip {version}: solve it again, or open it with xarray"
        raise InputError("path", shown, allowed)
    return data


def _result(data: Dataset, solver: Solver | None) -> Result:
    levels, attrs = levels_of(data.attrs["levels"]), data.attrs
    check_levels_of(data, len(levels))
    names = data["mu"].dims
    known = {each.name for each in fields(Result)}
    arrays = {name: _full(data, name, names) for name in map(str, data.variables) if name in known}
    result = Result(
        **arrays,
        counts=json.loads(attrs["counts"]),
        material=material_of(attrs["material"], solver),
        adhesion=adhesion_of(attrs["adhesion"]),
        levels=levels,
        load=attrs["load"],
        scene=attrs["scene"],
        temperature=float(attrs["temperature"]) if "temperature" in attrs else None,
        **_asked(attrs),
    )
    result.__dict__["p_sat"] = _full(data, "p_sat", names)  # a cached property, and what was saved is what it was
    return result


def _level(data: Dataset, solver: Solver | None) -> LevelSolution:
    attrs, names = data.attrs, data["p_mean"].dims
    (level,) = levels_of(attrs["levels"])
    material, adhesion = material_of(attrs["material"], solver), adhesion_of(attrs["adhesion"])
    inputs = Inputs(material, adhesion, level, _full(data, "velocity", names), **_asked(attrs))
    means = {name: _full(data, name, names) for name in ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction")}
    return LevelSolution(
        D=_full(data, "penetration", names),
        **means,
        error_estimate=data["error_estimate"].transpose("mean", *names).values,
        pulled_off=_full(data, "pulled_off", names),
        converged=_full(data, "converged", names),
        strips=int(attrs["strips_evaluated"]),
        inputs=inputs,
    )


def _sweep(data: Dataset, solver: Solver | None) -> Any:
    from .sweeps.saved import sweep_of  # needs the extra of scenes, which nothing else here does

    return sweep_of(data, Path(data.encoding.get("source", "")), solver)


_READ = {"result": ("Result", _result), "level": ("LevelSolution", _level), "sweep": ("Sweep", _sweep)}


def _asked(attrs: dict[str, Any]) -> dict[str, Any]:
    strips = attrs["strips"]
    strips = None if isinstance(strips, str) else int(strips)
    return {"edge": attrs["edge"], "branch": attrs["branch"], "rtol": float(attrs["rtol"]), "strips": strips}


def _full(data: Dataset, name: str, names: tuple[Any, ...]) -> np.ndarray:
    """A variable over all axes, a level axis in front where it has one."""
    dims = ("level", *names) if "level" in data[name].dims else names
    variable = data[name].transpose(*dims, missing_dims="ignore")
    index = tuple(slice(None) if each in variable.dims else None for each in dims)
    shape = tuple(data.sizes[each] for each in dims)
    return np.array(np.broadcast_to(variable.values[index], shape))


def _first_line(error: Exception) -> str:
    text = str(error).strip().splitlines()
    return f"{type(error).__name__}: {text[0]}" if text else type(error).__name__
