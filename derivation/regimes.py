"""The table of regimes of a strip with one relaxation time, each with its zones and its inequalities.

:func:`.regime.partial` makes the boundary equations of a regime from its zones and checks them.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from . import stable
from .inequality import Inequality, relation, require
from .regime import Regime, Zone, edgeless, partial
from .sequences import ADHESION, CONTACT, FREE, zones_of
from .symbols import D, J, chi, delta_0, p_0, s
from .zones import Zones

turn = sp.Symbol("e", real=True)  # where the gap is least or greatest


def regimes(zones: Zones, threshold: sp.Expr) -> tuple[Regime, ...]:
    """Stage 5: every regime of a strip. ``threshold``: of D for complete contact."""
    ratio = sp.cancel(zones.jumps.closure.value / sp.Symbol("step_p", real=True))  # [w]/[p]
    return (
        discrete_adhesion(ratio),
        trailing_adhesion(ratio),
        adhesion_only(ratio),
        saturated_adhesion(ratio),
        complete_contact(threshold),
        adhesion_everywhere(),
        separated(),
    )


def discrete_adhesion(ratio: sp.Expr) -> Regime:
    r"""Partial contact between two adhesion zones; unknown d, b, a, c. w steps by :math:`\mp\chi J p_0` at d and c:

    .. math:: g(b) = 0,\quad p(a) = -p_0,\quad g(c) = \delta_0,\quad g(d + 2\pi) = \delta_0
    """
    return partial(discrete_adhesion, "acaf", zones_of("acaf", Zone, ratio * p_0, J), ratio)


def trailing_adhesion(ratio: sp.Expr) -> Regime:
    r"""Snap-in at d into contact, adhesion from a to c. z is continuous at d, so contact is entered at :math:`-\delta_0/J`:

    .. math:: p(a) = -p_0,\quad g(c) = \delta_0,\quad g(d + 2\pi) = \delta_0
    """
    ratio = ratio.subs(chi, 1)
    step = ratio * p_0
    return partial(
        trailing_adhesion,
        "afc",
        zones_of("afc", Zone, step, J),
        ratio,
        (require(relation("==", chi, 1)), require(relation("<=", delta_0 - step, 0), sentence="w steps over the gap: {}")),
        closures=(1,),
    )


def adhesion_only(ratio: sp.Expr) -> Regime:
    r"""No contact; adhesion from d to c: :math:`g(c) = \delta_0,\ g(d + 2\pi) = \delta_0`."""
    adhesion, free = zones_of("af", Zone, ratio * p_0, J)
    return partial(
        adhesion_only,
        "af",
        (adhesion, free),
        ratio,
        (
            require(
                relation(">=", replace(adhesion, last=turn).after(), 0),
                relation("<", adhesion.drive(s), 0),
                sentence="the gap stays open: {} at the end e of the arc {}",
            ),
        ),
    )


def saturated_adhesion(ratio: sp.Expr) -> Regime:
    r"""Partial contact, the whole gap at :math:`-p_0`; with :math:`p_0 = 0` this is contact without adhesion ('cf'):

    .. math:: p(a) = -p_0,\quad g(b + 2\pi) = 0
    """
    contact, adhesion = zones_of("ac", Zone, ratio * p_0, J)
    return partial(
        saturated_adhesion,
        "ac",
        (contact, adhesion),
        ratio,
        (
            require(
                relation("<=", replace(adhesion, last=turn).after(), delta_0),
                relation(">", adhesion.drive(s), delta_0),
                relation("==", p_0, 0),
                sentence="the gap stays within reach: {} at the end e of the arc {}, unless {}",
            ),
        ),
    )


def complete_contact(threshold: sp.Expr) -> Regime:
    r"""No edge: :math:`w = u` everywhere, from the ``threshold`` of D on."""
    return edgeless(complete_contact, "c", CONTACT, (require(relation(">=", D, threshold)),))


def adhesion_everywhere() -> Regime:
    r"""No edge: the whole gap at :math:`-p_0`, at rest at :math:`w = -p_0`."""
    return edgeless(adhesion_everywhere, "a", ADHESION, within_reach())


def separated() -> Regime:
    r"""No edge: :math:`w = 0`."""
    return edgeless(separated, "f", FREE, (out_of_reach(),))


def within_reach() -> tuple[Inequality, Inequality]:
    """At rest at w = -p_0 the gap is open at the crest, s = 0, and within delta_0 in the valley, s = pi."""
    crest, valley = (-p_0 - stable.PROFILE(place, D) for place in (sp.Integer(0), sp.pi))
    return (
        require(relation(">=", crest, 0), sentence="the gap is open at the crest: {}"),
        require(relation("<=", valley, delta_0), sentence="and within reach in the valley: {}"),
    )


def out_of_reach() -> Inequality:
    """At rest at w = 0 the gap is at least delta_0 at the crest."""
    crest = -stable.PROFILE(sp.Integer(0), D)
    near, sticky, bare = relation(">=", crest, delta_0), relation(">", p_0, 0), relation(">=", crest, 0)
    return require(near, sticky, bare, sentence="the gap at the crest is out of reach: {} if {}, else {}")
