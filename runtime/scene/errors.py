"""What is wrong with a scene, in one sentence."""

import contextlib
import difflib
from collections.abc import Iterable, Iterator
from typing import Any

from ..errors import InputError, printable, shown


class SceneError(InputError):
    """A scene that cannot be used. Names the file, the key, its value and what is allowed.

    Parameters
    ----------
    field : dotted key, e.g. ``"levels[1].h"``; empty for the file as a whole
    value : what stands there
    allowed : what may stand there
    problem : says what is wrong where "got ...; allowed: ..." would not do
    source : the file's name
    """

    def __init__(self, field: str, value: Any, allowed: str, problem: str = "", source: str = ""):
        super().__init__(field, value, allowed)
        self.problem, self.source = problem, source

    def __str__(self) -> str:
        said = printable(self.problem, 300) or f"got {shown(self.value)}"
        parts = [part for part in (printable(self.source, 300), printable(self.field, 200), said) if part]
        return ": ".join(parts) + (f"; allowed: {printable(self.allowed)}" if self.allowed else "")

    def __reduce__(self):
        return type(self), (self.field, self.value, self.allowed, self.problem, self.source)


@contextlib.contextmanager
def located(source: str) -> Iterator[None]:
    """Add the file's name to every input error that leaves the block."""
    try:
        yield
    except InputError as error:
        raise SceneError(error.field, error.value, error.allowed, getattr(error, "problem", ""), source) from None


def nearest(name: str, valid: Iterable[str]) -> str | None:
    """The valid name most like `name`, or None if none resembles it. Differences of case count little."""
    if len(name) > 100:  # no slip of the hand, and comparing takes as long as it is
        return None
    by_folded = {each.casefold(): each for each in valid}
    found = difflib.get_close_matches(name.casefold(), by_folded, n=1, cutoff=0.5)
    return by_folded[found[0]] if found else None
