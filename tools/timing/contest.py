"""One measurement after another, each in a process of its own: what does not end in time is given up, what has ended is kept."""

from __future__ import annotations

import csv
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import astuple, fields
from pathlib import Path

import numpy as np

from hystrip.files import Outputs

from .scene import Contestant, Row, Scene

COLUMNS = tuple(field.name for field in fields(Row))
#: short runs are repeated so often, or so many seconds long
_REPEATS, _SECONDS = 31, 1.0
#: processor time of a first run above which imports and caches don't count
_LONG = 2.0


def measure(scene: Scene, contestant: Contestant, exact: np.ndarray | None) -> Row:
    """Median processor time and largest error; ``exact``: frictions at the points looked at."""
    index = scene.spread(contestant.points)
    p, V = scene.pressure[index], scene.velocity[index]
    seconds, results = _timed(lambda: [contestant.work(scene, a, p, V) for a in scene.adhesions])
    error = np.nan
    if exact is not None:
        looked_at = scene.spread(scene.looked_at)
        tau = np.array([tau for tau, _, _ in results])[:, np.isin(index, looked_at)]
        exact = exact[:, np.isin(looked_at, index)]
        error = float(np.max(np.abs(tau - exact) / (np.abs(exact) + scene.scale())))
    strips, failures = (sum(result[i] for result in results) for i in (1, 2))
    solved = index.size * len(scene.adhesions)
    scaled = seconds * scene.points / solved
    return Row(scene.name, contestant.method, contestant.setting, scene.points, solved, scaled, error, int(strips), int(failures))


def _timed(work: Callable):
    """Median processor time of repeated runs after the first (of the first, if it is long), and the result.

    Of this thread, the only one that works: under a limit of processor time the clock of the process moves in steps of some
    milliseconds.
    """
    start = time.thread_time()
    result = work()
    spent = [time.thread_time() - start]
    if spent[0] < _LONG:
        spent.clear()
        while len(spent) < _REPEATS and (len(spent) < 3 or sum(spent) < _SECONDS):
            start = time.thread_time()
            result = work()
            spent.append(time.thread_time() - start)
    return float(np.median(spent)), result


def run(scenes: list[Scene], out: Path, options: list[str], limit: float, report: Callable[[str], None]) -> list[Row]:
    """All rows: those that ``out`` (CSV) has, and the others measured in child processes with ``options`` and added to it one by
    one.

    A row that takes more than ``limit`` seconds of processor time has NaN for its time and error, and so have the settings of
    that method that follow, dearer ones; a scene whose reference takes more has no errors.
    """
    rows = read(out)
    for scene in scenes:
        done = {(row.scene, row.method, row.setting) for row in rows}
        missing = [c for c in scene.contestants if (scene.name, c.method, c.setting) not in done]
        exact = out.with_name(f"{out.stem}-reference-{''.join(c if c.isalnum() else '-' for c in scene.name)}.npy")
        if missing and scene.reference is not None and not exact.exists():
            report(f"{scene.name}: reference")
            _child(["--scene", scene.name, "--reference", str(exact), *options], limit)
        for c in missing:
            if any(row.scene == scene.name and row.method == c.method and not np.isfinite(row.seconds) for row in rows):
                rows.append(_given_up(scene, c))
                continue
            report(f"{scene.name}: {c.method}, {c.setting}")
            known = ["--reference", str(exact)] if exact.exists() else []
            text = _child(["--scene", scene.name, "--row", f"{c.method}, {c.setting}", *known, *options], limit)
            rows.append(_row(text.split("\t")) if text else _given_up(scene, c))
            write(rows, out)
    return rows


def _given_up(scene: Scene, c: Contestant) -> Row:
    return Row(scene.name, c.method, c.setting, scene.points, 0, np.nan, np.nan)


def _child(arguments: list[str], limit: float) -> str | None:
    """Last line that the command prints, or None if it was not done within the processor time. Whatever else goes wrong there is
    raised."""
    command = [sys.executable, str(Path(__file__).resolve().parent.parent / "benchmark.py"), *arguments, "--limit", str(limit)]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if done.returncode == -signal.SIGXCPU:
        return None
    done.check_returncode()
    return done.stdout.splitlines()[-1] if done.stdout else ""


def line(row: Row) -> str:
    """As the parent process reads it."""
    return "\t".join(map(str, astuple(row)))


def _row(cells: list[str]) -> Row:
    kinds = (str, str, str, int, int, float, float, int, int)
    return Row(*(kind(cell) for kind, cell in zip(kinds, cells, strict=True)))


def read(path: Path) -> list[Row]:
    """Rows of an earlier run; none if there was none."""
    if not path.exists():
        return []
    with open(path, newline="") as file:
        return [_row(cells) for cells in list(csv.reader(file))[1:]]


def write(rows: list[Row], path: Path) -> None:
    """All rows as CSV, in one stroke."""
    with Outputs(path.parent) as outputs, open(outputs.path(path.name), "w", newline="") as file:
        csv.writer(file).writerows([COLUMNS, *map(astuple, rows)])
