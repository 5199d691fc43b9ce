"""What a comparison of a printed equation is, and the checks that only comparisons need."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from ..check import CORRECTED, REPRODUCED, Check, DerivationError, zero
from ..exact import is_zero
from ..reader import Unreadable, statements
from .printed import PRINTED, SUBJECTS


@dataclass(frozen=True)
class Comparison:
    """An equation as printed, beside what is derived for it, and the checks that connect them."""

    number: int
    subject: str
    printed: str
    derived: tuple[str, ...]  # LaTeX, SI
    checks: tuple[Check, ...]
    status: str
    correction: str  # "" where the printed form holds
    steps: tuple[str, ...]  # names; the first states the equation


def compared(
    number: int,
    derived: tuple[str, ...],
    checks: list[Check],
    steps: tuple[str, ...],
    correction: str = "",
) -> Comparison:
    """Assemble a comparison; an equation with a correction must show what is wrong with the printed form."""
    name, status = step(number), CORRECTED if correction else REPRODUCED
    if not checks:
        raise DerivationError(name, "has no check")
    if correction and not any(check.outcome == FALSE for check in checks):
        raise DerivationError(name, "a correction is needed because a claim of the printed form is refuted, and says which")
    return Comparison(number, SUBJECTS[number], PRINTED[number], derived, tuple(checks), status, correction, steps)


FALSE = "not so"


def refuted(name: str, claim: str, residual: Any) -> Check:
    """Verify that a claim of the print does not hold: its residual does not vanish identically."""
    if is_zero(sp.sympify(residual)):
        raise DerivationError(name, f"the print is wrong in this: {claim}")
    return Check(claim, FALSE)


def read_back(number: int, derived: tuple[str, ...], names: Mapping[str, Any]) -> Check:
    """Verify that every derived line, typed as it is, reads as equations that hold with what ``names`` stands for."""
    claim = "the derived form, read back, holds with what was derived"
    for line in derived:
        try:
            read = statements(re.sub(r"\\quad\\text\{[^}]*\}", "", line), names)
        except Unreadable as problem:
            raise DerivationError(step(number), f"the derived form can be read: {problem}") from problem
        for statement in read:
            first, *others = (sp.sympify(side).doit() for side in statement.sides)
            if not others:
                raise DerivationError(step(number), f"the derived form {line!r} is an equation")
            zero(step(number), claim, [first - other for other in others])
    return Check(claim, "exact zero")


def step(number: int) -> str:
    """The name under which a comparison fails."""
    return f"print of Eq. {number}"
