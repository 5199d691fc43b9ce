"""Which generated solver belongs to a material, and how the library talks to it."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from .errors import InputError
from .inputs.checks import choice
from .inputs.half_space import HalfSpace
from .inputs.material import StandardLinearSolid
from .inputs.model import ModelMaterial
from .inputs.prony import Prony

if TYPE_CHECKING:
    from .strip.solved import Solved

EDGES = ("continuous", "constitutive")
_WHY = (
    "'constitutive' for a foundation with several relaxation times: where the pressure steps, a continuous "
    "displacement leaves all but one of the internal displacements open, so 'continuous' is not determined"
)
#: what may be given as a material
MATERIALS = (StandardLinearSolid, Prony, HalfSpace, ModelMaterial)
Material = StandardLinearSolid | Prony | HalfSpace | ModelMaterial


class Foundation(Protocol):
    """A material with its generated solver: all that levels and strips ask of it. Arrays flat, (N,), SI unless said otherwise."""

    kernel: ModuleType
    K: Any
    longest_time: float  # longest retardation time, s
    lossiest_rate: float  # rate at which Im K* is greatest, 1/s; inf where it only grows

    def flat(self, shape) -> Foundation:
        """The same for strips of this shape, flattened: array parameters are broadcast to it."""

    def solve(self, l, A, D, V, p_0, delta_0, edge: str, branch: str) -> tuple[Solved, Any, dict]:  # noqa: E741
        """Solve strips: ``Solved`` (dimensionless), the dimensionless strips, and the scales back to SI.

        ``edge`` has passed ``check_edge``. Raises ``SolverError`` for a strip that could not be certified."""

    def fields(self, strips, solved, phase) -> tuple[np.ndarray, np.ndarray]:
        """Dimensionless pressure and gap at a phase of each strip."""

    def modulus_ratio(self, rate) -> np.ndarray:
        """``|K*(i rate)|/K``."""

    def saturation_pressure(self, p_0, l, h, V) -> np.ndarray:  # noqa: E741
        """Nominal pressure from which a level is in saturated contact when unloading, Pa."""

    def saturation_penetration(self, p_0, l, h, V) -> np.ndarray:  # noqa: E741
        """Penetration at that pressure, m."""

    def saturation_friction(self, l, h, V) -> np.ndarray:  # noqa: E741
        """Friction of a level in saturated contact, Pa."""

    def surely_saturated(self, p_0, l, h, V) -> np.ndarray:  # noqa: E741
        """A penetration above which every strip of a level has no orbit but saturated contact, m."""


def kernel_of(material) -> ModuleType:
    """Generated module that solves ``material``. Raises ``InputError`` where there is none for its number of times."""
    material = _reduced(material)
    if isinstance(material, StandardLinearSolid):
        from hystrip.generated import standard_linear_solid

        return standard_linear_solid
    if isinstance(material, ModelMaterial):
        return material.kernel
    if material.solver is not None:
        return material.solver.prony_kernel(material.n)
    import importlib

    name = f"generalised_{material.n}"
    try:
        return importlib.import_module(f"hystrip.generated.{name}")
    except ModuleNotFoundError:
        raise InputError(
            "material.times",
            list(material.times),
            f"2 or 3 different times with the solvers that hystrip comes with; for {material.n} write a model file with "
            f'`MODEL = hystrip.derivation.prony_model("my_rubber", modes={material.n})`, run `hystrip regenerate` on it and give '
            "the material solver=hystrip.load_solver(...)",
        ) from None


def foundation_of(material) -> Foundation:
    """The material under one level, with its solver; with one time it is the standard linear solid, however it is written."""
    if isinstance(material, HalfSpace):
        raise TypeError("a half-space has a foundation for each level: give its at_wavelength(l)")
    material = _reduced(material)
    if isinstance(material, StandardLinearSolid):
        from .strip.single import SingleTime

        return SingleTime(kernel_of(material), material)
    from .modes.foundation import ManyTimes

    return ManyTimes(kernel_of(material), material)


def check_material(material) -> None:
    """``InputError`` unless ``material`` is one."""
    if not isinstance(material, MATERIALS):
        raise InputError("material", material, "a hystrip.StandardLinearSolid, KelvinVoigt, Prony or HalfSpace")


def check_edge(material, edge: str) -> str:
    """``edge`` if it is a closure that determines the edges of ``material``, else ``InputError``."""
    edge = choice("edge", edge, EDGES)
    if edge == "continuous" and not isinstance(_reduced(material), StandardLinearSolid):
        raise InputError("edge", edge, _WHY)
    return edge


def parameters(material) -> dict[str, Any]:
    """Names and values of a material's parameters, one entry for each number (or array over strips)."""
    if isinstance(material, StandardLinearSolid):
        return {name: getattr(material, name) for name in ("K", "T_eps", "T_sigma")}
    if isinstance(material, ModelMaterial):
        given = material.given
    else:
        own = ("E", "nu") if isinstance(material, HalfSpace) else ("K",)
        given = {n: getattr(material, n) for n in (*own, "moduli", "times")}
    named = {}
    for name, value in given.items():
        named |= {f"{name}[{i}]": each for i, each in enumerate(value)} if isinstance(value, tuple) else {name: value}
    return named


def _reduced(material):
    if isinstance(material, HalfSpace):  # every level has its times, at another scale
        material = material.modulus
    return (material.single or material) if isinstance(material, (Prony, ModelMaterial)) else material
