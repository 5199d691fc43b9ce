"""The whole derivation of a model with n relaxation times, stage after stage."""

from __future__ import annotations

from ..conditions import zone_conditions
from ..further import FOR_ANY_NUMBER, Basis, further
from ..model import Model, Roots
from ..outcome import Derivation, Progress, Stages, records
from ..paper.tags import require_all, require_tags
from ..strip import adhesion_law, strip_profile
from ..zones import rigid_profile
from .averages import means_of_a_strip
from .chain import chain_rule
from .displays import displays
from .flows import mode_flows, u
from .functions import all_functions, level_functions, period_map
from .jumps import closures, jump_law
from .levels import mode_levels
from .material import admissibility, foundation_law, prony_series, relaxed_stiffness
from .regimes import mode_regimes
from .sample_roots import sample_roots
from .saturated import complete_contact
from .states import dimensionless_groups, partial_fractions
from .states import states as point_states
from .whole import whole_kernels
from .zones import contact, gap, passages, relaxation, states

STAGES = ("model", "flows", "edge conditions", "zones", "complete contact", "regimes", "means", "levels", "print")


def derive(model: Model, progress: Progress | None = None) -> Derivation:
    """Derive and verify everything that follows from the Prony series of ``model``.

    ``progress`` is called with the name of each stage of ``STAGES`` when it is done.
    """
    stages = Stages(progress)
    ground = (admissibility(model), foundation_law(model), relaxed_stiffness(model), prony_series(model))
    coordinates = (dimensionless_groups(), partial_fractions(), point_states())
    stages.done("model", ground, coordinates, adhesion_law(), strip_profile(), zone_conditions(u))
    flows = mode_flows()
    stages.done("flows", flows)
    closure = closures(model)
    stages.done("edge conditions", jump_law(), closure)
    sections = [
        ("Rigid profile", rigid_profile(u)),
        ("States of a material point", states()),
        ("Gap zones: constant pressure", (*relaxation(flows), *gap(flows))),
        ("Contact zones", contact(flows)),
        ("Zones as maps of the state, and their derivatives", passages(flows)),
    ]
    stages.done("zones", *(kernels for _, kernels in sections))
    complete = complete_contact(flows)
    stages.done("complete contact", complete.kernels, complete)
    table = mode_regimes(model.springy, closure.value, complete.threshold.value)
    stages.done("regimes", table, sample_roots(table, flows))
    means, period = means_of_a_strip(), period_map()
    stages.done("means", means, period, chain_rule(period))
    stages.done("levels", mode_levels(flows, complete, table))
    more = further(FOR_ANY_NUMBER, Basis(flows, complete, table))
    sections += [("Complete contact", complete.kernels), *more]
    steps = tuple(records([*stages.made, more]))
    read = displays(steps, flows, isinstance(model.series, Roots))
    require_tags(steps)
    require_all(steps)
    stages.done("print", more)
    return Derivation(
        model,
        tuple(stages.made),
        table,
        tuple(sections),
        read,
        composed=tuple(regime for regime in table if regime.edges),
        of_level=level_functions(complete),
        of_regimes=all_functions(table, means),
        whole=whole_kernels(complete, table, model.springy),
    )
