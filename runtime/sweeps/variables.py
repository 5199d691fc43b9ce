"""What a sweep keeps of every point: one entry here is a column of the CSV and a variable of the dataset."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ..result import Result


@dataclass(frozen=True)
class Variable:
    """``column``: heading in the CSV; ``name``, ``unit``, ``long_name``: in the dataset; ``of``: its values in a result, (n,)."""

    column: str
    name: str
    unit: str
    long_name: str
    of: Callable[[Result], np.ndarray]


def part_of_level(number: int) -> Variable:
    """What level ``number``, from 1, adds to mu."""
    from ..tables import parts_of_mu

    column = f"mu of level {number}"
    return Variable(column, column.replace(" ", "_"), "1", column, lambda result: parts_of_mu(result)[number - 1])


_FRICTION = (
    Variable("mu", "mu", "1", "friction coefficient", lambda result: result.mu),
    Variable("tau [Pa]", "tau", "Pa", "friction stress", lambda result: result.tau),
)
_STATE = (
    Variable("pressure [Pa]", "pressure", "Pa", "nominal pressure", lambda result: result.pressure),
    Variable("penetration [m]", "penetration", "m", "penetration of level 1", lambda result: result.penetration),
    Variable(
        "contact fraction",
        "contact_fraction",
        "1",
        "real contact: fraction of the nominal area in contact on every level",
        lambda result: result.contact_fraction,
    ),
    Variable("pulled off", "pulled_off", "1", "1 where the pressure lies below pull-off", lambda result: result.pulled_off),
    Variable(
        "error estimate of mu",
        "error_estimate",
        "1",
        "estimated absolute error of the friction coefficient",
        lambda result: result.error_estimate,
    ),
    Variable("converged", "converged", "1", "1 where the estimated error is within rtol", lambda result: result.converged),
)
#: variables that do not depend on the number of levels
COMMON = (*_FRICTION, *_STATE)


def variables(levels: int) -> tuple[Variable, ...]:
    """All variables of a surface of so many levels, in the order of the CSV."""
    return (*_FRICTION, *(part_of_level(number) for number in range(1, levels + 1)), *_STATE)
