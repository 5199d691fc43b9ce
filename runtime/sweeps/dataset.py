"""A sweep as an xarray Dataset: the variables and types of a result, over what was swept."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from ..dataset import LABELS, about, reduced
from ..extras import require
from ..scene.load import quantities
from .variables import variables

if TYPE_CHECKING:
    from xarray import Dataset

    from .plan import Plan
    from .run import Sweep


def to_dataset(sweep: Sweep) -> Dataset:
    """Dataset of a :class:`hystrip.Sweep`; a point that failed has NaN, says no, and the reason. Needs the extra ``dataset``."""
    xarray = require("xarray", "dataset", "a labelled dataset")
    plan, columns = sweep.plan, sweep.columns
    grid = plan.combine == "grid"
    dims = tuple(axis.name for axis in plan.axes) if grid else ("point",)
    coords: dict[str, Any] = {"level": ("level", np.arange(1, plan.levels + 1), _label("level"))}
    for name, field in (("wavelength", "l"), ("height", "h")):
        values = np.stack([_over_points(plan, f"levels[{i}].{field}") for i in range(plan.levels)])
        coords[name] = (*reduced(("level", *dims), values, kept=("level",)), _label(name))
    for axis in plan.axes:
        label = {"units": axis.unit, "long_name": f"swept: {axis.key}"}
        coords[axis.name] = (axis.name if grid else "point", axis.values, label)
    found: dict[str, Any] = {}
    by_level: dict[str, list[np.ndarray]] = {}
    for each in variables(plan.levels):
        values = np.reshape(columns[each.column], plan.shape)
        if each.truth:
            values = values == 1
        if each.level:
            by_level.setdefault(each.name, []).append(values)
        elif each.name not in coords:
            found[each.name] = (dims, values, _label(each.name))
    found |= {name: (("level", *dims), np.stack(values), _label(name)) for name, values in by_level.items()}
    if "velocity" not in coords:
        coords["velocity"] = ((), float(plan.base["velocity"]), _label("velocity"))
    reasons = np.array(columns["failed"], dtype=object).reshape(plan.shape)
    found["failed"] = (dims, reasons, {"units": "", "long_name": "why a point could not be solved, empty if it was"})
    attributes = {
        **about("sweep"),
        "scene": plan.text,
        "sweep_fingerprint": plan.fingerprint,
        "edge": plan.base["edge"],
        "branch": plan.base["branch"],
        "rtol": float(plan.base["rtol"]),
        "sweep": json.dumps({
            "name": plan.name, "combine": plan.combine, "batch": plan.batch, "solver": plan.base["material"]["solver"],
            "values": {key: np.asarray(each).tolist() for key, each in quantities(plan.base)},
        }),
    }  # fmt: skip
    return xarray.Dataset(found, coords, attrs=attributes)


def _label(name: str) -> dict[str, str]:
    unit, long_name = LABELS[name]
    return {"units": unit, "long_name": long_name}


def _over_points(plan: Plan, key: str) -> np.ndarray:
    """A quantity of the scene at every point, in the sweep's shape."""
    keys = [axis.key for axis in plan.axes]
    if key in keys:
        return plan.coordinates(np.arange(plan.size))[:, keys.index(key)].reshape(plan.shape)
    return np.full(plan.shape, float(dict(quantities(plan.base))[key]))
