"""The table of regimes for n modes: the zones a material point meets, with the states in which they are entered and left.

As for one mode, but the closing condition is not among the equations: the constants of integration, one state of n numbers,
are eliminated by the linear condition that it returns after a period. What is left are the events at the edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ..check import Check, Derived, derived, zero
from ..inequality import Inequality, relation, require
from ..regime import in_order
from ..regimes import out_of_reach, within_reach
from ..sequences import (
    ADHESION,
    CONTACT,
    EQUATIONS,
    FREE,
    NOTHING,
    PERIOD,
    TITLES,
    Span,
    edgeless_record,
    obeys_jump_law,
    with_edges,
    zones_of,
)
from ..symbols import D, a, b, c, d, delta_0, p_0, s
from .symbols import J_0

gap_at, gap_slope, pressure_slope = (sp.Function(name) for name in ("g", "g'", "p'"))
falls, rises = "<=", ">="
ONSET = ("onset", "the gap falls to delta_0 at d")
ONSET_OF_CONTACT = ("contact_begins", "the gap closes at b")


@dataclass(frozen=True)
class ModeZone(Span):
    """A zone; the linear maps of its state and of what it adds to z are kernels."""

    @property
    def pressure(self) -> sp.Expr:
        """Pressure on entry, which in a gap lasts."""
        return self.entry - p_0 if self.kind == CONTACT else self.load

    @property
    def missing(self) -> sp.Expr:
        """What entry and exit leave for the change over the zone: the equation is ``missing + change = 0``."""
        return sp.expand(self.entry - self.exit)


@dataclass(frozen=True)
class ModeRegime:
    """One row of the regime table."""

    sequence: str
    title: str
    zones: tuple[ModeZone, ...]
    edges: tuple[sp.Symbol, ...]
    onset_pressure: sp.Expr  # p on the side where the state at the first edge is met
    onset_gap: sp.Expr  # the gap there
    admissible: tuple[Inequality, ...]
    derived: Derived

    @property
    def equations(self) -> tuple[tuple[str, str], ...]:
        """(label, meaning) of each boundary equation."""
        first = ONSET if self.edges[0] == d else ONSET_OF_CONTACT
        return (first, *(EQUATIONS[zone.last] for zone in self.zones[:-1]))


def mode_regimes(snaps: bool, threshold: sp.Expr) -> tuple[ModeRegime, ...]:
    """Every regime; without instantaneous compliance no point snaps into contact. ``threshold``: of D for complete contact."""
    trailing = (trailing_adhesion(),) if snaps else ()
    return (discrete_adhesion(), *trailing, adhesion_only(), saturated_adhesion(), *edgeless(threshold))


def discrete_adhesion() -> ModeRegime:
    r"""Partial contact between two adhesion zones. w steps by :math:`\mp J_0 p_0` at d and c."""
    return _partial(
        discrete_adhesion,
        "acaf",
        (NOTHING, delta_0),
        (_approached((falls, d), (falls, b), (rises, c)), _pressure_falls(), in_order(d, b, a, c)),
    )


def trailing_adhesion() -> ModeRegime:
    r"""Snap-in at d: the states are continuous, w steps by :math:`-\delta_0`, so contact is entered at :math:`-\delta_0/J_0`."""
    return _partial(
        trailing_adhesion,
        "afc",
        (NOTHING, delta_0),
        (
            require(relation("<=", delta_0 - J_0 * p_0, 0), sentence="w steps over the gap: {}"),
            _approached((falls, d), (rises, c)),
            _pressure_falls(),
            in_order(d, a, c),
        ),
    )


def adhesion_only() -> ModeRegime:
    r"""No contact; adhesion from d to c."""
    return _partial(
        adhesion_only,
        "af",
        (NOTHING, delta_0),
        (
            _approached((falls, d), (rises, c)),
            require(relation(">=", gap_at(s), 0), relation("<=", d, s, c), sentence="the gap stays open: {} for {}"),
            in_order(d, c),
        ),
    )


def saturated_adhesion() -> ModeRegime:
    r"""Partial contact, the whole gap at :math:`-p_0`; with :math:`p_0 = 0` this is contact without adhesion ('cf')."""
    return _partial(
        saturated_adhesion,
        "ac",
        (-p_0, NOTHING),
        (
            _approached((falls, b)),
            require(
                relation("<=", gap_at(s), delta_0),
                relation("<=", a, s, b + PERIOD),
                relation("==", p_0, 0),
                sentence="the gap stays within reach: {} for {}, unless {}",
            ),
            _pressure_falls(),
            in_order(b, a),
        ),
    )


def edgeless(threshold: sp.Expr) -> tuple[ModeRegime, ...]:
    """No edge: complete contact, everything at -p_0, nothing."""
    saturated = require(relation(">=", D, threshold), sentence="{}, where R is modulus_ratio")
    rows = (
        ("c", CONTACT, "w = u", (saturated,)),
        ("a", ADHESION, "w = p = -p_0", within_reach()),
        ("f", FREE, "w = p = 0", (out_of_reach(),)),
    )
    found = []
    for sequence, kind, latex, admissible in rows:
        zone = ModeZone(kind, s, s + PERIOD, NOTHING, NOTHING)
        change = zone.fields(s + PERIOD, NOTHING)[1] - zone.fields(s, NOTHING)[1]
        record = edgeless_record(edgeless, sequence, latex, change)
        found.append(ModeRegime(sequence, TITLES[sequence], (zone,), (), NOTHING, NOTHING, admissible, record))
    return tuple(found)


def _approached(*edges: tuple[str, sp.Symbol]) -> Inequality:
    """How the gap comes to an edge, in the zone that ends there."""
    words = (f"the gap {'falls' if sign == falls else 'rises'} just before {edge}: {{}}" for sign, edge in edges)
    return require(*(relation(sign, gap_slope(edge), 0) for sign, edge in edges), sentence="; ".join(words))


def _pressure_falls() -> Inequality:
    return require(relation(falls, pressure_slope(a), 0), sentence="the pressure falls just before a: {}")


def _partial(by, sequence, onset, admissible) -> ModeRegime:
    name = f"regime {sequence}"
    zones = zones_of(sequence, ModeZone, J_0 * p_0, J_0)
    edges = tuple(zone.first for zone in zones)
    record = derived(
        by,
        sequence,
        name=name,
        statement=f"{with_edges(sequence, edges)}. The state at the first edge follows from them by one linear system, "
        "the edges from one event each.",
        latex=r"R z = c,\qquad \text{" + "; ".join(_meanings(zones, edges)) + "}",
        checks=[obeys_jump_law(name, zones, J_0, "[w] = J_0 [p]"), _period(name, zones)],
        emitted=tuple(f"{kind}_{sequence}" for kind in ("state", "residual", "jacobian", "return_map")),
    )
    return ModeRegime(sequence, TITLES[sequence], zones, edges, *onset, admissible, record)


def _meanings(zones: tuple[ModeZone, ...], edges: tuple[sp.Symbol, ...]) -> list[str]:
    first = ONSET if edges[0] == d else ONSET_OF_CONTACT
    return [first[1], *(EQUATIONS[zone.last][1] for zone in zones[:-1])]


def _period(name: str, zones: tuple[ModeZone, ...]) -> Check:
    """The zones follow each other and close after one period."""
    ends = [zone.last - zone.first for zone in zones]
    return zero(name, "the zones are one period long", sp.Add(*ends) - PERIOD)


__all__ = ["D", "ModeRegime", "ModeZone", "mode_regimes"]
