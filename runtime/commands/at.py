"""One load and one velocity of a scene."""

import numpy as np

from ..result import Result
from ..scene import Scene
from ..scene.quantity import to_si
from .quantities import number_or_text


def point_of(case: Scene, pressure: str | None, velocity: str | None) -> Result:
    """Solve a scene at one pressure and one velocity: those given, else the first load and the middle velocity of the scene."""
    import hystrip

    name, load = case.load
    loads = np.ravel(load)
    velocities = np.sort(np.ravel(case.velocity))
    V = float(velocities[velocities.size // 2]) if velocity is None else to_si(number_or_text(velocity), "m/s", "--velocity")
    value = float(loads[0])
    if pressure is not None:
        name, value = "pressure", to_si(number_or_text(pressure), "Pa", "--pressure")
    how = {"edge": case.edge, "branch": case.branch, "rtol": case.rtol, "strips": case.strips}
    return hystrip.solve(case.material, case.adhesion, case.levels, velocity=V, **{name: value}, **how)
