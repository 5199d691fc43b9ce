"""Reporting how far a derivation is."""

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

SHARES = 40  # in which the certificates of a model are reported; its derivation is one
Report = Callable[[int, int], None]
Item = TypeVar("Item")


class Progress:
    """Counts what is done for a caller that wants (done, total)."""

    def __init__(self, report: Report | None, total: int):
        self._report, self._done, self._total = report, 0, total

    def __call__(self) -> None:
        self._done += 1
        if self._report is not None:
            self._report(self._done, self._total)

    def each(self, items: Iterable[Item]) -> Iterator[Item]:
        """The items, reported one by one as they are made."""
        for item in items:
            self()
            yield item

    def counted(self, items: Iterable[Item], count: int) -> Iterator[Item]:
        """The ``count`` items, reported in so many shares as they are made."""
        reported = 0
        for number, item in enumerate(items, start=1):
            yield item
            while reported < number * SHARES // count:
                self()
                reported += 1
