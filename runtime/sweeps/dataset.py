"""A sweep as an xarray Dataset."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..extras import require

_NAMES = {
    "mu": ("mu", "1", "friction coefficient"),
    "tau [Pa]": ("tau", "Pa", "friction stress"),
    "pressure [Pa]": ("pressure", "Pa", "nominal pressure"),
    "penetration [m]": ("penetration", "m", "penetration of level 1"),
    "contact fraction": ("contact_fraction", "1", "real contact: fraction of the nominal area in contact on every level"),
    "pulled off": ("pulled_off", "1", "1 where the pressure lies below pull-off"),
    "error estimate of mu": ("error_estimate", "1", "estimated absolute error of the friction coefficient"),
}


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
    for column, (name, unit, long_name) in _NAMES.items():
        if column in columns and name not in coords:
            variables[name] = (dims, np.reshape(columns[column], plan.shape), {"units": unit, "long_name": long_name})
    parts = np.stack([np.reshape(columns[f"mu of level {i}"], plan.shape) for i in range(1, plan.levels + 1)])
    variables["mu_by_level"] = (("level", *dims), parts, {"units": "1", "long_name": "part of mu that each level adds"})
    reasons = np.array(columns["failed"], dtype=object).reshape(plan.shape)
    variables["failed"] = (dims, reasons, {"units": "", "long_name": "why a point could not be solved, empty if it was"})
    attrs = {"source": f"hystrip {hystrip.__version__}", "hystrip_version": hystrip.__version__, "scene": plan.text,
             "numpy_version": np.__version__, "sweep_fingerprint": plan.fingerprint}  # fmt: skip
    return xarray.Dataset(variables, coords, attrs=attrs)
