"""The rows of the table of regimes for n modes (:mod:`..regimes`).

As for one mode, but the closing condition is not among the equations: the constants of integration, one state of n numbers,
are eliminated by the linear condition that it returns after a period. What is left are the events at the edges.
"""

from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from ..check import BEYOND, derived, zero
from ..regimes import Edges, System
from ..sequences import CONTACT, EQUATIONS, PERIOD, Inequality, Relation, Row, Span, obeys_jump_law, relation, zones_of
from ..symbols import b, d, p_0, s
from .symbols import J_0

gap_at, gap_slope, pressure_slope = (sp.Function(name) for name in ("g", "g'", "p'"))
ONSET = {  # by the first edge
    d: ("onset", "the gap falls to delta_0 at d"),
    b: ("contact_begins", "the gap closes at b"),
}


@dataclass(frozen=True)
class Zone(Span):
    """A zone at whose end the state comes to an edge with a slope that its fields show."""

    def approach(self, edge: sp.Symbol) -> Inequality:
        return self.comes(edge, (pressure_slope if self.kind == CONTACT else gap_slope)(edge), "just before")


@dataclass(frozen=True)
class SeveralTimes(Edges):
    """Makes the rows of the table for n modes."""

    closures: tuple[int, ...]
    step = J_0 * p_0
    at_threshold = "{}, where R is modulus_ratio"

    def zones(self, sequence: str) -> tuple[Zone, ...]:
        return zones_of(sequence, Zone, self.step, J_0)

    def all_along(self, zone: Zone, sign: str, limit: sp.Expr) -> tuple[tuple[Relation, Relation], str]:
        return (relation(sign, gap_at(s), limit), relation("<=", zone.first, s, zone.last)), "for {}"

    def system(
        self, by: Callable[..., Row], sequence: str, zones: tuple[Zone, ...], closures: tuple[int, ...], said: str
    ) -> System:
        equations = (ONSET[zones[0].first], *(EQUATIONS[zone.last] for zone in zones[:-1]))
        record = derived(
            by,
            sequence,
            [
                obeys_jump_law(zones, J_0, "[w] = J_0 [p]"),
                zero("the zones are one period long", sp.Add(*(zone.last - zone.first for zone in zones)) - PERIOD),
            ],
            f"regime {sequence}",
            statement=f"{said}. The state at the first edge follows from them by "
            "one linear system, the edges from one event each.",
            latex=r"R z = c,\qquad \text{" + "; ".join(meaning for _, meaning in equations) + "}",
            status=BEYOND,
            emitted=tuple(f"{kind}_{sequence}" for kind in ("state", "residual", "residual_and_jacobian", "return_map")),
        )
        return record, equations
