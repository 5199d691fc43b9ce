"""Hysteretic sliding friction of multiscale wavy surfaces by the strip method.

A rigid surface of nested waves slides over a viscoelastic foundation with Dugdale adhesion. ``solve_strip`` solves
single strips, ``solve_level`` and ``friction_law`` one level, ``solve`` the whole surface, ``sweep`` a scene over its
parameters. The strip solver's formulas are generated: see ``hystrip.derivation``.
"""

from typing import TYPE_CHECKING

from .errors import HystripError, InputError, MissingExtra, SolverError
from .inputs.adhesion import Dugdale
from .inputs.half_space import HalfSpace
from .inputs.material import KelvinVoigt, StandardLinearSolid
from .inputs.prony import Prony
from .inputs.surface import Level
from .solve import solve

__version__ = "0.1.0"

__all__ = [
    "Dugdale",
    "FrictionLaw",
    "HalfSpace",
    "HystripError",
    "InputError",
    "KelvinVoigt",
    "Level",
    "LevelSolution",
    "MissingExtra",
    "Prony",
    "Result",
    "Scene",
    "SolverError",
    "StandardLinearSolid",
    "StripSolution",
    "Sweep",
    "friction_law",
    "load_scene",
    "load_solver",
    "solve",
    "solve_level",
    "solve_strip",
    "sweep",
]


#: Where a name lives that is loaded when it is first used; scenes need the command-line extra, everything else works without.
_LAZY = {
    "FrictionLaw": "hystrip.level.solution",
    "LevelSolution": "hystrip.level.solution",
    "Result": "hystrip.result",
    "Scene": "hystrip.scene",
    "Sweep": "hystrip.sweeps",
    "StripSolution": "hystrip.strip.solution",
    "friction_law": "hystrip.level.solution",
    "load_scene": "hystrip.scene",
    "load_solver": "hystrip.loading",
    "solve_level": "hystrip.level.solution",
    "solve_strip": "hystrip.strip.solution",
    "sweep": "hystrip.sweeps",
}

if TYPE_CHECKING:
    from .level.solution import FrictionLaw, LevelSolution, friction_law, solve_level
    from .loading import load_solver
    from .result import Result
    from .scene import Scene, load_scene
    from .strip.solution import StripSolution, solve_strip
    from .sweeps import Sweep, sweep


def __getattr__(name: str):
    if name not in _LAZY:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import importlib

    value = getattr(importlib.import_module(_LAZY[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_LAZY})
