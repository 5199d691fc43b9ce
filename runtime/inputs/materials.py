"""Materials that can be solved: which generated solver belongs to one, its parameters, the closures that determine its edges."""

from collections.abc import Collection
from types import ModuleType
from typing import Any

from ..errors import InputError
from .checks import choice
from .half_space import HalfSpace
from .material import StandardLinearSolid
from .model import ModelMaterial
from .prony import Prony

CLOSURES = ("continuous", "constitutive")
#: what may be given as a material
MATERIALS = (StandardLinearSolid, Prony, HalfSpace, ModelMaterial)
Material = StandardLinearSolid | Prony | HalfSpace | ModelMaterial


def kernel_of(material) -> ModuleType:
    """Generated module that solves ``material``. Raises ``InputError`` where its own solver has none for its number of times."""
    material = reduced(material)
    if isinstance(material, StandardLinearSolid):
        from hystrip.generated import standard_linear_solid

        return standard_linear_solid
    if isinstance(material, ModelMaterial):
        return material.kernel
    if material.solver is not None:
        return material.solver.prony_kernel(material.n)
    from hystrip.generated import generalised

    return generalised


def check_material(material) -> None:
    """``InputError`` unless ``material`` is one."""
    if not isinstance(material, MATERIALS):
        raise InputError("material", material, "a hystrip.StandardLinearSolid, KelvinVoigt, Prony or HalfSpace")


def check_edge(material, edge: str) -> str:
    """``edge`` if it is a closure that determines the edges of ``material``, else ``InputError``."""
    edge = choice("edge", edge, CLOSURES)
    if edge == "continuous" and not isinstance(reduced(material), StandardLinearSolid):
        raise InputError(
            "edge",
            edge,
            "'constitutive' for a foundation with several relaxation times: where the pressure steps, a continuous "
            "displacement leaves all but one of the internal displacements open, so 'continuous' is not determined",
        )
    return edge


def parameters(material, apart: Collection[str] = ()) -> dict[str, Any]:
    """Names and values of a material's parameters, one entry for each number (or array over strips).

    ``apart``: names of what else is told beside them. A parameter that a model of one's own calls so, or ``K`` although it is not
    the stiffness, has ``material.`` before its name.
    """
    if isinstance(material, StandardLinearSolid):
        return {name: getattr(material, name) for name in ("K", "T_eps", "T_sigma")}
    if isinstance(material, ModelMaterial):
        others = {*apart, "K"} if apart and material.given.get("K") != material.K else apart
        given = {f"material.{name}" if name in others else name: value for name, value in material.given.items()}
    else:
        own = ("E", "nu") if isinstance(material, HalfSpace) else ("K",)
        given = {n: getattr(material, n) for n in (*own, "moduli", "times")}
    named = {}
    for name, value in given.items():
        named |= {f"{name}[{i}]": each for i, each in enumerate(value)} if isinstance(value, tuple) else {name: value}
    return named


def reduced(material):
    """The standard linear solid that a material with one time is, however it was written down; else itself."""
    if isinstance(material, HalfSpace):  # every level has its times, at another scale
        material = material.modulus
    return (material.single or material) if isinstance(material, (Prony, ModelMaterial)) else material
