"""Results as xarray Datasets: labelled dimensions, units and long names; inputs and versions in the attributes."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from .extras import require
from .orbit.materials import parameters
from .tables import parts_of_mu

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
    "closed_form": ("1", "solved by the closed form of saturated contact on all levels"),
    "error_estimate": ("1", "estimated absolute error of the friction coefficient"),
    "tau_error": ("Pa", "estimated absolute error of the friction stress"),
    "level": ("1", "level of the surface, 1 the largest"),
    "wavelength": ("m", "wavelength of the level"),
    "height": ("m", "height of the level"),
}
_BY_LEVEL = ("tau_by_level", "mu_by_level", "contact_by_level", "adhesion_by_level")
_PLAIN = (
    "mu", "tau", "contact_fraction", "pulled_off", "p_sat", "closed_form", "error_estimate", "tau_error",
)  # fmt: skip


def to_dataset(result: Any) -> Any:
    """Dataset of a :class:`hystrip.Result`.

    Dimensions: ``level``, and for every axis of the result what changes along it, ``velocity``, ``pressure`` or
    ``penetration``; ``point`` where several change together. Needs the extra ``dataset``.
    """
    xarray = require("xarray", "dataset", "a labelled dataset")
    names = axis_names(result)
    coords: dict[str, Any] = {"level": _labelled("level", ("level",), np.arange(1, len(result.levels) + 1))}
    coords["wavelength"] = _labelled("wavelength", ("level",), np.array([level.l for level in result.levels]))
    coords["height"] = _labelled("height", ("level",), np.array([level.h for level in result.levels]))
    variables = {name: _labelled(name, names, getattr(result, name)) for name in _PLAIN}
    by_level = {**{name: getattr(result, name, None) for name in _BY_LEVEL}, "mu_by_level": parts_of_mu(result)}
    variables |= {name: _labelled(name, ("level", *names), by_level[name]) for name in _BY_LEVEL}
    for name in ("velocity", "pressure", "penetration"):
        values = np.asarray(getattr(result, name))
        if name in names:
            axis = names.index(name)
            along = values[tuple(slice(None) if i == axis else 0 for i in range(values.ndim))]
            coords[name] = _labelled(name, (name,), along)
        elif name in ("velocity", result.load):
            coords[name] = _labelled(name, *_reduced(names, values))
        else:
            variables[name] = _labelled(name, names, values)
    return xarray.Dataset(variables, coords, attrs=attributes(result))


def axis_names(result: Any) -> tuple[str, ...]:
    """A name for every axis of the result."""
    shape = np.shape(result.mu)
    inputs = {name: np.asarray(getattr(result, name)) for name in (result.load, "velocity")}
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


def attributes(result: Any) -> dict[str, Any]:
    """Inputs and versions, as what netCDF can hold."""
    import hystrip

    material, adhesion = result.material, result.adhesion
    out = {
        "title": "friction of a multiscale wavy surface on a viscoelastic foundation with adhesion",
        "source": f"hystrip {hystrip.__version__}",
        "hystrip_version": hystrip.__version__,
        "numpy_version": np.__version__,
        "material": json.dumps({"model": type(material).__name__, **parameters(material)}),
        "adhesion": json.dumps({n: getattr(adhesion, n) for n in ("gamma", "p_0", "delta_0")}),
        "levels": json.dumps([{"l": level.l, "h": level.h} for level in result.levels]),
        "edge": result.edge,
        "branch": result.branch,
        "rtol": result.rtol,
        "strips": "adaptive panels" if result.strips is None else result.strips,
        "load": result.load,
        **{name: int(count) for name, count in result.counts.items()},
    }
    if result.scene:
        out["scene"] = result.scene
    return out


def _labelled(name: str, dims: tuple[str, ...], values: Any) -> tuple[tuple[str, ...], np.ndarray, dict[str, str]]:
    unit, long_name = LABELS[name]
    return dims, np.array(values), {"units": unit, "long_name": long_name}


def _constant(values: np.ndarray, axis: int) -> bool:
    if not values.size:  # an axis without points stays an axis
        return values.shape[axis] > 0
    first = np.take(values, [0], axis=axis)
    return bool(np.all((values == first) | (np.isnan(values) & np.isnan(first))))


def _reduced(names: tuple[str, ...], values: np.ndarray) -> tuple[tuple[str, ...], np.ndarray]:
    """Without the axes along which nothing changes."""
    kept = [axis for axis in range(values.ndim) if not _constant(values, axis)]
    return tuple(names[axis] for axis in kept), values[tuple(slice(None) if axis in kept else 0 for axis in range(values.ndim))]
