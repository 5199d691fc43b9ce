"""What a sweep keeps of every point: one entry here is a column of the CSV and a variable of the dataset."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..tables import parts_of_mu

if TYPE_CHECKING:
    from ..result import Result


@dataclass(frozen=True)
class Variable:
    """``column``: heading in the CSV; ``name``: in the dataset, as of a result; ``of``: its values in a result, (n,).

    ``level``: from 1, of a variable that every level has. ``truth``: it says yes or no.
    """

    column: str
    name: str
    of: Callable[[Result], Any]
    level: int = 0
    truth: bool = False


_FRICTION = (
    Variable("mu", "mu", lambda result: result.mu),
    Variable("tau [Pa]", "tau", lambda result: result.tau),
)
_STATE = (
    Variable("pressure [Pa]", "pressure", lambda result: result.pressure),
    Variable("penetration [m]", "penetration", lambda result: result.penetration),
    Variable("contact fraction", "contact_fraction", lambda result: result.contact_fraction),
    Variable("pulled off", "pulled_off", lambda result: result.pulled_off, truth=True),
    Variable("error estimate of mu", "error_estimate", lambda result: result.error_estimate),
    Variable("error estimate of tau [Pa]", "tau_error", lambda result: result.tau_error),
    Variable("converged", "converged", lambda result: result.converged, truth=True),
    Variable("closed form", "closed_form", lambda result: result.closed_form, truth=True),
    Variable("p_sat [Pa]", "p_sat", lambda result: result.p_sat),
)


def _at_level(number: int) -> tuple[Variable, ...]:
    """What is kept of level ``number``, from 1, behind its part of mu."""
    i = number - 1
    return (
        Variable(f"tau of level {number} [Pa]", "tau_by_level", lambda result: result.tau_by_level[i], number),
        Variable(f"contact of level {number}", "contact_by_level", lambda result: result.contact_by_level[i], number),
        Variable(f"adhesion of level {number}", "adhesion_by_level", lambda result: result.adhesion_by_level[i], number),
    )


def _part_of_mu(number: int) -> Variable:
    return Variable(f"mu of level {number}", "mu_by_level", lambda result: parts_of_mu(result)[number - 1], number)


def variables(levels: int) -> tuple[Variable, ...]:
    """All variables of a surface of so many levels, in the order of the CSV."""
    numbers = range(1, levels + 1)
    rest = (each for number in numbers for each in _at_level(number))
    return (*_FRICTION, *(_part_of_mu(number) for number in numbers), *_STATE, *rest)


def table(axes: dict[str, np.ndarray], values: dict[str, np.ndarray], velocity: np.ndarray, failed: list[str]) -> dict[str, Any]:
    """Columns of the CSV in their order: swept quantities, the variables, the reasons of what could not be solved."""
    columns: dict[str, Any] = dict(axes)
    for column, each in values.items():
        columns.setdefault(column, each)
    if "velocity [m/s]" not in columns:
        columns = {"velocity [m/s]": velocity, **columns}
    return columns | {"failed": failed}
