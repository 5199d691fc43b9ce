"""The whole derivation of a model with n relaxation times, stage after stage."""

from typing import Any

from ..averages import constant_means, means_of_a_strip
from ..conditions import zone_conditions
from ..displays import STATED, displays, of_modes
from ..model import Model, Roots
from ..multilevel import multilevel
from ..outcome import Derivation, records
from ..paper.tags import require_all, require_tags
from ..regimes import regimes
from ..sample_roots import sample_roots
from ..strip import adhesion_law, strip_profile
from ..zones import rigid_profile
from .chain import chain_rule
from .flows import mode_flows, passed_once, u
from .functions import period_map, whole_kernels
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
    made: list[Any] = []
    ground = (admissibility(model), foundation_law(model), relaxed_stiffness(model), prony_series(model))
    coordinates = (dimensionless_groups(), partial_fractions(), point_states())
    made += (ground, coordinates, adhesion_law(), strip_profile(), zone_conditions(u))
    flows = mode_flows()
    made.append(flows)
    closure = closures(model)
    made += (jump_law(), closure)
    sections = [
        ("Rigid profile", rigid_profile(u)),
        ("States of a material point", states()),
        ("Gap zones: constant pressure", (*relaxation(flows), *gap(flows))),
        ("Contact zones", contact(flows)),
        ("Zones as maps of the state, and their derivatives", passages(flows)),
    ]
    made += (kernels for _, kernels in sections)
    complete = saturated(flows)
    whole, stacked = level(complete.threshold.value)
    made += (complete, whole, stacked)
    table = regimes(SeveralTimes(closure.value), complete.threshold.value, model.springy)
    made += (table, sample_roots("several_times", table, flows))
    means, period = means_of_a_strip(), period_map()
    still = tuple(constant_means(regime, OF_STRIP) for regime in table if regime.sequence in ("a", "f"))
    made += (means, still, period, chain_rule(period))
    made += multilevel(table, passed_once(flows), ("excess_event",))
    sections += [
        ("Complete contact", complete.kernels),
        ("Means of strips without edges", (complete.means, *still)),
        ("Complete contact of whole levels: SI units, modes with times in seconds", whole),
    ]
    steps = tuple(records(made))
    read = displays(steps, unread(model), vocabulary(flows), BINDINGS, of_modes)
    require_tags(steps)
    require_all(steps)
    return Derivation(
        "several_times",
        model,
        tuple(made),
        table,
        tuple(sections),
        read,
        composed=tuple(regime for regime in table if regime.edges),
        whole=whole_kernels(),
    )


def unread(model: Model) -> dict[str, str]:
    """What is said of the displays that have nothing to compare."""
    return STATED["several_times"] | (STATED["roots"] if isinstance(model.series, Roots) else {})
