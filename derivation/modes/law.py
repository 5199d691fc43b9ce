"""The law of a foundation with n relaxation times, stages 1 and 2: the material, and its strip with both sets of states."""

from __future__ import annotations

from dataclasses import dataclass, field

import sympy as sp

from ..check import Derived
from ..model import Model
from .admissible import admissibility
from .coordinates import coordinates, strip_values
from .material import foundation_law, prony_series, relaxed_stiffness
from .tensor import Values
from .times import branch_weights, factored_operators, strip_times


@dataclass(frozen=True)
class Law:
    """Stages 1 and 2 for n modes. ``values``: each numbered quantity of a strip, rational in the times."""

    model: Model
    foundation: Derived
    relaxed: Derived
    series: Derived
    admissible: Derived
    factored: Derived
    weights: Derived
    states: Derived
    values: Values = field(compare=False, repr=False)

    @property
    def modes(self) -> int:
        return self.model.modes

    @property
    def operators(self) -> tuple[sp.Expr, sp.Expr]:
        """(Q, P) of the strip as polynomials in the derivative."""
        return self.factored.value


def law(model: Model) -> Law:
    n = model.modes
    admissible = admissibility(model)
    times = strip_times(n)
    weights = branch_weights(times)
    values = strip_values(times, weights.value)
    return Law(
        model,
        foundation_law(model),
        relaxed_stiffness(model),
        prony_series(model),
        admissible,
        factored_operators(model, times),
        weights,
        coordinates(times, values),
        values,
    )
