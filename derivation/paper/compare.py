"""Eq. 1 to 16 as printed against what is derived, in order."""

from collections.abc import Mapping
from typing import Any

import sympy as sp

from ..level import in_si
from ..strip import Strip
from ..surface import WAVE
from . import foundation, level, stack
from .record import Comparison


def comparisons(strip: Strip, exact: Mapping[str, sp.Expr], steps: Mapping[str, Any]) -> tuple[Comparison, ...]:
    """Every equation, by number. ``exact``: values of kernels, ``steps``: values of steps, both by name."""
    complete, one_level = in_si(exact["saturated_pressure"]).subs(WAVE), exact["level_saturation_friction"]
    return (
        foundation.law(strip.foundation),
        *foundation.adhesion(),
        level.shape(),
        foundation.moving(strip),
        level.conditions(steps["zone conditions"]),
        level.load(complete),
        level.penetration(),
        level.area(),
        level.stress(steps["local stress"]),
        level.means(complete),
        stack.shear(steps["local shear"]),
        stack.carried(complete, one_level),
        stack.coefficient(complete, one_level),
        stack.complete_contact(strip, complete),
        stack.all_complete(steps["Eq. 16 as printed"]),
    )
