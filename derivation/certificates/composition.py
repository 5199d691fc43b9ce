"""A regime at one point: the derived zones put together, every value with its natural scale carried along.

The derivatives of a regime are put together here in the same way as by the emitted functions, for their scales. Their exact
values do not come from there: they are differences of the state, the boundary equations and one turn of a material point, so
small that they agree with the derivative to more than 50 digits.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import mpmath
import numpy as np
import sympy as sp

from ..check import DerivationError
from ..modes.symbols import f_0, z, z_0
from ..sequences import CONTACT, FREE, Row, Span
from ..symbols import D, p, p_0, p_in, s, s_0, s_1
from .measure import FLOOR
from .point import Point
from .reference import Reference
from .scaled import STEP, Scaled, given, inverted, scaled, sizes, solved, values

AGREED = mpmath.mpf(10) ** -50  # of its scale, between a difference and the derivative put together
State = tuple[sp.Symbol, np.ndarray]


class Composition:
    """The functions of a regime at one point."""

    def __init__(self, regime: Row, blocks: Callable[[str], Reference], point: Point):
        self.regime, self.blocks, self.point = regime, blocks, point
        self.n = point.modes
        self.onset = point.values[regime.edges[0]]

    def functions(self, agreed: bool) -> dict[str, np.ndarray]:
        """Exact values and natural scales of every emitted function of the regime, flattened as it returns them.

        ``agreed``: the derivatives, put together as by the emitted functions, are held against differences.
        """
        forgotten, forget, drive = self.period()
        state = solved(forget, drive)
        passages = self.passages(state, forgotten)
        residual, jacobian, return_map = self.residual(passages), self.jacobian(passages, forget), self.return_map(passages)
        if agreed:
            exact_jacobian, exact_map = self.by_differences(values(state))
            self._require_same("jacobian", jacobian, exact_jacobian)
            self._require_same("return map", return_map, exact_map)
        return {
            "state": state,
            "passages": np.concatenate([np.ravel(part) for passage in passages for part in passage]),
            "residual": residual,
            "residual_and_jacobian": np.append(residual, jacobian),
            "return_map": return_map,
            "means": self.means(passages) if FREE in {zone.kind for zone in self.regime.zones} else self.raised_means(passages),
        }

    def _require_same(self, what: str, composed: np.ndarray, exact: np.ndarray) -> None:
        for one, other in zip(composed.flat, exact.flat, strict=True):
            if abs(one.value - other) > AGREED * max(one.size, FLOOR):
                name = f"regime {self.regime.sequence}"
                raise DerivationError(name, f"the {what} is the derivative of what the derived zones do", one.value - other)

    # -- what a zone does ---------------------------------------------------------------------------------------------

    def _block(self, name: str, at: dict[sp.Symbol, Any], *states: State) -> np.ndarray:
        inputs = {symbol: self.point.value(value) for symbol, value in at.items()}
        point = self.point.moved(inputs, [symbol for symbol in (s, s_0, s_1) if symbol in inputs])
        if at.get(s_1) is self.regime.zones[-1].last:  # what is left of the period is known to the period's own digits
            point = point.at({s_1: Scaled(inputs[s_1], 2 * mpmath.pi)})
        return self.blocks(name)(point.at(dict(states)))

    def _crossing(self, what: str, zone: Span, *states: State) -> np.ndarray:
        kind, pressure = ("contact", p_in) if zone.kind == CONTACT else ("relaxation", p)
        return self._block(f"{kind}_{what}", {s_0: zone.first, s_1: zone.last, pressure: zone.pressure}, *states)

    def _passage(self, zone: Span, state: np.ndarray) -> list[np.ndarray]:
        """Change of z, its derivatives by the edges; change of the gap or the pressure, its derivatives by z and the edges."""
        return np.split(self._crossing("passage", zone, (z_0, state)), np.cumsum([self.n, self.n, self.n, 1, self.n, 1]))

    def _gap(self, state: np.ndarray, pressure: sp.Expr) -> np.ndarray:
        """w - u at the first edge."""
        return self._block("displacement", {p: pressure}, (z, state)) - self._block("profile", {s: self.regime.edges[0]})

    # -- what the zones of a period do --------------------------------------------------------------------------------

    def _nothing(self, *shape: int) -> np.ndarray:
        return np.full(shape, Scaled(mpmath.mpf(0), mpmath.mpf(0)))

    def period(self) -> tuple[list[np.ndarray], np.ndarray, np.ndarray]:
        """What every zone makes the state at the first edge forget; what they do together, and what they drive it by."""
        forget, drive, forgotten = self._nothing(self.n, self.n), self._nothing(self.n), []
        for zone in self.regime.zones:
            lost, driven = np.split(self._crossing("map", zone), [-self.n])
            forgotten.append(lost.reshape(self.n, self.n) if zone.kind == CONTACT else lost)
            matrix = self._matrix(forgotten[-1])
            drive = drive + driven - matrix @ drive
            forget = forget + matrix - matrix @ forget
        return forgotten, forget, drive

    def _matrix(self, forget: np.ndarray) -> np.ndarray:
        """What a zone forgets: of a gap zone the diagonal is given."""
        return np.where(np.eye(self.n, dtype=bool), forget, self._nothing(1)) if forget.ndim == 1 else forget

    def passages(self, state: np.ndarray, forgotten: list[np.ndarray]) -> list[list[np.ndarray]]:
        """Of every zone: z on entry, what of it is forgotten, and what happens to it, from the state at the first edge."""
        found = []
        for zone, lost in zip(self.regime.zones, forgotten, strict=True):
            found.append([state, lost, *self._passage(zone, state)])
            state = state + found[-1][2]
        return found

    def residual(self, passages: list[list[np.ndarray]]) -> np.ndarray:
        *zones, last = self.regime.zones
        changes = [self._constant(zone.missing) + passage[5] for zone, passage in zip(zones, passages, strict=False)]
        onset = self._gap(passages[0][0], last.load) - self._constant(last.exit)
        return np.concatenate([onset, *changes])

    def _constant(self, expression: sp.Expr) -> np.ndarray:
        return np.sum([given([self.point.value(term)]) for term in sp.Add.make_args(sp.sympify(expression))], axis=0)

    def means(self, passages: list[list[np.ndarray]]) -> np.ndarray:
        height = work = self._nothing(1)
        for zone, (entered, *_) in zip(self.regime.zones, passages, strict=True):
            edges, load = {s_0: zone.first, s_1: zone.last}, given(self.point.value(zone.load))
            if zone.kind == CONTACT:
                height = height + self._block("profile_integral", edges)
                overstress = self._block("overstress", {p: zone.pressure}, (z, entered))
                work = work + self._block("contact_work", edges, (f_0, overstress))
                continue
            work = work + self._block("profile_rise", edges) * load
            if self.regime.touches:
                height = height + self._crossing("integral", zone, (z_0, entered))
            else:
                height = height + load * given(self.point.value(zone.last - zone.first))
        return np.concatenate([height, work]) / given(2 * mpmath.pi)

    def raised_means(self, passages: list[list[np.ndarray]]) -> np.ndarray:
        """Where nothing is free, with the scale that they have counted from -p_0: no more is lost if p_0 is large."""
        traction = self.point.values[p_0]
        inputs = {p_0: mpmath.mpf(0), D: self.point.values[D] + traction}
        raised = Composition(self.regime, self.blocks, self.point.moved(inputs, self.point.phases))
        forgotten, forget, drive = raised.period()
        p_mean, tau_mean = raised.means(raised.passages(solved(forget, drive), forgotten))
        return scaled(values(self.means(passages)), sizes(np.array([p_mean - Scaled(traction, traction), tau_mean])))

    # -- derivatives --------------------------------------------------------------------------------------------------

    def jacobian(self, passages: list[list[np.ndarray]], forget: np.ndarray) -> np.ndarray:
        """Derivatives of the boundary equations by the edges, the periodic state moving along."""
        moved = self._nothing(self.n, len(passages))
        for k, passage in enumerate(passages):
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
        _, lost, _, by_start, by_end, *_ = passage
        after = state - self._matrix(lost) @ state
        after[:, k] += by_start
        after[:, (k + 1) % len(self.regime.zones)] += by_end
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

    def by_differences(self, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Jacobian and return map from one turn: a function of the state before the first edge, which returns after it, and of
        the edges, which follow by their events."""

        def of_state(mode: int, step: mpmath.mpf) -> np.ndarray:
            changed = state.copy()
            changed[mode] += step
            return self.turn(given(changed), self.onset)

        def of_edge(edge: sp.Symbol, step: mpmath.mpf) -> np.ndarray:
            moved = self.point.moved({edge: self.point.values[edge] + step})
            return Composition(self.regime, self.blocks, moved).turn(given(state), self.onset)

        by_state, by_edge = _slopes(of_state, range(self.n)), _slopes(of_edge, self.regime.edges)
        (state_z, event_z), (state_e, event_e) = (np.split(each, [self.n]) for each in (by_state, by_edge))
        periodic = inverted(np.eye(self.n, dtype=object) - state_z) @ state_e
        return event_e + event_z @ periodic, state_z - state_e @ inverted(event_e) @ event_z

    def turn(self, state: np.ndarray, onset: mpmath.mpf) -> np.ndarray:
        """State one period after the phase ``onset``, and what every event's function comes to at its edge."""
        *zones, last = self.regime.zones
        first = self.point.value(self.regime.edges[0])
        state = state + self._block("relaxation_increment", {s_0: onset, s_1: first, p: last.pressure}, (z_0, state))
        events = [self._gap(state, last.pressure)]
        for zone in zones:
            increment, _, _, change, *_ = self._passage(zone, state)
            events.append(change)
            state = state + increment
        back = {s_0: last.first, s_1: onset + 2 * mpmath.pi, p: last.pressure}
        state = state + self._block("relaxation_increment", back, (z_0, state))
        return values(np.concatenate([state, *events]))


def _slopes(function: Callable[[Any, mpmath.mpf], np.ndarray], moved: Iterable[Any]) -> np.ndarray:
    """Derivatives of a function by each input that is ``moved``, a column each."""
    return np.stack([(function(each, STEP) - function(each, -STEP)) / (2 * STEP) for each in moved], axis=1)
