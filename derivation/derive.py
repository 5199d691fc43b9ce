"""The whole derivation, stage after stage: model, strip, flows, edge conditions, zones, regimes, means."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

from .averages import constant_means, strip_means, zone_integrals
from .check import Derived
from .flows import flows
from .jumps import jumps
from .level import level
from .model import Model, foundation, require_admissible
from .regimes import Regime, regimes
from .saturated import saturated
from .stability import onset_slope, shift_of_events
from .strip import strip
from .zones import Kernel, zones

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Derivation:
    """Everything derived for one model. ``sections`` holds the kernels to emit; ``steps`` every verified quantity."""

    model: Model
    stages: tuple[Any, ...]
    regimes: tuple[Regime, ...]
    sections: tuple[tuple[str, tuple[Kernel, ...]], ...]

    @property
    def steps(self) -> tuple[Derived, ...]:
        """Every derived quantity once, in the order of the derivation."""
        found: dict[int, Derived] = {}
        for record in _records(self.stages):
            found.setdefault(id(record), record)
        return tuple(found.values())

    @property
    def kernels(self) -> tuple[Kernel, ...]:
        return tuple(kernel for _, kernels in self.sections for kernel in kernels)


def derive(model: Model, progress: Progress | None = None) -> Derivation:
    """Derive and verify everything that follows from the two operators of ``model``."""
    say = progress or (lambda stage: None)
    say("model")
    require_admissible(model)
    ground = foundation(model)
    say("strip")
    one_strip = strip(ground)
    say("flows")
    flow = flows(one_strip)
    say("edge conditions")
    jump = jumps(one_strip)
    say("zones")
    zone = zones(flow, jump)
    say("saturated contact")
    full = saturated(flow)
    whole = level(full)
    say("regimes")
    table = regimes(zone)
    partial = [regime for regime in table if regime.edges]
    systems = tuple(k for regime in partial for k in system_kernels(regime))
    say("means")
    integrals = zone_integrals(flow)
    means = tuple(strip_means(regime, integrals) for regime in partial)
    still = tuple(constant_means(regime) for regime in table if regime.sequence in ("a", "f"))
    say("stability")
    shift = shift_of_events()
    slopes = tuple(onset_slope(regime) for regime in partial)
    sections = (
        ("Rigid profile, load, zones", zone.kernels),
        ("Complete contact", full.kernels),
        ("Boundary equations of each regime, and their derivatives by the unknown edges", systems),
        ("Means of pressure and friction", (full.means, *still, *means)),
        ("Slope of the onset-to-onset map", slopes),
        ("A whole level in complete contact, and a stack of them: SI units", whole.kernels),
    )
    stages = (ground, one_strip, flow, jump, zone, full, whole, table, systems, integrals, means, still, shift, slopes)
    return Derivation(model, stages, table, sections)


def system_kernels(regime: Regime) -> tuple[Kernel, Kernel]:
    residual, jacobian = regime.residual_formula, regime.jacobian_formula
    return (
        Kernel(residual, residual.written_out(residual.args), regime.derived),
        Kernel(jacobian, jacobian.written_out(jacobian.args), regime.derived),
    )


def _records(value: Any) -> Iterator[Derived]:
    if isinstance(value, Derived):
        yield value
    elif isinstance(value, (tuple, list)):
        for item in value:
            yield from _records(item)
    elif is_dataclass(value) and not isinstance(value, type):
        for item in fields(value):
            yield from _records(getattr(value, item.name))
