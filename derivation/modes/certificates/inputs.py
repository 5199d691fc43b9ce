"""Points of the grid on which emitted functions are measured: exact inputs, and the float64 inputs they are given."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ...sequences import CONTACT
from ...symbols import D, alpha, beta, delta_0, p_0
from ..law import Law
from ..regimes import ModeRegime
from ..symbols import J_0, MATERIAL, MATRICES, STATES, m, numbered
from .reference import PHASES, Point, matrix_symbol

ZERO = mpmath.mpf(10) ** -90  # stands for a vanishing speed, and for the relaxation time of a dashpot


class Inputs:
    """One point of the grid: exact inputs by symbol, and the float64 inputs that the emitted function is given."""

    def __init__(self, law: Law, args: tuple[sp.Symbol, ...], seed: str, moving: bool = False, dashpots: bool = True):
        self.n = law.modes
        self.draw = random.Random(f"{seed} {' '.join(map(str, args))} {self.n}")
        self.exact: Point = {}
        if m in args:
            self._material(law, moving, dashpots)
        for argument in args:
            if argument in STATES:
                for mode in range(self.n):
                    self.exact[numbered(argument, mode)] = mpmath.mpf(
                        self.draw.choice((0.0, self._signed(-6, 3), self._signed(-2, 1)))
                    )
            elif str(argument) not in PHASES and argument != m:
                self.exact[argument] = mpmath.mpf(self._value(str(argument)))
        self._phases([argument for argument in args if str(argument) in PHASES])
        self.given = {symbol: float(value) for symbol, value in self.exact.items()}
        for symbol, value in self.exact.items():
            if 0 < value < ZERO * 10**24:  # a vanishing time, or what is as small
                self.given[symbol] = 0.0
        self.exact |= {symbol: mpmath.mpf(self.given[symbol]) for symbol in args if symbol in self.exact and symbol != m}

    def _log(self, low: float, high: float) -> float:
        return 10.0 ** self.draw.uniform(low, high)

    def _signed(self, low: float, high: float) -> float:
        return self.draw.choice((-1.0, 1.0)) * self._log(low, high)

    def _material(self, law: Law, moving: bool, dashpots: bool) -> None:
        """Interlaced times as sums of positive steps over many decades, near-equal ones among them; the rest follows exactly."""
        draw = self.draw
        dashpot = law.model.P[-1] == 0 or (dashpots and draw.random() < 0.15)
        position, times = mpmath.mpf(0), []
        spread = draw.choice((1.0, 3.0, 6.0))
        for k in range(2 * self.n):
            step = self._log(-spread, spread) if k or not dashpot else 0.0
            step *= draw.choice((1.0, 1.0, 1.0, 1e-9)) if k else 1.0
            position += mpmath.mpf(step) or ZERO
            times.append(position)
        speed = mpmath.mpf(
            draw.choice((self._log(-2, 2) if moving else ZERO, self._log(-8, 6), self._log(-2, 2), self._log(-2, 2)))
        )
        symbols = [law.values[(symbol, mode)] for mode in range(self.n) for symbol in (alpha, beta)]
        at = dict(zip(symbols, (time * speed for time in times), strict=True))
        ordered = list(at)
        for key, value in law.values.items():
            symbol = key if isinstance(key, sp.Symbol) else numbered(*key) if len(key) == 2 else matrix_symbol(*key)
            self.exact[symbol] = _evaluated(value, ordered)(*(at[time] for time in ordered))

    def _phases(self, phases: list[sp.Symbol]) -> None:
        draw = self.draw
        start = draw.choice(
            (draw.uniform(-math.pi, math.pi), self._signed(-9, 0), draw.choice((-math.pi, math.pi / 2)) + self._signed(-9, -1))
        )
        for k, symbol in enumerate(sorted(phases, key=lambda phase: str(phase))):
            width = draw.choice((self._log(-9, 0), draw.uniform(0.0, 1.5), draw.uniform(0.0, 6.0))) if k else 0.0
            start = float(start + width)
            self.exact[symbol] = mpmath.mpf(start)

    def _value(self, name: str) -> float:
        draw = self.draw
        return {
            "D": lambda: draw.choice((0.0, self._signed(-9, 3), 1.0 + self._signed(-9, 0), draw.uniform(-2.0, 3.0))),
            "delta_0": lambda: draw.choice((self._log(-6, 3), self._log(-2, 1))),
            "p_0": lambda: draw.choice((0.0, self._log(-6, 6), self._log(-2, 1))),
            "p": lambda: draw.choice((0.0, -self._log(-6, 6))),
            "p_in": lambda: draw.choice((0.0, -self._log(-6, 6))),
            "kV": lambda: draw.choice((0.0, self._log(-6, 9))),
            "K": lambda: self._log(5, 12),
            "l": lambda: self._log(-9, -2),
            "h": lambda: self._log(-10, -3),
            "V": lambda: draw.choice((0.0, self._log(-9, 2), self._log(-9, 2))),
            "p_1": lambda: self._log(0, 9),
        }[name]()

    def argument(self, symbol: sp.Symbol, solver: Any) -> Any:
        """The float64 value of one argument of an emitted function."""
        if symbol == m:
            return self.modes(solver)
        if symbol in STATES:
            return np.array([self.given[numbered(symbol, mode)] for mode in range(self.n)])
        return self.given[symbol]

    def modes(self, solver: Any) -> Any:
        def field(symbol: sp.Symbol) -> Any:
            if symbol == J_0:
                return np.array(self.given[J_0])
            if symbol in MATRICES:
                return np.array([[self.given[matrix_symbol(symbol, r, c)] for c in range(self.n)] for r in range(self.n)])
            return np.array([self.given[numbered(symbol, mode)] for mode in range(self.n)])

        return solver.Modes(*(field(symbol) for symbol in MATERIAL))

    def shown(self) -> dict[str, float]:
        return {str(symbol): value for symbol, value in self.given.items()}


_functions: dict[Any, Callable[..., mpmath.mpf]] = {}


def _evaluated(value: sp.Expr, ordered: list[sp.Symbol]) -> Callable[..., mpmath.mpf]:
    key = (value, len(ordered))
    if key not in _functions:
        _functions[key] = sp.lambdify(ordered, value, modules="mpmath")
    return _functions[key]


class RegimeInputs(Inputs):
    """Edges in their order within one period, and the parameters of a strip."""

    def __init__(self, law: Law, regime: ModeRegime, seed: str):
        snaps = regime.zones[0].kind == CONTACT and regime.sequence == "afc"  # needs an instantaneous compliance
        super().__init__(law, (m, p_0, delta_0, D), seed, dashpots=not snaps)
        room = 2 * math.pi - 1e-2
        position = self.draw.uniform(-math.pi, 0.0)
        for k, edge in enumerate(regime.edges):
            width = min(self.draw.choice((self._log(-9, 0), self.draw.uniform(0.0, 2.0))), 0.8 * room) if k else 0.0
            room -= width
            position = float(position + width)
            self.exact[edge] = mpmath.mpf(position)
            self.given[edge] = position
