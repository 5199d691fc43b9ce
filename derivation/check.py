"""What a check is, what a derived quantity is, and the error that a failing check raises.

A quantity is derived by one function, whose docstring says what it is and shows the equation (:func:`said`). The function hands
its value and what it claims of it to :func:`derived`, which verifies every claim and returns a :class:`Derived`. A claim that
does not come out exactly zero raises :class:`DerivationError` with the name of the step, so nothing unverified goes on.
"""

import inspect
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from .exact import is_zero

REPRODUCED = "reproduced"
CORRECTED = "reproduced with a correction"
BEYOND = "beyond the paper"
PACKAGE = f"{__name__.rpartition('.')[0]}."
STATUSES = (REPRODUCED, CORRECTED, BEYOND)
EXACT = "exact zero"
PARAGRAPH = re.compile(r"(?:(\w+)(?:, )?)??(Eq\. \d+(?:, \d+)*)?: (?=\S)")
MATH = ".. math:: "


class DerivationError(Exception):
    """A step of the derivation did not verify. ``step`` is its name, ``claim`` what was to hold."""

    def __init__(self, step: str, claim: str, residual: Any = None):
        self.step, self.claim, self.residual = step, claim, residual
        shown = "" if residual is None else f" (residual: {str(residual):.200})"
        super().__init__(f"derivation step '{step}' failed: {claim}{shown}")


@dataclass(frozen=True)
class Check:
    """One verified claim. ``outcome`` is "exact zero" for an identity, "holds" for a statement, else the digits."""

    claim: str
    outcome: str


@dataclass(frozen=True)
class Claim(Check):
    """What is to be verified: ``left`` finds None if it holds, else what remains."""

    left: Callable[[], Any]

    def verified(self, step: str) -> Check:
        """The check that it is; raises :class:`DerivationError` with the name of the ``step`` if it does not hold."""
        residual = self.left()
        if residual is not None:
            raise DerivationError(step, self.claim, residual)
        return Check(self.claim, self.outcome)


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
    emitted: tuple[str, ...] = ()  # names of the generated functions that compute it


def zero(claim: str, residual: Any, outcome: str = EXACT, **options: Any) -> Claim:
    """The claim that ``residual`` (an expression or a sequence of them) vanishes identically."""
    parts = residual if isinstance(residual, (tuple, list)) else (residual,)
    return Claim(claim, outcome, lambda: next((part for part in parts if not is_zero(part, **options)), None))


def holds(claim: str, truth: Any) -> Claim:
    """The claim of a statement that is true or false."""
    return Claim(claim, "holds", lambda: None if truth else False)


def derived(by: Callable[..., Any], value: Any, claims: Iterable[Claim], name: str = "", **options: Any) -> Derived:
    """Verify the ``claims``, at least one, of what the function ``by`` derived, and record them.

    The step has the name of the function unless another is given. What it states, its equation and the paper's number
    stand in the docstring; the ``options`` ``statement``, ``latex`` and ``paper`` go before it. Others:
    ``correction``, what is wrong in the print; ``emitted``, names of generated functions; ``status``, if not that of
    the paper's equation, or beyond the paper.
    """
    name = name or by.__name__.replace("_", " ")
    statement, latex, paper = said(by, name)
    correction = options.get("correction", "")
    status = CORRECTED if correction else REPRODUCED if options.get("paper", paper) else BEYOND
    own = {"statement": statement, "latex": latex, "paper": paper, "status": status} | options
    checks = tuple(claim.verified(name) for claim in claims)
    if not checks:
        raise DerivationError(name, "has no check")
    if own["status"] not in STATUSES or (own["status"] == CORRECTED) != bool(correction):
        raise DerivationError(name, f"status {own['status']!r} does not fit its correction {correction!r}")
    return Derived(value, name, checks=checks, function=f"{by.__module__.removeprefix(PACKAGE)}.{by.__name__}", **own)


def said(by: Callable[..., Any], name: str) -> tuple[str, str, str]:
    r"""(sentence, LaTeX, number in the paper) of the quantity ``name``; the last two empty where there is none.

    Of one quantity a docstring says it at its beginning, of several each in a paragraph that begins with the quantity's name:

        Eq. 5: In contact w = u is given.                 gap_after: Gap at s_1 when it was gap_0 at s_0.

        .. math:: w = u                                   .. math:: g(s_1) = g_0 + \dots
    """
    paragraphs = [" ".join(text.split()) for text in (inspect.getdoc(by) or "").split("\n\n")]
    own = [n for n, text in enumerate(paragraphs) if (mark := PARAGRAPH.match(text)) and mark[1] == name] or [0]
    first, *rest = paragraphs[own[0] :]
    mark = PARAGRAPH.match(first)
    marked = mark is not None and mark[1] in (None, name)
    equation = next((text.removeprefix(MATH) for text in rest[:1] if text.startswith(MATH)), "")
    return (first[mark.end() :] if marked else first), equation, (mark[2] or "") if marked else ""
