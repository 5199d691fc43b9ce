"""The table of regimes for n modes: the zones a material point meets, with the states in which they are entered and left.

As for one mode, but the closing condition is not among the equations: the constants of integration, one state of n numbers,
are eliminated by the linear condition that it returns after a period. What is left are the events at the edges.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from ..check import BEYOND, Claim, derived, zero
from ..inequality import Inequality, relation, require
from ..regimes import out_of_reach, within_reach
from ..sequences import (
    ADHESION,
    CONTACT,
    EQUATIONS,
    FREE,
    NOTHING,
    PERIOD,
    Row,
    Span,
    edgeless_record,
    in_order,
    obeys_jump_law,
    with_edges,
    zones_of,
)
from ..symbols import D, a, b, c, d, delta_0, p_0, s
from .symbols import J_0

gap_at, gap_slope, pressure_slope = (sp.Function(name) for name in ("g", "g'", "p'"))
falls, rises = "<=", ">="
ONSET = {  # by the first edge
    d: ("onset", "the gap falls to delta_0 at d"),
    b: ("contact_begins", "the gap closes at b"),
}


@dataclass(frozen=True)
class ModeRegime(Row):
    """A row for n modes: the state at the first edge is met at the end of the last zone."""

    @property
    def onset_pressure(self) -> sp.Expr:
        return self.zones[-1].load

    @property
    def onset_gap(self) -> sp.Expr:
        return self.zones[-1].exit

    @property
    def equations(self) -> tuple[tuple[str, str], ...]:
        """(label, meaning) of each boundary equation."""
        return _equations(self.zones) if self.edges else ()


def mode_regimes(snaps: bool, closures: tuple[int, ...], threshold: sp.Expr) -> tuple[ModeRegime, ...]:
    """Every regime; without instantaneous compliance no point snaps into contact. ``threshold``: of D for complete contact."""
    trailing = (trailing_adhesion(closures),) if snaps else ()
    partial = (discrete_adhesion(closures), *trailing, adhesion_only(closures), saturated_adhesion(closures))
    return (*partial, *edgeless(closures, threshold))


def discrete_adhesion(closures: tuple[int, ...]) -> ModeRegime:
    r"""Partial contact between two adhesion zones. w steps by :math:`\mp J_0 p_0` at d and c."""
    return _partial(discrete_adhesion, "acaf", closures)


def trailing_adhesion(closures: tuple[int, ...]) -> ModeRegime:
    r"""Snap-in at d: the states are continuous, w steps by :math:`-\delta_0`, so contact is entered at :math:`-\delta_0/J_0`."""
    steps_over = require(relation("<=", delta_0 - J_0 * p_0, 0), sentence="w steps over the gap: {}")
    return _partial(trailing_adhesion, "afc", closures, snap=(steps_over,))


def adhesion_only(closures: tuple[int, ...]) -> ModeRegime:
    r"""No contact; adhesion from d to c."""
    stays = require(relation(">=", gap_at(s), 0), relation("<=", d, s, c), sentence="the gap stays open: {} for {}")
    return _partial(adhesion_only, "af", closures, stays=(stays,))


def saturated_adhesion(closures: tuple[int, ...]) -> ModeRegime:
    r"""Partial contact, the whole gap at :math:`-p_0`; with :math:`p_0 = 0` this is contact without adhesion ('cf')."""
    stays = require(
        relation("<=", gap_at(s), delta_0),
        relation("<=", a, s, b + PERIOD),
        relation("==", p_0, 0),
        sentence="the gap stays within reach: {} for {}, unless {}",
    )
    return _partial(saturated_adhesion, "ac", closures, stays=(stays,))


def edgeless(closures: tuple[int, ...], threshold: sp.Expr) -> tuple[ModeRegime, ...]:
    """No edge: complete contact, everything at -p_0, nothing."""
    saturated = require(relation(">=", D, threshold), sentence="{}, where R is modulus_ratio")
    rows = (
        ("c", CONTACT, "w = u", (saturated,)),
        ("a", ADHESION, "w = p = -p_0", within_reach()),
        ("f", FREE, "w = p = 0", (out_of_reach(),)),
    )
    found = []
    for sequence, kind, latex, admissible in rows:
        zone = Span(kind, s, s + PERIOD, NOTHING, NOTHING)
        change = zone.fields(s + PERIOD, NOTHING)[1] - zone.fields(s, NOTHING)[1]
        found.append(ModeRegime(sequence, (zone,), admissible, closures, edgeless_record(edgeless, sequence, latex, change)))
    return tuple(found)


def _partial(
    by: Callable[..., ModeRegime],
    sequence: str,
    closures: tuple[int, ...],
    snap: tuple[Inequality, ...] = (),
    stays: tuple[Inequality, ...] = (),
) -> ModeRegime:
    """A regime with edges. ``snap``, ``stays``: what it must satisfy besides the slopes at its edges and their order."""
    zones = zones_of(sequence, Span, J_0 * p_0, J_0)
    edges = tuple(zone.first for zone in zones)
    record = derived(
        by,
        sequence,
        [obeys_jump_law(zones, J_0, "[w] = J_0 [p]"), _period(zones)],
        f"regime {sequence}",
        statement=f"{with_edges(sequence, edges)}. The state at the first edge follows from them by one linear system, "
        "the edges from one event each.",
        latex=r"R z = c,\qquad \text{" + "; ".join(meaning for _, meaning in _equations(zones)) + "}",
        status=BEYOND,
        emitted=tuple(f"{kind}_{sequence}" for kind in ("state", "residual", "jacobian", "return_map")),
    )
    admissible = (*snap, _gap_approaches(zones), *stays, *_pressure_falls(zones), in_order(*edges))
    return ModeRegime(sequence, zones, admissible, closures, record)


def _equations(zones: tuple[Span, ...]) -> tuple[tuple[str, str], ...]:
    return (ONSET[zones[0].first], *(EQUATIONS[zone.last] for zone in zones[:-1]))


def _gap_approaches(zones: tuple[Span, ...]) -> Inequality:
    """How the gap comes to the edge where each zone outside contact ends, the one before the first edge first."""
    ends = [(zones[0].first, zones[-1]), *((zone.last, zone) for zone in zones[:-1] if zone.kind != CONTACT)]
    words = (f"the gap {'rises' if zone.rises else 'falls'} just before {edge}: {{}}" for edge, zone in ends)
    slopes = (relation(rises if zone.rises else falls, gap_slope(edge), 0) for edge, zone in ends)
    return require(*slopes, sentence="; ".join(words))


def _pressure_falls(zones: tuple[Span, ...]) -> tuple[Inequality, ...]:
    """So it does where contact ends."""
    ends = (zone.last for zone in zones if zone.kind == CONTACT)
    return tuple(
        require(relation(falls, pressure_slope(end), 0), sentence=f"the pressure falls just before {end}: {{}}") for end in ends
    )


def _period(zones: tuple[Span, ...]) -> Claim:
    """The zones follow each other and close after one period."""
    ends = [zone.last - zone.first for zone in zones]
    return zero("the zones are one period long", sp.Add(*ends) - PERIOD)
