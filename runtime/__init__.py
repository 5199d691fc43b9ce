"""Hysteretic sliding friction of multiscale wavy surfaces by the strip method.

A rigid surface of nested waves slides over a viscoelastic foundation with Dugdale adhesion. ``solve_strip`` solves
single strips, ``solve_level`` and ``friction_law`` one level, ``solve`` the whole surface, ``sweep`` a scene over its
parameters. The strip solver's formulas are generated: see ``hystrip.derivation``.
"""

import sys
from types import ModuleType
from typing import TYPE_CHECKING

from ._version import __version__ as __version__

__all__ = [
    "WLF",
    "Arrhenius",
    "ConvergenceWarning",
    "ContactMap",
    "Dugdale",
    "FrictionLaw",
    "HalfSpace",
    "HystripError",
    "InputError",
    "KelvinVoigt",
    "Level",
    "LevelSolution",
    "Loop",
    "MissingExtra",
    "Prony",
    "Result",
    "Scene",
    "SolverError",
    "StandardLinearSolid",
    "StripSolution",
    "Sweep",
    "dma",
    "friction_law",
    "load",
    "loading_loop",
    "load_scene",
    "load_solver",
    "plots",
    "roughness",
    "solve",
    "solve_level",
    "solve_strip",
    "sweep",
    "typing",
]


#: Where a name lives that is loaded when it is first used; scenes need the command-line extra, everything else works without.
_LAZY = {
    "Arrhenius": "hystrip.inputs.shift",
    "ContactMap": "hystrip.contact_map",
    "ConvergenceWarning": "hystrip.errors",
    "Dugdale": "hystrip.inputs.adhesion",
    "friction_law": "hystrip.level_law",
    "FrictionLaw": "hystrip.level_law",
    "HalfSpace": "hystrip.inputs.half_space",
    "HystripError": "hystrip.errors",
    "InputError": "hystrip.errors",
    "KelvinVoigt": "hystrip.inputs.material",
    "Level": "hystrip.inputs.surface",
    "LevelSolution": "hystrip.level_solution",
    "load": "hystrip.storage",
    "load_scene": "hystrip.scene",
    "load_solver": "hystrip.loading",
    "loading_loop": "hystrip.loop",
    "Loop": "hystrip.loop",
    "MissingExtra": "hystrip.errors",
    "Prony": "hystrip.inputs.prony",
    "Result": "hystrip.result",
    "Scene": "hystrip.scene",
    "solve": "hystrip.solve",
    "solve_level": "hystrip.level_solution",
    "solve_strip": "hystrip.strip_solution",
    "SolverError": "hystrip.errors",
    "StandardLinearSolid": "hystrip.inputs.material",
    "StripSolution": "hystrip.strip_solution",
    "Sweep": "hystrip.sweeps",
    "sweep": "hystrip.sweeps",
    "WLF": "hystrip.inputs.shift",
}

#: subpackages that are there without an import of their own
_MODULES = ("dma", "plots", "roughness", "typing")

if TYPE_CHECKING:
    from . import dma, plots, roughness, typing
    from .contact_map import ContactMap
    from .errors import ConvergenceWarning, HystripError, InputError, MissingExtra, SolverError
    from .inputs.adhesion import Dugdale
    from .inputs.half_space import HalfSpace
    from .inputs.material import KelvinVoigt, StandardLinearSolid
    from .inputs.prony import Prony
    from .inputs.shift import WLF, Arrhenius
    from .inputs.surface import Level
    from .level_law import FrictionLaw, friction_law
    from .level_solution import LevelSolution, solve_level
    from .loading import load_solver
    from .loop import Loop, loading_loop
    from .result import Result
    from .scene import Scene, load_scene
    from .solve import solve
    from .storage import load
    from .strip_solution import StripSolution, solve_strip
    from .sweeps import Sweep, sweep


class _Package(ModuleType):
    """The package itself: ``hystrip.solve`` is the function, also after an import of the module of that name."""

    def __setattr__(self, name, value):
        if not (name == "solve" and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package

if not TYPE_CHECKING:  # a type checker would take any name for one of ours

    def __getattr__(name):
        import importlib

        if name in _MODULES:
            return importlib.import_module(f".{name}", __name__)
        if name not in _LAZY:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        value = getattr(importlib.import_module(_LAZY[name]), name)
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_LAZY, *_MODULES})
