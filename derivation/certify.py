"""Certificates: how far each emitted function is from its SymPy expression, over a deterministic stress grid.

The reference is the *derived* expression (not the stable form) evaluated with mpmath, with so many digits that at least 50
are right. The error is counted in ulp of the function's natural scale,

    scale = |f| + sum over inputs |x df/dx|,

what a relative change of eps in the inputs may do to f, plus f itself. No formula can be expected to do better, and one
that cancels more than its inputs ask for shows here. Inputs are the parameters, the position of the first phase (at least
one radian of it), and the *widths* of the zones: a zone of width 1e-9 is known to a relative eps. A boundary equation
is as exact as its parts: its scale is the sum of those of the zones that it adds up.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from .derive import Derivation
from .kernel import Kernel
from .printing import source

EPS = 2.0**-52
POINTS = 500  # of the grid of a building block
POINTS_OF_REGIME = 200  # of a function of a whole regime, whose reference costs more
DIGITS = 260  # the worst cancellation of a derived form on this grid costs about 60, the stand-in for zero 120
ZERO = mpmath.mpf(10) ** -60  # stands for a vanishing time: the derived forms divide by it
FLOOR = mpmath.mpf(10) ** -40  # least scale: below it lie only remains of ZERO, and decays that underflow
STEP = mpmath.mpf(10) ** -40
SCALE = "|f| + sum |x df/dx| over the parameters, the first phase (at least 1 rad) and the widths of the zones"
PHASES = ("d", "b", "a", "c")
Point = dict[str, mpmath.mpf]


@dataclass(frozen=True)
class Certificate:
    """Worst error of one function, in ulp of its natural scale, and where."""

    name: str
    worst: float
    points: int
    where: dict[str, float]


def certify(derivation: Derivation, solver: ModuleType) -> Iterator[Certificate]:
    """Measure every kernel of the derivation as ``solver`` computes it."""
    for kernel in derivation.kernels:
        yield measure(kernel, solver)


def measure(kernel: Kernel, solver: Any, points: int | None = None) -> Certificate:
    """Measure one function, as ``solver`` computes it, against the kernel's exact expression."""
    if points is None:
        points = POINTS_OF_REGIME if set(PHASES) & {str(argument) for argument in kernel.args} else POINTS
    names = [source(argument) for argument in kernel.args]
    with mpmath.workdps(DIGITS):
        reference = _evaluator(kernel, _flat(kernel.exact))
        scale = _scale(kernel)
        grid = [_Inputs(names, index) for index in range(points)]
        truths = [reference(inputs.exact()) for inputs in grid]
        scales = [scale(inputs) for inputs in grid]
        columns = {name: np.array([float(inputs.given[name]) for inputs in grid]) for name in names}
        computed = _called(kernel, solver, columns, points)
        worst, where = 0.0, 0
        for index in range(points):
            for got, truth, size in zip((c[index] for c in computed), truths[index], scales[index], strict=True):
                error = abs(mpmath.mpf(float(got)) - truth)
                ulps = float(error / (max(size, FLOOR) * EPS))
                if not ulps <= worst:
                    worst, where = ulps, index
        return Certificate(kernel.formula.name, worst, points, {name: float(columns[name][where]) for name in names})


def _called(kernel: Kernel, solver: Any, columns: dict[str, np.ndarray], points: int) -> list[np.ndarray]:
    arrays = dict(columns)
    if "p_1" in arrays:  # a stack: one level along the last axis
        arrays = {name: (values if name == "p_1" else values[:, None]) for name, values in arrays.items()}
    with np.errstate(all="raise", under="ignore"):
        result = kernel.computed(solver, arrays)
    return [np.broadcast_to(np.asarray(part, dtype=float), (points,)) for part in _flat(result)]


def _evaluator(kernel: Kernel, expressions: list[sp.Expr]) -> Callable[[Point], list[mpmath.mpf]]:
    symbols = kernel.args
    modules = [{"acos": lambda cosine: mpmath.acos(max(-1, min(1, cosine)))}, "mpmath"]
    evaluate = sp.lambdify(symbols, expressions, modules=modules, cse=True)
    names = [source(symbol) for symbol in symbols]
    return lambda point: [mpmath.mpf(value) for value in evaluate(*(point[name] for name in names))]


def _scale(kernel: Kernel) -> Callable[[_Inputs], list[mpmath.mpf]]:
    """Natural scale of each component; of a balance, the sum over its parts."""
    parts = kernel.parts or tuple((component,) for component in _flat(kernel.exact))
    owner = [n for n, terms in enumerate(parts) for _ in terms]
    evaluate = _evaluator(kernel, [term for terms in parts for term in terms])

    def scale(inputs: _Inputs) -> list[mpmath.mpf]:
        values = evaluate(inputs.exact())
        sizes = [abs(value) for value in values]
        for weight, point in inputs.perturbed():
            for n, (value, moved) in enumerate(zip(values, evaluate(point), strict=True)):
                sizes[n] += weight * abs(moved - value) / STEP
        return [sum((s for s, o in zip(sizes, owner, strict=True) if o == n), mpmath.mpf(0)) for n in range(len(parts))]

    return scale


def _flat(result: Any) -> list[Any]:
    return [e for part in result for e in _flat(part)] if isinstance(result, tuple) else [result]


class _Inputs:
    """One point of the grid: the float64 inputs a function is given, and the exact ones that its reference is given.

    ``base`` holds independent quantities, as floats: beta, one of J and L, the first phase and the zone widths, and the rest.
    alpha, J, L and the phases follow from them exactly; the function gets them rounded.
    """

    def __init__(self, names: list[str], index: int):
        self.names = names
        self.draw = random.Random(f"{' '.join(names)} {index}")
        self.phases = [n for n in PHASES if n in names] or [n for n in ("s", "s_0", "s_1") if n in names]
        self.base: Point = {}
        self._phases()
        self._material()
        for name in names:
            if name not in self.phases and name not in ("alpha", "beta", "J", "L"):
                self.base[name] = mpmath.mpf(self._value(name))
        if "p" in names and "p_0" in names:
            self.base["p"] = self.draw.choice((mpmath.mpf(0), -self.base["p_0"]))
        if "T_sigma" in names:
            self.base["T_sigma"] = mpmath.mpf(
                float(self.base["T_eps"] * self.base.pop("T_ratio", mpmath.mpf(self.draw.choice((0.0, 1.0, self._log(-9, 0))))))
            )
        self.given = {name: mpmath.mpf(float(value)) for name, value in self.exact(zero=mpmath.mpf(0)).items()}
        # Phases are given rounded, and the widths that count are those of the rounded phases.
        for first, second in zip(self.phases, self.phases[1:], strict=False):
            self.base[f"width {second}"] = self.given[second] - self.given[first]

    def _log(self, low: float, high: float) -> float:
        return 10.0 ** self.draw.uniform(low, high)

    def _signed(self, low: float, high: float) -> float:
        return self.draw.choice((-1.0, 1.0)) * self._log(low, high)

    def _phases(self) -> None:
        draw = self.draw
        start = draw.choice(
            (draw.uniform(-math.pi, math.pi), self._signed(-9, 0), draw.choice((-math.pi, math.pi / 2)) + self._signed(-9, -1))
        )
        if self.phases:
            self.base["start"] = mpmath.mpf(start)
        room = 2 * math.pi - 1e-2
        for name in self.phases[1:]:
            width = draw.choice((self._log(-9, 0), draw.uniform(0.0, 1.5), draw.uniform(0.0, 0.8 * room)))
            width = min(width, 0.8 * room)
            room -= width
            self.base[f"width {name}"] = mpmath.mpf(width)

    def _material(self) -> None:
        draw = self.draw
        if not {"alpha", "beta"} & set(self.names):
            return
        self.base["beta"] = mpmath.mpf(draw.choice((0.0, self._log(-8, 9), self._log(-2, 2), self._log(-8, 9), self._log(-2, 2))))
        snap = self.names[0] == "d" and "b" not in self.names and "a" in self.names  # needs J > 0
        kind = draw.choice(("J", "J", "L", "L", "J=1" if snap else "J=0", "J=1"))
        if kind == "L":
            self.base["L"] = mpmath.mpf(self._log(-9, 0))
        elif kind == "J":
            self.base["J"] = mpmath.mpf(self._log(-9, 0))
        else:
            self.base["J"] = mpmath.mpf(float(kind[-1]))

    def _value(self, name: str) -> float:
        draw = self.draw
        return {
            "D": lambda: draw.choice((0.0, self._signed(-9, 3), 1.0 + self._signed(-9, 0), draw.uniform(-2.0, 3.0))),
            "p_0": lambda: draw.choice((0.0, self._log(-6, 6), self._log(-2, 1))),
            "delta_0": lambda: draw.choice((self._log(-6, 3), self._log(-2, 1))),
            "chi": lambda: draw.choice((0.0, 1.0)),
            "p": lambda: draw.choice((0.0, -self._log(-6, 6))),
            "gap_0": lambda: draw.choice((0.0, self._log(-6, 3), self._signed(-3, 1))),
            "q_0": lambda: draw.choice((0.0, 0.0, self._signed(-6, 6))),
            "p_in": lambda: draw.choice((0.0, -self._log(-6, 6), self._signed(-3, 3))),
            "lag_0": lambda: self._signed(-6, 6),
            "w_0": lambda: self._signed(-6, 3),
            "excess": lambda: draw.choice((0.0, self._log(-6, 6))),
            "K": lambda: self._log(5, 12),
            "T_eps": lambda: self._log(-6, 3),
            "T_sigma": lambda: 0.0,
            "l": lambda: self._log(-9, -2),
            "h": lambda: self._log(-10, -3),
            "V": lambda: draw.choice((0.0, self._log(-9, 2), self._log(-9, 2))),
            "p_1": lambda: self._log(0, 9),
        }[name]()

    def exact(self, base: Point | None = None, zero: mpmath.mpf = ZERO) -> Point:
        """All inputs, exactly, from the independent ones."""
        base = self.base if base is None else base
        point = {name: value for name, value in base.items() if name in self.names}
        if "beta" in base:
            point["beta"] = base["beta"] or zero
            J = base["J"] if "J" in base else 1 - base["L"]
            point["J"] = J or zero
            point["L"] = base.get("L", 1 - J)
            point["alpha"] = point["J"] * point["beta"] if J or zero else mpmath.mpf(0)
        if self.phases:
            position = base["start"]
            point[self.phases[0]] = position
            for name in self.phases[1:]:
                position = position + base[f"width {name}"]
                point[name] = position
        return {name: point[name] for name in self.names}

    def perturbed(self) -> Iterator[tuple[mpmath.mpf, Point]]:
        """(weight, inputs) with one independent quantity at a time moved by a relative STEP."""
        for name, value in self.base.items():
            if name == "start":
                reach = max(mpmath.mpf(1), abs(value))
                yield reach, self.exact({**self.base, name: value + STEP})
            elif value != 0:
                yield mpmath.mpf(1), self.exact({**self.base, name: value * (1 + STEP)})
