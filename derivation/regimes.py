"""The table of regimes of a strip: each is the list of its zones, with the states between them.

:func:`.regime.partial` makes the boundary equations of a regime from its zones and checks them.
"""

from __future__ import annotations

import sympy as sp

from . import stable
from .inequality import Inequality, relation, require
from .regime import ADHESION, CONTACT, FREE, NOTHING, PERIOD, Regime, Zone, edgeless, partial
from .symbols import D, J, a, alpha, b, beta, c, chi, d, delta_0, p_0, s
from .zones import Zones

turn = sp.Symbol("e", real=True)  # where the gap is least or greatest


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
            _falls_into_adhesion(),
            _falls_into_contact(),
            _leaves_contact(),
            _leaves_adhesion(),
            in_order(d, b, a, c),
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
            require(relation("==", chi, 1), relation(">=", J * p_0, delta_0), sentence="{} and {}"),
            _falls_into_adhesion(),
            _leaves_contact(),
            _leaves_adhesion(),
            in_order(d, a, c),
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
            _falls_into_adhesion(),
            _leaves_adhesion(),
            require(
                relation(">=", stable.GAP_AFTER(d, turn, delta_0 - chi * J * p_0, -p_0, D, beta), 0),
                relation(">", _load(s) + p_0, 0),
                sentence="the gap stays open: {} at the end e of the arc {}",
            ),
            in_order(d, c),
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
            _falls_into_contact(),
            _leaves_contact(),
            require(
                relation("<=", stable.GAP_AFTER(a, turn, NOTHING, -p_0, D, beta), delta_0),
                relation("<", _load(s) + p_0 + delta_0, 0),
                relation("==", p_0, 0),
                sentence="the gap stays within reach: {} at the end e of the arc {}, unless {}",
            ),
            in_order(b, a),
        ),
    )


def complete_contact() -> Regime:
    r"""No edge: :math:`w = u` everywhere."""
    saturated = require(relation(">=", D - 1 + p_0, stable.MODULUS_RATIO(alpha, beta)))
    return edgeless(complete_contact, "c", CONTACT, "complete contact", (saturated,))


def clinging() -> Regime:
    r"""No edge: the whole gap at :math:`-p_0`, at rest at :math:`w = -p_0`."""
    return edgeless(clinging, "a", ADHESION, "no contact, saturated adhesion", within_reach())


def separated() -> Regime:
    r"""No edge: :math:`w = 0`."""
    return edgeless(separated, "f", FREE, "no interaction", (out_of_reach(),))


def in_order(*edges: sp.Symbol) -> Inequality:
    """The edges follow one another within a period."""
    return require(relation("<=", *edges, edges[0] + PERIOD))


def within_reach() -> tuple[Inequality, Inequality]:
    """At rest at w = -p_0 the crest does not touch, and the valley stays within delta_0."""
    return require(relation("<=", D, -p_0)), require(relation("<=", 2 - D - p_0, delta_0))


def out_of_reach() -> Inequality:
    """At rest at w = 0."""
    near, sticky, bare = relation("<=", D, -delta_0), relation(">", p_0, 0), relation("<=", D, 0)
    return require(near, sticky, bare, sentence="{} if {}, else {}")


def _load(phase: sp.Expr) -> sp.Expr:
    """Load harmonic: at an event the slope of the event function has the sign of what it exceeds."""
    return stable.FORCING(phase, D, beta)


def _falls_into_adhesion() -> Inequality:
    return require(relation(">=", _load(d) + delta_0, 0), sentence="the gap falls at d: {}")


def _falls_into_contact() -> Inequality:
    return require(relation(">=", _load(b) + p_0, 0), sentence="the gap falls at b: {}")


def _leaves_contact() -> Inequality:
    return require(relation("<=", _load(a) + p_0, 0), sentence="the pressure falls at a: {}")


def _leaves_adhesion() -> Inequality:
    return require(relation("<=", _load(c) + p_0 + delta_0, 0), sentence="the gap rises at c: {}")
