"""The errors that hystrip raises on purpose, and its warnings."""

from __future__ import annotations

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
        super().__init__(f"{field}: got {shown(value)}; allowed: {allowed}")

    def __reduce__(self):
        # Exceptions travel between processes in sweeps; the default would rebuild this one from its message alone.
        return type(self), (self.field, self.value, self.allowed)


class SolverError(HystripError, RuntimeError):
    """No solution passed its own checks. The message names the strip; no number is returned in its place."""


class FitWarning(UserWarning):
    """A series that fits poorly what it was fitted to. Says over which band, and by how much."""


class ConvergenceWarning(UserWarning):
    """Points that came back without the accuracy asked for. The message names the first of them and the reason."""


class MissingExtra(HystripError, ImportError):
    """An optional dependency is not installed. The message names the extra that brings it."""


def shown(value: Any, limit: int = 80) -> str:
    """``repr`` of a value, cut to a length that fits into a one-line message."""
    text = " ".join(repr(value).split())
    return text if len(text) <= limit else text[: limit - 3] + "..."
