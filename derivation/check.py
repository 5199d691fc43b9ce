"""What a check is, what a derived quantity is, and the error that a failing check raises.

A quantity is derived by one function, which verifies it on the spot and returns it as a :class:`Derived`: the value, the
sentence and the equation a reader wants to see, the paper's equation number, and the checks that it passed. A check that
does not come out exactly zero raises :class:`DerivationError` with the name of the step, so nothing unverified goes on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from .exact import is_zero

REPRODUCED = "reproduced"
CORRECTED = "reproduced with a correction"
BEYOND = "beyond the paper"
PACKAGE = f"{__name__.rpartition('.')[0]}."
STATUSES = (REPRODUCED, CORRECTED, BEYOND)


class DerivationError(Exception):
    """A step of the derivation did not verify. ``step`` is its name, ``claim`` what was to hold."""

    def __init__(self, step: str, claim: str, residual: Any = None):
        self.step, self.claim, self.residual = step, claim, residual
        shown = "" if residual is None else f" (residual: {_shortened(residual)})"
        super().__init__(f"derivation step '{step}' failed: {claim}{shown}")


@dataclass(frozen=True)
class Check:
    """One verified claim. ``outcome`` is "exact zero" for an identity, "holds" for a statement, else the digits."""

    claim: str
    outcome: str


@dataclass(frozen=True)
class Derived:
    """A derived quantity with everything that an audit needs to know about it."""

    value: Any
    name: str
    statement: str
    latex: str
    paper: str  # the paper's equation number, "" if it has none
    status: str
    checks: tuple[Check, ...]
    function: str  # dotted name of the function that derives it, within this package
    correction: str = ""  # what is wrong in the printed paper, for status CORRECTED
    emitted: tuple[str, ...] = field(default=())  # names of the generated functions that compute it


def zero(step: str, claim: str, residual: Any, **options: Any) -> Check:
    """Verify that ``residual`` (an expression or a sequence of them) vanishes identically."""
    parts = residual if isinstance(residual, (tuple, list)) else (residual,)
    for part in parts:
        if not is_zero(part, **options):
            raise DerivationError(step, claim, part)
    return Check(claim, "exact zero")


def holds(step: str, claim: str, truth: Any) -> Check:
    """Verify a statement that is true or false."""
    if not bool(truth):
        raise DerivationError(step, claim)
    return Check(claim, "holds")


def derived(
    by: Callable[..., Any],
    value: Any,
    *,
    name: str,
    statement: str,
    latex: str,
    checks: tuple[Check, ...] | list[Check],
    paper: str = "",
    status: str = "",
    correction: str = "",
    emitted: tuple[str, ...] = (),
) -> Derived:
    """Assemble a :class:`Derived`; it must have passed at least one check.

    ``status``: that of the paper's equation, or, without one, beyond the paper; to be given where the print needs a correction.
    """
    status = status or (REPRODUCED if paper else BEYOND)
    if not checks:
        raise DerivationError(name, "has no check")
    if status not in STATUSES or (status == CORRECTED) != bool(correction):
        raise DerivationError(name, f"status {status!r} does not fit its correction {correction!r}")
    function = f"{by.__module__.removeprefix(PACKAGE)}.{by.__name__}"
    return Derived(value, name, statement, latex, paper, status, tuple(checks), function, correction, emitted)


def _shortened(residual: Any, limit: int = 200) -> str:
    text = str(residual)
    return text if len(text) <= limit else text[:limit] + " ..."
