"""The table of regimes for n modes: the zones a material point meets, with the states in which they are entered and left.

As for one mode, but the closing condition is not among the equations: the constants of integration, one state of n numbers,
are eliminated by the linear condition that it returns after a period. What is left are the events at the edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ..check import BEYOND, REPRODUCED, Check, Derived, derived, zero
from ..inequality import Inequality, relation, require
from ..regime import ADHESION, CONTACT, EQUATIONS, FREE, NOTHING, PERIOD, in_order
from ..regimes import out_of_reach, within_reach
from ..symbols import D, a, b, c, d, delta_0, p_0, s
from .flows import u
from .symbols import J_0

gap_at, gap_slope, pressure_slope = (sp.Function(name) for name in ("g", "g'", "p'"))
falls, rises = "<=", ">="
ONSET = ("onset", "the gap falls to delta_0 at d")
ONSET_OF_CONTACT = ("contact_begins", "the gap closes at b")


@dataclass(frozen=True)
class ModeZone:
    """From ``first`` to ``last``; entered and left with a gap (adhesion, free) or a pressure above -p_0 (contact)."""

    kind: str
    first: sp.Symbol
    last: sp.Expr
    entry: sp.Expr
    exit: sp.Expr

    @property
    def pressure(self) -> sp.Expr:
        """Pressure on entry, which in a gap lasts."""
        return {ADHESION: -p_0, FREE: NOTHING, CONTACT: self.entry - p_0}[self.kind]

    @property
    def missing(self) -> sp.Expr:
        """What entry and exit leave for the change over the zone: the equation is ``missing + change = 0``."""
        return sp.expand(self.entry - self.exit)

    def fields(self, edge: sp.Expr, state: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """(w, p) at an edge, from the state of this zone there."""
        height = u.subs(s, edge)
        return (height, state - p_0) if self.kind == CONTACT else (height + state, self.pressure)


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
    step = J_0 * p_0
    return _partial(
        discrete_adhesion,
        "acaf",
        "partial contact with discrete adhesion zones",
        (
            ModeZone(ADHESION, d, b, delta_0 - step, NOTHING),
            ModeZone(CONTACT, b, a, NOTHING, NOTHING),
            ModeZone(ADHESION, a, c, NOTHING, delta_0),
            ModeZone(FREE, c, d + PERIOD, delta_0 + step, delta_0),
        ),
        (NOTHING, delta_0),
        (_approached((falls, d), (falls, b), (rises, c)), _pressure_falls(), in_order(d, b, a, c)),
    )


def trailing_adhesion() -> ModeRegime:
    r"""Snap-in at d: the states are continuous, w steps by :math:`-\delta_0`, so contact is entered at :math:`-\delta_0/J_0`."""
    return _partial(
        trailing_adhesion,
        "afc",
        "partial contact with trailing adhesion only, after a snap into contact",
        (
            ModeZone(CONTACT, d, a, p_0 - delta_0 / J_0, NOTHING),
            ModeZone(ADHESION, a, c, NOTHING, delta_0),
            ModeZone(FREE, c, d + PERIOD, delta_0 + J_0 * p_0, delta_0),
        ),
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
    step = J_0 * p_0
    return _partial(
        adhesion_only,
        "af",
        "no contact, a discrete adhesion zone",
        (
            ModeZone(ADHESION, d, c, delta_0 - step, delta_0),
            ModeZone(FREE, c, d + PERIOD, delta_0 + step, delta_0),
        ),
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
        "partial contact with saturated adhesion, or without adhesion if p_0 = 0",
        (ModeZone(CONTACT, b, a, NOTHING, NOTHING), ModeZone(ADHESION, a, b + PERIOD, NOTHING, NOTHING)),
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
        ("c", CONTACT, "complete contact", "w = u", (saturated,)),
        ("a", ADHESION, "no contact, saturated adhesion", "w = p = -p_0", within_reach()),
        ("f", FREE, "no interaction", "w = p = 0", (out_of_reach(),)),
    )
    found = []
    for sequence, kind, title, latex, admissible in rows:
        zone = ModeZone(kind, s, s + PERIOD, NOTHING, NOTHING)
        steady = zone.fields(s + PERIOD, NOTHING)[1] - zone.fields(s, NOTHING)[1]
        record = derived(
            edgeless,
            sequence,
            name=f"regime {sequence}",
            statement=f"{title[0].upper()}{title[1:]}: no unknown edge.",
            latex=latex,
            checks=[zero(f"regime {sequence}", "the field is steady", steady)],
            status=REPRODUCED,
            emitted=(f"means_{sequence}",),
        )
        found.append(ModeRegime(sequence, title, (zone,), (), NOTHING, NOTHING, admissible, record))
    return tuple(found)


def _approached(*edges: tuple[str, sp.Symbol]) -> Inequality:
    """How the gap comes to an edge, in the zone that ends there."""
    words = (f"the gap {'falls' if sign == falls else 'rises'} just before {edge}: {{}}" for sign, edge in edges)
    return require(*(relation(sign, gap_slope(edge), 0) for sign, edge in edges), sentence="; ".join(words))


def _pressure_falls() -> Inequality:
    return require(relation(falls, pressure_slope(a), 0), sentence="the pressure falls just before a: {}")


def _partial(by, sequence, title, zones, onset, admissible) -> ModeRegime:
    name = f"regime {sequence}"
    edges = tuple(zone.first for zone in zones)
    record = derived(
        by,
        sequence,
        name=name,
        statement=f"{title[0].upper()}{title[1:]}: unknown edges {', '.join(map(str, edges))}. The state at the first "
        f"edge follows "
        "from them by one linear system, the edges from one event each.",
        latex=r"z = \text{drive} - (\text{forget} - 1) z,\qquad \text{" + "; ".join(_meanings(zones, edges)) + "}",
        checks=[_edge_conditions(name, zones), _period(name, zones)],
        status=BEYOND,
        emitted=tuple(f"{kind}_{sequence}" for kind in ("state", "residual", "jacobian", "return_map")),
    )
    return ModeRegime(sequence, title, zones, edges, *onset, admissible, record)


def _meanings(zones: tuple[ModeZone, ...], edges: tuple[sp.Symbol, ...]) -> list[str]:
    first = ONSET if edges[0] == d else ONSET_OF_CONTACT
    return [first[1], *(EQUATIONS[zone.last][1] for zone in zones[:-1])]


def _edge_conditions(name: str, zones: tuple[ModeZone, ...]) -> Check:
    """At every edge, from the exit of one zone to the entry of the next: ``[w] = J_0 [p]``; the states have no step."""
    residuals = []
    for before, after in zip(zones, (*zones[1:], zones[0]), strict=True):
        w_before, p_before = before.fields(before.last, before.exit)
        w_after, p_after = after.fields(after.first, after.entry)
        residuals.append(w_after - w_before - J_0 * (p_after - p_before))
    return zero(name, "every edge obeys the jump law, [w] = J_0 [p]", residuals)


def _period(name: str, zones: tuple[ModeZone, ...]) -> Check:
    """The zones follow each other and close after one period."""
    ends = [zone.last - zone.first for zone in zones]
    return zero(name, "the zones are one period long", sp.Add(*ends) - PERIOD)


__all__ = ["D", "ModeRegime", "ModeZone", "mode_regimes"]
