"""Types of the public interface, for annotations in scripts and for type checkers."""

from collections.abc import Callable, Sequence
from typing import Any, Literal, Protocol, TypeAlias, TypedDict

import numpy as np
import numpy.typing as npt

from .inputs.half_space import HalfSpace
from .inputs.material import KelvinVoigt, StandardLinearSolid
from .inputs.materials import Material
from .inputs.model import ModelMaterial
from .inputs.prony import Prony

__all__ = [
    "Array",
    "Bools",
    "Branch",
    "Edge",
    "Floats",
    "HalfSpace",
    "LevelPlot",
    "Material",
    "Number",
    "Numbers",
    "Options",
    "Progress",
    "ResultPlot",
    "KelvinVoigt",
    "ModelMaterial",
    "Prony",
    "StandardLinearSolid",
]

#: what w does where the pressure steps
Edge: TypeAlias = Literal["continuous", "constitutive"]
#: which of several orbits: the most engaged, or the least
Branch: TypeAlias = Literal["unloading", "loading"]
#: pictures of a result, and of the solution of a level
ResultPlot: TypeAlias = Literal["mu", "tau", "contact", "map", "strip", "loop"]
LevelPlot: TypeAlias = Literal["map", "strip"]


class Array(Protocol):
    """What NumPy makes an array of: its own arrays and numbers, those of xarray, pandas and others."""

    def __array__(self) -> npt.NDArray[Any]: ...


#: one number
Number: TypeAlias = float | np.floating[Any] | np.integer[Any]
#: numbers of any shape; text is none
Numbers: TypeAlias = float | Array | Sequence[float] | Sequence[Array] | Sequence[Sequence[float]]
Floats: TypeAlias = npt.NDArray[np.float64]
Bools: TypeAlias = npt.NDArray[np.bool_]
#: called with the number of points done and the total
Progress: TypeAlias = Callable[[int, int], object]


class Options(TypedDict, total=False):
    """Options of ``hystrip.solve`` that need not be given."""

    edge: Edge
    branch: Branch
    rtol: float
    strips: int | None
    skip: bool
    progress: Progress | None
    temperature: float | None
