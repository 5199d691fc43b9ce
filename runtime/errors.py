"""The errors that hystrip raises on purpose, and its warnings."""

import itertools
from typing import Any


class HystripError(Exception):
    """Base of every error that hystrip raises on purpose."""


class InputError(HystripError, ValueError):
    """An input that cannot be used. Its message names the field, the value and what is allowed.

    Parameters
    ----------
    field : name of the argument or scene key, e.g. ``"material.T_sigma"``
    value : what was given
    allowed : what may be given, in words, e.g. ``"a finite number >= 0 (s)"``
    """

    def __init__(self, field: str, value: Any, allowed: str):
        self.field, self.value, self.allowed = field, value, allowed
        super().__init__(f"{printable(field, 200)}: got {shown(value)}; allowed: {printable(allowed)}")

    def __reduce__(self):
        # Exceptions travel between processes in sweeps; the default would rebuild this one from its message alone.
        return type(self), (self.field, self.value, self.allowed)


class SolverError(HystripError, RuntimeError):
    """No solution passed its own checks. The message names the strip; no number is returned in its place."""


class ConvergenceWarning(UserWarning):
    """Points that came back without the accuracy asked for. The message names the first of them and the reason."""


class MissingExtra(HystripError, ImportError):
    """An optional dependency is not installed. The message names the extra that brings it."""


def shown(value: Any, limit: int = 80) -> str:
    """``repr`` of a value, cut to a length that fits into a one-line message; a large value is cut before it is written out."""
    return _cut(" ".join(_written(value, limit).split()), limit)


def printable(text: str, limit: int = 1000) -> str:
    """Text of one line as a terminal may have it: what would steer the terminal is written as an escape such as ``\\x1b``."""
    if not text.isprintable():
        text = "".join(each if each.isprintable() else repr(each)[1:-1] for each in text)
    return _cut(text, limit)


def _cut(text: str, limit: int) -> str:
    return text if len(text) <= limit else text[: limit - 3] + "..."


def _written(value: Any, limit: int, depth: int = 6) -> str:
    """``repr``, of no more than could be shown."""
    if isinstance(value, (str, bytes)) and len(value) > limit:
        return repr(value[:limit])[:-1] + "..."
    if isinstance(value, (list, tuple, dict)) and len(value) > 0:
        if not depth:
            return "..."
        each = list(itertools.islice(value.items() if type(value) is dict else value, limit))
        if type(value) is dict:
            return "{" + ", ".join(f"{_written(k, limit, depth - 1)}: {_written(v, limit, depth - 1)}" for k, v in each) + "}"
        if type(value) in (list, tuple):
            inner = ", ".join(_written(part, limit, depth - 1) for part in each)
            return f"[{inner}]" if type(value) is list else f"({inner}{',' * (len(value) == 1)})"
    if isinstance(value, int) and value.bit_length() > 10_000:  # Python refuses to write those of many digits
        return f"an integer of {value.bit_length()} bits"
    try:
        return repr(value)
    except Exception as error:  # whatever is wrong with it, the message is about something else
        return f"a {type(value).__name__} ({type(error).__name__} in its repr)"
