"""A formula to emit, tied to the expression that it was proven to compute."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from .check import Claim, DerivationError, Derived, derived, zero
from .exact import in_half_angles
from .functions import Call, Formula, flat, written_out
from .modes.symbols import SUMS, S, eta, generic
from .symbols import alpha, s_0, s_1


@dataclass(frozen=True)
class Kernel:
    """A formula and the expression that it was proven to compute, sums over modes and all, both in the formula's arguments."""

    formula: Formula
    exact: Any
    derived: Derived
    parts: tuple[tuple[sp.Expr, ...], ...] = ()  # of a balance: the terms of each component of ``exact``, flattened
    chain: tuple[Formula, Formula] | None = None  # an entry and its event, which are measured as one function
    moving: bool = False  # has no value at rest, V = 0

    @property
    def args(self) -> tuple[sp.Symbol, ...]:
        """The symbols of ``exact``: those of the formula, or of its chain."""
        if self.chain is None:
            return self.formula.args
        first, *rest = self.chain[0].args
        return (first, s_1, *rest)


Kernels = Mapping[str, Kernel]
"""By the names of their functions."""


def same(
    name: str, stated: Any, exact: Any, phases: tuple[sp.Symbol, ...] = (s_0, s_1), halved: tuple[sp.Symbol, ...] = ()
) -> Claim:
    """The stable form equals the derived expression, identically: what stands under the same sum over modes is the same.

    ``halved``: angles of which a form takes halves.
    """
    residuals = []
    for one, other in zip(flat(stated), flat(exact), strict=True):
        if {f.func for f in sp.sympify(one).atoms(*SUMS)} != {f.func for f in sp.sympify(other).atoms(*SUMS)}:
            raise DerivationError(name, "both forms sum over the modes in the same way", one - other)
        residual = (generic(sp.sympify(one)) - generic(sp.sympify(other))).subs(S, alpha / eta)
        residuals.append(in_half_angles(residual, *halved))
    return zero(f"{name}: the stable form equals the derived expression", residuals, phases=phases)


def kernel(
    by: Callable[..., Any],
    formula: Formula,
    exact: Any,
    *claims: Claim,
    phases: tuple[sp.Symbol, ...] = (s_0, s_1),
    halved: tuple[sp.Symbol, ...] = (),
    **options: Any,
) -> Kernel:
    """Prove ``formula`` equal to ``exact`` and record it under the function ``by`` that derived it, with its own ``claims``."""
    name = formula.name
    proven = same(name, formula.written_out(), exact, phases, halved)
    return Kernel(formula, exact, derived(by, exact, [proven, *claims], name, emitted=(name,), **options))


def as_derived(expression: sp.Expr, kernels: Kernels) -> sp.Expr:
    """An expression in calls of ``kernels``, with what these were proven to compute in their place."""

    def derived_form(call: Call) -> sp.Expr:
        kernel = kernels[call.formula.name]
        return kernel.exact.subs(dict(zip(kernel.formula.args, call.args, strict=True)), simultaneous=True)

    return expression.replace(lambda e: isinstance(e, Call), derived_form)


def pair(
    by: Callable[..., Any], chain: tuple[Formula, Formula], exact: Any, halved: tuple[sp.Symbol, ...] = ()
) -> tuple[Kernel, Kernel]:
    """An entry and its event, proven equal to ``exact`` together, and measured as the one function that they are."""
    entry, event = chain
    constants = tuple(written_out(part) for part in entry.written_out())
    composed = same(event.name, event.written_out((s_1, *constants)), exact, halved=halved)
    claim = replace(composed, claim=f"{event.name} after {entry.name} is the derived value and its slope")
    return chained(by, chain, exact, (constants, [claim]), (exact, [claim]))


def chained(
    by: Callable[..., Any], chain: tuple[Formula, Formula], exact: Any, *records: tuple[Any, Any]
) -> tuple[Kernel, Kernel]:
    """The kernels of an entry and its event; ``records``: the value and the claims of each."""
    return tuple(
        Kernel(formula, exact, derived(by, value, claims, formula.name, emitted=(formula.name,)), chain=chain)
        for formula, (value, claims) in zip(chain, records, strict=True)
    )
