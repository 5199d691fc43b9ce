"""The modes of a material from its parameters: retardation times as roots, everything else rational in the times."""

import random
from collections.abc import Sequence
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..model import Model, Series
from ..modes.states import exact_modes
from ..modes.symbols import MATERIAL, m
from .measure import DIGITS, Certificate, points_at
from .point import STEP
from .scaled import scaled

NAME = "material_modes"
POINTS = 40
RANGE = 160  # of the logarithm of a distance
ROUGH = mpmath.mpf(10) ** -35  # to which it is bisected
NEWTON = 5  # steps from there, or from a neighbouring point: each squares what is left


def measure_material(model: Model, series: Series, solver: Any, modes: Sequence[int], points: int = POINTS) -> Certificate:
    """Measure ``material_modes`` of a model that states its Prony series."""
    found = Certificate(NAME, (m,))
    with mpmath.workdps(DIGITS):
        for count in modes:
            material = Material(model, series, count)
            for index in range(points_at(count, points)):
                given = material.drawn(index)
                arguments = {key: np.array(value) if isinstance(value, list) else value for key, value in given.items()}

                def modes(given: Any = arguments) -> tuple[Any, ...]:
                    K, of_point = solver.material_modes(**given)
                    return (K, *of_point)

                shown = {f"{key} {k}": v for key, value in given.items() for k, v in enumerate(np.ravel(value).tolist())}
                found.see(modes, material.scaled(given), shown)
    return found


class Material:
    """Exact modes of a material with given parameters, and their natural scales."""

    def __init__(self, model: Model, series: Series, count: int):
        self.n, self.model, self.series = count, model, series
        symbols = [parameter.symbol for parameter in self.model.parameters]
        self.branch = sp.lambdify(symbols, (series.K, series.viscosity, series.time), modules="mpmath")

    def drawn(self, index: int) -> dict[str, float | list[float]]:
        """Parameters: times over many decades, near-equal ones among them, each with its modulus."""
        draw = random.Random(f"{self.model.parameters} {self.n} {index}")
        spread = draw.choice((1.0, 3.0, 6.0))
        given: dict[str, float | list[float]] = {}
        for parameter in self.model.parameters:
            if parameter.symbol not in self.series.arrays:
                given[parameter.name] = 10.0 ** draw.uniform(-3.0, 9.0)
                continue
            values = [10.0 ** draw.uniform(-spread, spread) for _ in range(self.n)]
            if self.n > 1 and draw.random() < 0.25:
                values[1] = values[0] * (1.0 + 10.0 ** draw.uniform(-12.0, -6.0))
            given[parameter.name] = values
        return given

    def scaled(self, given: dict[str, float | list[float]]) -> np.ndarray:
        exact = {name: np.array([mpmath.mpf(v) for v in np.ravel(value).tolist()], object) for name, value in given.items()}
        distances = [self._bisected(mode, *self._branches(exact)) for mode in range(self.n)]
        values = self._exact(exact, distances)
        sizes = abs(values)
        for name, numbers in exact.items():
            for k in range(len(numbers)):
                moved = numbers.copy()
                moved[k] *= 1 + STEP
                sizes = sizes + abs(self._exact({**exact, name: moved}, distances) - values) / STEP
        return scaled(values, sizes)

    def _exact(self, given: dict[str, np.ndarray], near: list[mpmath.mpf]) -> np.ndarray:
        """K and every entry of the modes, in the order of the fields; ``near``: distances of the roots, roughly."""
        times, viscosities = self._branches(given)
        roots = [times[mode] + self._polished(mode, times, viscosities, near[mode]) for mode in range(self.n)]
        found = exact_modes(times, roots)
        return np.concatenate(
            [np.ravel(np.array(part, dtype=object)) for part in (self._of_branch(given, 0)[0], *(found[f] for f in MATERIAL))]
        )

    def _branches(self, given: dict[str, np.ndarray]) -> tuple[list[mpmath.mpf], list[mpmath.mpf]]:
        """Relaxation times, ascending, and viscosities."""
        found = sorted(self._of_branch(given, mode)[:0:-1] for mode in range(self.n))
        return [time for time, _ in found], [viscosity for _, viscosity in found]

    def _of_branch(self, given: dict[str, np.ndarray], mode: int) -> tuple[mpmath.mpf, ...]:
        """(K, viscosity, time)."""
        return tuple(map(mpmath.mpf, self.branch(*(values[mode if len(values) > 1 else 0] for values in given.values()))))

    # The stiffness vanishes where sum eta_i/(lambda - tau_i) = 1: once above each relaxation time and below the next. Unknown is
    # the distance from the relaxation time below.

    def _bisected(self, mode: int, times: list[mpmath.mpf], viscosities: list[mpmath.mpf]) -> mpmath.mpf:
        with mpmath.workdps(60):
            high = mpmath.log(sum(viscosities) if mode + 1 == self.n else times[mode + 1] - times[mode])
            low = high - RANGE
            while high - low > ROUGH:
                middle = (low + high) / 2
                pull, _ = _pull(mode, times, viscosities, mpmath.exp(middle))
                low, high = (middle, high) if pull > 1 else (low, middle)
            return mpmath.exp(high)

    def _polished(self, mode: int, times: list[mpmath.mpf], viscosities: list[mpmath.mpf], distance: mpmath.mpf) -> mpmath.mpf:
        for _ in range(NEWTON):
            pull, slope = _pull(mode, times, viscosities, distance)
            distance = distance - (pull - 1) / slope
        return distance


def _pull(
    mode: int, times: list[mpmath.mpf], viscosities: list[mpmath.mpf], distance: mpmath.mpf
) -> tuple[mpmath.mpf, mpmath.mpf]:
    """sum eta_i/(lambda - tau_i), and its derivative by lambda."""
    terms = [(v, distance + (times[mode] - time)) for v, time in zip(viscosities, times, strict=True)]
    return sum(v / x for v, x in terms), -sum(v / x**2 for v, x in terms)
