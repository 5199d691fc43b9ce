"""The map from one onset to the next away from periodic orbits: what the search for the extremal one bounds."""

from collections.abc import Sequence

import sympy as sp

from . import stable
from .check import Claim, Derived, derived, zero
from .functions import decay, written_out
from .sequences import CONTACT, NOTHING, PERIOD, Row
from .stability import offsets, same_phase
from .symbols import D, L, a, alpha, b, beta, c, d, p_0

F, M, F_step, M_step = sp.symbols("F M F_step M_step", positive=True)
RATES = {f"{name}'": sp.Symbol(f"{name}'", real=True) for name in "bacFM"}
NAMES = {"F": F, "M": M, "[F]": F_step, "[M]": M_step, **RATES}
"""In the displays."""


def slope_of_the_onset_map(regimes: Sequence[Row]) -> Derived:
    r"""A point that meets its onset at x misses the next one, a period later, by r in the gap: beta times the derivative of r
    exp(x/beta) is (F T' - F) exp(x/beta). F is the load before the onset, M less the load before the release, [F] and [M] what
    they step by there; at a periodic orbit T' is the slope of the map.

    .. math:: T' = e^{-2\pi/\beta - (a - b) L/\alpha} \left(1 + \frac{[F]}{F}\right) \left(1 + \frac{[M]}{M}\right)
    """
    slope = sp.exp(-PERIOD / beta - (a - b) * L / alpha) * (1 + F_step / F) * (1 + M_step / M)
    claims = [claim for regime in regimes for claim in _of_regime(regime, slope)]
    return derived(slope_of_the_onset_map, slope, claims)


def _of_regime(regime: Row, slope: sp.Expr) -> list[Claim]:
    """That this is the slope for the zones of one regime, the last of which ends anywhere."""
    *zones, last = regime.zones
    loads, before = _loads(regime)
    faded = [decay(zone.last - zone.first, alpha if zone.kind == CONTACT else beta) for zone in regime.zones]
    *shifts, left_over = (load * fading for load, fading in zip(loads, faded, strict=True))
    moved = sp.Mul(*(shift / end for shift, end in zip(shifts, before[:-1], strict=True)))
    steps = {F_step: loads[0] - before[-1], M_step: before[-2] - loads[-1]}
    width = sum((zone.last - zone.first for zone in zones if zone.kind == CONTACT), NOTHING)
    stated = slope.subs(a, width + b).subs(steps).subs({F: before[-1], M: -before[-2]})
    gap, onset, moves = written_out(last.after()), regime.edges[0], sp.Symbol("moves", real=True)
    missed = gap - last.exit
    left = sp.diff(gap, onset) + sp.diff(gap, last.first) * moves  # the next onset is a period after this one
    driven = before[-1] - left_over * moves
    return [
        zero(f"{regime.sequence}: beta r' + r = F T' - F", beta * left + missed + written_out(driven), phases=regime.edges),
        zero(
            f"{regime.sequence}: F T' is the product over the zones",
            written_out(left_over * moved - before[-1] * stated),
            phases=regime.edges,
        ),
    ]


def growth_of_the_slope(regime: Row) -> Derived:
    r"""How the logarithm of T' changes with the onset, c' = dc/dx being negative: b' = db/dx along the first adhesion, a' = da/dc
    along the last, F' and M' by their own phases.

    .. math:: \frac{L b'}{\alpha} - \frac{[F] F'}{F (F + [F])} - c' \left(\frac{L a'}{\alpha} + \frac{[M] M'}{M (M +
        [M])}\right),\quad \frac{F + [F]}{H(b) + p_0} e^{-(b - d)/\beta},\quad -\frac{M}{H(a) + p_0} e^{(c - a)/\beta}
    """
    x, place = sp.symbols("x place", real=True)
    begins, release, load = (sp.Function(name)(x) for name in ("b", "c", "F"))
    ends, pull = (sp.Function(name)(place) for name in ("a", "M"))
    logarithm = (begins - ends) * L / alpha + sp.log(1 + F_step / load) + sp.log(1 + M_step / pull)
    whole = sp.diff(logarithm, x) + sp.diff(logarithm, place) * sp.diff(release, x)
    rates = {sp.diff(f, f.args[0]): RATES[f"{f.func}'"] for f in (begins, release, load, ends, pull)}
    b_rate, a_rate, c_rate, F_rate, M_rate = (RATES[f"{name}'"] for name in "bacFM")
    first = L * b_rate / alpha - F_step * F_rate / (F * (F + F_step))
    last = L * a_rate / alpha + M_step * M_rate / (M * (M + M_step))
    loads, before = ([written_out(part) for part in parts] for parts in _loads(regime))
    known = {F: before[-1], F_step: loads[0] - before[-1], M: -before[2]}
    at_b, at_a = (written_out(stable.FORCING(edge, D, beta)) + p_0 for edge in (b, a))
    begun = (F + F_step) / at_b * sp.exp(-(b - d) / beta)
    ended = -M / at_a * sp.exp((c - a) / beta)
    claims = [
        zero("the chain rule", whole.subs(rates).subs({load: F, pull: M}) - first + c_rate * last),
        zero("b' as adhesion moves it", begun.subs(known) - loads[0] / before[0] * decay(b - d, beta), phases=regime.edges),
        zero("a' as adhesion moves c", ended.subs(known) * loads[2] / before[2] * decay(c - a, beta) - 1, phases=regime.edges),
    ]
    return derived(growth_of_the_slope, (first - c_rate * last, begun, ended), claims)


def _loads(regime: Row) -> tuple[list[sp.Expr], list[sp.Expr]]:
    """What drives the state where each zone is entered, and where it is left."""
    first = [stable.FORCING(zone.first, D, beta) + offsets(zone)[0] for zone in regime.zones]
    last = [stable.FORCING(same_phase(zone.last), D, beta) + offsets(zone)[1] for zone in regime.zones]
    return first, last
