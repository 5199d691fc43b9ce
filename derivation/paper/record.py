"""What a comparison of a printed equation is, and the checks that only comparisons need."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp

from ..check import CORRECTED, STATUSES, Check, DerivationError
from ..exact import is_zero
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
    status: str,
    correction: str = "",
) -> Comparison:
    """Assemble a comparison; an equation with a correction must show what is wrong with the printed form."""
    name = step(number)
    if status not in STATUSES or (status == CORRECTED) != bool(correction) or not checks:
        raise DerivationError(name, f"status {status!r} does not fit its correction {correction!r} or its {len(checks)} checks")
    if status == CORRECTED and not any(check.outcome == FALSE for check in checks):
        raise DerivationError(name, "a correction is needed because a claim of the printed form is refuted, and says which")
    return Comparison(number, SUBJECTS[number], PRINTED[number], derived, tuple(checks), status, correction, steps)


FALSE = "not so"


def refuted(name: str, claim: str, residual: Any) -> Check:
    """Verify that a claim of the print does not hold: its residual does not vanish identically."""
    if is_zero(sp.sympify(residual)):
        raise DerivationError(name, f"the print is wrong in this: {claim}")
    return Check(claim, FALSE)


def step(number: int) -> str:
    """The name under which a comparison fails."""
    return f"print of Eq. {number}"
