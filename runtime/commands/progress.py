"""How far the work is: a bar on a terminal, a line now and then elsewhere."""

import contextlib
import sys
from collections.abc import Callable, Iterator
from time import monotonic

from ..errors import printable

Report = Callable[[int, int], None]
#: seconds until the first line, and between lines: work of a moment says nothing, a log of a night stays readable
_FIRST, _BETWEEN = 5.0, 10.0


@contextlib.contextmanager
def progress(title: str, rate: bool = False) -> Iterator[Report]:
    """Yield a function to call with (done, total): it moves a bar, or writes lines to standard error where no person watches.

    ``rate``: show how many a second.
    """
    title = printable(title)
    if not sys.stderr.isatty():
        yield _lines(title)
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


def _lines(title: str) -> Report:
    start = monotonic()
    due = start + _FIRST

    def report(done: int, total: int) -> None:
        nonlocal due
        now = monotonic()
        if now >= due and done < total:
            print(f"hystrip: {title}: {done} of {total}, after {now - start:.0f} s", file=sys.stderr, flush=True)
            due = now + _BETWEEN

    return report


def _rate_column(bars):
    from rich.text import Text

    class Rate(bars.ProgressColumn):
        def render(self, task):
            speed = task.finished_speed or task.speed
            return Text(f"{speed:.3g}/s" if speed else "")

    return Rate()
