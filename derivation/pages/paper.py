"""The paper's equations by number: as printed beside as derived where they are compared, and the steps that state them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..check import Derived
from ..paper.printed import SUBJECTS
from ..paper.record import Comparison
from ..paper.tags import numbers

FIRST = {6: ("zone conditions",), 11: ("means over a level",), 15: ("saturated_pressure",)}
"""The step that states an equation, where that is not the first with its number."""


def equations(steps: tuple[Derived, ...], comparisons: Sequence[Comparison] = ()) -> list[dict[str, Any]]:
    """The contents by equation number; the first of a row's steps is the one that states the equation.

    Without ``comparisons`` (a foundation that is not the paper's) the status is that of the steps.
    """
    compared = {comparison.number: comparison for comparison in comparisons}
    return [_row(number, steps, compared.get(number)) for number in SUBJECTS]


def _row(number: int, steps: tuple[Derived, ...], comparison: Comparison | None) -> dict[str, Any]:
    by_name = {step.name: step for step in steps}
    cited = [step.name for step in steps if number in numbers(step.paper)]
    named = comparison.steps if comparison else FIRST.get(number, ())
    listed = list(dict.fromkeys(name for name in (*named, *cited) if name in by_name))
    return {
        "number": number,
        "subject": SUBJECTS[number],
        "status": comparison.status if comparison else by_name[listed[0]].status,
        "printed": comparison.printed if comparison else "",
        "derived": list(comparison.derived or (by_name[listed[0]].latex,)) if comparison else [],
        "checks": [[check.claim, check.outcome] for check in comparison.checks] if comparison else [],
        "correction": comparison.correction if comparison else "",
        "steps": listed,
    }
