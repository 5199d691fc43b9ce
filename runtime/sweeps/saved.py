"""Sweeps, read back from their datasets."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..dataset import check_levels_of
from ..errors import InputError
from ..scene.load import parse_toml
from ..scene.validate import validated
from .plan import plan_of
from .run import Sweep
from .variables import table, variables

if TYPE_CHECKING:
    from xarray import Dataset

    from ..loading import Solver


def sweep_of(data: Dataset, path: Path, solver: Solver | None) -> Sweep:
    """The sweep of a dataset that stood in ``path``; no batch of it was solved now.

    Raises InputError where it was solved with a solver of one's own that is not given, ValueError for a part of a sweep.
    """
    about = json.loads(data.attrs["sweep"])
    values = validated(parse_toml(data.attrs["scene"]))
    if about["solver"] is not None:
        if solver is None:
            how = f"solver=hystrip.load_solver({about['solver']!r}): the sweep was solved with that code, which would run"
            raise InputError("solver", None, how)
        values["material"]["solver"] = str(solver.folder)
    plan = plan_of(values, about["name"], data.attrs["scene"], about["values"], about["combine"], about["batch"])
    swept = {axis.name: axis.values for axis in plan.axes}
    check_levels_of(data, plan.levels)
    for name, each in swept.items():
        if not np.array_equal(data[name], each):
            raise ValueError(f"it has not all values of {name} that were swept, in their order")
    data = data.transpose("level", *(swept if plan.combine == "grid" else ("point",)))
    failed = [str(each) for each in data["failed"].values.ravel()]
    found = {}
    for each in variables(plan.levels):
        if each.name in swept:  # the load is an axis: its column is that of the axis
            continue
        values = data[each.name].values
        found[each.column] = np.array(values[each.level - 1] if each.level else values, dtype=float).ravel()
        if each.truth:
            found[each.column][[bool(reason) for reason in failed]] = np.nan
    return Sweep(table(plan, found, failed), path, plan, 0, 0)
