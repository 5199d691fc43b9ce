"""The whole derivation of a model with n relaxation times, stage after stage."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..basis import Basis
from ..check import Check, Derived
from ..conditions import zone_conditions
from ..derive import _records as records
from ..further import FOR_ANY_NUMBER, further
from ..kernel import Kernel
from ..model import Model, Roots
from ..paper.tags import require_tags
from ..strip import adhesion_law, strip_profile
from .averages import strip_means
from .chain import chain_rule
from .displays import displays
from .flows import mode_flows, u
from .functions import RegimeFunction, level_functions, period_map
from .jumps import closures, jump_law
from .levels import mode_levels
from .material import admissibility, foundation_law, prony_series, relaxed_stiffness
from .regimes import ModeRegime, mode_regimes
from .saturated import Complete, complete_contact
from .states import dimensionless_groups, partial_fractions
from .states import states as point_states
from .witness import witnesses
from .zones import contact, gap, passages, profile, relaxation, states

Progress = Callable[[str], None]
STAGES = ("model", "flows", "edge conditions", "zones", "complete contact", "regimes", "means", "levels", "print")


@dataclass(frozen=True)
class ModesDerivation:
    """Everything derived for one model. ``sections`` holds the kernels to emit; ``steps`` every verified quantity."""

    model: Model
    closures: Derived
    complete: Complete
    levels: tuple[RegimeFunction, ...]
    means: Derived
    regimes: tuple[ModeRegime, ...]
    sections: tuple[tuple[str, tuple[Kernel, ...]], ...]
    stages: tuple[Any, ...]
    displayed: dict[str, Check]  # by step: its LaTeX read back and compared

    @property
    def steps(self) -> tuple[Derived, ...]:
        """Every derived quantity once, in the order of the derivation."""
        found: dict[int, Derived] = {}
        for record in records(self.stages):
            found.setdefault(id(record), record)
        return tuple(found.values())

    @property
    def kernels(self) -> tuple[Kernel, ...]:
        return tuple(kernel for _, kernels in self.sections for kernel in kernels)


def derive_modes(model: Model, progress: Progress | None = None) -> ModesDerivation:
    """Derive and verify everything that follows from the Prony series of ``model``."""
    done = progress or (lambda stage: None)
    ground = (admissibility(model), foundation_law(model), relaxed_stiffness(model), prony_series(model))
    coordinates = (dimensionless_groups(), partial_fractions(), point_states())
    done("model")
    flows = mode_flows()
    done("flows")
    jump, closure = jump_law(), closures(model)
    done("edge conditions")
    sections = [
        ("Rigid profile", profile()),
        ("States of a material point", states()),
        ("Gap zones: constant pressure", (*relaxation(flows), *gap(flows))),
        ("Contact zones", contact(flows)),
        ("Zones as maps of the state, and their derivatives", passages(flows)),
    ]
    done("zones")
    complete = complete_contact(flows)
    of_level = level_functions(complete)
    sections.append(("Complete contact", complete.kernels))
    done("complete contact")
    regimes = mode_regimes(model.springy, complete.threshold.value)
    solutions = witnesses(regimes, flows)
    done("regimes")
    sections += further(FOR_ANY_NUMBER, Basis(flows, complete, regimes))
    means = strip_means()
    period = period_map()
    done("means")
    upwards = mode_levels(flows, complete, regimes)
    done("levels")
    stages = (
        ground,
        coordinates,
        adhesion_law(),
        strip_profile(),
        zone_conditions(u),
        flows,
        jump,
        closure,
        tuple(kernels for _, kernels in sections),
        complete,
        regimes,
        solutions,
        means,
        period,
        chain_rule(period),
        upwards,
    )
    read = displays(records(stages), flows, isinstance(model.series, Roots))
    require_tags(records(stages))
    done("print")
    return ModesDerivation(model, closure, complete, of_level, means, regimes, tuple(sections), stages, read)
