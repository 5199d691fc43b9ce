"""Events and links of a zone: the functions that root finders ask for at many phases.

An event is value and slope at many phases of one zone, whose entry is evaluated once: the same functions as ``gap_after`` and
``excess_after`` with their slopes, split in two: an ``..._entry`` that turns the state in which the zone is entered into
constants, and an ``..._event`` that takes the phase and these constants. What an event computes costs a fourth; it loses no
accuracy, and the pair is proven and certified as one function. The contact event needs the saturated field as one harmonic,
``p_sat = D - 1 + R cos(s + phi)``: with ``K*(i omega)/K = R e^(i phi)`` that is ``phi = arctan(beta) - arctan(alpha)``.

A link is how the state at one edge depends on this edge and the one before, for Newton on the chain of edges: the same functions
with both their derivatives, sharing what these have in common. One link for every zone of a regime gives its boundary equations
and their Jacobian along the chain.
"""

import sympy as sp

from .check import holds, zero
from .exact import in_half_angles
from .flows import Flows
from .functions import Formula, divisible, expm1, per_time, versine
from .kernel import Kernel, chained, kernel, pair
from .stable import LABELLED_LOSS, MODULUS_RATIO, STORAGE, half, level, loss_factor, middle, steepness
from .symbols import D, L, alpha, beta, gap_0, p, p_0, q_0, s, s_0, s_1

start, time, turn, back, late, sine, twice = sp.symbols("start time turn back late sine twice", real=True)
lead, ahead, double, steep, top, ratio = sp.symbols("lead ahead double steep top ratio", real=True)
lag_rate, transient_rate, decayed, lapsed = sp.symbols("lag_rate transient_rate decayed lapsed", real=True)
_phase = sp.Symbol("phi", positive=True)
ANGLES = (s_0, s_1, _phase)

# Few operations, since a root finder asks for them at many phases of one zone.
# The exponent is back/time, with time > 0: no cut-off is needed while s_1 >= s_0. Both exp and expm1 are taken, since
# 1 + expm1 would lose a large gap_0 or q_0 long after the entry.

_times = ((turn, s_1 / 2), (back, start - turn), (late, back / time), (decayed, sp.exp(late)), (lapsed, expm1(late)))
GAP_ENTRY = Formula(
    "gap_entry",
    (s_0, gap_0, p, D, beta),
    (gap_0, s_0 / 2, divisible(beta) / 2, level, per_time(level + gap_0 - versine(s_0), beta)),
    ((level, D - p),),
)
GAP_EVENT = Formula(
    "gap_event",
    (s_1, gap_0, start, time, level, lag_rate),
    (
        (gap_0 - 2 * (sp.sin(back) * sp.sin(middle))) * decayed + (level - twice * sine) * lapsed,
        twice * sp.cos(turn) - lag_rate * decayed,
    ),
    (*_times, (middle, start + turn), (sine, sp.sin(turn)), (twice, 2 * sine)),
)
EXCESS_ENTRY = Formula(
    "excess_entry",
    (s_0, q_0, p_0, D, alpha, beta, L),
    (q_0, s_0 / 2, divisible(alpha) / 2, lead, 2 * ratio, top, per_time(q_0 - top + ratio * versine(s_0 + 2 * lead), alpha)),
    (
        (ratio, MODULUS_RATIO(alpha, beta)),
        LABELLED_LOSS,
        (lead, sp.atan(loss_factor / STORAGE(alpha, beta)) / 2),
        (steepness, (alpha + beta) / (1 + ratio)),
        (top, D + p_0 + loss_factor * steepness),
    ),
)
EXCESS_EVENT = Formula(
    "excess_event",
    (s_1, q_0, start, time, lead, double, top, transient_rate),
    (
        (q_0 + double * sp.sin(back) * sp.sin(middle)) * decayed - (top - steep * sine) * lapsed,
        -(steep * sp.cos(ahead) + transient_rate * decayed),
    ),
    (*_times, (ahead, lead + turn), (middle, back + 2 * ahead), (sine, sp.sin(ahead)), (steep, double * sine)),
)


def gap_event(flows: Flows) -> tuple[Kernel, Kernel]:
    r""":math:`(g, g')` at :math:`s_1`, from constants of the entry.

    gap_entry: Constants of gap_event in a zone entered at s_0 with gap_0 under the constant pressure p. For beta = 0
    the last is 0 and the third the least time that can be divided by.

    .. math:: g_0,\quad \tfrac{s_0}{2},\quad \tfrac{\beta}{2},\quad D - p,\quad \frac{u(s_0) + g_0 - p}{\beta}

    gap_event: Gap and its slope at s_1, from the constants of gap_entry. Same gap as gap_after; s_1 must not be before s_0.

    .. math:: g = \left(g_0 - [u]_{s_0}^{s_1}\right) e^{-(s_1 - s_0)/\beta} + (u(s_1) - p)\left(e^{-(s_1 - s_0)/\beta} -
        1\right),\quad g' = \sin s_1 - \frac{u(s_0) + g_0 - p}{\beta} e^{-(s_1 - s_0)/\beta}
    """
    g = flows.gap.value.subs(s, s_1)
    return pair(gap_event, (GAP_ENTRY, GAP_EVENT), (g, sp.diff(g, s_1)), halved=(s_0, s_1))


def excess_event(flows: Flows) -> tuple[Kernel, Kernel]:
    r""":math:`(q, q')` at :math:`s_1`, from constants of the entry, with the saturated field as one harmonic.

    excess_entry: Constants of excess_event in a contact entered at s_0 with q_0. For alpha = 0 the last is 0 and the third the
    least time that can be divided by.

    .. math:: q_0,\quad \tfrac{s_0}{2},\quad \tfrac{\alpha}{2},\quad \tfrac{\varphi}{2},\quad 2R,\quad D + p_0 - 1 + R,\quad
        \frac{q_0 - p_0 - p_{sat}(s_0)}{\alpha}

    excess_event, Eq. 15: Pressure above -p_0 in contact and its slope at s_1, from the constants of excess_entry. Same as
    excess_after; s_1 must not be before s_0.

    .. math:: p_{sat}(s) = D - 1 + R\cos(s + \varphi),\quad R\,e^{i\varphi} = \frac{1 + i\beta}{1 + i\alpha}
    """
    q = flows.contact.value.subs(s, s_1) + p_0
    exact = (q, sp.diff(q, s_1))
    # Rational in alpha and tan(phi): beta = tan(arctan(alpha) + phi), R = sqrt((1 + beta^2)/(1 + alpha^2)).
    shrunk = sp.cos(_phase) - alpha * sp.sin(_phase)
    tilted = {beta: (alpha * sp.cos(_phase) + sp.sin(_phase)) / shrunk}
    modulus = 1 / shrunk
    transient = q_0 - p_0 - (D - 1 + modulus * sp.cos(s_0 + _phase))
    constants = (q_0, s_0 / 2, alpha / 2, _phase / 2, 2 * modulus, D + p_0 - 1 + modulus, transient / alpha)
    composed = EXCESS_EVENT.written_out((s_1, *constants))
    tangent = (beta - alpha) / (1 + alpha * beta)
    R_squared = (1 + beta**2) / (1 + alpha**2)
    loss = (beta - alpha) / (1 + alpha**2)
    stated = EXCESS_ENTRY.written_out()
    R = sp.sqrt(1 + beta**2) / sp.sqrt(1 + alpha**2)
    one_harmonic = [
        zero("tan(phi) = (beta - alpha)/(1 + alpha beta)", sp.tan(2 * stated[3]) - tangent),
        holds(
            "and phi is an arc tangent: cos(phi) > 0, as that of R exp(i phi) with a storage above 0",
            (2 * stated[3]).func == sp.atan,
        ),
        zero("beta = tan(arctan(alpha) + phi)", (alpha + tangent) / (1 - alpha * tangent) - beta),
        zero(
            "R^2 = (1 + beta^2)/(1 + alpha^2) is what that makes of 1/(cos phi - alpha sin phi)^2",
            ((1 + tangent**2) / (1 - alpha * tangent) ** 2) - R_squared,
        ),
        zero("R^2 - 1 = loss (alpha + beta), so that R - 1 need not cancel", R_squared - 1 - loss * (alpha + beta)),
    ]
    entry = [
        zero("q_0, s_0/2, alpha/2", [a - b for a, b in zip(stated[:3], constants[:3], strict=True)]),
        zero("2 R", stated[4] - 2 * R),
        zero("D + p_0 - 1 + R", (stated[5] - (D + p_0)) * (1 + R) - loss * (alpha + beta)),
        zero(
            "q_0 - p_0 - p_sat(s_0), over alpha, with p_sat(s_0) as the harmonic",
            stated[6] * alpha - (q_0 - stated[5] + R * (1 - sp.cos(s_0 + 2 * stated[3]))),
        ),
    ]
    left = [in_half_angles(one - other.subs(tilted), *ANGLES) for one, other in zip(composed, exact, strict=True)]
    event = [
        *one_harmonic,
        zero("excess_event after excess_entry is the derived q", left[0], phases=(s_0, s_1)),
        zero("and its derivative by s_1", left[1], phases=(s_0, s_1)),
    ]
    return chained(excess_event, (EXCESS_ENTRY, EXCESS_EVENT), exact, (constants, entry), (exact, event))


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
