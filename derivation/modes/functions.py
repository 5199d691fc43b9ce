"""The functions of a regime on a foundation with modes, as formulas to emit.

The zones of a regime are data. The boundary equations are theirs: what entry and exit leave for the change over a zone. The
state at the first edge is the one that a period returns: zones are affine maps of it, z -> z + drive - forget z, which the step
"period map" composes; derivatives go by the chain rule. These are functions of the generated ``modes``, loops over the zones and
products of matrices, which hold no physics. So are the means: the integrals of the zones, summed.
"""

from dataclasses import replace

import sympy as sp

from ..check import Derived, derived, zero
from ..functions import Formula
from ..kernel import Kernel
from ..sequences import ADHESION, CONTACT, FREE, PARTIAL, Row, Span
from ..symbols import alpha, beta
from .symbols import J_0, OF_STRIP, J, S, enter, eta, leave, m, share

kV = sp.Symbol("kV", nonnegative=True)


KINDS = {ADHESION: sp.Function("Adhesion"), FREE: sp.Function("Free"), CONTACT: sp.Function("Contact")}
"""The zones of the generated ``modes``."""


def whole_kernels() -> tuple[Kernel, ...]:
    """What the template's modes of a strip come to."""
    passing = (*(kV * time for time in (alpha, beta, eta)), S, J, J_0, enter, leave, share)
    return (Kernel(Formula("at_speed", (m, kV), passing), passing, None),)


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
        emitted=tuple(f"state_{sequence}" for sequence in PARTIAL),
    )


def zones_function(regime: Row) -> tuple[Formula, Derived]:
    """The zones of a regime with edges, from which the generated ``modes`` has all its functions."""
    zones = Formula(f"zones_{regime.sequence}", (*regime.edges, *OF_STRIP), tuple(_zone(regime, zone) for zone in regime.zones))
    record = replace(
        regime.derived,
        statement=f"{regime.derived.statement} Of a zone: ends, pressure on entry, and what is missing in its boundary equation. "
        f"{'; '.join(meaning for _, meaning in (*regime.equations[1:], regime.equations[0])).capitalize()}.",
        latex=r"R z = c,\quad \text{missing} + \Delta = 0,\quad \Delta\ \text{of the gap or of the pressure}",
    )
    return zones, record


def _zone(regime: Row, zone: Span) -> sp.Expr:
    """The zone as data; the equation of the last one is the onset, w - u - gap = 0 at the first edge."""
    missing = -zone.exit if zone is regime.zones[-1] else zone.missing
    return KINDS[zone.kind](zone.first, zone.last, zone.pressure, missing)
