"""The building blocks: every kernel of the derivation against its expression."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ...certify import Certificate
from ...printing import source
from ...symbols import s_1
from ..kernel import ModeKernel
from ..law import Law
from .inputs import Inputs
from .reference import DIGITS, Reference
from .worst import Worst

POINTS = 30


def measure(kernel: ModeKernel, law: Law, solver: Any, points: int = POINTS) -> Certificate:
    """Measure one function, as ``solver`` computes it, against the kernel's exact expression."""
    worst = Worst(kernel.formula.name)
    args = _arguments(kernel)
    with mpmath.workdps(DIGITS):
        reference = Reference(kernel.exact, law.modes)
        for index in range(points):
            inputs = Inputs(law, args, f"{kernel.formula.name} {index}", kernel.moving)
            with np.errstate(all="raise", under="ignore"):
                computed = _computed(kernel, solver, inputs)
            worst.see(computed, reference(inputs.exact), inputs.shown())
    return worst.certificate()


def _arguments(kernel: ModeKernel) -> tuple[sp.Symbol, ...]:
    if kernel.chain is None:
        return kernel.formula.args
    first, *rest = kernel.chain[0].args
    return (first, s_1, *rest)


def _computed(kernel: ModeKernel, solver: Any, inputs: Inputs) -> Any:
    given = {source(argument): inputs.argument(argument, solver) for argument in _arguments(kernel)}
    if kernel.chain is None:
        return getattr(solver, kernel.formula.name)(*(given[source(argument)] for argument in kernel.formula.args))
    first, event = kernel.chain
    constants = getattr(solver, first.name)(*(given[source(argument)] for argument in first.args))
    return getattr(solver, event.name)(given[source(s_1)], *constants)
