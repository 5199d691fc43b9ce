"""The table of regimes of a strip: the zones of each, and its inequalities, on any foundation.

How a foundation makes the rows, its :class:`Edges`: :mod:`.regime` for one relaxation time, :mod:`.modes.regimes` for several.
"""

from collections.abc import Callable
from typing import Any

import sympy as sp

from . import stable
from .check import REPRODUCED, Derived, derived, zero
from .functions import written_out
from .sequences import ADHESION, CONTACT, FREE, NOTHING, PERIOD, TITLES, Inequality, Relation, Row, Span, relation, require
from .symbols import D, chi, delta_0, p_0, s

System = tuple[Derived, tuple[tuple[str, Any], ...]]


class Edges:
    """How a foundation makes the rows of the table."""

    closures: tuple[int, ...]
    step: sp.Expr  # of w where the pressure steps by p_0 in a snap into contact
    at_threshold: str  # what is said of the threshold of complete contact

    def zones(self, sequence: str) -> tuple[Any, ...]:
        """The zones of a regime with edges."""
        raise NotImplementedError

    def all_along(self, zone: Any, sign: str, limit: sp.Expr) -> tuple[tuple[Relation, Relation], str]:
        """The gap compared with a limit, and where, with what is said of the latter: all along a zone."""
        raise NotImplementedError

    def system(self, by: Callable[..., Row], sequence: str, zones: Any, closures: tuple[int, ...], said: str) -> System:
        """The record of a regime with edges, whose statement begins with what is ``said``, and its equations."""
        raise NotImplementedError

    def partial(self, by: Callable[..., Row], sequence: str, *admissible: Inequality, closures: tuple[int, ...] = ()) -> Row:
        """A regime with edges; ``admissible``: besides how the state comes to each edge, and their order."""
        zones, closures = self.zones(sequence), closures or self.closures
        edges = tuple(zone.first for zone in zones)
        record, equations = self.system(
            by, sequence, zones, closures, f"{_capitalised(sequence)}: unknown edges {', '.join(map(str, edges))}"
        )
        approaches = (zone.approach(edge) for zone, edge in zip(zones, (*edges[1:], edges[0]), strict=True))
        order = require(relation("<=", *edges, edges[0] + PERIOD))
        return Row(sequence, zones, (*admissible, *approaches, order), closures, record, equations)

    def edgeless(self, by: Callable[..., Row], sequence: str, kind: str, *admissible: Inequality) -> Row:
        """A regime without edges: the same zone all along."""
        zone = Span(kind, s, s + PERIOD, NOTHING, NOTHING)
        at_ends = zip(zone.fields(zone.first, NOTHING), zone.fields(zone.last, NOTHING), strict=True)
        record = derived(
            by,
            sequence,
            [zero("after a period w and p are what they were", [written_out(after - before) for before, after in at_ends])],
            f"regime {sequence}",
            statement=f"{_capitalised(sequence)}: no unknown edge.",
            latex="w = u" if kind == CONTACT else f"w = p = {sp.latex(zone.load)}",
            status=REPRODUCED,
            emitted=(f"means_{sequence}",),
        )
        return Row(sequence, (zone,), admissible, self.closures, record)


def _capitalised(sequence: str) -> str:
    title = TITLES[sequence]
    return f"{title[0].upper()}{title[1:]}"


def regimes(edges: Edges, threshold: sp.Expr, snaps: bool = True) -> tuple[Row, ...]:
    """Every regime of a strip; without instantaneous compliance no point ``snaps`` into contact. ``threshold``: of D."""
    return (
        discrete_adhesion(edges),
        *([trailing_adhesion(edges)] if snaps else []),
        adhesion_only(edges),
        saturated_adhesion(edges),
        complete_contact(edges, threshold),
        adhesion_everywhere(edges),
        separated(edges),
    )


def discrete_adhesion(edges: Edges) -> Row:
    r"""Partial contact between two adhesion zones; unknown d, b, a, c. w steps by :math:`\mp\chi J p_0` at d and c:

    .. math:: g(b) = 0,\quad p(a) = -p_0,\quad g(c) = \delta_0,\quad g(d + 2\pi) = \delta_0
    """
    return edges.partial(discrete_adhesion, "acaf")


def trailing_adhesion(edges: Edges) -> Row:
    r"""Snap-in at d into contact, adhesion from a to c. z is continuous at d, so contact is entered at :math:`-\delta_0/J`:

    .. math:: p(a) = -p_0,\quad g(c) = \delta_0,\quad g(d + 2\pi) = \delta_0
    """
    constitutive = [require(relation("==", chi, 1))] if 0 in edges.closures else []
    steps_over = require(relation("<=", delta_0 - edges.step, 0), sentence="w steps over the gap: {}")
    return edges.partial(trailing_adhesion, "afc", *constitutive, steps_over, closures=(1,))


def adhesion_only(edges: Edges) -> Row:
    r"""No contact; adhesion from d to c: :math:`g(c) = \delta_0,\ g(d + 2\pi) = \delta_0`."""
    adhesion, _ = edges.zones("af")
    relations, where = edges.all_along(adhesion, ">=", sp.Integer(0))
    return edges.partial(adhesion_only, "af", require(*relations, sentence=f"the gap stays open: {{}} {where}"))


def saturated_adhesion(edges: Edges) -> Row:
    r"""Partial contact, the whole gap at :math:`-p_0`; with :math:`p_0 = 0` this is contact without adhesion ('cf'):

    .. math:: p(a) = -p_0,\quad g(b + 2\pi) = 0
    """
    _, adhesion = edges.zones("ac")
    relations, where = edges.all_along(adhesion, "<=", delta_0)
    within = require(*relations, relation("==", p_0, 0), sentence=f"the gap stays within reach: {{}} {where}, unless {{}}")
    return edges.partial(saturated_adhesion, "ac", within)


def complete_contact(edges: Edges, threshold: sp.Expr) -> Row:
    r"""No edge: :math:`w = u` everywhere, from the ``threshold`` of D on."""
    enough = require(relation(">=", D, threshold), sentence=edges.at_threshold)
    return edges.edgeless(complete_contact, "c", CONTACT, enough)


def adhesion_everywhere(edges: Edges) -> Row:
    r"""No edge: the whole gap at :math:`-p_0`, at rest at :math:`w = -p_0`, open at the crest and within reach in the valley."""
    crest, valley = (-p_0 - stable.PROFILE(place, D) for place in (sp.Integer(0), sp.pi))
    opened = require(relation(">=", crest, 0), sentence="the gap is open at the crest: {}")
    reached = require(relation("<=", valley, delta_0), sentence="and within reach in the valley: {}")
    return edges.edgeless(adhesion_everywhere, "a", ADHESION, opened, reached)


def separated(edges: Edges) -> Row:
    r"""No edge: :math:`w = 0`, the crest out of reach."""
    crest = -stable.PROFILE(sp.Integer(0), D)
    near, sticky, bare = relation(">=", crest, delta_0), relation(">", p_0, 0), relation(">=", crest, 0)
    beyond = require(near, sticky, bare, sentence="the gap at the crest is out of reach: {} if {}, else {}")
    return edges.edgeless(separated, "f", FREE, beyond)
