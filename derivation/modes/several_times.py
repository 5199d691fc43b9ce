"""The whole derivation of a model with n relaxation times, stage after stage."""

from ..averages import constant_means, means_of_a_strip
from ..conditions import zone_conditions
from ..displays import STATED, displays, of_modes
from ..model import Model, Roots
from ..multilevel import multilevel
from ..outcome import Derivation, records
from ..paper.record import require_all, require_tags
from ..regimes import regimes
from ..sample_roots import sample_roots
from ..strip import adhesion_law, strip_profile
from ..zones import rigid_profile
from .chain import chain_rule, period_map
from .emit import whole_kernels
from .flows import mode_flows, passed_once, u
from .jumps import closures, jump_law
from .material import admissibility, foundation_law, prony_series, relaxed_stiffness
from .regimes import SeveralTimes
from .saturated import level, saturated
from .states import dimensionless_groups, partial_fractions
from .states import states as point_states
from .symbols import OF_STRIP
from .vocabulary import BINDINGS, vocabulary
from .zones import contact, gap, passages, relaxation, states


def derive(model: Model) -> Derivation:
    """Derive and verify everything that follows from the Prony series of ``model``."""
    ground = (admissibility(model), foundation_law(), relaxed_stiffness(model), prony_series(model))
    coordinates = (dimensionless_groups(), partial_fractions(), point_states())
    flows, closure = mode_flows(), closures(model)
    complete = saturated(flows)
    whole, stacked = level(complete.threshold.value)
    table = regimes(SeveralTimes(closure.value), complete.threshold.value, model.springy)
    still = tuple(constant_means(regime, OF_STRIP) for regime in table if regime.sequence in ("a", "f"))
    period = period_map()
    zones = (
        ("Rigid profile", rigid_profile(u)),
        ("States of a material point", states()),
        ("Gap zones: constant pressure", (*relaxation(flows), *gap(flows))),
        ("Contact zones", contact(flows)),
        ("Zones as maps of the state, and their derivatives", passages(flows)),
    )
    sections = (
        *zones,
        ("Complete contact", complete.kernels),
        ("Means of strips without edges", (complete.means, *still)),
        ("Complete contact of whole levels: SI units, modes with times in seconds", whole),
    )
    made = (
        (ground, coordinates, adhesion_law(), strip_profile(), zone_conditions(u)),
        (flows, jump_law(), closure, *(kernels for _, kernels in zones), complete, whole, stacked),
        (table, sample_roots("several_times", table, flows), means_of_a_strip(), still, period, chain_rule(period)),
        multilevel(table, passed_once(flows), ("excess_event",)),
    )
    steps = tuple(records(made))
    read = displays(steps, unread(model), vocabulary(flows), BINDINGS, of_modes)
    require_tags(steps)
    require_all(steps)
    return Derivation(
        "several_times",
        model,
        made,
        table,
        sections,
        read,
        composed=tuple(regime for regime in table if regime.edges),
        whole=whole_kernels(),
    )


def unread(model: Model) -> dict[str, str]:
    """What is said of the displays that have nothing to compare."""
    return STATED["several_times"] | (STATED["roots"] if isinstance(model.series, Roots) else {})
