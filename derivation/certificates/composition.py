"""A regime at one point: the derived zones put together, every value with its natural scale carried along.

The derivatives of a regime are put together here in the same way as by the emitted functions, for their scales. Their exact
values do not come from there: they are differences of the state, the boundary equations and one turn of a material point, so
small that they agree with the derivative to more than 50 digits.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..check import DerivationError
from ..functions import evaluator
from ..modes.regimes import ModeRegime
from ..modes.symbols import f_0, z, z_0
from ..sequences import CONTACT, Span
from ..symbols import p, p_in, s, s_0, s_1
from .measure import FLOOR
from .point import Point
from .reference import Reference, on_diagonal
from .scaled import Scaled, inverted

STEP = mpmath.mpf(10) ** -60  # of a difference; an error of its square remains
AGREED = mpmath.mpf(10) ** -50  # of its scale, between a difference and the derivative put together


class Composition:
    """The functions of a regime at one point. Without ``sized`` the scales are left out, which is much less work."""

    def __init__(self, regime: ModeRegime, blocks: Callable[[str], Reference], point: Point, sized: bool = True):
        self.regime, self.blocks, self.point, self.sized = regime, blocks, point, sized
        self.n = point.modes or 1
        self.onset = point.values[regime.edges[0]]

    def functions(self, agreed: bool) -> dict[str, Scaled]:
        """Exact values and natural scales of every emitted function of the regime, flattened as it returns them.

        ``agreed``: the derivatives, put together as by the emitted functions, are held against differences.
        """
        state, forgotten = self.state()
        residual, passages = self.residual(state), self.passages(state, forgotten)
        jacobian, return_map = self.jacobian(passages), self.return_map(passages)
        if agreed:
            self._agree("jacobian", jacobian, self.jacobian_by_differences())
            self._agree("return map", return_map, self.return_map_by_differences(state))
        return {
            "state": state,
            "passages": Scaled.joined([part for passage in passages for part in passage]),
            "residual": residual,
            "residual_and_jacobian": Scaled.joined([residual, jacobian]),
            "return_map": return_map,
            "means": self.means(state),
        }

    def _agree(self, what: str, composed: Scaled, exact: np.ndarray) -> None:
        for one, other, size in zip(composed.value.flat, exact.flat, composed.size.flat, strict=True):
            if abs(one - other) > AGREED * max(size, FLOOR):
                name = f"regime {self.regime.sequence}"
                raise DerivationError(name, f"the {what} is the derivative of what the derived zones do", one - other)

    # -- what a zone does ---------------------------------------------------------------------------------------------

    def _block(self, name: str, at: dict[sp.Symbol, Any], state: tuple[sp.Symbol, Scaled] | None = None) -> Scaled:
        values = {symbol: self._value(value) for symbol, value in at.items()}
        # What is left of the period for the last zone is known to the period's own digits.
        rest = {s_1: 2 * mpmath.pi} if at.get(s_1) is self.regime.zones[-1].last else {}
        point = self.point.moved(values, [symbol for symbol in (s, s_0, s_1) if symbol in values], rest)
        return self.blocks(name)(point.at(dict([state])) if state else point, self.sized)

    def _value(self, expression: Any) -> mpmath.mpf:
        if isinstance(expression, mpmath.mpf):
            return expression
        symbols, evaluate = evaluator(sp.sympify(expression), "mpmath")
        return mpmath.mpf(evaluate(*(self.point.values[symbol] for symbol in symbols)))

    def _edges(self, zone: Span) -> dict[sp.Symbol, Any]:
        return {s_0: zone.first, s_1: zone.last}

    def _overstress(self, zone: Span, state: Scaled) -> Scaled:
        return self._block("overstress", {p: zone.pressure}, (z, state))

    def _increment(self, zone: Span, state: Scaled) -> Scaled:
        if zone.kind == CONTACT:
            return self._block("contact_increment", self._edges(zone), (f_0, self._overstress(zone, state)))
        return self._block("relaxation_increment", {**self._edges(zone), p: zone.pressure}, (z_0, state))

    def _change(self, zone: Span, state: Scaled) -> Scaled:
        if zone.kind == CONTACT:
            return self._block("excess_change", self._edges(zone), (f_0, self._overstress(zone, state)))
        return self._block("gap_change", {**self._edges(zone), p: zone.pressure}, (z_0, state))

    def _gap(self, state: Scaled, pressure: sp.Expr) -> Scaled:
        """w - u at the first edge."""
        return self._block("displacement", {p: pressure}, (z, state)) - self._block("profile", {s: self.regime.edges[0]})

    # -- what the zones of a period do --------------------------------------------------------------------------------

    def state(self) -> tuple[Scaled, list[Scaled]]:
        """The state that returns after a period, at the first edge; what every zone makes it forget."""
        maps = []
        for zone in self.regime.zones:
            name, entry = ("contact_map", p_in) if zone.kind == CONTACT else ("relaxation_map", p)
            found = self._block(name, {**self._edges(zone), entry: zone.pressure})
            lost = found[: -self.n]
            maps.append((lost.reshape((self.n, self.n)) if zone.kind == CONTACT else lost, found[-self.n :]))
        nothing = np.full((self.n, self.n), mpmath.mpf(0))
        forget, drive = Scaled.of(nothing), Scaled.of(nothing[0])
        for lost, driven in maps:
            drive = drive + driven - _matrix(lost) @ drive
            forget = forget + _matrix(lost) - _matrix(lost) @ forget
        return forget.solved(drive), [lost for lost, _ in maps]

    def _along(self, state: Scaled) -> Iterator[tuple[Span, Scaled]]:
        """Every zone and the state in which it is entered."""
        for number, zone in enumerate(self.regime.zones):
            yield zone, state
            if number + 1 < len(self.regime.zones):
                state = state + self._increment(zone, state)

    def residual(self, state: Scaled) -> Scaled:
        regime = self.regime
        parts = [self._gap(state, regime.onset_pressure) - self._constant(regime.onset_gap)]
        for zone, entered in self._along(state):
            if zone is not regime.zones[-1]:
                parts.append(self._constant(zone.missing) + self._change(zone, entered))
        return Scaled.joined(parts)

    def _constant(self, expression: sp.Expr) -> Scaled:
        terms = [Scaled.of([self._value(term)]) for term in sp.Add.make_args(sp.sympify(expression))]
        return sum(terms[1:], terms[0])

    def means(self, state: Scaled) -> Scaled:
        height = work = Scaled.of([mpmath.mpf(0)])
        for zone, entered in self._along(state):
            edges = self._edges(zone)
            if zone.kind == CONTACT:
                w = self._block("profile_integral", edges)
                q = self._block("contact_work", edges, (f_0, self._overstress(zone, entered)))
            else:
                load = self._value(zone.pressure)
                q = self._block("profile_rise", edges) * Scaled.of([load])
                if self.regime.touches:
                    w = self._block("relaxation_integral", {**edges, p: zone.pressure}, (z_0, entered))
                else:
                    w = Scaled.of([load * self._value(zone.last - zone.first)])
            height, work = height + w, work + q
        return Scaled.joined([height, work]) / Scaled.of([2 * mpmath.pi])

    # -- derivatives --------------------------------------------------------------------------------------------------

    def passages(self, state: Scaled, forgotten: list[Scaled]) -> list[list[Scaled]]:
        """Of every zone: z, what of it is forgotten, its change and derivatives by the edges; the same of gap or pressure."""
        n, found = self.n, []
        for (zone, entered), lost in zip(self._along(state), forgotten, strict=True):
            name, entry = ("contact_passage", p_in) if zone.kind == CONTACT else ("relaxation_passage", p)
            flat = self._block(name, {**self._edges(zone), entry: zone.pressure}, (z_0, entered))
            parts = [entered, lost]
            for shape in ((n,), (n,), (n,), (), (n,), (), ()):
                count = n ** len(shape)
                parts.append(flat[:count].reshape(shape))
                flat = flat[count:]
            found.append(parts)
        return found

    def jacobian(self, passages: list[list[Scaled]]) -> Scaled:
        """Derivatives of the boundary equations by the edges, the periodic state moving along."""
        count = len(passages)
        nothing = Scaled.of(np.full((self.n, count), mpmath.mpf(0)))
        forget, moved = Scaled.of(np.full((self.n, self.n), mpmath.mpf(0))), nothing
        for k, passage in enumerate(passages):
            lost = _matrix(passage[1])
            forget = forget + lost - lost @ forget
            moved = self._carried(passage, k, count, moved)
        state = forget.solved(moved)
        slope = self._block("profile_slope", {s: self.regime.edges[0]})
        rows = [_with(state.sum(), 0, -slope[0])]
        for k, passage in enumerate(passages[:-1]):
            *_, by_state, by_start, by_end = passage
            rows.append(_with(_with(by_state @ state, k, by_start), k + 1, by_end))
            state = self._carried(passage, k, count, state)
        return Scaled.stacked(rows)

    def _carried(self, passage: list[Scaled], k: int, count: int, state: Scaled) -> Scaled:
        """Derivatives of the state by the edges, carried through a zone."""
        _, forget, _, by_start, by_end, *_ = passage
        after = (state - _matrix(forget) @ state).transposed
        return _with(_with(after, k, by_start), (k + 1) % count, by_end).transposed

    def return_map(self, passages: list[list[Scaled]]) -> Scaled:
        """Derivative of the state before the first edge, one period later, by the same; every event moves along."""
        *_, last_end, _, _, _, last_slope = passages[-1]
        state = Scaled.of(np.array([[mpmath.mpf(i == j) for j in range(self.n)] for i in range(self.n)], object))
        shift = -state.sum() / last_slope
        state = state + _outer(last_end, shift)
        for _, forget, _, by_start, by_end, _, by_state, change_start, change_end in passages:
            through = state - _matrix(forget) @ state + _outer(by_start, shift)
            shift = -(by_state @ state + change_start * shift) / change_end
            state = through + _outer(by_end, shift)
        return through

    # -- the same by differences --------------------------------------------------------------------------------------

    def _moved(self, edge: sp.Symbol, by: mpmath.mpf) -> Composition:
        return Composition(self.regime, self.blocks, self.point.moved({edge: self.point.values[edge] + by}, ()), sized=False)

    def jacobian_by_differences(self) -> np.ndarray:
        def residual(edge: sp.Symbol, step: mpmath.mpf) -> np.ndarray:
            moved = self._moved(edge, step)
            return moved.residual(moved.state()[0]).value

        return _slopes(residual, self.regime.edges)

    def return_map_by_differences(self, state: Scaled) -> np.ndarray:
        """One turn as a function of the state before the first edge and of the edges, which follow it by their events."""
        still = Composition(self.regime, self.blocks, self.point, sized=False)

        def of_state(mode: int, step: mpmath.mpf) -> np.ndarray:
            value = state.value.copy()
            value[mode] += step
            return still.turn(Scaled(value, 0 * value), self.onset)

        def of_edge(edge: sp.Symbol, step: mpmath.mpf) -> np.ndarray:
            return self._moved(edge, step).turn(Scaled(state.value, 0 * state.value), self.onset)

        by_state, by_edge = _slopes(of_state, range(self.n)), _slopes(of_edge, self.regime.edges)
        return by_state[: self.n] - by_edge[: self.n] @ inverted(by_edge[self.n :]) @ by_state[self.n :]

    def turn(self, state: Scaled, onset: mpmath.mpf) -> np.ndarray:
        """State one period after the phase ``onset``, and what every event's function comes to at its edge."""
        *zones, last = self.regime.zones
        first = self._value(self.regime.edges[0])
        state = state + self._block("relaxation_increment", {s_0: onset, s_1: first, p: last.pressure}, (z_0, state))
        events = [self._gap(state, last.pressure)]
        for zone in zones:
            events.append(self._change(zone, state))
            state = state + self._increment(zone, state)
        back = {s_0: last.first, s_1: onset + 2 * mpmath.pi, p: last.pressure}
        state = state + self._block("relaxation_increment", back, (z_0, state))
        return Scaled.joined([state, *events]).value


def _slopes(function: Callable[[Any, mpmath.mpf], np.ndarray], moved: Iterable[Any]) -> np.ndarray:
    """Derivatives of a function by each input that is ``moved``, a column each."""
    return np.stack([(function(each, STEP) - function(each, -STEP)) / (2 * STEP) for each in moved], axis=1)


def _with(rows: Scaled, index: int, more: Scaled) -> Scaled:
    """``rows`` with ``more`` added to the one at ``index``."""
    value, size = rows.value.copy(), rows.size.copy()
    value[index] = value[index] + more.value
    size[index] = size[index] + more.size
    return Scaled(value, size)


def _matrix(forget: Scaled) -> Scaled:
    """What a zone forgets: of a gap zone the diagonal is given."""
    return on_diagonal(forget) if forget.value.ndim == 1 else forget


def _outer(column: Scaled, row: Scaled) -> Scaled:
    return column.reshape((-1, 1)) * row.reshape((1, -1))
