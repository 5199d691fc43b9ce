"""Means of pressure and friction of a strip (Eq. 11), in closed form in the edges: SymPy does the integrals per zone."""

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from . import stable
from .check import Claim, Derived, derived, zero
from .flows import Flows
from .functions import Formula, either, loss_mean, written_out
from .kernel import Kernel, kernel
from .modes.states import J_j, summed, w
from .modes.states import p as load
from .modes.symbols import J_0
from .regime import Regime
from .sequences import ADHESION, CONTACT, FREE, NOTHING, PERIOD, Row, Span
from .symbols import D, L, alpha, beta, p, p_0, q_0, s, s_0, s_1, w_0


@dataclass(frozen=True)
class ZoneIntegrals:
    """Integrals over a zone from s_0 to s_1, by SymPy: of p, of w, and of p u'."""

    contact: Derived  # in s_0, s_1, q_0
    relaxation: Derived  # in s_0, s_1, w_0, p


def zone_integrals(flows: Flows) -> ZoneIntegrals:
    return ZoneIntegrals(integrals_over_contact(flows), integrals_over_gaps(flows))


def integrals_over_contact(flows: Flows) -> Derived:
    r"""Eq. 11: What a contact zone adds to the sums of pressure, displacement and friction.

    .. math:: \int_{s_0}^{s_1} p\,ds,\quad \int_{s_0}^{s_1} u\,ds,\quad \int_{s_0}^{s_1} p\,u'\,ds
    """
    u, pressure = flows.strip.u, flows.contact.value
    value, checks = _integrated((pressure, u, pressure * sp.diff(u, s)))
    return derived(integrals_over_contact, value, checks, emitted=("profile_integral", "contact_work"))


def integrals_over_gaps(flows: Flows) -> Derived:
    r"""Eq. 11: What a zone at constant pressure adds. Adhesion counts in both means.

    .. math:: \int_{s_0}^{s_1} p\,ds = p\,(s_1 - s_0),\quad \int_{s_0}^{s_1} w\,ds,\quad p\,[u]_{s_0}^{s_1}
    """
    u, displacement = flows.strip.u, flows.relaxation.value
    value, checks = _integrated((p, displacement, p * sp.diff(u, s)))
    return derived(integrals_over_gaps, value, checks, emitted=("relaxation_integral", "profile_rise"))


def _integrated(integrands: tuple[sp.Expr, ...]) -> tuple[tuple[sp.Expr, ...], list[Claim]]:
    """Definite integrals from s_0 to s_1, term by term, each antiderivative differentiated back."""
    values, residuals = [], []
    for integrand in map(sp.expand, integrands):
        primitive = sp.Add(*(sp.integrate(term, s) for term in sp.Add.make_args(integrand)))
        residuals.append(sp.diff(primitive, s) - integrand)
        values.append(primitive.subs(s, s_1) - primitive.subs(s, s_0))
    return tuple(values), [zero("every antiderivative differentiates back to its integrand", residuals, phases=(s_0, s))]


def strip_means(regime: Regime, integrals: ZoneIntegrals) -> Kernel:
    r"""Eq. 11: Means of a strip over one period of s.

    .. math:: \bar p = \frac{1}{2\pi}\oint p\,ds = \frac{1}{2\pi}\oint w\,ds,\qquad \bar\tau = \frac{1}{2\pi}\oint p\,u'\,ds
    """
    sums = [NOTHING, NOTHING, NOTHING]  # of p, w, p u'
    for zone in regime.zones:
        edges = {s_0: zone.first, s_1: zone.last}
        if zone.kind == CONTACT:
            parts = [e.subs({**edges, q_0: zone.entry}, simultaneous=True) for e in integrals.contact.value]
        else:
            state = {w_0: zone.displacement, p: zone.load}
            parts = [e.subs({**edges, **state}, simultaneous=True) for e in integrals.relaxation.value]
        sums = [total + written_out(part) for total, part in zip(sums, parts, strict=True)]
    sum_p, sum_w, sum_tau = sums
    exact = ((sum_w if regime.touches else sum_p) / PERIOD, sum_tau / PERIOD)
    checks = [
        zero(
            "int p ds = int w ds + beta times the closing balance: mean p = mean w on an orbit",
            sum_p - sum_w - beta * regime.closing,
            phases=regime.edges,
        ),
        zero(
            "over a period the profile rises by nothing",
            sum(written_out(stable.PROFILE_RISE(zone.first, zone.last)) for zone in regime.zones),
            phases=regime.edges,
        ),
    ]
    why = (
        "as the mean of w, equal to it on a closed orbit, because that sum holds no large terms that cancel."
        if regime.touches
        else "from the adhesion zone alone, where the pressure is constant."
    )
    return kernel(
        strip_means,
        Formula(f"means_{regime.sequence}", regime.args, _stable_means(regime)),
        exact,
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


def _stable_means(regime: Regime) -> tuple[sp.Expr, sp.Expr]:
    """Candidates: w (without contact p, which is zero or -p_0) summed and the work of p, zone by zone.

    Where nothing is free the traction acts everywhere and does no work over a period: pressures are counted from -p_0,
    which is the same strip raised by p_0. So they are where contact, entered at -p_0, is too short to lose it.
    """
    contact = [zone for zone in regime.zones if zone.kind == CONTACT]
    total = NOTHING
    for zone in regime.zones:
        if zone in contact:
            total += stable.PROFILE_INTEGRAL(zone.first, zone.last, D)
        elif contact:
            total += stable.RELAXATION_INTEGRAL(zone.first, zone.last, zone.displacement, zone.load, beta)
        else:
            total += zone.load * (zone.last - zone.first)
    plain, raised = _work(regime, NOTHING), _work(regime, p_0)
    if all(zone.kind != FREE for zone in regime.zones):
        work = raised
    elif contact and contact[0].entry == NOTHING:
        work = either(2 * loss_mean(contact[0].last - contact[0].first, alpha), raised, plain)
    else:
        work = plain
    return total / PERIOD, work / PERIOD


def _work(regime: Regime, raised: sp.Expr) -> sp.Expr:
    """The work of p, with pressures counted from -raised."""
    work = (raised - p_0) * adhesive_rise(regime.zones)
    for zone in regime.zones:
        if zone.kind == CONTACT:
            pressure = sp.expand(zone.entry - p_0 + raised)
            work += stable.CONTACT_WORK(zone.first, zone.last, pressure, D + raised, alpha, beta, L)
        elif zone.kind == FREE:
            work += raised * stable.PROFILE_RISE(zone.first, zone.last)
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
    no large terms that cancel; the friction is the work of p on the profile, zone by zone. Adhesion counts in both.

    .. math:: \bar p = \frac{1}{2\pi}\oint p\,ds = \frac{1}{2\pi}\oint w\,ds,\qquad \bar\tau = \frac{1}{2\pi}\oint p\,u'\,ds
    """
    z_j = sp.Symbol("z_j", real=True)
    checks = [
        summed(
            "d/ds sum beta_j z_j = p - w, and that sum is periodic: mean p = mean w on a closed orbit",
            J_j * load - z_j,
            [(load, (J_j, 1 - J_0)), (-1, (z_j, w - J_0 * load))],
            load - w,
            over={J_j, z_j},
        )
    ]
    return derived(
        means_of_a_strip,
        load - w,
        checks,
        emitted=tuple(f"means_{sequence}" for sequence in ("acaf", "afc", "af", "ac")),
    )
