"""The derivation for one relaxation time, stage after stage."""

import sympy as sp

from .averages import constant_means, strip_means
from .balance import standing_still
from .conditions import strip_problem, zone_conditions
from .displays import STATED, displays, of_one_time
from .energy import friction_balance, power_balance
from .events import excess_event, gap_event, links
from .flows import flows
from .functions import Formula
from .half_space import half_space
from .jumps import closures, internal_state, jump_law
from .kernel import Kernel, Kernels, as_derived
from .level import crests_at_rest, least_pressure, level, levels_together, printed_equation_16
from .membership import require_constructor
from .model import Model, foundation, inadmissible, refuse
from .modes.flows import mode_flows
from .multilevel import multilevel, passed_once
from .onset_map import growth_of_the_slope, slope_of_the_onset_map
from .outcome import Derivation, records
from .paper.compare import comparisons
from .paper.record import require_all, require_status, require_tags
from .regime import OneTime
from .regimes import regimes
from .sample_roots import sample_roots
from .saturated import saturated
from .sequences import FREE, Row
from .stability import onset, onset_slope, shift_of_an_event
from .strip import strip
from .symbols import PARAMETERS
from .vocabulary import BINDINGS, vocabulary
from .zones import zones


def derive(model: Model) -> Derivation:
    """Derive and verify everything that follows from the two operators of ``model``."""
    refuse(model, inadmissible(model))
    require_constructor(model)
    ground = foundation(model)
    one_strip = strip(ground)
    flow, jump = flows(one_strip), jump_law(one_strip)
    closure = closures(jump.value)
    zone, chain = zones(flow), links(flow)
    events = (*gap_event(flow), *excess_event(flow))
    full = saturated(flow)
    threshold = full.threshold.value
    whole, stacked = level(threshold)
    ratio = sp.cancel(closure.value / sp.Symbol("step_p", real=True))  # [w]/[p]
    table = regimes(OneTime(ratio), threshold)
    partial = [regime for regime in table if regime.edges]
    of_zones = {kernel.formula.name: kernel for kernel in zone}
    systems = tuple(boundary_equations(regime, of_zones) for regime in partial)
    still = tuple(constant_means(regime, PARAMETERS) for regime in table if regime.sequence in ("a", "f"))
    means = tuple(strip_means(regime, of_zones) for regime in partial)
    onsets = onset({regime.sequence: regime for regime in partial})
    slopes = tuple(onset_slope(regime) for regime in partial if regime.zones[-1].kind == FREE)
    made = (
        (ground, one_strip, flow, jump, internal_state(one_strip), closure),
        (zone, events, chain, full, whole, stacked, printed_equation_16(whole[2].exact)),
        (zone_conditions(one_strip.u), strip_problem(one_strip, table[0]), table),
        (sample_roots("one_time", table, mode_flows()), systems, means, still),
        (power_balance(flow), *(friction_balance(regime) for regime in partial)),
        (shift_of_an_event(), onsets, slopes, slope_of_the_onset_map(partial), growth_of_the_slope(partial[0])),
        (standing_still(flow),),
        multilevel(table, [passed_once(one_strip)], ("excess_after", "excess_event")),
        (least_pressure(threshold, whole[1].exact), levels_together(one_strip, whole[2].exact), crests_at_rest(), half_space()),
    )
    sections = (
        ("Rigid profile, load, zones", zone),
        ("Events: value and slope, for root finding in a zone whose entry is evaluated once", events),
        ("Links: value and derivatives by both edges, for Newton on the chain of edges", chain),
        ("Complete contact", full.kernels),
        ("Boundary equations of each regime", systems),
        ("Means of pressure and friction", (full.means, *still, *means)),
        ("Onset of adhesion, and the slope of the map from one onset to the next", (*onsets, *slopes)),
        ("A whole level in complete contact: SI units", whole),
    )
    exact = {kernel.formula.name: kernel.exact for _, kernels in sections for kernel in kernels}
    steps = tuple(records(made))
    printed = comparisons(one_strip, exact, {step.name: step.value for step in steps})
    read = displays(steps, STATED["one_time"], vocabulary(flow, exact["saturated_pressure"]), BINDINGS, of_one_time)
    require_tags(steps)
    require_all(steps)
    require_status(steps, printed)
    return Derivation("one_time", model, made, table, sections, read, printed)


def boundary_equations(regime: Row, zones: Kernels) -> Kernel:
    """Boundary equations to emit, with the exact expressions they compute: the derived flows put in."""
    parts = tuple(tuple(as_derived(part, zones) for part in sp.Add.make_args(term)) for _, term in regime.equations)
    computed = Formula(f"residual_{regime.sequence}", (*regime.edges, *PARAMETERS), tuple(term for _, term in regime.equations))
    return Kernel(computed, tuple(sp.Add(*equation) for equation in parts), regime.derived, parts)
