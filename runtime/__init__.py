"""Hysteretic sliding friction of multiscale wavy surfaces by the strip method.

A rigid surface of nested waves slides over a viscoelastic foundation with Dugdale adhesion. ``solve_strip`` solves single strips,
``solve_level`` and ``friction_law`` one level, ``solve`` the whole surface. The strip solver's formulas are generated: see
``hystrip.derivation``.
"""

from hystrip.errors import HystripError, InputError, MissingExtra, SolverError
from hystrip.inputs.adhesion import Dugdale
from hystrip.inputs.material import StandardLinearSolid
from hystrip.inputs.surface import Level
from hystrip.level.solution import FrictionLaw, LevelSolution, friction_law, solve_level
from hystrip.result import Result
from hystrip.solve import solve
from hystrip.strip.solution import StripSolution, solve_strip

__version__ = "0.1.0"

__all__ = [
    "Dugdale",
    "FrictionLaw",
    "HystripError",
    "InputError",
    "Level",
    "LevelSolution",
    "MissingExtra",
    "Result",
    "Scene",
    "SolverError",
    "StandardLinearSolid",
    "StripSolution",
    "friction_law",
    "load_scene",
    "solve",
    "solve_level",
    "solve_strip",
]


def __getattr__(name: str):
    # scenes need the command-line extra; everything else works without
    if name in ("Scene", "load_scene"):
        import hystrip.scene

        return getattr(hystrip.scene, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
