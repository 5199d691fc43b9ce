"""The functions of a regime on a foundation with modes, as formulas to emit.

The zones of a regime are data. The boundary equations are theirs: what entry and exit leave for the change over a zone. The
state at the first edge is the one that a period returns: zones are affine maps of it, z -> z + drive - forget z, which the step
"period map" composes; derivatives go by the chain rule. These are functions of the generated ``modes``, loops over the zones and
products of matrices, which hold no physics. Means are the integrals of the zones, summed.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from ..averages import adhesive_rise
from ..check import Derived, derived, zero
from ..functions import Formula, Helper
from ..kernel import Kernel
from ..sequences import ADHESION, CONTACT, PERIOD, Span
from ..stable import PROFILE_INTEGRAL, PROFILE_RISE
from ..symbols import D, K, alpha, beta, p_0
from . import stable
from .regimes import ModeRegime
from .symbols import J_0, OF_STRIP, J, S, enter, eta, leave, m, share

kV = sp.Symbol("kV", nonnegative=True)
ENTRY = sp.IndexedBase("entry")


class Gap(Helper):
    """A zone of adhesion, or free."""


class Contact(Helper):
    """A zone of contact."""


class start(Helper):
    """The state at the first edge that returns after the zones of a period."""


class entries(Helper):
    """What every zone is entered with, z or in contact f, from the state at the first edge."""


@dataclass(frozen=True)
class RegimeFunction:
    """A formula that calls derived ones."""

    formula: Formula
    statement: str
    latex: str
    function: str
    paper: str = ""


def all_functions(regimes: Sequence[ModeRegime], means: Derived) -> tuple[RegimeFunction, ...]:
    """What is emitted for the regimes with edges."""
    return tuple(each for regime in regimes if regime.edges for each in regime_functions(regime, means))


def whole_kernels(springs: bool) -> tuple[Kernel, ...]:
    """What the functions of the template come to: modes of a strip, and of the material. ``springs``: every branch has one."""
    passing = (*(kV * time for time in (alpha, beta, eta)), S, J, J_0, enter, leave, share)
    prony, retardation = (K / S, alpha), (J_0 / K, J / K, beta)
    return (
        Kernel(Formula("at_speed", (m, kV), passing), passing, None),
        *([Kernel(Formula("prony", (K, m), prony), prony, None, moving=True, springs=True)] if springs else []),
        Kernel(Formula("retardation", (K, m), retardation), retardation, None),
    )


def period_map() -> Derived:
    r"""A period is an affine map of the state, and R z = c is the state that it returns. What is forgotten is
    accumulated, not what is kept: slow modes forget little, and that little keeps its digits.

    .. math:: z \to z + c_k - R_k z,\quad c = c_2 + c_1 - R_2 c_1,\ R = R_1 + R_2 - R_2 R_1
    """
    state, drive_1, drive_2, forget_1, forget_2 = sp.symbols("z c_1 c_2 R_1 R_2", commutative=False)
    after = state + drive_1 - forget_1 * state
    twice = after + drive_2 - forget_2 * after
    drive, forget = drive_2 + drive_1 - forget_2 * drive_1, forget_1 + forget_2 - forget_2 * forget_1
    return derived(
        period_map,
        (drive, forget),
        [zero("for matrices, which do not commute", sp.expand(twice - (state + drive - forget * state)))],
        latex=rf"c = {sp.latex(drive)},\quad R = {sp.latex(forget)}",
        emitted=tuple(f"state_{sequence}" for sequence in ("acaf", "afc", "af", "ac")),
    )


def regime_functions(regime: ModeRegime, means: Derived) -> tuple[RegimeFunction, ...]:
    """What is emitted for a regime with edges: its zones, from which the generated ``modes`` has all but the means."""
    args = (*regime.edges, *OF_STRIP)
    zones = Formula(f"zones_{regime.sequence}", args, tuple(_zone(regime, zone) for zone in regime.zones))
    return (
        RegimeFunction(
            zones,
            f"{regime.derived.statement} Of a zone: ends, pressure on entry, and what is missing in its boundary equation. "
            f"{'; '.join(meaning for _, meaning in (*regime.equations[1:], regime.equations[0])).capitalize()}.",
            r"R z = c,\quad \text{missing} + \Delta = 0,\quad \Delta\ \text{of the gap or of the pressure}",
            regime.derived.function,
        ),
        RegimeFunction(
            _means(regime, args, zones),
            f"Means of pressure and friction of a strip: {regime.title}.",
            means.latex,
            means.function,
            means.paper,
        ),
    )


def _zone(regime: ModeRegime, zone: Span) -> sp.Expr:
    """The zone as data; the equation of the last one is the onset, w - u - gap = 0 at the first edge."""
    missing = -regime.onset_gap if zone is regime.zones[-1] else zone.missing
    return (Contact if zone.kind == CONTACT else Gap)(zone.first, zone.last, zone.pressure, missing)


def _means(regime: ModeRegime, args: tuple[sp.Symbol, ...], zones: Formula) -> Formula:
    """The mean of w, where there is contact, for that of p, and the work of p.

    Where nothing is free the traction acts everywhere and does no work over a period: pressures count from -p_0.
    """
    raised = p_0 if regime.touches and all(zone.kind in (CONTACT, ADHESION) for zone in regime.zones) else sp.Integer(0)
    height = work = sp.Integer(0)
    for number, zone in enumerate(regime.zones):
        if zone.kind == CONTACT:
            height += PROFILE_INTEGRAL(zone.first, zone.last, D)
            work += stable.CONTACT_WORK(zone.first, zone.last, ENTRY[number], D + raised, m)
            continue
        if zone.kind != ADHESION:
            work += (zone.pressure + raised) * PROFILE_RISE(zone.first, zone.last)
        if regime.touches:
            height += stable.RELAXATION_INTEGRAL(zone.first, zone.last, ENTRY[number], zone.pressure, m)
        else:
            height += zone.pressure * (zone.last - zone.first)
    work += (raised - p_0) * adhesive_rise(regime.zones)
    met = sp.Symbol("zones")
    steps = ((met, zones(*args)), (ENTRY.label, entries(met, start(met, m), m)))
    return Formula(f"means_{regime.sequence}", args, (height / PERIOD, work / PERIOD), steps)
