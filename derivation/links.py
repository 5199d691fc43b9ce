"""Links: how the state at one edge depends on this edge and the one before, for Newton on the chain of edges.

The same functions as ``gap_after`` and ``excess_after`` with both their derivatives, sharing what these have in common. One
link for every zone of a regime gives its boundary equations and their Jacobian along the chain.
"""

from __future__ import annotations

import sympy as sp

from .events import back, decayed, lag_rate, lapsed, late, sine, start, transient_rate, turn
from .flows import Flows
from .functions import Formula, divisible, expm1, per_time
from .kernel import Kernel, kernel
from .stable import LABELLED_LOSS, half, level, loss_factor
from .symbols import D, L, alpha, beta, gap_0, p, p_0, q_0, s, s_0, s_1

sine_0, cosine_0, cosine, drop, drop_0 = sp.symbols("sine_0 cosine_0 cosine drop drop_0", real=True)
sine_middle, cosine_middle = sp.symbols("sine_middle cosine_middle", real=True)

# Half angles serve every term; s_1 must not be before s_0, as in the events.


def _link(relaxation_time):
    """Half angles, decay and profile that a link between two edges needs."""
    return (
        (start, s_0 / 2),
        (turn, s_1 / 2),
        (back, start - turn),
        (late, 2 * back / divisible(relaxation_time)),
        (decayed, sp.exp(late)),
        (lapsed, expm1(late)),
        (sine_0, sp.sin(start)),
        (cosine_0, sp.cos(start)),
        (sine, sp.sin(turn)),
        (cosine, sp.cos(turn)),
        (half, sp.sin(back)),
        (drop_0, 2 * sine_0**2),
        (drop, 2 * sine**2),
        (sine_middle, sine_0 * cosine + cosine_0 * sine),
    )


GAP_LINK = Formula(
    "gap_link",
    (s_0, s_1, gap_0, p, D, beta),
    (
        (gap_0 - 2 * half * sine_middle) * decayed + (level - drop) * lapsed,
        (lag_rate - 2 * sine_0 * cosine_0) * decayed,
        2 * sine * cosine - lag_rate * decayed,
    ),
    (*_link(beta), (level, D - p), (lag_rate, per_time(gap_0 + level - drop_0, beta))),
)
EXCESS_LINK = Formula(
    "excess_link",
    (s_0, s_1, q_0, p_0, D, alpha, beta, L),
    (
        (q_0 + 2 * half * (sine_middle + loss_factor * (alpha * sine_middle + cosine_middle))) * decayed
        - (level - drop + loss_factor * (alpha * (1 - drop) - 2 * sine * cosine)) * lapsed,
        (transient_rate + 2 * sine_0 * cosine_0 + loss_factor * (2 * alpha * sine_0 * cosine_0 + 1 - drop_0)) * decayed,
        -transient_rate * decayed - 2 * sine * cosine - loss_factor * (2 * alpha * sine * cosine + 1 - drop),
    ),
    (
        *_link(alpha),
        (cosine_middle, cosine_0 * cosine - sine_0 * sine),
        LABELLED_LOSS,
        (level, D + p_0),
        (
            transient_rate,
            per_time(q_0 - level + drop_0 - loss_factor * (alpha * (1 - drop_0) - 2 * sine_0 * cosine_0), alpha),
        ),
    ),
)


def links(flows: Flows) -> tuple[Kernel, Kernel]:
    r""":math:`(g, \partial g/\partial s_0, \partial g/\partial s_1)` over a gap and the same of q over contact.

    gap_link: Gap at s_1 when it was gap_0 at s_0 and the pressure is p since, with its derivatives by s_0 and s_1. Same as
    gap_after; s_1 must not be before s_0.

    .. math:: g,\quad \partial g/\partial s_0,\quad \partial g/\partial s_1

    excess_link: Pressure above -p_0 at s_1 in contact entered at s_0 with q_0, with its derivatives by s_0 and s_1. Same as
    excess_after; s_1 must not be before s_0.

    .. math:: q,\quad \partial q/\partial s_0,\quad \partial q/\partial s_1
    """
    gap = flows.gap.value.subs(s, s_1)
    excess = flows.contact.value.subs(s, s_1) + p_0
    of_both = ((GAP_LINK, gap), (EXCESS_LINK, excess))
    return tuple(
        kernel(links, formula, (value, sp.diff(value, s_0), sp.diff(value, s_1)), halved=(s_0, s_1)) for formula, value in of_both
    )
