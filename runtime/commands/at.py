"""One load and one velocity of a scene."""

import dataclasses

import numpy as np

from ..inputs.checks import number
from ..result import Result
from ..scene import Scene
from .quantities import quantity


def point_of(case: Scene, pressure: str | None, velocity: str | None) -> Result:
    """Solve a scene at one pressure and one velocity: those given, else the first load and the middle velocity of the scene."""
    name, load = case.load
    V, value = quantity(velocity, "m/s", "--velocity"), quantity(pressure, "Pa", "--pressure")
    V = np.sort(np.ravel(case.velocity))[case.velocity.size // 2] if V is None else number("--velocity", V, "m/s", 0)
    name, value = (name, np.ravel(load)[0]) if value is None else ("pressure", value)
    at = {"pressure": None, "penetration": None, name: np.array(value)}
    # without a source: what is wrong may stand on the command line, not in the file
    return dataclasses.replace(case, source="", velocity=np.array(V), **at).solve()
