"""The numbers that steps carry: which steps may carry which, that none is missing, and that their status is the equation's."""

import re
from collections.abc import Iterable

from ..check import DerivationError, Derived
from .record import DERIVED_BY, Comparison

STEP = "tags"


def numbers(paper: str) -> list[int]:
    """Equation numbers in a citation such as ``Eq. 2, 3``."""
    return [int(number) for number in re.findall(r"\d+", paper)]


def require_tags(steps: Iterable[Derived]) -> None:
    """Raise :class:`DerivationError` for a step that carries the number of an equation that it does not derive."""
    for step in steps:
        for number in numbers(step.paper):
            if not step.name.startswith(DERIVED_BY.get(number, ())):
                raise DerivationError(STEP, f"{step.name!r} carries Eq. {number}, which {step.function} does not derive")


def require_all(steps: Iterable[Derived]) -> None:
    """Raise :class:`DerivationError` unless every equation of the paper has a step."""
    carried = {number for step in steps for number in numbers(step.paper)}
    missing = sorted(set(DERIVED_BY) - carried)
    if missing:
        raise DerivationError(STEP, f"Eq. {missing[0]} of the paper has a step")


def require_status(steps: Iterable[Derived], comparisons: Iterable[Comparison]) -> None:
    """Raise :class:`DerivationError` where a step says of the print what its comparison does not."""
    status = {step.name: step.status for step in steps}
    for comparison in comparisons:
        stating = comparison.steps[0]
        if status[stating] != comparison.status:
            raise DerivationError(stating, f"Eq. {comparison.number} is {comparison.status}, as its comparison shows")
