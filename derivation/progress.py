"""Reporting how far a derivation is."""

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

Report = Callable[[int, int], None]
Item = TypeVar("Item")


def reported(items: Iterable[Item], report: Report | None, total: int) -> Iterator[Item]:
    """The ``total`` items; ``report``, if any, is called with (done, total) as each is made."""
    for done, item in enumerate(items, start=1):
        if report is not None:
            report(done, total)
        yield item
