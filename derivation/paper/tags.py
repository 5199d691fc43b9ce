"""The numbers that steps carry: each stands in the docstring of the function that derives it, and none is missing."""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Iterable

from ..check import DerivationError, Derived
from .printed import PRINTED

STEP = "tags"
ROOT = __name__.rpartition(".paper.")[0]


def numbers(paper: str) -> list[int]:
    """Equation numbers in a citation such as ``Eq. 10-11`` or ``Eq. 2, 3``."""
    found: list[int] = []
    for first, last in re.findall(r"(\d+)(?:-(\d+))?", paper):
        found += range(int(first), int(last or first) + 1)
    return found


def require_tags(steps: Iterable[Derived]) -> None:
    """Raise :class:`DerivationError` for a step whose number is not that of the function that derives it."""
    for step in steps:
        module, _, name = step.function.rpartition(".")
        text = inspect.getdoc(getattr(importlib.import_module(f"{ROOT}.{module}"), name)) or ""
        cited = {int(number) for group in re.findall(r"Eq\. (\d+(?:, \d+)*)", text) for number in group.split(", ")}
        strange = sorted(set(numbers(step.paper)) - cited)
        if strange:
            raise DerivationError(STEP, f"{step.name!r} carries Eq. {strange[0]}, which {step.function} does not derive")


def require_all(steps: Iterable[Derived]) -> None:
    """Raise :class:`DerivationError` unless every equation of the paper has a step."""
    carried = {number for step in steps for number in numbers(step.paper)}
    missing = sorted(set(PRINTED) - carried)
    if missing:
        raise DerivationError(STEP, f"Eq. {missing[0]} of the paper has a step")
