"""What a material point meets in a period, on any foundation: the zones of each regime, and the states at their ends.

A state is the gap where p is given, and the excess pressure ``q = p + p_0`` in contact. What changes it over a zone is
the foundation's: :mod:`.regime` for one relaxation time, :mod:`.modes.regimes` for several.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import sympy as sp

from . import stable
from .check import Claim, Derived, zero
from .functions import written_out
from .symbols import D, a, b, c, d, delta_0, p_0

SIGNS = {"<=": r"\le", ">=": r"\ge", "<": "<", ">": ">", "==": "="}


@dataclass(frozen=True)
class Relation:
    """Two or more sides with the same sign between them."""

    sign: str
    sides: tuple[sp.Expr, ...]

    @property
    def code(self) -> str:
        return f" {self.sign} ".join(map(str, self.sides))

    @property
    def latex(self) -> str:
        """With every call and helper written out."""
        return f" {SIGNS[self.sign]} ".join(sp.latex(written_out(side)) for side in self.sides)


@dataclass(frozen=True)
class Inequality:
    """Relations in a sentence, each in the place of a pair of braces."""

    sentence: str
    relations: tuple[Relation, ...]

    @property
    def code(self) -> str:
        return self.sentence.format(*(relation.code for relation in self.relations))

    @property
    def prose(self) -> str:
        """The sentence with LaTeX between dollars."""
        return self.sentence.format(*(f"${relation.latex}$" for relation in self.relations))


def relation(sign: str, *sides: sp.Expr | int) -> Relation:
    return Relation(sign, tuple(map(sp.sympify, sides)))


def require(*relations: Relation, sentence: str = "{}") -> Inequality:
    """``relations`` hold, in the words of ``sentence``."""
    return Inequality(sentence, relations)


PERIOD = 2 * sp.pi
CONTACT, ADHESION, FREE = "contact", "adhesion", "free"
NOTHING = sp.Integer(0)
EQUATIONS = {  # by the edge at which a zone ends
    b: ("contact_begins", "the gap closes at b"),
    a: ("contact_ends", "the pressure falls to -p_0 at a"),
    c: ("adhesion_ends", "the gap reaches delta_0 at c from below"),
}
TITLES = {  # by the zones in order: f free, a adhesion, c contact
    "acaf": "partial contact with discrete adhesion zones",
    "afc": "partial contact with trailing adhesion only, after a snap into contact",
    "af": "no contact, a discrete adhesion zone",
    "ac": "partial contact with saturated adhesion, or without adhesion if p_0 = 0",
    "a": "no contact, saturated adhesion",
    "c": "complete contact",
    "f": "no interaction",
}


PARTIAL = tuple(sequence for sequence in TITLES if len(sequence) > 1)
"""Those with edges."""


@dataclass(frozen=True)
class Span:
    """From ``first`` to ``last``; entered and left with a gap (adhesion, free) or an excess pressure (contact)."""

    kind: str
    first: sp.Symbol
    last: sp.Expr
    entry: sp.Expr
    exit: sp.Expr

    @property
    def load(self) -> sp.Expr:
        """The constant pressure of an adhesion or free zone."""
        return -p_0 if self.kind == ADHESION else NOTHING

    @property
    def pressure(self) -> sp.Expr:
        """Pressure on entry, which in a gap lasts."""
        return self.entry - p_0 if self.kind == CONTACT else self.load

    @property
    def missing(self) -> sp.Expr:
        """What entry and exit leave for the change over the zone: the equation is ``missing + change = 0``."""
        return sp.expand(self.entry - self.exit)

    @property
    def rises(self) -> bool:
        """Whether its state comes to the exit from below: the gap that reaches delta_0; contact begins and ends from above."""
        return self.kind == ADHESION and self.exit != NOTHING

    def comes(self, edge: sp.Symbol, slope: sp.Expr, where: str) -> Inequality:
        """How the state must come to the ``edge`` where the zone ends: ``slope`` has the sign of its slope there."""
        what = "the pressure" if self.kind == CONTACT else "the gap"
        sign, verb = (">=", "rises") if self.rises else ("<=", "falls")
        return require(relation(sign, slope, 0), sentence=f"{what} {verb} {where} {edge}: {{}}")

    def fields(self, edge: sp.Expr, state: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """(w, p) at an edge, from the state of this zone there."""
        height = stable.PROFILE(edge, D)
        return (height, state - p_0) if self.kind == CONTACT else (height + state, self.load)


@dataclass(frozen=True)
class Row:
    """One row of the regime table. ``sequence`` names the zones in order: f free, a adhesion, c contact."""

    sequence: str
    zones: tuple[Any, ...]
    admissible: tuple[Inequality, ...]
    closures: tuple[int, ...]
    derived: Derived
    equations: tuple[tuple[str, Any], ...] = ()  # label, and what vanishes, or what is said of it

    @property
    def title(self) -> str:
        return TITLES[self.sequence]

    @property
    def edges(self) -> tuple[sp.Symbol, ...]:
        """The unknown edges: where each zone begins, but of a single zone that goes all round."""
        return tuple(zone.first for zone in self.zones) if len(self.zones) > 1 else ()

    @property
    def touches(self) -> bool:
        return any(zone.kind == CONTACT for zone in self.zones)


Zone = TypeVar("Zone", bound=Span)


def zones_of(sequence: str, zone: Callable[..., Zone], step: sp.Expr, compliance: sp.Expr) -> tuple[Zone, ...]:
    r"""The zones of a regime with edges, in order. w falls by ``step`` at d and rises by it at c.

    A snap into contact at d leaves z as it is: contact is entered at :math:`-\delta_0/J_0`, J_0 the ``compliance``.
    """
    trailing = zone(ADHESION, a, c, NOTHING, delta_0)
    free = zone(FREE, c, d + PERIOD, delta_0 + step, delta_0)
    return {
        "acaf": (zone(ADHESION, d, b, delta_0 - step, NOTHING), zone(CONTACT, b, a, NOTHING, NOTHING), trailing, free),
        "afc": (zone(CONTACT, d, a, p_0 - delta_0 / compliance, NOTHING), trailing, free),
        "af": (zone(ADHESION, d, c, delta_0 - step, delta_0), free),
        "ac": (zone(CONTACT, b, a, NOTHING, NOTHING), zone(ADHESION, a, b + PERIOD, NOTHING, NOTHING)),
    }[sequence]


def obeys_jump_law(zones: Sequence[Span], ratio: sp.Expr, law: str) -> Claim:
    """At every edge, from the exit of one zone to the entry of the next: ``[w] = ratio [p]``, as ``law`` says."""
    residuals = []
    for before, after in zip(zones, (*zones[1:], zones[0]), strict=True):
        w_before, p_before = before.fields(before.last, before.exit)
        w_after, p_after = after.fields(after.first, after.entry)
        residuals.append(w_after - w_before - ratio * (p_after - p_before))
    return zero(f"every edge obeys the jump law, {law}", residuals)
