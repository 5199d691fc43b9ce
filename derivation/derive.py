"""The whole derivation, stage after stage: model, strip, flows, edge conditions, zones, regimes, means, levels."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

import sympy as sp

from .averages import constant_means, strip_means, zone_integrals
from .basis import Basis
from .check import Check, Derived
from .conditions import conditions
from .displays import displays
from .energy import friction_balance, power_balance
from .events import excess_event, gap_event
from .flows import flows
from .functions import Call
from .further import FOR_ONE_TIME, further
from .half_space import half_space
from .jumps import jumps
from .kernel import Kernel
from .level import level
from .links import links
from .membership import require_member
from .model import Model, foundation, require_admissible
from .multilevel import multilevel
from .paper import Comparison, comparisons
from .paper.tags import require_all, require_tags
from .regime import Regime
from .regimes import regimes
from .saturated import saturated
from .stability import onset_slope, shift_of_events
from .stack import stack
from .strip import strip
from .witness import witnesses
from .zones import zones

Progress = Callable[[str], None]
STAGES = (
    "model",
    "strip",
    "flows",
    "edge conditions",
    "zones",
    "complete contact",
    "regimes",
    "means",
    "stability",
    "levels",
    "print",
)


@dataclass(frozen=True)
class Derivation:
    """Everything derived for one model. ``sections`` holds the kernels to emit; ``steps`` every verified quantity."""

    model: Model
    stages: tuple[Any, ...]
    regimes: tuple[Regime, ...]
    sections: tuple[tuple[str, tuple[Kernel, ...]], ...]
    comparisons: tuple[Comparison, ...]
    displayed: dict[str, Check]  # by step: its LaTeX read back and compared

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
    """Derive and verify everything that follows from the two operators of ``model``.

    ``progress`` is called with the name of each stage of ``STAGES`` when it is done.
    """
    done = progress or (lambda stage: None)
    require_admissible(model)
    require_member(model)
    ground = foundation(model)
    done("model")
    one_strip = strip(ground)
    done("strip")
    flow = flows(one_strip)
    done("flows")
    jump = jumps(one_strip)
    done("edge conditions")
    zone = zones(flow, jump)
    events = (*gap_event(flow), *excess_event(flow))
    chain = links(flow)
    done("zones")
    full = saturated(flow)
    whole = level(full)
    done("complete contact")
    table = regimes(zone, full.threshold.value)
    solutions = witnesses(table)
    partial = [regime for regime in table if regime.edges]
    systems = tuple(k for regime in partial for k in system_kernels(regime, zone.kernels))
    done("regimes")
    integrals = zone_integrals(flow)
    still = tuple(constant_means(regime) for regime in table if regime.sequence in ("a", "f"))
    means = tuple(strip_means(regime, integrals) for regime in partial)
    balances = (power_balance(flow), *(friction_balance(regime) for regime in partial))
    done("means")
    shift = shift_of_events()
    slopes = tuple(onset_slope(regime) for regime in partial)
    done("stability")
    asked = conditions(one_strip, table[0])
    upwards = multilevel(one_strip, full, whole, partial, means, integrals)
    pile = stack(one_strip, full, whole)
    rubber = half_space()
    done("levels")
    more = further(FOR_ONE_TIME, Basis(flow, full, table))
    sections = (
        ("Rigid profile, load, zones", zone.kernels),
        ("Events: value and slope, for root finding in a zone whose entry is evaluated once", events),
        ("Links: value and derivatives by both edges, for Newton on the chain of edges", chain),
        ("Complete contact", full.kernels),
        ("Boundary equations of each regime, and their derivatives by the unknown edges", systems),
        ("Means of pressure and friction", (full.means, *still, *means)),
        ("Slope of the onset-to-onset map", slopes),
        ("A whole level in complete contact, and a stack of them: SI units", whole.kernels),
        *more,
    )
    stages = (
        ground,
        one_strip,
        flow,
        jump,
        zone,
        events,
        chain,
        full,
        whole,
        asked,
        table,
        solutions,
        systems,
        integrals,
        means,
        still,
        balances,
        shift,
        slopes,
        upwards,
        pile,
        rubber,
        more,
    )
    exact = {kernel.formula.name: kernel.exact for _, kernels in sections for kernel in kernels}
    values = {record.name: record.value for record in _records(stages)}
    printed = comparisons(one_strip, exact, values)
    read = displays(_records(stages), flow, exact["saturated_pressure"])
    require_tags(_records(stages))
    require_all(_records(stages))
    done("print")
    return Derivation(model, stages, table, sections, printed, read)


def system_kernels(regime: Regime, zone_kernels: tuple[Kernel, ...]) -> tuple[Kernel, Kernel]:
    """Boundary equations and Jacobian to emit, with the exact expressions they compute: the derived flows put in."""
    by_name = {kernel.formula.name: kernel for kernel in zone_kernels}

    def as_derived(call: Call) -> sp.Expr:
        kernel = by_name[call.formula.name]
        return kernel.exact.subs(dict(zip(kernel.formula.args, call.args, strict=True)), simultaneous=True)

    parts = tuple(
        tuple(part.replace(lambda e: isinstance(e, Call), as_derived) for part in sp.Add.make_args(term))
        for _, term in regime.equations
    )
    exact = tuple(sp.Add(*equation) for equation in parts)
    slopes = tuple(tuple(sp.diff(part, edge) for part in equation) for equation in parts for edge in regime.edges)
    matrix = tuple(tuple(sp.diff(term, edge) for edge in regime.edges) for term in exact)
    return (
        Kernel(regime.residual_formula, exact, regime.derived, parts),
        Kernel(regime.jacobian_formula, matrix, regime.derived, slopes),
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
