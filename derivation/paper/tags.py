"""The numbers that steps carry: which steps may carry which, that none is missing, and that their status is the equation's."""

from __future__ import annotations

import re
from collections.abc import Iterable

from ..check import DerivationError, Derived
from .record import Comparison

STEP = "tags"
DERIVED_BY = {
    1: ("foundation law", "relaxed stiffness"),
    2: ("adhesion law",),
    3: ("adhesion law",),
    4: ("strip profile",),
    5: ("moving frame", "dimensionless groups", "contact flow", "relaxation flow"),
    6: ("zone conditions",),
    7: ("equilibrium",),
    8: ("strip profile",),
    9: ("contact area",),
    10: ("local stress", "level_saturation_friction"),
    11: ("means", "contact_work", "relaxation_integral", "integrals", "level_saturation_pressure", "level_saturation_friction"),
    12: ("local shear",),
    13: ("carried friction",),
    14: ("friction coefficient",),
    15: ("saturated_pressure", "saturated_overstress", "excess_event", "contact flow"),
    16: ("saturated_stack_friction", "Eq. 16 as printed"),
}
"""By equation, the beginnings of the names of the steps that derive it, or a part of it."""


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
