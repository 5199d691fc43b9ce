"""The whole derivation of a model with n relaxation times, stage after stage."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..basis import Basis
from ..check import Derived
from ..conditions import zone_conditions
from ..derive import _records as records
from ..further import FOR_ANY_NUMBER, further
from ..model import Model
from ..strip import adhesion_law, strip_profile
from .averages import strip_means
from .flows import mode_flows, u
from .jumps import closures, jump_law
from .kernel import ModeKernel
from .law import Law, law
from .levels import mode_levels
from .regimes import ModeRegime, mode_regimes
from .saturated import Complete, complete_contact
from .zones import contact, gap, passages, profile, relaxation, states

Progress = Callable[[str], None]
STAGES = ("model", "flows", "edge conditions", "zones", "complete contact", "regimes", "means", "levels")


@dataclass(frozen=True)
class ModesDerivation:
    """Everything derived for one model. ``sections`` holds the kernels to emit; ``steps`` every verified quantity."""

    model: Model
    law: Law
    closures: Derived
    complete: Complete
    means: Derived
    regimes: tuple[ModeRegime, ...]
    sections: tuple[tuple[str, tuple[ModeKernel, ...]], ...]
    stages: tuple[Any, ...]

    @property
    def steps(self) -> tuple[Derived, ...]:
        """Every derived quantity once, in the order of the derivation."""
        found: dict[int, Derived] = {}
        for record in records(self.stages):
            found.setdefault(id(record), record)
        return tuple(found.values())

    @property
    def kernels(self) -> tuple[ModeKernel, ...]:
        return tuple(kernel for _, kernels in self.sections for kernel in kernels)


def derive_modes(model: Model, progress: Progress | None = None) -> ModesDerivation:
    """Derive and verify everything that follows from the Prony series of ``model``."""
    done = progress or (lambda stage: None)
    ground = law(model)
    done("model")
    flows = mode_flows(ground)
    done("flows")
    jump, closure = jump_law(ground), closures(ground)
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
    sections.append(("Complete contact", complete.kernels))
    done("complete contact")
    regimes = mode_regimes(model.P[-1] != 0, complete.threshold.value)
    done("regimes")
    sections += further(FOR_ANY_NUMBER, Basis(flows, complete, regimes))
    means = strip_means(ground)
    done("means")
    upwards = mode_levels(flows, complete, regimes)
    done("levels")
    stages = (
        ground,
        adhesion_law(),
        strip_profile(),
        zone_conditions(u),
        flows,
        jump,
        closure,
        tuple(kernels for _, kernels in sections),
        complete,
        regimes,
        means,
        upwards,
    )
    return ModesDerivation(model, ground, closure, complete, means, regimes, tuple(sections), stages)
