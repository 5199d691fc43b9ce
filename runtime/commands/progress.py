"""A progress bar on a terminal, nothing elsewhere."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator

Report = Callable[[int, int], None]


@contextlib.contextmanager
def progress(title: str, rate: bool = False) -> Iterator[Report | None]:
    """Yield a function to call with (done, total), or None where no person watches standard error.

    ``rate``: show how many a second.
    """
    if not sys.stderr.isatty():
        yield None
        return
    from ..extras import require

    console = require("rich.console", "cli", "the progress bar").Console(stderr=True)
    bars = require("rich.progress", "cli", "the progress bar")
    name = bars.TextColumn("{task.description}", markup=False)
    columns = (name, bars.BarColumn(), bars.MofNCompleteColumn(), bars.TimeRemainingColumn())
    if rate:
        columns = (*columns[:-1], _rate_column(bars), columns[-1])
    with bars.Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task(title, total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def _rate_column(bars):
    from rich.text import Text

    class Rate(bars.ProgressColumn):
        def render(self, task):
            speed = task.finished_speed or task.speed
            return Text(f"{speed:.3g}/s" if speed else "")

    return Rate()
