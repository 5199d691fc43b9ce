"""The table of regimes of a strip: each is the list of its zones, with the states between them.

:func:`.regime.partial` makes the boundary equations of a regime from its zones and checks them.
"""

from __future__ import annotations

import sympy as sp

from .regime import ADHESION, CONTACT, FREE, NOTHING, PERIOD, Regime, Zone, edgeless, partial
from .symbols import J, a, b, c, chi, d, delta_0, p_0
from .zones import Zones


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
    r"""Partial contact between two adhesion zones; unknown d, b, a, c. w steps by :math:`\mp\chi J p_0` at d and c:

    .. math:: g(b) = 0,\quad p(a) = -p_0,\quad g(c) = \delta_0,\quad g(d + 2\pi) = \delta_0
    """
    step = ratio * p_0
    return partial(
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
    r"""Snap-in at d into contact, adhesion from a to c. z is continuous at d, so contact is entered at :math:`-\delta_0/J`:

    .. math:: p(a) = -p_0,\quad g(c) = \delta_0,\quad g(d + 2\pi) = \delta_0
    """
    return partial(
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
    r"""No contact; adhesion from d to c: :math:`g(c) = \delta_0,\ g(d + 2\pi) = \delta_0`."""
    step = ratio * p_0
    return partial(
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
    r"""Partial contact, the whole gap at :math:`-p_0`; with :math:`p_0 = 0` this is contact without adhesion ('cf'):

    .. math:: p(a) = -p_0,\quad g(b + 2\pi) = 0
    """
    return partial(
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
    r"""No edge: :math:`w = u` everywhere."""
    return edgeless(complete_contact, "c", CONTACT, "complete contact", ("D - 1 + p_0 >= modulus_ratio",))


def clinging() -> Regime:
    r"""No edge: the whole gap at :math:`-p_0`, at rest at :math:`w = -p_0`."""
    return edgeless(clinging, "a", ADHESION, "no contact, saturated adhesion", ("D <= -p_0", "2 - D - p_0 <= delta_0"))


def separated() -> Regime:
    r"""No edge: :math:`w = 0`."""
    return edgeless(separated, "f", FREE, "no interaction", ("D <= -delta_0 if p_0 > 0, else D <= 0",))
