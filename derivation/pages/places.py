"""Where the runtime carries out what a step says, and which steps a step enters that no function computes by itself.

All by the function that derives the step.

A place is a function of the runtime and a piece of the line that does it. The page quotes the line; one that is gone, or
no longer the only one, is an error that names the step.
"""

from __future__ import annotations

import ast
import importlib.util
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from ..check import DerivationError, Derived

RUNTIME: dict[str, tuple[tuple[str, str, str], ...]] = {
    "strip.adhesion_law": (("inputs/adhesion.py", "Dugdale.__init__", "p * delta"),),
    "strip.dimensionless_groups": (("orbit/si.py", "dimensionless", "alpha, beta ="),),
    "jumps.closures": (("orbit/groups.py", "adhesive_cycle", "jump ="),),
    "saturated.saturation_threshold": (("orbit/closed_form_exclusion.py", "saturates", "return s.D - 1 + s.p_0 >="),),
    "multilevel.means_over_a_level": (
        ("level/means.py", "level_means", "return average("),
        ("level/means.py", "equal_strips", "mean = values.mean"),
    ),
    "load.contact_area": (("orbit/solved.py", "Record.orbits", "contact = np.clip("),),
    "multilevel.local_shear": (("level/strips.py", "_values", "np.concatenate((strips.values, carried)"),),
    "multilevel.carried_friction": (
        ("level/lower_levels.py", "_contributions", "total[saturated, :-1] +="),
        ("level/lower_levels.py", "_attempt", "best = width"),
    ),
    "multilevel.friction_coefficient": (("solve.py", "_result", "mu = np.divide"),),
    "half_space.foundation_of_a_level": (("inputs/half_space.py", "_foundation", "per_modulus = SHAPE"),),
    "stack.least_pressure": (("multilevel.py", "saturated", "needed = "),),
}
ENTERS: dict[str, tuple[str, ...]] = {
    "model.foundation_law": ("relaxed stiffness", "moving frame", "complex modulus"),
    "model.relaxed_stiffness": ("dimensionless groups",),
    "model.instantaneous_compliance": ("dimensionless groups", "jump law"),
    "strip.moving_frame": ("dimensionless groups", "strip problem"),
    "flows.relaxation_flow": ("gap flow", "relaxation_increment", "relaxation_integral"),
    "modes.flows.relaxation_flow": ("gap_after", "relaxation_increment", "relaxation_integral"),
    "jumps.jump_law": ("closures",),
    "jumps.internal_state": ("contact_increment", "relaxation_increment", "regime acaf"),
    "saturated.complex_modulus": ("storage", "loss", "modulus_ratio", "saturated_pressure"),
    "conditions.zone_conditions": ("strip problem", "regime acaf"),
    "multilevel.local_stress": ("local shear", "integrals over contact"),
    "energy.power_balance": ("friction balance acaf",),
    "half_space.stiffness_under_a_wave": ("foundation that stands for a half-space",),
    "stability.shift_of_an_event": ("onset_slope_acaf", "onset_slope_af"),
}
MEASURED = {"multilevel.friction_coefficient": "two_levels"}  # a table of the measured figures that shows the runtime at it


@dataclass(frozen=True)
class Place:
    file: str
    function: str
    text: str


def carried_out(step: Derived) -> list[Place]:
    """The runtime's lines for a step."""
    return [_place(step.name, *where) for where in RUNTIME.get(step.function, ())]


def _place(step: str, file: str, function: str, piece: str) -> Place:
    text, tree = _parsed(file)
    name = function.rpartition(".")[2]
    found = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) and node.name == name and not _overload(node)]
    lines = [line for node in found for line in text.splitlines()[node.lineno - 1 : node.end_lineno] if piece in line]
    if len(found) != 1 or len(lines) != 1:
        raise DerivationError(
            step, f"runtime/{file}: {function} has {len(lines)} lines with {piece!r}, not the one that the audit names"
        )
    return Place(f"runtime/{file}", function, lines[0].strip())


def _overload(node: ast.FunctionDef) -> bool:
    return any(ast.unparse(decorator) == "overload" for decorator in node.decorator_list)


@lru_cache
def _parsed(file: str) -> tuple[str, ast.Module]:
    found = importlib.util.find_spec("hystrip")
    if found is None or found.origin is None:
        raise FileNotFoundError("the package hystrip is not installed")
    text = (Path(found.origin).parent / file).read_text(encoding="utf-8")
    return text, ast.parse(text)
