"""The map from one onset to the next: what traction does to a point that it reaches, and its slope at a periodic orbit."""

from collections.abc import Mapping

import sympy as sp

from . import stable
from .check import Derived, derived, zero
from .functions import Formula, decay, decay_loss, either, written_out
from .kernel import Kernel, kernel
from .regime import Zone
from .sequences import CONTACT, NOTHING, PERIOD, Row
from .symbols import PARAMETERS, D, J, L, alpha, beta, chi, delta_0, gap_0, p, p_0, q_0, s_0, s_1

kept, load, released, upper, lower = sp.symbols("kept load released upper lower", real=True)


def shift_of_an_event() -> Derived:
    r"""The derivatives of a zone's flow F by its two edges are loads: what drives the event function there. The edge
    where the zone ends moves by minus their quotient.

    .. math:: \frac{\partial g/\partial s_0}{\partial g/\partial s_1} = -\frac{H(s_0) + g_0 - p}{H(s_1) + g(s_1) - p}\,e^{-(s_1
        - s_0)/\beta},\quad \frac{\partial q/\partial s_0}{\partial q/\partial s_1} = -\frac{H(s_0) + p_0 - q_0}{H(s_1) + p_0 -
        q(s_1)}\,e^{-(s_1 - s_0)/\alpha}
    """
    gap = written_out(stable.GAP_AFTER(s_0, s_1, gap_0, p, D, beta))
    pressure = written_out(stable.EXCESS_AFTER(s_0, s_1, q_0, p_0, D, alpha, beta, L))
    load_0, load_1 = (written_out(stable.FORCING(place, D, beta)) for place in (s_0, s_1))
    checks = [
        zero(
            "adhesion and free gap: beta dg/ds_0 = (H_0 + gap_0 - p) exp(-(s_1 - s_0)/beta), beta dg/ds_1 = -(H_1 + g - p)",
            [
                beta * sp.diff(gap, s_0) - (load_0 + gap_0 - p) * decay(s_1 - s_0, beta),
                beta * sp.diff(gap, s_1) + (load_1 + gap - p),
            ],
            phases=(s_0, s_1),
        ),
        zero(
            "contact: alpha dq/ds_0 = -(H_0 + p_0 - q_0) exp(-(s_1 - s_0)/alpha), alpha dq/ds_1 = H_1 + p_0 - q",
            [
                alpha * sp.diff(pressure, s_0) + (load_0 + p_0 - q_0) * decay(s_1 - s_0, alpha),
                alpha * sp.diff(pressure, s_1) - (load_1 + p_0 - pressure),
            ],
            phases=(s_0, s_1),
        ),
    ]
    return derived(shift_of_an_event, None, checks)


def onset_slope(regime: Row) -> Kernel:
    r"""A shift of the onset fades over contact with alpha, over the rest of the period with beta, and is scaled where p steps: T'
    as numerator and denominator, and the one less the other, which vanishes at a fold; an orbit is stable when T' < 1. Both are
    products of loads, so that Newton's method finds a fold from far off, over 1 + beta, which all loads grow with.

    .. math:: T' = \prod_{\text{zones}} \frac{ds_{last}}{ds_{first}}
    """
    width = sum((zone.last - zone.first for zone in regime.zones if zone.kind == CONTACT), NOTHING)
    left_over, lost = decay(PERIOD - width, beta), decay_loss(PERIOD - width, beta)
    if width != 0:
        left_over, lost = left_over * decay(width, alpha), lost * decay(width, alpha) + decay_loss(width, alpha)
    loads = [stable.FORCING(zone.first, D, beta) + offsets(zone)[0] for zone in regime.zones]
    before = [stable.FORCING(same_phase(zone.last), D, beta) + offsets(zone)[1] for zone in regime.zones]
    product = sp.Mul(left_over, *(first / last for first, last in zip(loads, before, strict=True)))
    # A zone begins with the load that the one before is left with, but where p steps: at both ends of the free zone.
    onset, release = (step_of_load(sp.expand(loads[n] - before[n - 1])) for n in (0, -1))
    labels = (
        (kept, left_over),
        (load, before[-1]),
        (released, loads[-1] / (1 + beta)),
        (upper, -kept * (load + onset) * released),
        (lower, load * (release / (1 + beta) - released)),
    )
    change = -lost * (load + onset) * released - _grown(regime.zones[-1], onset, release) / (1 + beta)
    over, under = (written_out(-two) / (1 + beta) for two in (left_over * loads[0] * loads[-1], before[-1] * before[-2]))
    args = (*regime.edges, *PARAMETERS)
    nearly = Formula("nearly", args, change, labels).written_out()
    factors = (*sp.Mul.make_args(left_over), loads[0] / before[-1], loads[-1] / before[-2])
    return kernel(
        onset_slope,
        Formula(f"onset_slope_{regime.sequence}", args, (upper, lower, either(2 * kept, upper - lower, change)), labels),
        (over, under, over - under),
        zero("the product over the zones, telescoped", over / under - written_out(product), phases=regime.edges),
        zero("the difference where little fades is the same", over - under - nearly, phases=regime.edges),
        latex="T' = " + r" \cdot ".join(sp.latex(written_out(part)) for part in factors),
        phases=regime.edges,
    )


def _grown(free: Zone, onset: sp.Expr, release: sp.Expr) -> sp.Expr:
    """What the steps of the load at both ends of the free zone make of its loads, common terms taken out."""
    first, last = free.first, same_phase(free.last)
    spare = sp.cancel(sp.expand(onset * offsets(free)[0] + release * offsets(free)[1]) / onset)
    if sp.expand(onset + release) != 0:
        return onset * (spare + stable.FORCING(first, D, beta)) + release * stable.FORCING(last, D, beta)
    half, middle = (first - last) / 2, (first + last) / 2
    return onset * (spare - 2 * sp.sin(half) * (sp.sin(middle) + beta * sp.cos(middle)))


def offsets(zone: Zone) -> tuple[sp.Expr, sp.Expr]:
    """What the load of a zone is more than H where it is entered, and where it is left."""
    if zone.kind == CONTACT:
        return p_0 - zone.entry, p_0 - zone.exit
    return zone.entry - zone.load, zone.exit - zone.load


def step_of_load(change: sp.Expr) -> sp.Expr:
    """What a load steps by, without cancellation where J is nearly 1."""
    return sp.factor(change).subs({J * chi - 1: -(L * chi + 1 - chi), J - 1: -L})


def same_phase(edge: sp.Expr) -> sp.Expr:
    """The edge itself instead of one period later: the load has the period 2 pi."""
    return edge.subs(sp.pi, 0)


continuous = sp.Symbol("continuous", real=True)


def onset(regimes: Mapping[str, Row]) -> tuple[Kernel, Kernel]:
    r"""The onset of adhesion, by the zones that meet there; F is the load that drives their event functions.

    adhesive_onset: Gap just after adhesion begins, and the step there of the load H + g - p. Where adhesion ends it steps
    back by as much.

    .. math:: g_d = \delta_0 - \chi J p_0,\quad [F] = (1 - \chi J)\,p_0

    snap_onset: Pressure above -p_0 just after a snap into contact, and the step there of the load, H + p_0 - q in contact.
    J must be above 0.

    .. math:: q_d = p_0 - \frac{\delta_0}{J},\quad [F] = \frac{\delta_0}{J} - \delta_0
    """
    state, step = _onset(regimes["acaf"])
    excess, snap = _onset(regimes["afc"])
    back = {sequence: offsets(row.zones[-1])[0] - offsets(row.zones[-2])[1] for sequence, row in regimes.items()}
    alone = _onset(regimes["af"])
    return (
        kernel(
            onset,
            Formula("adhesive_onset", (p_0, delta_0, J, L, chi), (state, p_0 * (continuous + L * chi)), ((continuous, 1 - chi),)),
            (state, step),
            zero("without contact it is the same", [state - alone[0], step - alone[1]]),
            zero("F steps back where adhesion ends", [back["acaf"] + step, back["af"] + step, back["afc"] + step.subs(chi, 1)]),
        ),
        kernel(onset, Formula("snap_onset", (p_0, delta_0, J, L), (excess, step_of_load(snap))), (excess, snap)),
    )


def _onset(regime: Row):
    """The state in which the first zone is entered, and what its load exceeds that at the end of the last by."""
    first, last = regime.zones[0], regime.zones[-1]
    return first.entry, offsets(first)[0] - offsets(last)[1]
