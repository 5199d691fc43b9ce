"""A sweep as an xarray Dataset."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..extras import require
from .variables import COMMON, part_of_level


def to_dataset(sweep: Any) -> Any:
    """Dataset of a :class:`hystrip.sweeps.Sweep`. Needs the extra ``dataset``."""
    import hystrip

    xarray = require("xarray", "dataset", "a labelled dataset")
    plan, columns = sweep.plan, sweep.columns
    grid = plan.combine == "grid"
    dims = tuple(axis.name for axis in plan.axes) if grid else ("point",)
    coords: dict[str, Any] = {
        "level": ("level", np.arange(1, plan.levels + 1), {"units": "1", "long_name": "level of the surface"})
    }
    for axis in plan.axes:
        coords[axis.name] = (axis.name if grid else "point", axis.values, {"units": axis.unit, "long_name": f"swept: {axis.key}"})
    variables = {}
    for each in COMMON:
        if each.name not in coords:
            attributes = {"units": each.unit, "long_name": each.long_name}
            variables[each.name] = (dims, np.reshape(columns[each.column], plan.shape), attributes)
    parts = np.stack([np.reshape(columns[part_of_level(i).column], plan.shape) for i in range(1, plan.levels + 1)])
    variables["mu_by_level"] = (("level", *dims), parts, {"units": "1", "long_name": "part of mu that each level adds"})
    reasons = np.array(columns["failed"], dtype=object).reshape(plan.shape)
    variables["failed"] = (dims, reasons, {"units": "", "long_name": "why a point could not be solved, empty if it was"})
    attrs = {"source": f"hystrip {hystrip.__version__}", "hystrip_version": hystrip.__version__, "scene": plan.text,
             "numpy_version": np.__version__, "sweep_fingerprint": plan.fingerprint}  # fmt: skip
    return xarray.Dataset(variables, coords, attrs=attrs)
