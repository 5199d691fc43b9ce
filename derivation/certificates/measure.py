"""The worst error of an emitted function over the grid, in ulp of its natural scale."""

from collections.abc import Callable, Iterator, Sequence
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
POINTS_OF_REGIME = 80  # of a function of a whole regime, whose reference costs more; and as many with all zones but one narrow
COUNTS = (1, 2, 3, 5, 8, 30)  # numbers of relaxation times at which a solver for any number is measured


@dataclass
class Certificate:
    """Worst error of one function, in ulp of its natural scale, and where; collected point by point."""

    name: str
    args: tuple[sp.Symbol, ...]
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


def grid(modes: Sequence[int], points: int) -> Iterator[tuple[int, int]]:
    """(number of modes, number of the point). Fewer points with more modes: each of them is a sample by itself, and costs."""
    return ((count, index) for count in modes or (0,) for index in range(max(1, points // max(1, count))))


def measure(kernel: Kernel, solver: Any, modes: Sequence[int] = (), points: int | None = None) -> Certificate:
    """Measure one function, as ``solver`` computes it, against the kernel's exact expression.

    ``modes``: the numbers of relaxation times at which a function of a Prony series is measured; empty for one of a single time.
    ``points``: of the grid, with one relaxation time.
    """
    name, of_regime = kernel.formula.name, not set(EDGES).isdisjoint(kernel.args)
    found = Certificate(name, kernel.args)
    if points is None:
        points = (POINTS_OF_REGIME if of_regime else POINTS) // (8 if modes else 1)
    # of a regime, the last zone is what is left of 2 pi, known to its own digits
    named = {sp.pi: TURN} if of_regime else {}
    exact, *parts = ([sp.sympify(term).xreplace(named) for term in flat(terms)] for terms in (kernel.exact, *kernel.parts))
    with mpmath.workdps(DIGITS):
        reference = Reference(exact, parts)
        for count, index in grid(modes, points):
            for narrow in (False, True) if of_regime else (False,):
                seed = f"{name} {index}{' narrow' * narrow}"
                point = drawn(kernel.args, seed, count, kernel.moving, narrow=narrow)
                found.see(partial(_computed, kernel, solver, point), reference(point), point.shown())
    return found


def _computed(kernel: Kernel, solver: Any, point: Point) -> Any:
    if kernel.chain is None:
        return point.called(solver, kernel.formula.name, kernel.formula.args)
    entry, event = kernel.chain
    return point.called(solver, event.name, event.args[:1], *point.called(solver, entry.name, entry.args))


def _numbers(result: Any) -> list[float]:
    """All numbers of a nested result, in order."""
    return [float(value) for part in flat(result) for value in np.ravel(np.asarray(part, dtype=float))]
