"""Solving one batch: what runs on a worker."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

_RUN_KEYS = ("pressure", "penetration", "velocity")


@dataclass(frozen=True)
class Task:
    """A batch as it travels to a worker: the scene, the swept keys, their values at the batch's points (n, keys)."""

    number: int
    base: dict[str, Any]
    keys: tuple[str, ...]
    coordinates: np.ndarray


def outputs(levels: int) -> list[str]:
    """Names of the numbers that a point gives, in order."""
    parts = [f"mu of level {i}" for i in range(1, levels + 1)]
    return [
        "mu",
        "tau [Pa]",
        *parts,
        "pressure [Pa]",
        "penetration [m]",
        "contact fraction",
        "pulled off",
        "error estimate of mu",
    ]


def solve_batch(task: Task) -> tuple[np.ndarray, dict[int, str]]:
    """Numbers of every point (n, outputs), NaN where a point failed; and the reasons of those, by place in the batch.

    What is solved together is decided by the batch alone, so the numbers do not depend on where or when it is solved.
    """
    numbers = np.full((len(task.coordinates), len(outputs(len(task.base["levels"])))), np.nan)
    reasons: dict[int, str] = {}
    fixed = [i for i, key in enumerate(task.keys) if key not in _RUN_KEYS]
    cases, case = np.unique(task.coordinates[:, fixed], axis=0, return_inverse=True)
    for number in range(len(cases)):
        _solve(task, cases[number], fixed, np.flatnonzero(case.ravel() == number), numbers, reasons)
    return numbers, reasons


def _solve(task: Task, at: np.ndarray, fixed: list[int], rows: np.ndarray, numbers: np.ndarray, reasons: dict[int, str]) -> None:
    """Solve the points ``rows``, which share everything but load and velocity; halve them until a failing one is alone."""
    try:
        numbers[rows] = _numbers(task, at, fixed, rows)
    except Exception as error:  # whatever it is: one point must not cost a night's sweep
        if rows.size == 1:
            reasons[int(rows[0])] = " ".join(f"{type(error).__name__}: {error}".split())
            return
        for half in np.array_split(rows, 2):
            _solve(task, at, fixed, half, numbers, reasons)


def _numbers(task: Task, at: np.ndarray, fixed: list[int], rows: np.ndarray) -> np.ndarray:
    import hystrip

    from ..tables import parts_of_mu
    from .plan import single

    base = task.base
    objects = single(base, [task.keys[i] for i in fixed], at)
    run = {key: np.broadcast_to(base[key], rows.size) for key in _RUN_KEYS if base[key] is not None and key not in task.keys}
    run |= {key: task.coordinates[rows, i] for i, key in enumerate(task.keys) if key in _RUN_KEYS}
    result = hystrip.solve(
        objects["material"],
        objects["adhesion"],
        objects["levels"],
        **run,
        edge=base["edge"],
        branch=base["branch"],
        rtol=base["rtol"],
        strips=base["strips"],
    )
    return np.column_stack([
        result.mu, result.tau, *parts_of_mu(result), result.pressure, result.penetration, result.contact_fraction,
        result.pulled_off, result.error_estimate,
    ])  # fmt: skip
