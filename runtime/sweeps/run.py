"""Running a sweep: batches out, results to disk as they come, one table at the end."""

from __future__ import annotations

import contextlib
import os
import warnings
from collections.abc import Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Executor, Future, wait
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ..errors import ConvergenceWarning, HystripError, InputError
from ..files import path_of, refuse_unwritable
from ..inputs.checks import truth
from ..origins import outputs_from, refuse_other_origin
from ..scene.load import quantities
from ..tables import about_version, over_strips, write_csv
from .batch import OTHER_CODE, Batch, Task, solve_batch
from .code import code_key, fresh_code_key
from .executors import check_workers, dask, give_up, local, lost
from .notes import notes_of
from .plan import Plan, check_combination, plan_of
from .sizing import blocks, first_size, next_size
from .store import Store
from .variables import table, variables

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame
    from xarray import Dataset

    from ..typing import Numbers, Progress


@dataclass(frozen=True, eq=False, repr=False)
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

    def __repr__(self) -> str:
        from ..display import as_text, of_sweep

        return as_text(of_sweep(self))

    def _repr_html_(self) -> str:
        from ..display import as_html, of_sweep

        return as_html(of_sweep(self))

    @property
    def failed(self) -> dict[int, str]:
        """Reasons of the points that could not be solved."""
        return {row: reason for row, reason in enumerate(self.columns["failed"]) if reason}

    @property
    def notes(self) -> list[str]:
        """What about the inputs may be beyond the model or the material, one sentence of each kind with the first row of those
        looked at; mostly none."""
        return notes_of(self.plan)

    def plot(self) -> Figure:
        """A matplotlib Figure of friction and real contact over the swept quantity of most values. Needs the extra ``plot``."""
        from ..plots.sweep import over_swept

        return over_swept(self)

    def to_dataset(self) -> Dataset:
        """The sweep as an xarray Dataset: one dimension for every swept quantity of a grid, ``point`` for a list."""
        from .dataset import to_dataset

        return to_dataset(self)

    def to_dataframe(self) -> DataFrame:
        """The sweep as a pandas DataFrame: the table of the CSV file. Needs the extra ``dataset``, which brings pandas."""
        from ..extras import require

        frame: DataFrame = require("pandas", "dataset", "a data frame").DataFrame(self.columns)
        return frame

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the sweep as netCDF; ``hystrip.load(path)`` gives it back, equal to the bit. Returns the path.

        Needs the extra ``dataset``.
        """
        from ..files import save

        return save(self.to_dataset(), path)


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
    batch : points solved and stored together; the scene's ``[sweep]`` if None, and if it does not say as many as take a
        few seconds. That is counted, not timed: the same points are solved together wherever and whenever the sweep runs
    workers : local processes, 1 for this one; or executor : anything with the ``concurrent.futures`` interface, such as
        Dask's ``Client.get_executor()``; or scheduler : address of a Dask scheduler
    restart : delete what an earlier sweep left in the folder
    allow_solver : run the code of a solver that the scene names; without it such a scene is refused
    progress : called with the number of points done and the total

    Raises
    ------
    InputError : the scene or an argument; a single point that fails is recorded, it raises nothing
    HystripError : another run is at work in the folder, or the workers were lost; finished batches are kept

    Warns
    -----
    ConvergenceWarning : points whose estimated error exceeds what ``rtol`` allows; the column ``converged`` is 0 there

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     done = sweep("paper_fig7", over={"adhesion.gamma": [0, 1e-5]}, out=folder)
    ...     again = sweep("paper_fig7", over={"adhesion.gamma": [0, 1e-5]}, out=folder)
    >>> done.plan.shape, done.solved, again.solved, again.kept
    ((2, 141), 18, 0, 18)
    """
    from ..scene.errors import located
    from ..scene.load import resolve_solver, scene_text
    from ..scene.toml import parse_toml
    from ..scene.validate import validated

    if over is not None and not isinstance(over, Mapping):
        raise InputError("over", over, "a dict of dotted key of the scene -> values in SI")
    if scheduler is not None and not (isinstance(scheduler, str) and scheduler):
        raise InputError("scheduler", scheduler, "the address of a Dask scheduler, such as 'tcp://host:8786'")
    check_combination("grid" if combine is None else combine, batch)  # arguments, not keys of the scene
    restart, allow_solver = truth("restart", restart), truth("allow_solver", allow_solver)
    if progress is not None and not callable(progress):
        raise InputError("progress", progress, "a function of the points done and their total")
    text, name = scene_text(scene)
    with located(os.fspath(scene)):
        values = validated(parse_toml(text))
        resolve_solver(values, os.fspath(scene), allow_solver)
    with located(os.fspath(scene)) if not over else contextlib.nullcontext():
        plan = plan_of(values, name, text, dict(over or {}), combine, batch)
    folder, done = path_of(out, "out", "a folder"), f"{name}.sweep.csv"
    refuse_unwritable(folder, "out")
    refuse_other_origin(folder, [done], scene)
    if executor is not None and not hasattr(executor, "submit"):
        raise InputError("executor", executor, "anything with the concurrent.futures interface")
    workers = check_workers(workers)
    if sum((workers != 1, executor is not None, scheduler is not None)) > 1:
        raise InputError("workers, executor, scheduler", (workers, executor, scheduler), "one of them")
    where = contextlib.nullcontext((executor, 64)) if executor is not None else dask(scheduler) if scheduler else local(workers)
    about = {"name": name, "points": plan.size, "scene": text}
    store = Store(folder / f"{name}.parts", plan.fingerprint, about)
    with where as (runs_on, in_flight), store.open(restart):
        run = _Run(plan, store, progress)
        run.all(runs_on, in_flight)
        columns = _collected(plan, store)
        with outputs_from(scene, folder, [done]) as files:
            write_csv(files.path(done), columns, _about(plan))
    _warn_of_missed(columns["converged"], plan)
    return Sweep(columns, folder / done, plan, run.solved, run.kept)


def _warn_of_missed(converged: np.ndarray, plan: Plan) -> None:
    missed = np.flatnonzero(converged == 0)
    if missed.size and plan.base["strips"] is None:
        text = f"{missed.size} of {plan.size} points did not converge to rtol = {plan.base['rtol']:g}; the first: row {missed[0]}"
        warnings.warn(f"{text} (see the columns 'converged' and 'error estimate of mu')", ConvergenceWarning, stacklevel=3)


class _Block:
    """Points that are solved in batches one after the other."""

    def __init__(self, points: range, size: int):
        self.at, self.end, self.size = points.start, points.stop, min(size, len(points))

    def advance(self, plan: Plan, batch: Batch) -> bool:
        """Go on behind a batch; False at the end."""
        self.at += batch.points
        self.size = min(next_size(plan, batch.points, batch.work), self.end - self.at)
        return self.at < self.end


class _Run:
    """The work of one call: what is on disk is kept, what is missing is solved."""

    def __init__(self, plan: Plan, store: Store, progress: Progress | None):
        self.plan, self.store, self.progress = plan, store, progress
        self.solved = self.kept = self.done = 0

    def all(self, executor: Executor, in_flight: int) -> None:
        """Solve what is missing, with so many batches in flight."""
        waiting = filter(self._missing, (_Block(points, first_size(self.plan)) for points in blocks(self.plan)))
        running: dict[Future, _Block] = {}
        if self.progress:
            self.progress(0, self.plan.size)
        ready: list[_Block] = []  # blocks whose next batch follows from one that is finished
        try:
            while True:
                while len(running) < in_flight and (block := ready.pop() if ready else next(waiting, None)):
                    running[executor.submit(solve_batch, self._task(block))] = block
                if not running:
                    break
                # what is finished goes to disk before another batch's failure ends the run
                for future in sorted(wait(running, return_when=FIRST_COMPLETED).done, key=_failed):
                    block, batch = running.pop(future), _solved(future.result())
                    self.store.write(batch)
                    self.solved += 1
                    self._count(batch)
                    if block.advance(self.plan, batch) and self._missing(block):
                        ready.append(block)
        except (BrokenExecutor, CancelledError) as error:
            raise HystripError(lost(f"the workers are gone ({str(error) or type(error).__name__})")) from None
        finally:
            give_up(executor, running)
        if fresh_code_key() != code_key():
            raise HystripError("the installed hystrip changed while the sweep ran: run the sweep with restart=True (--restart)")

    def _missing(self, block: _Block) -> bool:
        """Go on to the first batch of a block that is not on disk; False if all are."""
        while (stored := self.store.read(block.at, block.size)) is not None:
            self.kept += 1
            self._count(stored)
            if not block.advance(self.plan, stored):
                return False
        return True

    def _count(self, batch: Batch) -> None:
        self.done += batch.points
        if self.progress:
            self.progress(self.done, self.plan.size)

    def _task(self, block: _Block) -> Task:
        keys = tuple(axis.key for axis in self.plan.axes)
        coordinates = self.plan.coordinates(np.arange(block.at, block.at + block.size))
        return Task(block.at, self.plan.solved, keys, coordinates, code_key(), self.plan.solver)


def _failed(future: Future) -> bool:
    return future.cancelled() or future.exception() is not None


def _solved(batch: Any) -> Batch:
    """What a worker returned. A worker too old to say by which code it is is refused."""
    if getattr(batch, "code", None) != code_key():
        raise HystripError(OTHER_CODE)
    return batch


def _about(plan: Plan) -> list[str]:
    """Lines above the table: version, units, scene, inputs that are not swept, tolerance."""
    base, swept = plan.base, [axis.key for axis in plan.axes]
    fixed = ", ".join(f"{key} = {float(each)!r}" for key, each in quantities(base) if key not in swept)
    asked = f"edge {base['edge']}, branch {base['branch']}, rtol {base['rtol']:g}{over_strips(base['strips'])}"
    scene = f"scene: {base['title'] or plan.name}; over {', '.join(swept)}"
    return [*about_version(), scene, f"fixed: {fixed}", asked]


def _collected(plan: Plan, store: Store) -> dict[str, Any]:
    """All batches as one table."""
    stored = [*_all_batches(plan, store)]
    store.require_ours()
    failed = [""] * plan.size
    for batch in stored:
        for row, reason in batch.failed.items():
            failed[batch.first + row] = reason
    values = {each.column: np.concatenate([batch.columns[each.column] for batch in stored]) for each in variables(plan.levels)}
    return table(plan, values, failed)


def _all_batches(plan: Plan, store: Store) -> Iterator[Batch]:
    for points in blocks(plan):
        block = _Block(points, first_size(plan))
        while True:
            batch = store.read(block.at, block.size)
            if batch is None:
                store.require_ours()
                raise HystripError(f"{store.path(block.at)} vanished while the sweep ran: run it again")
            yield batch
            if not block.advance(plan, batch):
                break
