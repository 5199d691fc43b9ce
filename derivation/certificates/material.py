"""The modes of a material from its parameters: retardation times as eigenvalues, everything else rational in the times."""

import random
from collections.abc import Sequence
from functools import partial
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..model import Model
from ..modes.states import exact_modes
from ..modes.symbols import MATERIAL, m
from .measure import DIGITS, Certificate, grid
from .scaled import STEP, naturally

NAME = "material_modes"
POINTS = 40
ROUGH = 200  # digits of an eigenvalue, which the nearness of a time can cost 80 of
NEWTON = 5  # steps from there, or from a neighbouring point: each squares what is left


def measure_material(model: Model, solver: Any, modes: Sequence[int], points: int = POINTS) -> Certificate:
    """Measure ``material_modes`` of a model that states its Prony series."""
    found = Certificate(NAME, (m,))
    with mpmath.workdps(DIGITS):
        for count, index in grid(modes, points):
            material = Material(model, count)
            given = material.drawn(index)

            def function(given: dict[str, Any] = given) -> tuple[Any, ...]:
                K, of_point = solver.material_modes(**given)
                return (K, *of_point)

            shown = {f"{key} {k}": v for key, value in given.items() for k, v in enumerate(np.ravel(value).tolist())}
            found.see(function, material.scaled(given), shown)
    return found


class Material:
    """Exact modes of a material with given parameters, and their natural scales."""

    def __init__(self, model: Model, count: int):
        self.n, self.model, series = count, model, model.series
        symbols = [parameter.symbol for parameter in self.model.parameters]
        self.branch = sp.lambdify(symbols, (series.K, series.viscosity, series.time), modules="mpmath")

    def drawn(self, index: int) -> dict[str, Any]:
        """Parameters: times over many decades, near-equal ones among them, each with its modulus."""
        draw = random.Random(f"{self.model.parameters} {self.n} {index}")
        spread = draw.choice((1.0, 3.0, 6.0))
        given: dict[str, Any] = {}
        for parameter in self.model.parameters:
            if parameter.symbol not in self.model.series.arrays:
                given[parameter.name] = 10.0 ** draw.uniform(-3.0, 9.0)
                continue
            values = [10.0 ** draw.uniform(-spread, spread) for _ in range(self.n)]
            if self.n > 1 and draw.random() < 0.25:
                values[1] = values[0] * (1.0 + 10.0 ** draw.uniform(-12.0, -6.0))
            given[parameter.name] = np.array(values)
        return given

    def scaled(self, given: dict[str, Any]) -> np.ndarray:
        exact = {name: np.array([mpmath.mpf(v) for v in np.ravel(value).tolist()], object) for name, value in given.items()}
        near = _eigenvalues(*self._branches(exact)[1:])
        moved = (
            {**exact, name: numbers * (1 + STEP * (np.arange(len(numbers)) == k))}
            for name, numbers in exact.items()
            for k in range(len(numbers))
        )
        return naturally(partial(self._exact, near), exact, ((1, each) for each in moved))

    def _exact(self, near: np.ndarray, given: dict[str, np.ndarray]) -> np.ndarray:
        """K and every entry of the modes, in the order of the fields; ``near``: the retardation times, roughly."""
        K, times, viscosities = self._branches(given)
        for _ in range(NEWTON):  # on sum eta_i/(lambda - tau_i) = 1, for each of them
            gaps = near[:, None] - times
            near = near + ((viscosities / gaps).sum(axis=1) - 1) / (viscosities / gaps**2).sum(axis=1)
        found = exact_modes(list(times), list(near))
        return np.concatenate([np.ravel(np.array(part, dtype=object)) for part in (K, *(found[each] for each in MATERIAL))])

    def _branches(self, given: dict[str, np.ndarray]) -> tuple[mpmath.mpf, np.ndarray, np.ndarray]:
        """K; relaxation times, ascending, and their viscosities."""
        columns = zip(*np.broadcast_arrays(*given.values()), strict=True)
        of_branches = [tuple(map(mpmath.mpf, self.branch(*column))) for column in columns]
        K, viscosities, times = np.array(sorted(of_branches, key=lambda one: one[::-1]), dtype=object).T
        return K[0], times, viscosities


def _eigenvalues(times: np.ndarray, viscosities: np.ndarray) -> np.ndarray:
    """Where the stiffness vanishes, sum eta_i/(lambda - tau_i) = 1: eigenvalues of diag(tau) + v v^T with v_i^2 = eta_i."""
    with mpmath.workdps(ROUGH):
        root = np.array([mpmath.sqrt(each) for each in viscosities], dtype=object)
        matrix = mpmath.matrix((np.diag(times) + np.outer(root, root)).tolist())
        return np.array(list(mpmath.eigsy(matrix, eigvals_only=True)), dtype=object)
