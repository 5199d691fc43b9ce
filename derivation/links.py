"""Links: how the state at one edge depends on this edge and the one before, for Newton on the chain of edges.

The same functions as ``gap_after`` and ``excess_after`` with both their derivatives, sharing what these have in common. One
link for every zone of a regime gives its boundary equations and their Jacobian along the chain.
"""

from __future__ import annotations

import sympy as sp

from . import stable
from .flows import Flows
from .kernel import Kernel, kernel
from .symbols import p_0, s, s_0, s_1


def links(flows: Flows) -> tuple[Kernel, Kernel]:
    r""":math:`(g, \partial g/\partial s_0, \partial g/\partial s_1)` over a gap and the same of q over contact.

    gap_link: Gap at s_1 when it was gap_0 at s_0 and the pressure is p since, with its derivatives by s_0 and s_1. Same as
    gap_after, gap_after_start and gap_after_slope; s_1 must not be before s_0.

    .. math:: g,\quad \partial g/\partial s_0,\quad \partial g/\partial s_1

    excess_link: Pressure above -p_0 at s_1 in contact entered at s_0 with q_0, with its derivatives by s_0 and s_1. Same as
    excess_after, excess_after_start and excess_after_slope; s_1 must not be before s_0.

    .. math:: q,\quad \partial q/\partial s_0,\quad \partial q/\partial s_1
    """
    gap = flows.gap.value.subs(s, s_1)
    excess = flows.contact.value.subs(s, s_1) + p_0
    of_both = ((stable.GAP_LINK, gap), (stable.EXCESS_LINK, excess))
    return tuple(
        kernel(links, formula, (value, sp.diff(value, s_0), sp.diff(value, s_1)), halved=(s_0, s_1)) for formula, value in of_both
    )
