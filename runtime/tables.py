"""Results as named columns of equal length, and as CSV."""

from __future__ import annotations

import csv
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .result import Result

LOAD_UNITS = {"pressure": "Pa", "penetration": "m"}


def parts_of_mu(result: Any) -> np.ndarray:
    """What every level adds to mu, shape (levels, ...). Where there is no friction the parts are as zero (or undefined) as mu."""
    tau, mu, parts = (np.asarray(each) for each in (result.tau, result.mu, result.tau_by_level))
    per_tau = np.divide(mu, tau, out=np.zeros(tau.shape), where=tau != 0)
    return np.where(tau != 0, parts * per_tau + 0.0, mu)


def shares(result: Any) -> np.ndarray:
    """Every level's part of tau over tau, shape (levels, ...); NaN where there is no friction."""
    parts = np.asarray(result.tau_by_level)
    return np.divide(parts, result.tau, out=np.full(parts.shape, np.nan), where=np.asarray(result.tau) != 0)


def friction_rows(result: Any) -> dict[str, np.ndarray]:
    """One row for every point of a result, in its order.

    Parameters
    ----------
    result : a :class:`hystrip.Result`

    Returns
    -------
    dict of column name (with its unit) -> array of shape (points,). ``mu of level i`` are the parts that add up to mu,
    ``share of level i`` the same over their sum (nan where there is no friction).
    """
    name = result.load
    columns = {
        f"{name} [{LOAD_UNITS[name]}]": getattr(result, name),
        "velocity [m/s]": result.velocity,
        "mu": result.mu,
        "tau [Pa]": result.tau,
    }
    for number, part in enumerate(parts_of_mu(result), start=1):
        columns[f"mu of level {number}"] = part
    for number, part in enumerate(shares(result), start=1):
        columns[f"share of level {number}"] = part
    columns["contact fraction"] = result.contact_fraction
    columns["pulled off"] = result.pulled_off
    columns["error estimate of mu"] = result.error_estimate
    columns["converged"] = result.converged
    return {name: np.array(values).reshape(-1) for name, values in columns.items()}


def write_csv(path: str | os.PathLike[str], columns: dict[str, Sequence[Any]], about: Sequence[str] = ()) -> None:
    """Write columns under a heading row; every number has all its digits, an undefined one is empty.

    ``about``: lines that stand above the heading, each behind ``# `` (``pandas.read_csv(path, comment="#")`` skips them).
    """
    # a file's name, which may stand in a line, need not be text that can be encoded
    with open(path, "w", encoding="utf-8", errors="backslashreplace", newline="") as file:
        file.writelines(f"# {line}\n" for text in about for line in text.splitlines())
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        lists = (values.tolist() if isinstance(values, np.ndarray) else values for values in columns.values())
        for row in zip(*lists, strict=True):
            writer.writerow(cell(value) for value in row)


def about_version() -> list[str]:
    """What wrote a table, and the units in it."""
    from ._version import __version__

    return [f"hystrip {__version__}", "units: SI, in brackets in the headings; what has none is a number"]


def about_result(result: Result, scene: str = "") -> list[str]:
    """Lines above the table of a result: version, units, scene, inputs, tolerance."""
    from .inputs.as_json import adhesion_text, levels_text, material_text

    return [
        *about_version(),
        *([f"scene: {scene}"] if scene else []),
        f"material: {material_text(result.material)}",
        *([] if result.temperature is None else [f"temperature: {result.temperature:g} K, at which the material is given"]),
        f"adhesion: {adhesion_text(result.adhesion)}",
        f"levels: {levels_text(result.levels)}",
        f"edge {result.edge}, branch {result.branch}, rtol {result.rtol:g}{over_strips(result.strips)}",
    ]


def over_strips(strips: int | None) -> str:
    """What to say behind the tolerance where level 1 was averaged over equal strips."""
    return "" if strips is None else f", level 1 over {strips} equal strips"


def cell(value: Any) -> str:
    """A value as CSV text: numbers with all their digits, empty where undefined."""
    return value if isinstance(value, str) else "" if value != value else repr(value)
