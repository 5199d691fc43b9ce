"""Results as named columns of equal length, and as CSV."""

from __future__ import annotations

import csv
import os
from typing import Any

import numpy as np


def friction_rows(scene: Any, result: Any) -> dict[str, np.ndarray]:
    """One row for every combination of load and velocity.

    Parameters
    ----------
    scene : the :class:`hystrip.scene.Scene` that was solved
    result : what its ``solve`` returned

    Returns
    -------
    dict of column name (with its unit) -> array of shape (rows,); the load varies slowest. ``mu of level i`` are the
    parts that add up to mu, ``share of level i`` the same over their sum (nan where there is no friction).
    """
    shape = np.shape(result.tau)
    load_name, load = scene.load
    unit = {"pressure": "Pa", "penetration": "m"}[load_name]
    given = np.broadcast_to(load.reshape(load.shape + (1,) * scene.velocity.ndim), shape)
    tau, mu = np.asarray(result.tau), np.asarray(result.mu)
    parts = np.asarray(result.tau_by_level)
    columns = {
        f"{load_name} [{unit}]": given,
        "velocity [m/s]": np.broadcast_to(scene.velocity, shape),
        "mu": mu,
        "tau [Pa]": tau,
    }
    # mu / tau is 1 / p; where there is no friction the parts of mu are as zero (or as undefined) as mu itself.
    per_tau = np.divide(mu, tau, out=np.zeros(shape), where=tau != 0)
    for number, part in enumerate(parts, start=1):
        columns[f"mu of level {number}"] = np.where(tau != 0, part * per_tau, mu)
    for number, part in enumerate(parts, start=1):
        columns[f"share of level {number}"] = np.divide(part, tau, out=np.full(shape, np.nan), where=tau != 0)
    columns["contact fraction"] = result.contact_fraction
    columns["error estimate of mu"] = result.error_estimate
    return {name: np.array(values, dtype=float).reshape(-1) for name, values in columns.items()}


def write_csv(path: str | os.PathLike[str], columns: dict[str, np.ndarray]) -> None:
    """Write columns under a heading row; every number has all its digits, an undefined one is empty."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for row in zip(*(values.tolist() for values in columns.values()), strict=True):
            writer.writerow("" if value != value else repr(value) for value in row)
