"""Solving one batch: what runs on a worker."""

import warnings
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import ConvergenceWarning, HystripError
from ..loading import solver_key
from .code import code_key
from .plan import RUN_KEYS, single
from .sizing import work_of
from .variables import variables


@dataclass(frozen=True)
class Task:
    """A batch as it travels to a worker.

    ``first``: its first point; ``base``: the scene; ``keys``: what is swept; ``coordinates``: their values at the batch's
    points, (n, keys); ``code``, ``solver``: keys of the code that has to solve it.
    """

    first: int
    base: dict[str, Any]
    keys: tuple[str, ...]
    coordinates: np.ndarray
    code: str
    solver: str


@dataclass(frozen=True)
class Batch:
    """A solved batch.

    ``columns``: values of every variable at its points, (n,), NaN where a point failed; ``failed``: the reasons of those, by
    place in the batch; ``work``: what it took, in the unit of ``sizing.work_of``; ``code``: key of the code that solved it.
    """

    first: int
    points: int
    columns: dict[str, np.ndarray]
    failed: dict[int, str] = field(default_factory=dict)
    work: float = 0.0
    code: str = ""


def solve_batch(task: Task) -> Batch:
    """Solve every point of a batch; one that fails is recorded with its reason.

    What is solved together is decided by the batch alone, so the numbers do not depend on where or when it is solved.

    Raises ``HystripError`` on a worker whose hystrip is another, and for a solver's folder that has changed since.
    """
    if code_key() != task.code:
        raise HystripError(OTHER_CODE)
    _refuse_changed_solver(task)
    points = len(task.coordinates)
    columns = {each.column: np.full(points, np.nan) for each in variables(len(task.base["levels"]))}
    failed: dict[int, str] = {}
    fixed = [i for i, key in enumerate(task.keys) if key not in RUN_KEYS]
    at, work = task.coordinates[:, fixed], 0.0
    # not by np.unique: where Ctrl-C meets its comparison of rows it ends in a TypeError
    order = np.lexsort(at.T[::-1]) if fixed else np.arange(points)
    changes = np.flatnonzero((np.diff(at[order], axis=0) != 0).any(axis=1)) + 1
    for rows in np.split(order, changes):
        work += _solve(task, at[rows[0]], fixed, rows, columns, failed)
    _refuse_changed_solver(task)
    return Batch(task.first, points, columns, failed, work, task.code)


OTHER_CODE = "a worker has another hystrip than this process: install the same version there; finished batches are kept"


def _refuse_changed_solver(task: Task) -> None:
    folder = task.base["material"]["solver"]
    if solver_key(folder) != task.solver:
        changed = f"material.solver: the code in {folder} changed while the sweep ran"
        raise HystripError(f"{changed}: put it back, or run the sweep with restart=True (--restart)")


def _solve(
    task: Task, at: np.ndarray, fixed: list[int], rows: np.ndarray, columns: dict[str, np.ndarray], failed: dict[int, str]
) -> float:
    """Solve the points ``rows``, which share everything but load and velocity; halve them until a failing one is alone.

    Returns the work done.
    """
    try:
        with warnings.catch_warnings():  # kept as a variable, and said once for the sweep
            warnings.simplefilter("ignore", ConvergenceWarning)
            result = _result(task, at, fixed, rows)
        found = {each.column: each.of(result) for each in variables(len(task.base["levels"]))}
    except Exception as error:  # whatever it is: one point must not cost a night's sweep
        if rows.size == 1:
            failed[int(rows[0])] = " ".join(f"{type(error).__name__}: {error}".split())
            return work_of(None)
        return work_of(None) + sum(_solve(task, at, fixed, half, columns, failed) for half in np.array_split(rows, 2))
    for column, values in found.items():
        columns[column][rows] = values
    return work_of(result)


def _result(task: Task, at: np.ndarray, fixed: list[int], rows: np.ndarray) -> Any:
    import hystrip

    base = task.base
    objects = single(base, [task.keys[i] for i in fixed], at)
    run = {key: np.broadcast_to(base[key], rows.size) for key in RUN_KEYS if base[key] is not None and key not in task.keys}
    run |= {key: task.coordinates[rows, i] for i, key in enumerate(task.keys) if key in RUN_KEYS}
    options = {key: base[key] for key in ("edge", "branch", "rtol", "strips")}
    return hystrip.solve(objects["material"], objects["adhesion"], objects["levels"], **run, **options)
