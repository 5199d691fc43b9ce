"""Eq. 1 to 16 as printed (``printed.toml``); what a comparison with one is, and the checks that only comparisons need."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import sympy as sp

from ..check import CORRECTED, REPRODUCED, Check, Claim, DerivationError
from ..exact import is_zero

_EQUATIONS = tomllib.loads(Path(__file__).with_name("printed.toml").read_text(encoding="utf-8"))
PRINTED = {int(number): row["latex"] for number, row in _EQUATIONS.items()}
SUBJECTS = {int(number): row["subject"] for number, row in _EQUATIONS.items()}
DERIVED_BY = {int(number): tuple(row["derived_by"]) for number, row in _EQUATIONS.items()}
CORRECTIONS = {int(number): row["correction"] for number, row in _EQUATIONS.items() if "correction" in row}


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


def compared(
    number: int, claims: list[Claim], steps: tuple[str, ...], derived: tuple[str, ...] = (), correction: str = ""
) -> Comparison:
    """Verify the claims of a comparison; one with a correction must show what is wrong with the printed form."""
    name, status = f"print of Eq. {number}", CORRECTED if correction else REPRODUCED
    checks = tuple(claim.verified(name) for claim in claims)
    if not checks:
        raise DerivationError(name, "has no check")
    if correction and not any(check.outcome == FALSE for check in checks):
        raise DerivationError(name, "a correction is needed because a claim of the printed form is refuted, and says which")
    return Comparison(number, SUBJECTS[number], PRINTED[number], derived, checks, status, correction, steps)


FALSE = "not so"


def refuted(claim: str, residual: Any) -> Claim:
    """The claim of the print that does not hold: its residual does not vanish identically."""

    def verify(step: str) -> None:
        if is_zero(sp.sympify(residual)):
            raise DerivationError(step, f"the print is wrong in this: {claim}")

    return Claim(claim, FALSE, verify)
