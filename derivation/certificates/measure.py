"""The worst error of an emitted function over the grid, in ulp of its natural scale."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..functions import flat
from ..kernel import Kernel
from .grid import EDGES, TURN, drawn
from .point import Point
from .reference import Reference

EPS = 2.0**-52
DIGITS = 420  # the worst cancellation of a derived form on this grid costs about 150, the stand-in for zero 220
FLOOR = mpmath.mpf(10) ** -40  # least scale: below it lie only remains of the stand-in, and decays that underflow
POINTS = 200  # of the grid, for a function of one relaxation time
POINTS_OF_REGIME = 80  # of a function of a whole regime, whose reference costs more
COUNTS = (1, 2, 3, 5, 8, 30)  # numbers of relaxation times at which a solver for any number is measured


@dataclass
class Certificate:
    """Worst error of one function, in ulp of its natural scale, and where; collected point by point."""

    name: str
    args: tuple[sp.Symbol, ...] = ()
    worst: float = 0.0
    where: dict[str, float] = field(default_factory=dict)
    points: int = 0

    def see(self, function: Callable[[], Any], truth: np.ndarray, where: dict[str, float]) -> None:
        """Compare a result of the emitted function, nested or not, with its exact value; an overflow is infinitely far off."""
        self.points += 1
        self.where = self.where or where
        try:
            with np.errstate(all="raise", under="ignore"):
                computed = function()
        except FloatingPointError:
            self.worst, self.where = np.inf, where
            return
        for got, true in zip(_numbers(computed), np.ravel(truth), strict=True):
            ulps = float(abs(mpmath.mpf(got) - true.value) / (max(true.size, FLOOR) * EPS)) if np.isfinite(got) else np.inf
            if not ulps <= self.worst:
                self.worst, self.where = ulps, where


def points_at(modes: int, few: int) -> int:
    """How many points are enough with so many modes: each of them is a sample by itself, and costs as much."""
    return max(1, few // modes)


def measure(kernel: Kernel, solver: Any, modes: Sequence[int] = (), points: int | None = None) -> Certificate:
    """Measure one function, as ``solver`` computes it, against the kernel's exact expression.

    ``modes``: the numbers of relaxation times at which a function of a Prony series is measured; empty for one of a single time.
    ``points``: of the grid, with one relaxation time.
    """
    found = Certificate(kernel.formula.name, kernel.args)
    if points is None:
        points = POINTS_OF_REGIME if set(EDGES) & set(kernel.args) else POINTS
        points = points // 8 if modes else points
    with mpmath.workdps(DIGITS):
        reference = Reference(*_with_rest(kernel))
        for count in modes or (0,):
            for index in range(points_at(count or 1, points)):
                point = drawn(kernel.args, f"{kernel.formula.name} {index}", count, kernel.moving)
                found.see(partial(_computed, kernel, solver, point), reference(point), point.shown())
    return found


def _with_rest(kernel: Kernel) -> tuple[Any, Any]:
    """The exact expression and its parts; of a regime, the last zone is what is left of 2 pi, known to its own digits."""
    if not set(EDGES) & set(kernel.args):
        return kernel.exact, kernel.parts
    named = lambda terms: [sp.sympify(term).xreplace({sp.pi: TURN}) for term in flat(terms)]  # noqa: E731
    return named(kernel.exact), [named(terms) for terms in kernel.parts]


def _computed(kernel: Kernel, solver: Any, point: Point) -> Any:
    def called(name: str, args: Sequence[sp.Symbol]) -> Any:
        return getattr(solver, name)(*(point.argument(symbol, solver) for symbol in args))

    if kernel.chain is None:
        return called(kernel.formula.name, kernel.formula.args)
    entry, event = kernel.chain
    constants = called(entry.name, entry.args)
    return getattr(solver, event.name)(point.argument(event.args[0], solver), *constants)


def _numbers(result: Any) -> list[float]:
    """All numbers of a nested result, in order."""
    return [float(value) for part in flat(result) for value in np.ravel(np.asarray(part, dtype=float))]
