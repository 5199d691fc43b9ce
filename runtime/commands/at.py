"""One load and one velocity of a scene."""

import dataclasses

import numpy as np

from ..inputs.checks import number
from ..result import Result
from ..scene import Scene
from ..scene.quantity import to_si
from .quantities import number_or_text


def point_of(case: Scene, pressure: str | None, velocity: str | None) -> Result:
    """Solve a scene at one pressure and one velocity: those given, else the first load and the middle velocity of the scene."""
    name, load = case.load
    loads = np.ravel(load)
    velocities = np.sort(np.ravel(case.velocity))
    V = float(velocities[velocities.size // 2])
    if velocity is not None:
        V = number("--velocity", to_si(number_or_text(velocity), "m/s", "--velocity"), "m/s", 0)
    value = float(loads[0])
    if pressure is not None:
        name, value = "pressure", to_si(number_or_text(pressure), "Pa", "--pressure")
    at = {"pressure": None, "penetration": None, name: np.array(value)}
    # without a source: what is wrong may stand on the command line, not in the file
    return dataclasses.replace(case, source="", velocity=np.array(V), **at).solve()
