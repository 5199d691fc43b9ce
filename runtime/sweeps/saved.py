"""Sweeps, read back from their datasets."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..errors import InputError
from ..scene.load import parse_toml
from ..scene.validate import validated
from ..sweeps.plan import plan_of
from ..sweeps.run import Sweep
from ..sweeps.variables import table, variables

if TYPE_CHECKING:
    from xarray import Dataset

    from ..loading import Solver


def sweep_of(data: Dataset, path: Path, solver: Solver | None) -> Sweep:
    """The sweep of a dataset that stood in ``path``; no batch of it was solved now.

    Raises InputError where it was solved with a solver of one's own that is not given.
    """
    about = json.loads(data.attrs["sweep"])
    values = validated(parse_toml(data.attrs["scene"]))
    if about["solver"] is not None:
        if solver is None:
            how = f"solver=hystrip.load_solver({about['solver']!r}): the sweep was solved with that code, which would run"
            raise InputError("solver", None, how)
        values["material"]["solver"] = str(solver.folder)
    plan = plan_of(values, about["name"], data.attrs["scene"], about["values"], about["combine"], about["batch"])
    swept = {axis.name for axis in plan.axes}
    found = {}
    for each in variables(plan.levels):
        variable = data[each.name]
        if each.name in swept:  # the load is an axis: its column is that of the axis
            continue
        along = variable.values[each.level - 1] if each.level else variable.values
        found[each.column] = np.array(along, dtype=float).ravel()
    failed = [str(each) for each in data["failed"].values.ravel()]
    for each in variables(plan.levels):
        if each.truth:
            found[each.column][[bool(reason) for reason in failed]] = np.nan
    coordinates = plan.coordinates(np.arange(plan.size))
    axes = {f"{axis.name} [{axis.unit}]": coordinates[:, i] for i, axis in enumerate(plan.axes)}
    velocity = np.full(plan.size, float(data["velocity"])) if "velocity" not in swept else np.empty(0)
    return Sweep(table(axes, found, velocity, failed), path, plan, 0, 0)
