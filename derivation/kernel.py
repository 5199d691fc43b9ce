"""A formula to emit, tied to the expression that it was proven to compute."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp

from .check import BEYOND, REPRODUCED, Check, Derived, derived, zero
from .functions import Formula
from .printing import source
from .symbols import s_0, s_1


@dataclass(frozen=True)
class Kernel:
    """A formula and the expression that it was proven to compute, both in the formula's arguments."""

    formula: Formula
    exact: Any
    derived: Derived
    parts: tuple[tuple[sp.Expr, ...], ...] = ()  # of a balance: the terms of each component of ``exact``, flattened
    chain: tuple[Formula, Formula] | None = None  # an entry and its event, which are measured as one function

    @property
    def args(self) -> tuple[sp.Symbol, ...]:
        """The symbols of ``exact``: those of the formula, or of its chain."""
        return self.formula.args if self.chain is None else (s_0, s_1, *self.chain[0].args[1:])

    def computed(self, solver: Any, columns: dict[str, Any]) -> Any:
        """What ``solver`` computes for the arguments ``columns``, by name."""
        if self.chain is None:
            return getattr(solver, self.formula.name)(**columns)
        entry, event = self.chain
        constants = getattr(solver, entry.name)(*(columns[source(argument)] for argument in entry.args))
        return getattr(solver, event.name)(columns[source(s_1)], *constants)


def same(step: str, formula: Formula, exact: Any, phases: tuple = (s_0, s_1)) -> Check:
    """The stable form equals the derived expression, identically."""
    return zero(
        step,
        f"{formula.name}: the stable form equals the derived expression",
        formula.written_out(formula.args) - exact,
        phases=phases,
    )


def kernel(by: Any, formula: Formula, exact: Any, statement: str, latex: str, *extra: Check, **options: Any) -> Kernel:
    """Prove ``formula`` equal to ``exact`` and record it under the function ``by`` that derived it."""
    options.setdefault("status", REPRODUCED if options.get("paper") else BEYOND)
    checks = [same(formula.name, formula, exact), *extra]
    return Kernel(
        formula,
        exact,
        derived(
            by, exact, name=formula.name, statement=statement, latex=latex, checks=checks, emitted=(formula.name,), **options
        ),
    )
