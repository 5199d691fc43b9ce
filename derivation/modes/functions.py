"""The functions of a regime on a foundation with modes: its zones put together, as formulas to emit.

The boundary equations are the zones' own: what entry and exit of a zone leave for the change over it. The state at the first
edge is the one that a period returns: zones are affine maps of it, z -> z + drive - forget z, which the step "period map"
composes. Means are the integrals of the zones, summed. What is an algorithm, the chain rule over the zones, is named as one.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from ..averages import adhesive_rise
from ..check import Derived, derived, zero
from ..functions import Formula, Helper
from ..kernel import Kernel
from ..sequences import ADHESION, CONTACT, PERIOD, Span
from ..stable import PROFILE, PROFILE_INTEGRAL, PROFILE_RISE, PROFILE_SLOPE
from ..symbols import D, K, alpha, beta, p_0
from . import stable
from .regimes import ModeRegime
from .symbols import J_0, OF_STRIP, J, S, enter, eta, leave, m, share

kV = sp.Symbol("kV", nonnegative=True)
ORDINALS = ("first", "second", "third", "fourth")


class periodic(Helper):
    """The state that a period returns, from the maps of its zones."""


class Passage(Helper):
    """What a zone does, under names."""


class edge_slopes(Helper):
    """Chain rule over the passages of a period, the periodic state moving along."""


class monodromy(Helper):
    """Chain rule over the passages of a period, every event moving along."""


ALGORITHMS = (periodic, Passage, edge_slopes, monodromy)
"""Functions of the generated ``modes``: loops and products of matrices, which hold no physics."""


@dataclass(frozen=True)
class RegimeFunction:
    """A formula that calls derived ones. ``algorithm``: what puts them together, if not the formula."""

    formula: Formula
    statement: str
    latex: str
    function: str
    paper: str = ""
    algorithm: str = ""


def all_functions(regimes: Sequence[ModeRegime], means: Derived) -> tuple[RegimeFunction, ...]:
    """What is emitted for the regimes with edges."""
    return tuple(each for regime in regimes if regime.edges for each in regime_functions(regime, means))


def whole_kernels(springs: bool) -> tuple[Kernel, ...]:
    """What the functions of the template come to: modes of a strip, and of the material. ``springs``: every branch has one."""
    passing = (*(kV * time for time in (alpha, beta, eta)), S, J, J_0, enter, leave, share)
    prony, retardation = (K / S, alpha), (J_0 / K, J / K, beta)
    return (
        Kernel(Formula("at_speed", (m, kV), passing), passing, None),
        *([Kernel(Formula("prony", (K, m), prony), prony, None, moving=True, springs=True)] if springs else []),
        Kernel(Formula("retardation", (K, m), retardation), retardation, None),
    )


def period_map() -> Derived:
    r"""A period is an affine map of the state, and R z = c is the state that it returns. What is forgotten is
    accumulated, not what is kept: slow modes forget little, and that little keeps its digits.

    .. math:: z \to z + c_k - R_k z,\quad c = c_2 + c_1 - R_2 c_1,\ R = R_1 + R_2 - R_2 R_1
    """
    state, drive_1, drive_2, forget_1, forget_2 = sp.symbols("z c_1 c_2 R_1 R_2", commutative=False)
    after = state + drive_1 - forget_1 * state
    twice = after + drive_2 - forget_2 * after
    drive, forget = drive_2 + drive_1 - forget_2 * drive_1, forget_1 + forget_2 - forget_2 * forget_1
    return derived(
        period_map,
        (drive, forget),
        [zero("for matrices, which do not commute", sp.expand(twice - (state + drive - forget * state)))],
        latex=rf"c = {sp.latex(drive)},\quad R = {sp.latex(forget)}",
        emitted=tuple(f"state_{sequence}" for sequence in ("acaf", "afc", "af", "ac")),
    )


def regime_functions(regime: ModeRegime, means: Derived) -> tuple[RegimeFunction, ...]:
    """What is emitted for a regime with edges."""
    sequence, args = regime.sequence, (*regime.edges, *OF_STRIP)
    by, first = regime.derived.function, regime.edges[0]
    state = Formula(f"state_{sequence}", args, periodic(sp.Tuple(*(_map(zone) for zone in regime.zones))))
    passages = _passages(regime, args)
    zones = sp.Symbol("zones")
    both = (_residual_of(regime, zones), edge_slopes(zones, PROFILE_SLOPE(first)))
    linear = Formula(f"residual_and_jacobian_{sequence}", args, both, ((zones, passages(*args)),))
    turn = Formula(f"return_map_{sequence}", args, monodromy(passages(*args)))
    meanings = "; ".join(meaning for _, meaning in regime.equations)
    return (
        RegimeFunction(state, f"{regime.derived.statement} The state at {first}.", "R z = c", "modes.functions.period_map"),
        RegimeFunction(
            passages,
            f"The zones in turn, from the state at {first}: a Passage each.",
            r"z_{k+1} = z_k + \Delta z_k",
            by,
        ),
        RegimeFunction(
            _residual(regime, args, state),
            f"Boundary equations: {meanings}. Each is counted from the edge before.",
            r"w - u - g = 0,\quad \text{entry} - \text{exit} + \Delta = 0,\quad \Delta\ \text{of the gap or of the pressure}",
            by,
        ),
        RegimeFunction(
            linear,
            f"What residual_{sequence} returns, and its derivatives by the edges, the state moving along.",
            r"R\,\partial z = \partial c - \partial R\,z",
            "modes.chain.chain_rule",
            algorithm="the loop over the zones, modes.edge_slopes",
        ),
        RegimeFunction(
            turn,
            f"Derivative of the state before {first} by that one period earlier. "
            "An orbit is stable if its spectral radius is below 1.",
            r"\partial z(s + 2\pi)/\partial z(s)",
            "modes.chain.chain_rule",
            algorithm="the loop over the zones and their events, modes.monodromy",
        ),
        RegimeFunction(
            _means(regime, args, state),
            f"Means of pressure and friction of a strip: {regime.title}.",
            means.latex,
            means.function,
            means.paper,
        ),
    )


def _map(zone: Span) -> sp.Expr:
    """The zone as an affine map of the state."""
    of = stable.CONTACT_MAP if zone.kind == CONTACT else stable.RELAXATION_MAP
    return of(zone.first, zone.last, zone.pressure, m)


def _symbol(letter: str, number: int) -> sp.Symbol:
    return sp.Symbol(f"{letter}_{number + 1}", real=True)


def _passages(regime: ModeRegime, args: tuple[sp.Symbol, ...]) -> Formula:
    maps, entered, names = sp.Symbol("maps"), _symbol("z", 0), []
    steps = [(maps, sp.Tuple(*(_map(zone) for zone in regime.zones))), (entered, periodic(maps))]
    for number, zone in enumerate(regime.zones):
        of = stable.CONTACT_PASSAGE if zone.kind == CONTACT else stable.RELAXATION_PASSAGE
        name, forget = sp.Symbol(ORDINALS[number]), sp.Symbol(f"maps[{number}][0]")
        steps.append((name, Passage(entered, forget, of(zone.first, zone.last, entered, zone.pressure, m))))
        names.append(name)
        if zone is not regime.zones[-1]:
            after = _symbol("z", number + 1)
            steps.append((after, entered + sp.Symbol(f"{name}.increment")))
            entered = after
    return Formula(f"passages_{regime.sequence}", args, tuple(names), tuple(steps))


def _entries(
    regime: ModeRegime, args: tuple[sp.Symbol, ...], state: Formula
) -> tuple[list[sp.Symbol], list[tuple[sp.Symbol, sp.Expr]]]:
    """What every zone is entered with (overstresses in contact, retardation displacements elsewhere), and the steps to it."""
    z = _symbol("z", 0)
    entered, steps = [], [(z, state(*args))]
    for number, zone in enumerate(regime.zones):
        last = zone is regime.zones[-1]
        if zone.kind == CONTACT:
            f = _symbol("f", number)
            steps.append((f, stable.OVERSTRESS(z, zone.pressure, m)))
            entered.append(f)
            change = stable.CONTACT_INCREMENT(zone.first, zone.last, f, m)
        else:
            entered.append(z)
            change = stable.RELAXATION_INCREMENT(zone.first, zone.last, z, zone.pressure, m)
        if not last:
            after = _symbol("z", number + 1)
            steps.append((after, z + change))
            z = after
    return entered, steps


def _onset(regime: ModeRegime, state: sp.Expr) -> sp.Expr:
    return stable.DISPLACEMENT(state, regime.onset_pressure, m) - PROFILE(regime.edges[0], D) - regime.onset_gap


def _residual(regime: ModeRegime, args: tuple[sp.Symbol, ...], state: Formula) -> Formula:
    entered, steps = _entries(regime, args, state)
    terms = [_onset(regime, steps[0][0])]
    for zone, entry in zip(regime.zones[:-1], entered, strict=False):
        if zone.kind == CONTACT:
            change = stable.EXCESS_CHANGE(zone.first, zone.last, entry, m)
        else:
            change = stable.GAP_CHANGE(zone.first, zone.last, entry, zone.pressure, m)
        terms.append(zone.missing + change)
    return Formula(f"residual_{regime.sequence}", args, tuple(terms), tuple(steps))


def _residual_of(regime: ModeRegime, zones: sp.Symbol) -> tuple[sp.Expr, ...]:
    """The boundary equations, from the passages of a period."""
    changes = [zone.missing + sp.Symbol(f"{zones}[{number}].change") for number, zone in enumerate(regime.zones[:-1])]
    return (_onset(regime, sp.Symbol(f"{zones}[0].state")), *changes)


def _means(regime: ModeRegime, args: tuple[sp.Symbol, ...], state: Formula) -> Formula:
    """The mean of w, where there is contact, for that of p, and the work of p.

    Where nothing is free the traction acts everywhere and does no work over a period: pressures count from -p_0.
    """
    name = f"means_{regime.sequence}"
    raised = p_0 if regime.touches and all(zone.kind in (CONTACT, ADHESION) for zone in regime.zones) else sp.Integer(0)
    entered, steps = _entries(regime, args, state) if regime.touches else ([None] * len(regime.zones), [])
    height = work = sp.Integer(0)
    for zone, entry in zip(regime.zones, entered, strict=True):
        if zone.kind == CONTACT:
            height += PROFILE_INTEGRAL(zone.first, zone.last, D)
            work += stable.CONTACT_WORK(zone.first, zone.last, entry, D + raised, m)
            continue
        if zone.kind != ADHESION:
            work += (zone.pressure + raised) * PROFILE_RISE(zone.first, zone.last)
        if regime.touches:
            height += stable.RELAXATION_INTEGRAL(zone.first, zone.last, entry, zone.pressure, m)
        else:
            height += zone.pressure * (zone.last - zone.first)
    work += (raised - p_0) * adhesive_rise(regime.zones)
    return Formula(name, args, (height / PERIOD, work / PERIOD), tuple(steps))
