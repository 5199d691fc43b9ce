"""Eq. 1 to 16 as printed (``printed.toml``); what a comparison with one is, and which steps may carry its number."""

import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import sympy as sp

from ..check import CORRECTED, REPRODUCED, Check, Claim, DerivationError, Derived
from ..exact import is_zero
from ..latex import Statement, statements

_EQUATIONS = {
    int(number): row
    for number, row in tomllib.loads(Path(__file__).with_name("printed.toml").read_text(encoding="utf-8")).items()
}
PRINTED = {number: row["latex"] for number, row in _EQUATIONS.items()}
SUBJECTS = {number: row["subject"] for number, row in _EQUATIONS.items()}
DERIVED_BY = {number: tuple(row["derived_by"]) for number, row in _EQUATIONS.items()}
CORRECTIONS = {number: row["correction"] for number, row in _EQUATIONS.items() if "correction" in row}
FALSE = "not so"


@dataclass(frozen=True)
class Comparison:
    """An equation as printed, beside what is derived for it, and the checks that connect them."""

    number: int
    subject: str
    printed: str
    derived: tuple[str, ...]  # LaTeX, SI; where it is empty, the first of the steps displays it
    checks: tuple[Check, ...]
    status: str
    correction: str  # "" where the printed form holds
    steps: tuple[str, ...]  # names; the first states the equation


def read(number: int, names: Mapping[str, Any]) -> tuple[Statement, ...]:
    """An equation as printed, with what the ``names`` in it mean."""
    return statements(PRINTED[number], names)


def compared(number: int, claims: Iterable[Claim], derived: Iterable[str] = (), corrected_as: int | None = None) -> Comparison:
    """Verify the claims of a comparison; one with a correction must show what is wrong with the printed form.

    ``corrected_as``: the equation whose correction is this one's too.
    """
    name, row = f"print of Eq. {number}", _EQUATIONS[number]
    checks = tuple(claim.verified(name) for claim in claims)
    if not checks:
        raise DerivationError(name, "has no check")
    correction, status = "", REPRODUCED
    if corrected_as:
        correction, status = f"{CORRECTIONS[corrected_as]} {row.get('besides', '')}".strip(), CORRECTED
        if not any(check.outcome == FALSE for check in checks):
            raise DerivationError(name, "a correction is needed because a claim of the printed form is refuted, and says which")
    return Comparison(number, row["subject"], row["latex"], tuple(derived), checks, status, correction, tuple(row["steps"]))


def refuted(claim: str, residual: Any) -> Claim:
    """The claim of the print that does not hold: its residual does not vanish identically."""
    return Claim(claim, FALSE, lambda: "none, so the print is right in this" if is_zero(sp.sympify(residual)) else None)


def numbers(paper: str) -> list[int]:
    """Equation numbers in a citation such as ``Eq. 2, 3``."""
    return [int(number) for number in re.findall(r"\d+", paper)]


def require_tags(steps: Iterable[Derived]) -> None:
    """Raise :class:`DerivationError` for a step that carries the number of an equation that it does not derive."""
    for step in steps:
        for number in numbers(step.paper):
            if not step.name.startswith(DERIVED_BY.get(number, ())):
                raise DerivationError("tags", f"{step.name!r} carries Eq. {number}, which {step.function} does not derive")


def require_all(steps: Iterable[Derived]) -> None:
    """Raise :class:`DerivationError` unless every equation of the paper has a step."""
    carried = {number for step in steps for number in numbers(step.paper)}
    missing = sorted(set(DERIVED_BY) - carried)
    if missing:
        raise DerivationError("tags", f"Eq. {missing[0]} of the paper has a step")


def require_status(steps: Iterable[Derived], comparisons: Iterable[Comparison]) -> None:
    """Raise :class:`DerivationError` where a step says of the print what its comparison does not."""
    status = {step.name: step.status for step in steps}
    for comparison in comparisons:
        stating = comparison.steps[0]
        if status[stating] != comparison.status:
            raise DerivationError(stating, f"Eq. {comparison.number} is {comparison.status}, as its comparison shows")
