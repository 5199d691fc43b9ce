"""What a sweep keeps of every point: one entry here is a column of the CSV and a variable of the dataset."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..tables import parts_of_mu

if TYPE_CHECKING:
    from ..result import Result
    from .plan import Plan


@dataclass(frozen=True)
class Variable:
    """``column``: heading in the CSV; ``name``: in the dataset, as of a result.

    ``level``: from 1, of a variable that every level has. ``truth``: it says yes or no.
    """

    column: str
    name: str
    level: int = 0
    truth: bool = False

    def of(self, result: Result) -> Any:
        """Its values in a result of n points, (n,)."""
        values = parts_of_mu(result) if self.name == "mu_by_level" else getattr(result, self.name)
        return values[self.level - 1] if self.level else values


_STATE = (
    Variable("pressure [Pa]", "pressure"),
    Variable("penetration [m]", "penetration"),
    Variable("contact fraction", "contact_fraction"),
    Variable("pulled off", "pulled_off", truth=True),
    Variable("error estimate of mu", "error_estimate"),
    Variable("error estimate of tau [Pa]", "tau_error"),
    Variable("error estimate of pressure [Pa]", "pressure_error"),
    Variable("converged", "converged", truth=True),
    Variable("closed form", "closed_form", truth=True),
    Variable("p_sat [Pa]", "p_sat"),
)
_BY_LEVEL = {"tau of level {} [Pa]": "tau_by_level", "contact of level {}": "contact_by_level",
             "adhesion of level {}": "adhesion_by_level"}  # fmt: skip


def variables(levels: int) -> tuple[Variable, ...]:
    """All variables of a surface of so many levels, in the order of the CSV."""
    numbers = range(1, levels + 1)
    parts = (Variable(f"mu of level {number}", "mu_by_level", number) for number in numbers)
    rest = (Variable(column.format(number), name, number) for number in numbers for column, name in _BY_LEVEL.items())
    return (Variable("mu", "mu"), Variable("tau [Pa]", "tau"), *parts, *_STATE, *rest)


def table(plan: Plan, values: dict[str, np.ndarray], failed: list[str]) -> dict[str, Any]:
    """Columns of the CSV in their order: swept quantities, the variables, the reasons of what could not be solved."""
    coordinates = plan.coordinates(np.arange(plan.size))
    axes = {f"{axis.name} [{axis.unit}]": coordinates[:, i] for i, axis in enumerate(plan.axes)}
    if "velocity [m/s]" not in axes:
        axes = {"velocity [m/s]": np.full(plan.size, float(plan.base["velocity"])), **axes}
    return axes | {column: each for column, each in values.items() if column not in axes} | {"failed": failed}
