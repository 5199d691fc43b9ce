"""A formula over modes, tied to the expressions of a generic mode that it was proven to compute."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp

from ..check import BEYOND, REPRODUCED, Check, DerivationError, Derived, derived, zero
from ..functions import Formula
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


def same(name: str, stated: Any, exact: Any, phases: tuple = (s_0, s_1)) -> Check:
    """The stable form equals the derived expression: what stands under the same sum over modes is the same."""
    pairs = list(zip(_flat(stated), _flat(exact), strict=True))
    residuals = []
    for one, other in pairs:
        if {f.func for f in sp.sympify(one).atoms(*SUMS)} != {f.func for f in sp.sympify(other).atoms(*SUMS)}:
            raise DerivationError(name, "both forms sum over the modes in the same way", one - other)
        residuals.append((generic(one) - generic(other)).subs(S, alpha / eta))
    return zero(name, f"{name}: the stable form equals the derived expression, mode by mode", residuals, phases=phases)


def _flat(result: Any) -> list[Any]:
    return [e for part in result for e in _flat(part)] if isinstance(result, (tuple, list)) else [result]
