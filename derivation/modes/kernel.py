"""A formula over modes, tied to the expressions of a generic mode that it was proven to compute."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp

from ..check import BEYOND, REPRODUCED, Check, DerivationError, Derived, derived, zero
from ..functions import Formula, written_out
from ..symbols import alpha, s_0, s_1
from .symbols import S, eta
from .tensor import SUMS, generic


@dataclass(frozen=True)
class ModeKernel:
    """A formula and what it computes, sums over modes and all, in plain functions of the generic mode."""

    formula: Formula
    exact: Any
    derived: Derived
    chain: tuple[Formula, Formula] | None = None  # an entry and its event, which are measured as one function
    moving: bool = False  # has no value at rest, V = 0


def kernel(
    by: Any, formula: Formula, exact: Any, statement: str, latex: str, *extra: Check, moving: bool = False, **options: Any
) -> ModeKernel:
    """Prove ``formula`` equal to ``exact``, sum by sum, and record it under the function ``by`` that derived it."""
    options.setdefault("status", REPRODUCED if options.get("paper") else BEYOND)
    checks = [same(formula.name, formula.written_out(formula.args), exact), *extra]
    record = derived(
        by, exact, name=formula.name, statement=statement, latex=latex, checks=checks, emitted=(formula.name,), **options
    )
    return ModeKernel(formula, exact, record, moving=moving)


def pair(
    by: Any, chain: tuple[Formula, Formula], exact: Any, statements: tuple[str, str], latex: tuple[str, str]
) -> tuple[ModeKernel, ModeKernel]:
    """An entry and its event, proven equal to ``exact`` together, and measured as the one function that they are."""
    entry, event = chain
    constants = tuple(written_out(part) for part in entry.written_out(entry.args))
    composed = event.written_out((s_1, *constants))
    check = same(event.name, composed, exact, claim=f"{event.name} after {entry.name} is the derived value and its slope")

    def record(formula: Formula, value: Any, k: int) -> Derived:
        return derived(
            by, value, name=formula.name, statement=statements[k], latex=latex[k], checks=[check], emitted=(formula.name,)
        )

    records = record(entry, constants, 0), record(event, exact, 1)
    return tuple(ModeKernel(formula, exact, found, chain) for formula, found in zip(chain, records, strict=True))


def same(name: str, stated: Any, exact: Any, phases: tuple = (s_0, s_1), claim: str = "") -> Check:
    """The stable form equals the derived expression: what stands under the same sum over modes is the same."""
    pairs = list(zip(_flat(stated), _flat(exact), strict=True))
    residuals = []
    for one, other in pairs:
        if {f.func for f in sp.sympify(one).atoms(*SUMS)} != {f.func for f in sp.sympify(other).atoms(*SUMS)}:
            raise DerivationError(name, "both forms sum over the modes in the same way", one - other)
        residuals.append((generic(one) - generic(other)).subs(S, alpha / eta))
    claim = claim or f"{name}: the stable form equals the derived expression"
    return zero(name, f"{claim}, mode by mode", residuals, phases=phases)


def _flat(result: Any) -> list[Any]:
    return [e for part in result for e in _flat(part)] if isinstance(result, (tuple, list)) else [result]
