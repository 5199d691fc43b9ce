"""Means of pressure and friction of a strip (Eq. 11), in closed form in the edges: SymPy does the integrals per zone."""

from collections.abc import Sequence

import sympy as sp

from . import stable
from .check import Derived, derived, zero
from .functions import Formula, either, loss_mean, written_out
from .integral import integral
from .kernel import Kernel, Kernels, as_derived, kernel
from .modes.states import J_j, summed, w
from .modes.states import p as load
from .modes.symbols import J_0
from .regime import Zone
from .sequences import ADHESION, CONTACT, FREE, NOTHING, PARTIAL, PERIOD, Row, Span
from .symbols import PARAMETERS, D, L, alpha, beta, p_0, q_0, s, s_0, s_1


def strip_means(regime: Row, zones: Kernels) -> Kernel:
    r"""Eq. 11: Means of a strip over one period of s.

    .. math:: \bar p = \frac{1}{2\pi}\oint p\,ds = \frac{1}{2\pi}\oint w\,ds,\qquad \bar\tau = \frac{1}{2\pi}\oint p\,u'\,ds
    """
    _, closing = regime.equations[-1]
    added = [_added(zone, zones) for zone in regime.zones]
    pressed, height, work = (sp.Add(*parts) / PERIOD for parts in zip(*added, strict=True))
    mean_p = height if regime.touches else pressed
    stable_work = _stable_work(regime)
    checks = [
        zero(
            "int p ds = int w ds + beta times the closing balance: mean p = mean w on an orbit",
            written_out(PERIOD * (pressed - height) - beta * closing),
            phases=regime.edges,
        ),
        zero(
            "over a period the profile rises by nothing",
            sum(written_out(stable.PROFILE_RISE(zone.first, zone.last)) for zone in regime.zones),
            phases=regime.edges,
        ),
    ]
    if forms := stable_work.atoms(either):
        residuals = [written_out(short - wide) for _, short, wide in (form.args for form in forms)]
        checks.append(zero("the forms for short zones and for wide ones are the same", residuals, phases=regime.edges))
    why = (
        "as the mean of w, equal to it on a closed orbit, because that sum holds no large terms that cancel."
        if regime.touches
        else "from the adhesion zone alone, where the pressure is constant."
    )
    return kernel(
        strip_means,
        Formula(f"means_{regime.sequence}", (*regime.edges, *PARAMETERS), (mean_p, stable_work / PERIOD)),
        (as_derived(mean_p, zones), as_derived(work, zones)),
        *checks,
        statement=f"Means of a strip: {regime.title}. The mean pressure is computed {why}",
        phases=regime.edges,
    )


def constant_means(regime: Row, args: tuple[sp.Symbol, ...]) -> Kernel:
    r"""Eq. 11: At rest :math:`w = p` is constant: :math:`\bar p = p,\ \bar\tau = 0`."""
    (zone,) = regime.zones
    u = stable.PROFILE(s, D)
    mean_tau = sp.integrate(zone.load * sp.diff(written_out(u), s), (s, 0, PERIOD)) / PERIOD
    return kernel(
        constant_means,
        Formula(f"means_{regime.sequence}", args, (zone.load, NOTHING)),
        (zone.load, mean_tau),
        zero("a constant pressure does no work over a period", mean_tau),
        statement=f"Means of a strip: {regime.title}.",
        latex=rf"\bar p = {sp.latex(zone.load)},\quad \bar\tau = 0",
    )


def _added(zone: Zone, zones: Kernels) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """What a zone adds to the sums of p, w and p u'."""
    first, last = zone.first, zone.last
    if zone.kind != CONTACT:
        height = stable.RELAXATION_INTEGRAL(first, last, zone.displacement, zone.load, beta)
        return zone.load * (last - first), height, zone.load * stable.PROFILE_RISE(first, last)
    pressure = zones["excess_after"].exact.subs({q_0: zone.entry, s_0: first, s_1: s}, simultaneous=True) - p_0
    pressed = integral(pressure, s, first, last)
    work = stable.CONTACT_WORK(first, last, sp.expand(zone.entry - p_0), D, alpha, beta, L)
    return pressed, stable.PROFILE_INTEGRAL(first, last, D), work


def _stable_work(regime: Row) -> sp.Expr:
    """The work of p as it is computed.

    Where nothing is free the traction acts everywhere and does no work over a period: pressures are counted from -p_0,
    which is the same strip raised by p_0. So they are where contact, entered at -p_0, is too short to lose it.
    """
    plain, raised = _work(regime, NOTHING), _work(regime, p_0)
    contact = [zone for zone in regime.zones if zone.kind == CONTACT]
    if all(zone.kind != FREE for zone in regime.zones):
        return raised
    if contact and contact[0].entry == NOTHING:
        return either(2 * loss_mean(contact[0].last - contact[0].first, alpha), raised, plain)
    return plain


def _work(regime: Row, raised: sp.Expr) -> sp.Expr:
    """The work of p, with pressures counted from -raised."""
    work = (raised - p_0) * adhesive_rise(regime.zones)
    for zone in regime.zones:
        if zone.kind == CONTACT:
            pressure = sp.expand(zone.entry - p_0 + raised)
            work += stable.CONTACT_WORK(zone.first, zone.last, pressure, D + raised, alpha, beta, L)
        elif zone.kind == FREE:
            begun = zone.last - PERIOD  # of all that is not free; where that is narrow, a period less it has lost its digits
            rise = stable.PROFILE_RISE(zone.first, zone.last)
            work += raised * either(zone.first - begun, -stable.PROFILE_RISE(begun, zone.first), rise)
    return work


def adhesive_rise(zones: Sequence[Span]) -> sp.Expr:
    """Rise of the profile over the adhesion zones; over two wide ones, less that over the rest: over a period it is 0."""
    rises = {zone: stable.PROFILE_RISE(zone.first, zone.last) for zone in zones}
    adhesive = [zone for zone in zones if zone.kind == ADHESION]
    short = sum((rises[zone] for zone in adhesive), NOTHING)
    if len(adhesive) < 2:
        return short
    width = sum(zone.last - zone.first for zone in adhesive)
    return either(width, short, -sum(rises[zone] for zone in zones if zone not in adhesive))


def means_of_a_strip() -> Derived:
    r"""Eq. 11: The mean pressure is computed as the mean of w, equal to it on a closed orbit, because that sum holds
    no large terms that cancel; the friction is the work of p on the profile, zone by zone. Adhesion counts in both. Where
    nothing is free pressures and displacements count from -p_0: the strip raised by p_0, without traction.

    .. math:: \bar p = \frac{1}{2\pi}\oint p\,ds = \frac{1}{2\pi}\oint w\,ds,\qquad \bar\tau = \frac{1}{2\pi}\oint p\,u'\,ds
    """
    z_j = sp.Symbol("z_j", real=True)
    raised = {load: load + p_0, z_j: z_j + J_j * p_0}
    lag = J_j * load - z_j  # beta_j z_j', and what contact begins with
    checks = [
        summed(
            "d/ds sum beta_j z_j = p - w, and that sum is periodic: mean p = mean w on a closed orbit",
            lag,
            [(load, (J_j, 1 - J_0)), (-1, (z_j, w - J_0 * load))],
            load - w,
            over={J_j, z_j},
        ),
        zero("with p_0 added to p and J_j p_0 to z_j the state moves as before", lag.subs(raised, simultaneous=True) - lag),
        summed("and w is raised by p_0", J_j * p_0, [(p_0, (J_j, 1 - J_0))], p_0 - J_0 * p_0, over={J_j}),
        zero("p_0 does no work over a period", sp.integrate(p_0 * sp.diff(sp.cos(s), s), (s, s_0, s_0 + PERIOD))),
    ]
    return derived(means_of_a_strip, load - w, checks, emitted=tuple(f"means_{sequence}" for sequence in PARTIAL))
