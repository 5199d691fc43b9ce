"""Certificates of a model with n modes: how far each emitted function is from its SymPy expression.

As for one mode (:mod:`..certify`): the reference is the derived expression, evaluated with mpmath on exact inputs; the error is
counted in ulp of the function's natural scale, |f| + sum |x df/dx|. Inputs are the parameters, the phases, the state, and
every entry of the material's arrays, which the function is given rounded. A sum over modes or over zones is as exact as
its parts: the scale is that of each part, added up.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..certify import EPS, FLOOR, STEP, Certificate
from ..printing import source
from ..regime import CONTACT
from ..symbols import D, alpha, beta, delta_0, p, p_0, p_in, s, s_0, s_1
from .derive import ModesDerivation
from .kernel import ModeKernel
from .law import Law
from .regimes import ModeRegime
from .symbols import J_0, MATERIAL, MATRICES, STATES, f_0, m, numbered, z, z_0
from .tensor import components

POINTS = 30  # of a building block
POINTS_OF_REGIME = 12
MANY = 4  # modes, from which a point of the reference costs so much that half as many do
DIGITS = 320
ZERO = mpmath.mpf(10) ** -90  # stands for a vanishing speed, and for the relaxation time of a dashpot
Point = dict[sp.Symbol, mpmath.mpf]
PHASES = ("s", "s_0", "s_1")


def measure(kernel: ModeKernel, law: Law, solver: Any, points: int | None = None) -> Certificate:
    """Measure one function, as ``solver`` computes it, against the kernel's exact expression."""
    points = points or (POINTS if law.modes < MANY else POINTS // 2)
    with mpmath.workdps(DIGITS):
        args = _arguments(kernel)
        reference = Reference(kernel.exact, law.modes)
        grid = [Inputs(law, args, f"{kernel.formula.name} {index}", kernel.moving) for index in range(points)]
        worst, where = 0.0, grid[0]
        for inputs in grid:
            computed = _called(kernel, solver, inputs)
            for got, truth, size in zip(computed, *reference(inputs.exact), strict=True):
                ulps = float(abs(mpmath.mpf(float(got)) - truth) / (max(size, FLOOR) * EPS))
                if not ulps <= worst:
                    worst, where = ulps, inputs
        return Certificate(kernel.formula.name, worst, points, where.shown())


def certify_modes(derivation: ModesDerivation, solver: Any) -> Iterator[Certificate]:
    """Measure every kernel, and every regime's state, boundary equations and means, as ``solver`` computes them."""
    for kernel in derivation.kernels:
        yield measure(kernel, derivation.law, solver)
    yield from measure_regimes(derivation, solver)


def measured_names(derivation: ModesDerivation) -> list[str]:
    """Names of the functions that :func:`certify_modes` measures."""
    return [kernel.formula.name for kernel in derivation.kernels] + [
        f"{kind}_{regime.sequence}" for regime in derivation.regimes if regime.edges for kind in KINDS
    ]


def _arguments(kernel: ModeKernel) -> tuple[sp.Symbol, ...]:
    if kernel.chain is None:
        return kernel.formula.args
    first, *rest = kernel.chain[0].args
    return (first, s_1, *rest)


def _called(kernel: ModeKernel, solver: Any, inputs: Inputs) -> list[float]:
    given = {source(argument): inputs.argument(argument, solver) for argument in _arguments(kernel)}
    with np.errstate(all="raise", under="ignore"):
        if kernel.chain is None:
            result = getattr(solver, kernel.formula.name)(*(given[source(argument)] for argument in kernel.formula.args))
        else:
            first, event = kernel.chain
            constants = getattr(solver, first.name)(*(given[source(argument)] for argument in first.args))
            result = getattr(solver, event.name)(given[source(s_1)], *constants)
    parts = result if isinstance(result, tuple) else (result,)
    return [float(value) for part in parts for value in np.ravel(np.asarray(part, dtype=float))]


class Reference:
    """Values of an exact expression, and their natural scales, part by part of every sum."""

    def __init__(self, exact: Any, n: int):
        names = {(symbol, mode): numbered(symbol, mode) for symbol in (*MATERIAL, *STATES) for mode in range(n)}
        names |= {key: matrix_symbol(*key) for matrix in MATRICES for key in _keys(matrix, n)}
        values = components(exact, n, names)
        self.owner = [k for k, parts in enumerate(values) for _ in parts]
        parts = [part for parts in values for part in parts]
        self.count = len(values)
        self.symbols = sorted(set().union(*(part.free_symbols for part in parts)), key=str)
        self.evaluate = sp.lambdify(self.symbols, parts, modules="mpmath", cse=True)

    def __call__(self, point: Point, scales: Point | None = None) -> tuple[list[mpmath.mpf], list[mpmath.mpf]]:
        """Values and natural scales at a point. ``scales``: of inputs that are themselves computed, their natural scales."""
        values = self._at(point)
        sizes = [abs(value) for value in self._summed(values)]
        for weight, moved_point in perturbed(point, self.symbols, scales or {}):
            for k, (value, moved) in enumerate(zip(values, self._at(moved_point), strict=True)):
                sizes[self.owner[k]] += weight * abs(moved - value) / STEP
        return self._summed(values), sizes

    def _at(self, point: Point) -> list[mpmath.mpf]:
        return [mpmath.mpf(value) for value in self.evaluate(*(point[symbol] for symbol in self.symbols))]

    def _summed(self, parts: list[mpmath.mpf]) -> list[mpmath.mpf]:
        sums = [mpmath.mpf(0)] * self.count
        for k, part in zip(self.owner, parts, strict=True):
            sums[k] += part
        return sums


def _keys(matrix: sp.Symbol, n: int) -> Iterator[tuple[sp.Symbol, int, int]]:
    return ((matrix, row, column) for row in range(n) for column in range(n))


def matrix_symbol(matrix: sp.Symbol, row: int, column: int) -> sp.Symbol:
    return sp.Symbol(f"{matrix.name}_{row + 1}_{column + 1}", real=True)


def perturbed(point: Point, symbols: list[sp.Symbol], scales: Point) -> Iterator[tuple[mpmath.mpf, Point]]:
    """(weight, inputs) with one input at a time moved by a relative STEP; phases: the first one, then the width."""
    for symbol in symbols:
        value = point[symbol]
        if symbol in scales:
            if scales[symbol]:
                yield scales[symbol], {**point, symbol: value + STEP}
        elif symbol == s_1 and s_0 in point:
            yield abs(value - point[s_0]), {**point, symbol: value + STEP}
        elif str(symbol) in PHASES:
            moved = {phase: point[phase] + STEP for phase in (symbol, *((s_1,) if s_1 in point else ()))}
            yield max(mpmath.mpf(1), abs(value)), {**point, **moved}
        elif value != 0:
            yield mpmath.mpf(1), {**point, symbol: value * (1 + STEP)}


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


# -- regimes: the exact zones put together, with the natural scale carried along ------------------------------------------------

KINDS = ("state", "residual", "means")
BLOCKS = (
    "displacement",
    "overstress",
    "relaxation_increment",
    "relaxation_integral",
    "gap_change",
    "contact_increment",
    "contact_work",
    "excess_change",
    "profile",
    "profile_rise",
    "profile_integral",
    "relaxation_map",
    "contact_map",
)
Scaled = tuple[list[mpmath.mpf], list[mpmath.mpf]]


def measure_regimes(derivation: ModesDerivation, solver: Any, points: int | None = None) -> Iterator[Certificate]:
    """Measure the functions of every regime with edges against the same composition of the derived expressions."""
    law = derivation.law
    points = points or (POINTS_OF_REGIME if law.modes < MANY else POINTS_OF_REGIME // 2)
    with mpmath.workdps(DIGITS):
        blocks = {k.formula.name: Reference(k.exact, law.modes) for k in derivation.kernels if k.formula.name in BLOCKS}
        for regime in derivation.regimes:
            if not regime.edges:
                continue
            worst: dict[str, tuple[float, dict[str, float]]] = dict.fromkeys(KINDS, (0.0, {}))
            for index in range(points):
                inputs = RegimeInputs(derivation, regime, f"{regime.sequence} {index}")
                truth = Composition(regime, blocks, inputs).functions()
                for kind in KINDS:
                    given = [inputs.given[edge] for edge in regime.edges]
                    parameters = (inputs.given[p_0], inputs.given[delta_0], inputs.given[D])
                    with np.errstate(all="raise", under="ignore"):
                        found = getattr(solver, f"{kind}_{regime.sequence}")(*given, inputs.modes(solver), *parameters)
                    for got, true, size in zip(np.ravel(found), *truth[kind], strict=True):
                        ulps = float(abs(mpmath.mpf(float(got)) - true) / (max(size, FLOOR) * EPS))
                        if not ulps <= worst[kind][0]:
                            worst[kind] = (ulps, inputs.shown())
            for kind in KINDS:
                yield Certificate(f"{kind}_{regime.sequence}", worst[kind][0], points, worst[kind][1])


class RegimeInputs(Inputs):
    """Edges in their order within one period, and the parameters of a strip."""

    def __init__(self, derivation: ModesDerivation, regime: ModeRegime, seed: str):
        snaps = regime.zones[0].kind == CONTACT and regime.sequence == "afc"  # needs an instantaneous compliance
        super().__init__(derivation.law, (m, p_0, delta_0, D), seed, dashpots=not snaps)
        room = 2 * math.pi - 1e-2
        position = self.draw.uniform(-math.pi, 0.0)
        for k, edge in enumerate(regime.edges):
            width = min(self.draw.choice((self._log(-9, 0), self.draw.uniform(0.0, 2.0))), 0.8 * room) if k else 0.0
            room -= width
            position = float(position + width)
            self.exact[edge] = mpmath.mpf(position)
            self.given[edge] = position


class Composition:
    """A regime at one point: the derived zones in turn, every value with its natural scale."""

    def __init__(self, regime: ModeRegime, blocks: dict[str, Reference], inputs: Inputs):
        self.regime, self.blocks, self.point, self.n = regime, blocks, inputs.exact, inputs.n

    def functions(self) -> dict[str, Scaled]:
        """(values, natural scales) of the regime's state, boundary equations and means."""
        state = self._state()
        return {"state": state, "residual": self._residual(state), "means": self._means(state)}

    def _value(self, expression: sp.Expr) -> mpmath.mpf:
        expression = sp.sympify(expression)
        symbols = sorted(expression.free_symbols, key=str)
        return mpmath.mpf(sp.lambdify(symbols, expression, modules="mpmath")(*(self.point[symbol] for symbol in symbols)))

    def _block(self, name: str, at: dict[sp.Symbol, Any], state: tuple[sp.Symbol, Scaled] | None = None) -> Scaled:
        point = {**self.point, **{symbol: self._value(value) for symbol, value in at.items()}}
        scales: Point = {}
        if state is not None:
            symbol, (values, sizes) = state
            for mode in range(self.n):
                point[numbered(symbol, mode)] = values[mode]
                scales[numbered(symbol, mode)] = sizes[mode]
        return self.blocks[name](point, scales)

    def _edges(self, zone: Any) -> dict[sp.Symbol, Any]:
        return {s_0: zone.first, s_1: zone.last}

    def _state(self) -> Scaled:
        """The periodic state; its scale is what relative changes of every entry of every zone's map do to it."""
        n = self.n
        forget, drive = mpmath.zeros(n), mpmath.zeros(n, 1)
        forget_size, drive_size = mpmath.zeros(n), mpmath.zeros(n, 1)
        for zone in self.regime.zones:
            name, entry = ("contact_map", p_in) if zone.kind == CONTACT else ("relaxation_map", p)
            values, sizes = self._block(name, {**self._edges(zone), entry: zone.pressure})
            lost, lost_size = (mpmath.matrix(n, n) for _ in range(2))
            for row in range(n):
                for column in range(n):
                    lost[row, column], lost_size[row, column] = values[row * n + column], sizes[row * n + column]
            driven, driven_size = mpmath.matrix(values[n * n :]), mpmath.matrix(sizes[n * n :])
            drive_size = drive_size + driven_size + lost_size * drive_size
            forget_size = forget_size + lost_size + lost_size * forget_size
            drive = drive + driven - lost * drive
            forget = forget + lost - lost * forget
        inverse = forget**-1
        state = inverse * drive
        size = inverse.apply(abs) * (drive_size + forget_size * state.apply(abs)) + state.apply(abs)
        return list(state), list(size)

    def _after(self, zone: Any, state: Scaled) -> Scaled:
        """The state after a zone, carried as an emitted function carries it: plus the increment."""
        if zone.kind == CONTACT:
            change = self._block("contact_increment", self._edges(zone), (f_0, self._overstress(zone, state)))
        else:
            change = self._block("relaxation_increment", {**self._edges(zone), p: zone.pressure}, (z_0, state))
        return tuple([one + other for one, other in zip(a, b, strict=True)] for a, b in zip(state, change, strict=True))

    def _overstress(self, zone: Any, state: Scaled) -> Scaled:
        return self._block("overstress", {p: zone.pressure}, (z, state))

    def _residual(self, state: Scaled) -> Scaled:
        regime = self.regime
        first = regime.edges[0]
        (w,), (w_size,) = self._block("displacement", {p: regime.onset_pressure}, (z, state))
        (u,), (u_size,) = self._block("profile", {s: first})
        gap = self._value(regime.onset_gap)
        values, sizes = [w - u - gap], [w_size + u_size + abs(gap)]
        for zone in regime.zones[:-1]:
            if zone.kind == CONTACT:
                (change,), (size,) = self._block("excess_change", self._edges(zone), (f_0, self._overstress(zone, state)))
            else:
                (change,), (size,) = self._block("gap_change", {**self._edges(zone), p: zone.pressure}, (z_0, state))
            values.append(self._value(zone.missing) + change)
            sizes.append(sum((abs(self._value(part)) for part in sp.Add.make_args(zone.missing)), size))
            state = self._after(zone, state)
        return values, sizes

    def _means(self, state: Scaled) -> Scaled:
        touches = any(zone.kind == CONTACT for zone in self.regime.zones)
        height = height_size = work = work_size = mpmath.mpf(0)
        for zone in self.regime.zones:
            edges = self._edges(zone)
            if zone.kind == CONTACT:
                (w,), (w_size,) = self._block("profile_integral", edges)
                (q,), (q_size,) = self._block("contact_work", edges, (f_0, self._overstress(zone, state)))
            else:
                (rise,), (rise_size,) = self._block("profile_rise", edges)
                load = self._value(zone.pressure)
                q, q_size = load * rise, abs(load) * rise_size
                if touches:
                    (w,), (w_size,) = self._block("relaxation_integral", {**edges, p: zone.pressure}, (z_0, state))
                else:
                    w = load * self._value(zone.last - zone.first)
                    w_size = abs(w)
            height, height_size, work, work_size = height + w, height_size + w_size, work + q, work_size + q_size
            state = self._after(zone, state)
        period = 2 * mpmath.pi
        return [height / period, work / period], [height_size / period, work_size / period]
