"""Running a sweep: batches out, results to disk as they come, one table at the end."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ..errors import HystripError, InputError
from ..files import Outputs, refuse_unwritable
from ..tables import write_csv
from .batch import Task, outputs, solve_batch
from .executors import dask, local, lost
from .plan import Plan, plan_of
from .store import Store

if TYPE_CHECKING:
    from xarray import Dataset

    from ..typing import Numbers, Progress


@dataclass(frozen=True, eq=False)
class Sweep:
    """A finished sweep.

    Attributes
    ----------
    columns : column name (with its unit) -> values, one for every point in the order of the scene; ``failed`` holds the
        reason of a point that could not be solved, and its numbers are NaN
    path : the CSV file; plan : what was swept
    solved, kept : batches solved now, and found finished on disk
    """

    columns: dict[str, Any]
    path: Path
    plan: Plan
    solved: int
    kept: int

    @property
    def failed(self) -> dict[int, str]:
        """Reasons of the points that could not be solved."""
        return {row: reason for row, reason in enumerate(self.columns["failed"]) if reason}

    def to_dataset(self) -> Dataset:
        """The sweep as an xarray Dataset: one dimension for every swept quantity of a grid, ``point`` for a list."""
        from .dataset import to_dataset

        return to_dataset(self)


def sweep(
    scene: str | os.PathLike[str],
    *,
    over: Mapping[str, Numbers] | None = None,
    out: str | os.PathLike[str] = "hystrip-out",
    combine: Literal["grid", "list"] | None = None,
    batch: int | None = None,
    workers: int = 1,
    executor: Executor | None = None,
    scheduler: str | None = None,
    restart: bool = False,
    allow_solver: bool = False,
    progress: Progress | None = None,
) -> Sweep:
    """Solve a scene over all lists and ranges in it. Killed at any moment and called again, it goes on where it was.

    Parameters
    ----------
    scene : path of a scene file or name of a built-in scene; any quantity in it may be a list or a range
    over : further swept quantities, dotted key of the scene -> values in SI, such as
        ``{"adhesion.gamma": [0, 1e-5], "levels[1].h": [5e-8, 1e-7], "material.times[0]": [1e-3, 1e-2]}``
    out : folder for ``<name>.sweep.csv`` and the finished batches (``<name>.parts/``)
    combine : ``"grid"`` (every combination) or ``"list"`` (all of one length, taken together); the scene's ``[sweep]`` if None
    batch : points solved and stored together; the scene's ``[sweep]`` if None, and if it does not say a
        16th of all, from 128 (with one level 512) to 2048
    workers : local processes, 1 for this one; or executor : anything with the ``concurrent.futures`` interface, such as
        Dask's ``Client.get_executor()``; or scheduler : address of a Dask scheduler
    restart : delete what an earlier sweep left in the folder
    allow_solver : run the code of a solver that the scene names; without it such a scene is refused
    progress : called with the number of points done and the total

    Raises
    ------
    InputError : the scene or an argument; a single point that fails is recorded, it raises nothing
    HystripError : another run is at work in the folder, or the workers were lost; finished batches are kept

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     done = sweep("paper_fig7", over={"adhesion.gamma": [0, 1e-5]}, out=folder)
    ...     again = sweep("paper_fig7", over={"adhesion.gamma": [0, 1e-5]}, out=folder)
    >>> done.plan.shape, done.solved, again.solved, again.kept
    ((2, 141), 3, 0, 3)
    """
    from ..scene.load import located, parse_toml, resolve_solver, scene_text
    from ..scene.validate import validated

    text, name = scene_text(scene)
    with located(os.fspath(scene)):
        values = validated(parse_toml(text))
        resolve_solver(values, os.fspath(scene), allow_solver)
    with located(os.fspath(scene)) if not over else contextlib.nullcontext():
        plan = plan_of(values, name, text, dict(over or {}), combine, batch)
    out = Path(out)
    refuse_unwritable(out, "--out")
    if executor is not None and not hasattr(executor, "submit"):
        raise InputError("executor", executor, "anything with the concurrent.futures interface")
    if sum((workers != 1, executor is not None, scheduler is not None)) > 1:
        raise InputError("workers, executor, scheduler", (workers, executor, scheduler), "one of them")
    where = contextlib.nullcontext((executor, 64)) if executor is not None else dask(scheduler) if scheduler else local(workers)
    about = {"name": name, "points": plan.size, "batches": plan.batches, "scene": text}
    store = Store(out / f"{name}.parts", plan.fingerprint, about)
    with where as (runs_on, in_flight), store.open(restart):
        missing = [number for number in range(plan.batches) if store.read(number) is None]
        _run(plan, store, missing, runs_on, in_flight, progress)
        columns = _collected(plan, store)
        with Outputs(out) as files:
            write_csv(files.path(f"{name}.sweep.csv"), columns)
    return Sweep(columns, out / f"{name}.sweep.csv", plan, len(missing), plan.batches - len(missing))


def _run(plan: Plan, store: Store, missing: list[int], executor: Executor, in_flight: int, progress: Any) -> None:
    done = plan.size - sum(plan.points_of(number).size for number in missing)
    tasks = _tasks(plan, missing)
    running: dict[Future, int] = {}
    if progress:
        progress(done, plan.size)
    try:
        while True:
            while len(running) < in_flight and (task := next(tasks, None)) is not None:
                running[executor.submit(solve_batch, task)] = task.number
            if not running:
                return
            # what is finished goes to disk before another batch's failure ends the run
            for future in sorted(wait(running, return_when=FIRST_COMPLETED).done, key=_failed):
                number = running.pop(future)
                store.write(number, *future.result())
                done += plan.points_of(number).size
                if progress:
                    progress(done, plan.size)
    except (BrokenExecutor, CancelledError) as error:
        raise HystripError(lost(f"the workers are gone ({str(error) or type(error).__name__})")) from None
    finally:
        for future in running:
            future.cancel()


def _failed(future: Future) -> bool:
    return future.cancelled() or future.exception() is not None


def _tasks(plan: Plan, missing: list[int]) -> Iterator[Task]:
    keys = tuple(axis.key for axis in plan.axes)
    base = {key: each for key, each in plan.base.items() if key not in ("title", "description", "sweep")}
    for number in missing:
        yield Task(number, base, keys, plan.coordinates(plan.points_of(number)))


def _collected(plan: Plan, store: Store) -> dict[str, Any]:
    """All batches as one table."""
    rows, failed = [], [""] * plan.size
    for number in range(plan.batches):
        stored = store.read(number)
        if stored is None:
            raise HystripError(f"{store.path(number)} vanished while the sweep ran: run it again")
        rows.append(stored[0])
        for row, reason in stored[1].items():
            failed[number * plan.batch + row] = reason
    coordinates = plan.coordinates(np.arange(plan.size))
    columns: dict[str, Any] = {f"{axis.name} [{axis.unit}]": coordinates[:, i] for i, axis in enumerate(plan.axes)}
    numbers = np.concatenate(rows)
    for i, name in enumerate(outputs(plan.levels)):
        columns.setdefault(name, numbers[:, i])
    if "velocity [m/s]" not in columns:
        columns = {"velocity [m/s]": np.full(plan.size, float(plan.base["velocity"])), **columns}
    columns["failed"] = failed
    return columns
