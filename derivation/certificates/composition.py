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
from ..modes.symbols import f_0, z, z_0
from ..sequences import CONTACT, Row, Span
from ..symbols import p, p_in, s, s_0, s_1
from .measure import FLOOR
from .point import Point
from .reference import Reference
from .scaled import Scaled, given, inverted, solved, values

STEP = mpmath.mpf(10) ** -60  # of a difference; an error of its square remains
AGREED = mpmath.mpf(10) ** -50  # of its scale, between a difference and the derivative put together


class Composition:
    """The functions of a regime at one point."""

    def __init__(self, regime: Row, blocks: Callable[[str], Reference], point: Point):
        self.regime, self.blocks, self.point = regime, blocks, point
        self.n = point.modes or 1
        self.onset = point.values[regime.edges[0]]

    def functions(self, agreed: bool) -> dict[str, np.ndarray]:
        """Exact values and natural scales of every emitted function of the regime, flattened as it returns them.

        ``agreed``: the derivatives, put together as by the emitted functions, are held against differences.
        """
        state, forgotten = self.state()
        residual, passages = self.residual(state), self.passages(state, forgotten)
        jacobian, return_map = self.jacobian(passages), self.return_map(passages)
        if agreed:
            self._agree("jacobian", jacobian, self.jacobian_by_differences())
            self._agree("return map", return_map, self.return_map_by_differences(values(state)))
        return {
            "state": state,
            "passages": np.concatenate([np.ravel(part) for passage in passages for part in passage]),
            "residual": residual,
            "residual_and_jacobian": np.append(residual, jacobian),
            "return_map": return_map,
            "means": self.means(state),
        }

    def _agree(self, what: str, composed: np.ndarray, exact: np.ndarray) -> None:
        for one, other in zip(composed.flat, exact.flat, strict=True):
            if abs(one.value - other) > AGREED * max(one.size, FLOOR):
                name = f"regime {self.regime.sequence}"
                raise DerivationError(name, f"the {what} is the derivative of what the derived zones do", one.value - other)

    # -- what a zone does ---------------------------------------------------------------------------------------------

    def _block(self, name: str, at: dict[sp.Symbol, Any], state: tuple[sp.Symbol, np.ndarray] | None = None) -> np.ndarray:
        inputs = {symbol: self._value(value) for symbol, value in at.items()}
        # What is left of the period for the last zone is known to the period's own digits.
        rest = {s_1: 2 * mpmath.pi} if at.get(s_1) is self.regime.zones[-1].last else {}
        point = self.point.moved(inputs, [symbol for symbol in (s, s_0, s_1) if symbol in inputs], rest)
        return self.blocks(name)(point.at(dict([state])) if state else point)

    def _value(self, expression: Any) -> mpmath.mpf:
        if isinstance(expression, mpmath.mpf):
            return expression
        symbols, evaluate = evaluator(sp.sympify(expression), "mpmath")
        return mpmath.mpf(evaluate(*(self.point.values[symbol] for symbol in symbols)))

    def _edges(self, zone: Span) -> dict[sp.Symbol, Any]:
        return {s_0: zone.first, s_1: zone.last}

    def _overstress(self, zone: Span, state: np.ndarray) -> np.ndarray:
        return self._block("overstress", {p: zone.pressure}, (z, state))

    def _increment(self, zone: Span, state: np.ndarray) -> np.ndarray:
        if zone.kind == CONTACT:
            return self._block("contact_increment", self._edges(zone), (f_0, self._overstress(zone, state)))
        return self._block("relaxation_increment", {**self._edges(zone), p: zone.pressure}, (z_0, state))

    def _change(self, zone: Span, state: np.ndarray) -> np.ndarray:
        if zone.kind == CONTACT:
            return self._block("excess_change", self._edges(zone), (f_0, self._overstress(zone, state)))
        return self._block("gap_change", {**self._edges(zone), p: zone.pressure}, (z_0, state))

    def _gap(self, state: np.ndarray, pressure: sp.Expr) -> np.ndarray:
        """w - u at the first edge."""
        return self._block("displacement", {p: pressure}, (z, state)) - self._block("profile", {s: self.regime.edges[0]})

    # -- what the zones of a period do --------------------------------------------------------------------------------

    def _nothing(self, *shape: int) -> np.ndarray:
        return np.full(shape, Scaled(mpmath.mpf(0), mpmath.mpf(0)))

    def state(self) -> tuple[np.ndarray, list[np.ndarray]]:
        """The state that returns after a period, at the first edge; what every zone makes it forget."""
        forget, drive, forgotten = self._nothing(self.n, self.n), self._nothing(self.n), []
        for zone in self.regime.zones:
            name, entry = ("contact_map", p_in) if zone.kind == CONTACT else ("relaxation_map", p)
            found = self._block(name, {**self._edges(zone), entry: zone.pressure})
            lost, driven = found[: -self.n], found[-self.n :]
            forgotten.append(lost.reshape(self.n, self.n) if zone.kind == CONTACT else lost)
            matrix = self._matrix(forgotten[-1])
            drive = drive + driven - matrix @ drive
            forget = forget + matrix - matrix @ forget
        return solved(forget, drive), forgotten

    def _matrix(self, forget: np.ndarray) -> np.ndarray:
        """What a zone forgets: of a gap zone the diagonal is given."""
        return np.where(np.eye(self.n, dtype=bool), forget, self._nothing(1)) if forget.ndim == 1 else forget

    def _along(self, state: np.ndarray) -> Iterator[tuple[Span, np.ndarray]]:
        """Every zone and the state in which it is entered."""
        for number, zone in enumerate(self.regime.zones):
            yield zone, state
            if number + 1 < len(self.regime.zones):
                state = state + self._increment(zone, state)

    def residual(self, state: np.ndarray) -> np.ndarray:
        regime = self.regime
        parts = [self._gap(state, regime.zones[-1].load) - self._constant(regime.zones[-1].exit)]
        for zone, entered in self._along(state):
            if zone is not regime.zones[-1]:
                parts.append(self._constant(zone.missing) + self._change(zone, entered))
        return np.concatenate(parts)

    def _constant(self, expression: sp.Expr) -> np.ndarray:
        return np.sum([given([self._value(term)]) for term in sp.Add.make_args(sp.sympify(expression))], axis=0)

    def means(self, state: np.ndarray) -> np.ndarray:
        height = work = self._nothing(1)
        for zone, entered in self._along(state):
            edges = self._edges(zone)
            if zone.kind == CONTACT:
                w = self._block("profile_integral", edges)
                q = self._block("contact_work", edges, (f_0, self._overstress(zone, entered)))
            else:
                load = self._value(zone.pressure)
                q = self._block("profile_rise", edges) * given(load)
                if self.regime.touches:
                    w = self._block("relaxation_integral", {**edges, p: zone.pressure}, (z_0, entered))
                else:
                    w = given(load * self._value(zone.last - zone.first))
            height, work = height + w, work + q
        return np.concatenate([height, work]) / given(2 * mpmath.pi)

    # -- derivatives --------------------------------------------------------------------------------------------------

    def passages(self, state: np.ndarray, forgotten: list[np.ndarray]) -> list[list[np.ndarray]]:
        """Of every zone: z, what of it is forgotten, its change and derivatives by the edges; the same of gap or pressure."""
        n, found = self.n, []
        for (zone, entered), lost in zip(self._along(state), forgotten, strict=True):
            name, entry = ("contact_passage", p_in) if zone.kind == CONTACT else ("relaxation_passage", p)
            flat = self._block(name, {**self._edges(zone), entry: zone.pressure}, (z_0, entered))
            found.append([entered, lost, *np.split(flat, np.cumsum([n, n, n, 1, n, 1]))])
        return found

    def jacobian(self, passages: list[list[np.ndarray]]) -> np.ndarray:
        """Derivatives of the boundary equations by the edges, the periodic state moving along."""
        forget, moved = self._nothing(self.n, self.n), self._nothing(self.n, len(passages))
        for k, passage in enumerate(passages):
            lost = self._matrix(passage[1])
            forget = forget + lost - lost @ forget
            moved = self._carried(passage, k, moved)
        state = solved(forget, moved)
        rows = [state.sum(axis=0)]
        rows[0][:1] -= self._block("profile_slope", {s: self.regime.edges[0]})
        for k, passage in enumerate(passages[:-1]):
            *_, by_state, by_start, by_end = passage
            row = by_state @ state
            row[k : k + 1] += by_start
            row[k + 1 : k + 2] += by_end
            rows.append(row)
            state = self._carried(passage, k, state)
        return np.stack(rows)

    def _carried(self, passage: list[np.ndarray], k: int, state: np.ndarray) -> np.ndarray:
        """Derivatives of the state by the edges, carried through a zone."""
        _, forget, _, by_start, by_end, *_ = passage
        after = state - self._matrix(forget) @ state
        after[:, k] += by_start
        after[:, (k + 1) % state.shape[1]] += by_end
        return after

    def return_map(self, passages: list[list[np.ndarray]]) -> np.ndarray:
        """Derivative of the state before the first edge, one period later, by the same; every event moves along."""
        *_, last_end, _, _, _, last_slope = passages[-1]
        state = given(np.array([[mpmath.mpf(i == j) for j in range(self.n)] for i in range(self.n)]))
        shift = -state.sum(axis=0) / last_slope
        state = state + np.outer(last_end, shift)
        for _, forget, _, by_start, by_end, _, by_state, change_start, change_end in passages:
            through = state - self._matrix(forget) @ state + np.outer(by_start, shift)
            shift = -(by_state @ state + change_start * shift) / change_end
            state = through + np.outer(by_end, shift)
        return through

    # -- the same by differences --------------------------------------------------------------------------------------

    def _moved(self, edge: sp.Symbol, by: mpmath.mpf) -> Composition:
        return Composition(self.regime, self.blocks, self.point.moved({edge: self.point.values[edge] + by}, ()))

    def jacobian_by_differences(self) -> np.ndarray:
        def residual(edge: sp.Symbol, step: mpmath.mpf) -> np.ndarray:
            moved = self._moved(edge, step)
            return values(moved.residual(moved.state()[0]))

        return _slopes(residual, self.regime.edges)

    def return_map_by_differences(self, state: np.ndarray) -> np.ndarray:
        """One turn as a function of the state before the first edge and of the edges, which follow it by their events."""

        def of_state(mode: int, step: mpmath.mpf) -> np.ndarray:
            changed = state.copy()
            changed[mode] += step
            return self.turn(given(changed), self.onset)

        def of_edge(edge: sp.Symbol, step: mpmath.mpf) -> np.ndarray:
            return self._moved(edge, step).turn(given(state), self.onset)

        by_state, by_edge = _slopes(of_state, range(self.n)), _slopes(of_edge, self.regime.edges)
        return by_state[: self.n] - by_edge[: self.n] @ inverted(by_edge[self.n :]) @ by_state[self.n :]

    def turn(self, state: np.ndarray, onset: mpmath.mpf) -> np.ndarray:
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
        return values(np.concatenate([state, *events]))


def _slopes(function: Callable[[Any, mpmath.mpf], np.ndarray], moved: Iterable[Any]) -> np.ndarray:
    """Derivatives of a function by each input that is ``moved``, a column each."""
    return np.stack([(function(each, STEP) - function(each, -STEP)) / (2 * STEP) for each in moved], axis=1)
