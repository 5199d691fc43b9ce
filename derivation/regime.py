"""The regimes of a strip: zones and edge conditions in, boundary equations out.

A regime is written down as the zones that a material point meets, each with the state in which it is entered and the
state in which it is left (:mod:`.sequences`). Everything else follows. The closing condition is taken as a balance,
"the changes of z over a period sum to zero", because the other way round the last zone would have to be subtracted from
itself when the foundation is slow.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import sympy as sp

from . import stable
from .check import BEYOND, REPRODUCED, Claim, derived, zero
from .functions import written_out
from .regimes import Edges, System
from .sequences import CONTACT, EQUATIONS, NOTHING, Inequality, Relation, Row, Span, obeys_jump_law, relation, zones_of
from .symbols import D, J, L, alpha, beta, chi, p_0, s, s_1

turn = sp.Symbol("e", real=True)  # where the gap is least or greatest
PERIODIC = ("period", "the changes of z over the period sum to zero, so that the gap falls to delta_0 again at d + 2 pi")


@dataclass(frozen=True)
class Zone(Span):
    """A zone with its flow, which takes the state at its beginning to that at its end."""

    def after(self) -> sp.Expr:
        """The state at the end of the zone by its flow."""
        if self.kind == CONTACT:
            return stable.EXCESS_AFTER(self.first, self.last, self.entry, p_0, D, alpha, beta, L)
        return stable.GAP_AFTER(self.first, self.last, self.entry, self.load, D, beta)

    def misses(self) -> sp.Expr:
        """What is left to the exit state at the end of the zone: a boundary equation."""
        if self.kind != CONTACT and self.exit != 0:  # delta_0 against delta_0: take the change
            return self.missing + stable.GAP_CHANGE(self.first, self.last, self.entry, self.load, D, beta)
        return self.after() - self.exit

    def increment(self) -> sp.Expr:
        """The change of z over the zone by its flow."""
        if self.kind == CONTACT:
            pressure = sp.expand(self.entry - p_0)  # all that counts here, so the traction is handed over as 0
            return stable.CONTACT_INCREMENT(self.first, self.last, pressure, NOTHING, D, alpha, beta, J, L)
        return stable.RELAXATION_INCREMENT(self.first, self.last, self.displacement - self.load, beta)

    def drive(self, phase: sp.Expr) -> sp.Expr:
        """What the state would come to rest at: the gap p - H, in contact the excess pressure H + p_0."""
        harmonic = stable.FORCING(phase, D, beta)
        return harmonic + p_0 if self.kind == CONTACT else self.load - harmonic

    def approach(self, edge: sp.Symbol) -> Inequality:
        """Its slope at the edge has the sign of ``drive - exit``."""
        return self.comes(edge, self.drive(edge) - self.exit, "at")

    @property
    def displacement(self) -> sp.Expr:
        """w on entry."""
        return self.fields(self.first, self.entry)[0]


@dataclass(frozen=True)
class OneTime(Edges):
    """Makes the rows of the table for one relaxation time. ``ratio``: [w]/[p] where p steps."""

    ratio: sp.Expr
    closures = (0, 1)
    at_threshold = "{}"

    @property
    def step(self) -> sp.Expr:
        return self.ratio.subs(chi, 1) * p_0

    def zones(self, sequence: str) -> tuple[Zone, ...]:
        return zones_of(sequence, Zone, self.step if sequence == "afc" else self.ratio * p_0, J)

    def all_along(self, zone: Zone, sign: str, limit: sp.Expr) -> tuple[tuple[Relation, Relation], str]:
        """The gap is least or greatest where the drive passes the limit."""
        driven = relation("<" if sign == ">=" else ">", zone.drive(s), limit)
        return (relation(sign, replace(zone, last=turn).after(), limit), driven), "at the end e of the arc {}"

    def system(
        self, by: Callable[..., Row], sequence: str, zones: tuple[Zone, ...], closures: tuple[int, ...], said: str
    ) -> System:
        events = [(EQUATIONS[zone.last][0], zone.misses()) for zone in zones[:-1]]
        equations = (*events, (PERIODIC[0], sp.Add(*(zone.increment() for zone in zones))))
        claims = [
            obeys_jump_law(zones, self.ratio.subs(chi, 1) if closures == (1,) else self.ratio, "[w] = chi J [p]"),
            _closing_is_periodicity(zones, equations),
            _slopes_have_the_sign_of_what_drives(zones),
        ]
        meaning = [EQUATIONS[zone.last][1] for zone in zones[:-1]] + [PERIODIC[1]]
        record = derived(
            by,
            tuple(term for _, term in equations),
            claims,
            f"regime {sequence}",
            statement=f"{said}; {'; '.join(meaning)}.",
            latex=r"\\ ".join(f"{sp.latex(written_out(term))} = 0" for _, term in equations),
            status=BEYOND if closures == (1,) else REPRODUCED,
            emitted=(f"residual_{sequence}",),
        )
        return record, equations


def _slopes_have_the_sign_of_what_drives(zones: tuple[Zone, ...]) -> Claim:
    residuals = []
    for zone in zones:
        state = written_out(replace(zone, last=s_1).after())
        time = alpha if zone.kind == CONTACT else beta
        residuals.append(time * sp.diff(state, s_1) + state - written_out(zone.drive(s_1)))
    firsts = tuple(zone.first for zone in zones)
    return zero("at an edge the slope times its time is drive - exit: its sign", residuals, phases=(*firsts, s_1))


def _closing_is_periodicity(zones: tuple[Zone, ...], equations: tuple[tuple[str, sp.Expr], ...]) -> Claim:
    """Sum of increments = sum over zones of what w - J p misses at the zone's end: zero with the events iff periodic."""
    *events, (_, closing) = equations
    direct = zones[-1].misses()
    weights = [-J if zone.kind == CONTACT else 1 for zone in zones[:-1]]
    combined = sp.Add(direct, *(weight * term for weight, (_, term) in zip(weights, events, strict=True)))
    return zero(
        "given the other equations, the closing balance is the gap condition one period after the first edge",
        closing - combined,
        phases=tuple(zone.first for zone in zones),
    )
