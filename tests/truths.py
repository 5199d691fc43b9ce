"""The stored truths (``tools/truths.py``) as arrays, and the library's answers to them."""

import json
from functools import cache
from pathlib import Path

import numpy as np
from scenes import BRANCHES, EDGES

import hystrip

PATH = Path(__file__).parent / "data" / "truths.json"
TEXT = ("kind", "edge", "branch", "sequence", "coexisting")


@cache
def columns() -> dict[str, np.ndarray]:
    """Column name to values of all rows; text columns as objects, absent numbers as NaN."""
    stored = json.loads(PATH.read_text())
    values = zip(*stored["rows"], strict=True)
    return {
        name: np.array(column, object) if name in TEXT else np.array(column, float)  # float turns None into NaN
        for name, column in zip(stored["columns"], values, strict=True)
    }


def solve(index, edge, branch):
    """Solution of the rows ``index``, which all have this closure and branch."""
    t = {name: values[index] for name, values in columns().items()}
    material = hystrip.StandardLinearSolid(1.0, t["T_eps"], t["T_sigma"])
    adhesion = hystrip.Dugdale(p_0=t["p_0"], delta_0=t["delta_0"])
    return hystrip.solve_strip(material, adhesion, l=t["l"], A=1.0, D=t["D"], V=t["V"], edge=edge, branch=branch)


@cache
def answers() -> dict[str, np.ndarray]:
    """The library's answer to every row, in the columns of the truths: all rows of one closure and branch are one batch."""
    t = columns()
    n = t["l"].size
    names = ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction", "a", "b", "c", "d")
    out = {name: np.full(n, np.nan) for name in names} | {"sequence": np.empty(n, object)}
    for edge in EDGES:
        for branch in BRANCHES:
            index = np.flatnonzero((t["edge"] == edge) & (t["branch"] == branch))
            with np.errstate(over="raise", divide="raise", invalid="raise"):
                s = solve(index, edge, branch)
            out["sequence"][index] = s.regime
            for name in names:
                values = getattr(s, name)
                # stored edges are phases k x
                out[name][index] = values * 2 * np.pi / t["l"][index] if name in "abcd" else values
    return out
