"""The regimes of a strip: zones and edge conditions in, boundary equations and Jacobians out.

A regime is written down as the zones that a material point meets, each with the state in which it is entered and the
state in which it is left. Everything else follows. A state is the gap where p is given, and the excess pressure
``q = p + p_0`` in contact. The closing condition is taken as a balance, "the changes of z over a period sum to zero",
because the other way round the last zone would have to be subtracted from itself when the foundation is slow.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from . import stable
from .check import BEYOND, REPRODUCED, Check, Derived, derived, zero
from .functions import Formula, written_out
from .symbols import PARAMETERS, D, J, L, a, alpha, b, beta, c, chi, d, delta_0, p_0
from .zones import Zones

PERIOD = 2 * sp.pi
CONTACT, ADHESION, FREE = "contact", "adhesion", "free"
NOTHING = sp.Integer(0)
EQUATIONS = {  # by the edge at which a zone ends
    b: ("contact_begins", "the gap closes at b"),
    a: ("contact_ends", "the pressure falls to -p_0 at a"),
    c: ("adhesion_ends", "the gap reaches delta_0 at c from below"),
}
PERIODIC = ("period", "the changes of z over the period sum to zero, so that the gap falls to delta_0 again at d + 2 pi")


@dataclass(frozen=True)
class Zone:
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

    def after(self) -> sp.Expr:
        """The state at the end of the zone by its flow."""
        if self.kind == CONTACT:
            return stable.EXCESS_AFTER(self.first, self.last, self.entry, p_0, D, alpha, beta, L)
        return stable.GAP_AFTER(self.first, self.last, self.entry, self.load, D, beta)

    def increment(self) -> sp.Expr:
        """The change of z over the zone by its flow."""
        if self.kind == CONTACT:
            return stable.CONTACT_INCREMENT(self.first, self.last, self.entry, p_0, D, alpha, beta, J, L)
        return stable.RELAXATION_INCREMENT(self.first, self.last, self.displacement - self.load, beta)

    @property
    def displacement(self) -> sp.Expr:
        """w on entry."""
        return stable.PROFILE(self.first, D) + (NOTHING if self.kind == CONTACT else self.entry)

    def fields(self, edge: sp.Expr, state: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """(w, p) at an edge, from the state of this zone there."""
        height = stable.PROFILE(edge, D)
        return (height, state - p_0) if self.kind == CONTACT else (height + state, self.load)


@dataclass(frozen=True)
class Regime:
    """One row of the regime table. ``sequence`` names the zones in order: f free, a adhesion, c contact."""

    sequence: str
    title: str
    zones: tuple[Zone, ...]
    edges: tuple[sp.Symbol, ...]
    equations: tuple[tuple[str, sp.Expr], ...]
    jacobian: tuple[tuple[sp.Expr, ...], ...]
    admissible: tuple[str, ...]
    closures: tuple[int, ...]
    derived: Derived

    @property
    def args(self) -> tuple[sp.Symbol, ...]:
        return (*self.edges, *PARAMETERS)

    @property
    def closing(self) -> sp.Expr:
        """The closing balance."""
        return self.equations[-1][1]

    @property
    def residual_formula(self) -> Formula:
        return Formula(f"residual_{self.sequence}", self.args, tuple(term for _, term in self.equations))

    @property
    def jacobian_formula(self) -> Formula:
        return Formula(f"jacobian_{self.sequence}", self.args, self.jacobian)


def regimes(zones: Zones) -> tuple[Regime, ...]:
    """Stage 5: every regime of a strip."""
    ratio = sp.cancel(zones.jumps.closure.value / sp.Symbol("step_p", real=True))  # [w]/[p]
    return (
        discrete_adhesion(ratio),
        trailing_adhesion(ratio),
        adhesion_only(ratio),
        saturated_adhesion(ratio),
        complete_contact(),
        clinging(),
        separated(),
    )


def discrete_adhesion(ratio: sp.Expr) -> Regime:
    r"""Partial contact between two adhesion zones; unknown d, b, a, c. w steps by :math:`\mp\chi J p_0` at d and c."""
    step = ratio * p_0
    return _regime(
        discrete_adhesion,
        "acaf",
        "partial contact with discrete adhesion zones",
        (
            Zone(ADHESION, d, b, delta_0 - step, NOTHING),
            Zone(CONTACT, b, a, NOTHING, NOTHING),
            Zone(ADHESION, a, c, NOTHING, delta_0),
            Zone(FREE, c, d + PERIOD, delta_0 + step, delta_0),
        ),
        ratio,
        (
            "forcing(d) + delta_0 >= 0",
            "forcing(b) + p_0 >= 0",
            "forcing(a) + p_0 <= 0",
            "forcing(c) + p_0 + delta_0 <= 0",
            "d <= b <= a <= c <= d + 2 pi",
        ),
    )


def trailing_adhesion(ratio: sp.Expr) -> Regime:
    r"""Snap-in at d into contact, adhesion from a to c. z is continuous at d: the contact is entered at :math:`p = -\delta_0/J`."""
    return _regime(
        trailing_adhesion,
        "afc",
        "partial contact with trailing adhesion only, after a snap into contact",
        (
            Zone(CONTACT, d, a, p_0 - delta_0 / J, NOTHING),
            Zone(ADHESION, a, c, NOTHING, delta_0),
            Zone(FREE, c, d + PERIOD, delta_0 + J * p_0, delta_0),
        ),
        ratio.subs(chi, 1),
        (
            "chi == 1 and J p_0 >= delta_0",
            "forcing(d) + delta_0 >= 0",
            "forcing(a) + p_0 <= 0",
            "forcing(c) + p_0 + delta_0 <= 0",
            "d <= a <= c <= d + 2 pi",
        ),
        closures=(1,),
    )


def adhesion_only(ratio: sp.Expr) -> Regime:
    r"""No contact; adhesion from d to c."""
    step = ratio * p_0
    return _regime(
        adhesion_only,
        "af",
        "no contact, a discrete adhesion zone",
        (Zone(ADHESION, d, c, delta_0 - step, delta_0), Zone(FREE, c, d + PERIOD, delta_0 + step, delta_0)),
        ratio,
        (
            "forcing(d) + delta_0 >= 0",
            "forcing(c) + p_0 + delta_0 <= 0",
            "gap_after(d, e, delta_0 - chi J p_0, -p_0) >= 0 at the end e of the arc forcing + p_0 > 0",
            "d <= c <= d + 2 pi",
        ),
    )


def saturated_adhesion(ratio: sp.Expr) -> Regime:
    r"""Partial contact, the whole gap at :math:`-p_0`; with :math:`p_0 = 0` this is contact without adhesion ('cf')."""
    return _regime(
        saturated_adhesion,
        "ac",
        "partial contact with saturated adhesion, or without adhesion if p_0 = 0",
        (Zone(CONTACT, b, a, NOTHING, NOTHING), Zone(ADHESION, a, b + PERIOD, NOTHING, NOTHING)),
        ratio,
        (
            "forcing(b) + p_0 >= 0",
            "forcing(a) + p_0 <= 0",
            "gap_after(a, e, 0, -p_0) <= delta_0 at the end e of the arc forcing + p_0 + delta_0 < 0, unless p_0 = 0",
            "b <= a <= b + 2 pi",
        ),
    )


def complete_contact() -> Regime:
    """No edge: ``w = u`` everywhere."""
    return _edgeless(complete_contact, "c", CONTACT, "complete contact", ("D - 1 + p_0 >= modulus_ratio",))


def clinging() -> Regime:
    """No edge: the whole gap at ``-p_0``, at rest at ``w = -p_0``."""
    return _edgeless(clinging, "a", ADHESION, "no contact, saturated adhesion", ("D <= -p_0", "2 - D - p_0 <= delta_0"))


def separated() -> Regime:
    """No edge: ``w = 0``."""
    return _edgeless(separated, "f", FREE, "no interaction", ("D <= -delta_0 if p_0 > 0, else D <= 0",))


def _edgeless(by: Callable, sequence: str, kind: str, title: str, admissible: tuple[str, ...]) -> Regime:
    name = f"regime {sequence}"
    zone = Zone(kind, sp.Symbol("s_0", real=True), sp.Symbol("s_0", real=True) + PERIOD, NOTHING, NOTHING)
    if kind == CONTACT:
        residual, latex = zone.displacement - stable.PROFILE(zone.first, D), "w = u"
    else:  # a constant w at rest under its load does not change
        residual, latex = stable.RELAXATION_INCREMENT(zone.first, zone.last, zone.load - zone.load, beta), f"w = p = {sp.latex(zone.load)}"
    record = derived(by, sequence, name=name, statement=f"{title}: no unknown edge.", latex=latex,
                     checks=[zero(name, "the field is steady", residual)], status=REPRODUCED, emitted=(f"means_{sequence}",))
    return Regime(sequence, title, (zone,), (), (), (), admissible, (0, 1), record)


def _regime(
    by: Callable,
    sequence: str,
    title: str,
    zones: tuple[Zone, ...],
    ratio: sp.Expr,
    admissible: tuple[str, ...],
    closures: tuple[int, ...] = (0, 1),
) -> Regime:
    name = f"regime {sequence}"
    edges = tuple(zone.first for zone in zones)
    events = [(EQUATIONS[zone.last][0], zone.after() - zone.exit) for zone in zones[:-1]]
    equations = (*events, (PERIODIC[0], sp.Add(*(zone.increment() for zone in zones))))
    jacobian = tuple(tuple(sp.diff(term, edge) for edge in edges) for _, term in equations)
    checks = [
        _edge_conditions(name, zones, ratio),
        _closing_is_periodicity(name, zones, events, equations[-1][1], edges),
        _jacobian_is_derivative(name, equations, jacobian, edges),
    ]
    meaning = [EQUATIONS[zone.last][1] for zone in zones[:-1]] + [PERIODIC[1]]
    record = derived(
        by,
        tuple(term for _, term in equations),
        name=name,
        statement=f"{title[0].upper()}{title[1:]}: unknown edges {', '.join(map(str, edges))}; {'; '.join(meaning)}.",
        latex=r"\\ ".join(f"{sp.latex(written_out(term))} = 0" for _, term in equations),
        checks=checks,
        status=BEYOND if closures == (1,) else REPRODUCED,
        emitted=(f"residual_{sequence}", f"jacobian_{sequence}"),
    )
    return Regime(sequence, title, zones, edges, equations, jacobian, admissible, closures, record)


def _edge_conditions(name: str, zones: tuple[Zone, ...], ratio: sp.Expr) -> Check:
    """At every edge, from the exit of one zone to the entry of the next: ``[w] = chi J [p]``."""
    residuals = []
    for before, after in zip(zones, (*zones[1:], zones[0]), strict=True):
        w_before, p_before = before.fields(before.last, before.exit)
        w_after, p_after = after.fields(after.first, after.entry)
        residuals.append(w_after - w_before - ratio * (p_after - p_before))
    return zero(name, "every edge obeys the jump law, [w] = chi J [p]", residuals)


def _closing_is_periodicity(name, zones, events, closing, edges) -> Check:
    """Sum of increments = sum over zones of what w - J p misses at the zone's end: zero with the events iff periodic."""
    direct = zones[-1].after() - zones[-1].exit
    weights = [-J if zone.kind == CONTACT else 1 for zone in zones[:-1]]
    combined = sp.Add(direct, *(weight * term for weight, (_, term) in zip(weights, events, strict=True)))
    return zero(name, "given the other equations, the closing balance is the gap condition one period after the first edge",
                closing - combined, phases=edges)


def _jacobian_is_derivative(name, equations, jacobian, edges) -> Check:
    residuals = [
        sp.diff(written_out(term), edge) - written_out(entry)
        for (_, term), row in zip(equations, jacobian, strict=True)
        for edge, entry in zip(edges, row, strict=True)
    ]
    return zero(name, "the stable Jacobian equals SymPy's derivative of the equations", residuals, phases=edges)
