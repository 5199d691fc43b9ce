"""Results as xarray Datasets: labelled dimensions, units and long names; inputs and versions in the attributes."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from .extras import require
from .inputs.as_json import adhesion_text, levels_text, material_text
from .tables import parts_of_mu

if TYPE_CHECKING:
    from xarray import Dataset

    from .level_solution import LevelSolution
    from .result import Result

#: unit and long name of every variable
LABELS = {
    "mu": ("1", "friction coefficient"),
    "tau": ("Pa", "friction stress"),
    "tau_by_level": ("Pa", "friction stress that each level adds"),
    "mu_by_level": ("1", "part of the friction coefficient that each level adds"),
    "pressure": ("Pa", "nominal pressure"),
    "velocity": ("m/s", "sliding velocity"),
    "penetration": ("m", "penetration of level 1"),
    "contact_fraction": ("1", "real contact: fraction of the nominal area in contact on every level"),
    "contact_by_level": ("1", "fraction of the nominal area in contact on each level"),
    "adhesion_by_level": ("1", "fraction of the nominal area in the adhesion zone of each level"),
    "pulled_off": ("1", "the pressure lies below pull-off: no contact"),
    "p_sat": ("Pa", "nominal pressure from which level 1 is in saturated contact"),
    "converged": ("1", "the estimated error is within the accuracy that was asked for"),
    "closed_form": ("1", "solved by the closed form of saturated contact on all levels"),
    "error_estimate": ("1", "estimated absolute error of the friction coefficient"),
    "tau_error": ("Pa", "estimated absolute error of the friction stress"),
    "pressure_error": ("Pa", "estimated absolute error of the nominal pressure: none where it was given"),
    "p_mean": ("Pa", "mean pressure"),
    "tau_mean": ("Pa", "mean friction stress"),
    "adhesion_fraction": ("1", "fraction of the area in the adhesion zone"),
    "level": ("1", "level of the surface, 1 the largest"),
    "wavelength": ("m", "wavelength of the level"),
    "height": ("m", "height of the level"),
}
#: version of the layout, counted up where what is read changes: files of no other one are read
FORMAT = 2
_BY_LEVEL = ("tau_by_level", "mu_by_level", "contact_by_level", "adhesion_by_level")
_ERRORS = ("error_estimate", "tau_error", "pressure_error")
_PLAIN = ("mu", "tau", "contact_fraction", "pulled_off", "p_sat", "converged", "closed_form", *_ERRORS)
_MEANS = ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction")


def to_dataset(result: Result) -> Dataset:
    """Dataset of a :class:`hystrip.Result`.

    Dimensions: ``level``, and for every axis of the result what changes along it, ``velocity``, ``pressure`` or
    ``penetration``; ``point`` where several change together. Needs the extra ``dataset``.
    """
    xarray = require("xarray", "dataset", "a labelled dataset")
    inputs = {name: np.asarray(getattr(result, name)) for name in (result.load, "velocity")}
    names = axis_names(inputs, np.shape(result.mu))
    coords: dict[str, Any] = {"level": _labelled("level", ("level",), np.arange(1, len(result.levels) + 1))}
    coords["wavelength"] = _labelled("wavelength", ("level",), np.array([level.l for level in result.levels]))
    coords["height"] = _labelled("height", ("level",), np.array([level.h for level in result.levels]))
    variables = {name: _labelled(name, names, getattr(result, name)) for name in _PLAIN}
    by_level = {**{name: getattr(result, name, None) for name in _BY_LEVEL}, "mu_by_level": parts_of_mu(result)}
    variables |= {name: _labelled(name, ("level", *names), by_level[name]) for name in _BY_LEVEL}
    for name in ("velocity", "pressure", "penetration"):
        values = np.asarray(getattr(result, name))
        if name in names:
            coords[name] = _labelled(name, (name,), _along(values, names.index(name)))
        elif name in inputs:
            coords[name] = _labelled(name, *reduced(names, values))
        else:
            variables[name] = _labelled(name, names, values)
    attributes = {
        **about("result"),
        "material": material_text(result.material),
        "adhesion": adhesion_text(result.adhesion),
        "levels": levels_text(result.levels),
        **_asked(result.edge, result.branch, result.rtol, result.strips),
        **({} if result.temperature is None else {"temperature": result.temperature}),
        "load": result.load,
        "counts": json.dumps(result.counts),
        "scene": result.scene,
    }
    return xarray.Dataset(variables, coords, attrs=attributes)


def level_dataset(solution: LevelSolution) -> Dataset:
    """Dataset of a :class:`hystrip.LevelSolution`; dimensions as of a result. Needs the extra ``dataset``."""
    xarray = require("xarray", "dataset", "a labelled dataset")
    asked = solution.inputs
    inputs = {"penetration": solution.D, "velocity": asked.velocity}
    names = axis_names(inputs, np.shape(solution.D))
    coords: dict[str, Any] = {"mean": ("mean", list(_MEANS), {"units": "1", "long_name": "which mean an error estimate is of"})}
    variables = {name: _labelled(name, names, getattr(solution, name)) for name in (*_MEANS, "pulled_off", "converged")}
    label = {"units": "1", "long_name": "estimated absolute error, in the unit of the mean"}
    variables["error_estimate"] = (("mean", *names), np.array(solution.error_estimate), label)
    for name, values in inputs.items():
        coords[name] = _labelled(name, (name,), _along(values, names.index(name))) if name in names else _labelled(
            name, *reduced(names, values)
        )  # fmt: skip
    attributes = {
        **about("level"),
        "material": material_text(asked.material),
        "adhesion": adhesion_text(asked.adhesion),
        "levels": levels_text([asked.level]),
        **_asked(asked.edge, asked.branch, asked.rtol, asked.strips),
        "strips_evaluated": solution.strips,
    }
    return xarray.Dataset(variables, coords, attrs=attributes)


def axis_names(inputs: dict[str, np.ndarray], shape: tuple[int, ...]) -> tuple[str, ...]:
    """A name for every axis of arrays of ``shape``: that of the one input that changes along it."""
    names: list[str] = []
    for axis, size in enumerate(shape):
        varies = [name for name, values in inputs.items() if size > 1 and not _constant(values, axis)]
        alone = [name for name in varies if all(_constant(inputs[name], other) for other in range(len(shape)) if other != axis)]
        if len(varies) == 1 and alone and alone[0] not in names:
            names.append(alone[0])
        elif size == 1 and len(shape) == 1:
            names.append("velocity")
        else:
            names.append("point" if "point" not in names else f"point_{axis}")
    return tuple(names)


def check_levels_of(data: Dataset, levels: int) -> None:
    """Raise ``ValueError`` unless a dataset has all ``levels``, in their order."""
    if not np.array_equal(data["level"], np.arange(1, levels + 1)):
        raise ValueError(f"of {levels} levels it has {data['level'].values.tolist()}")


def about(kind: str) -> dict[str, Any]:
    """What the file holds, and what wrote it."""
    from ._version import __version__

    return {
        "title": "friction of a multiscale wavy surface on a viscoelastic foundation with adhesion",
        "source": f"hystrip {__version__}",
        "hystrip_kind": kind,
        "hystrip_format": FORMAT,
        "hystrip_version": __version__,
        "numpy_version": np.__version__,
    }


def _asked(edge: str, branch: str, rtol: float, strips: int | None) -> dict[str, Any]:
    return {"edge": edge, "branch": branch, "rtol": rtol, "strips": "adaptive panels" if strips is None else strips}


def _labelled(name: str, dims: tuple[str, ...], values: Any) -> tuple[tuple[str, ...], np.ndarray, dict[str, str]]:
    unit, long_name = LABELS[name]
    return dims, np.array(values), {"units": unit, "long_name": long_name}


def _along(values: np.ndarray, axis: int) -> np.ndarray:
    """Along an axis, at the start of all others."""
    return values[tuple(slice(None) if i == axis else 0 for i in range(values.ndim))]


def _constant(values: np.ndarray, axis: int) -> bool:
    """Whether nothing changes along an axis, to the bit: zeros of both signs differ."""
    if not values.size:  # an axis without points stays an axis
        return values.shape[axis] > 0
    bits = np.ascontiguousarray(values, dtype=float).view(np.int64)
    return bool(np.all(bits == np.take(bits, [0], axis=axis)))


def reduced(names: tuple[str, ...], values: np.ndarray, kept: tuple[str, ...] = ()) -> tuple[tuple[str, ...], np.ndarray]:
    """Without the axes along which nothing changes, but for those to be ``kept``."""
    rest = [axis for axis in range(values.ndim) if names[axis] in kept or not _constant(values, axis)]
    return tuple(names[axis] for axis in rest), values[tuple(slice(None) if axis in rest else 0 for axis in range(values.ndim))]
