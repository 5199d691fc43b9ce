"""Strips at rest: the limit of vanishing speed, and the flat strip, which knows no speed.

The foundation is elastic then, ``w = p/K`` but for transients of no length: edges lie where the profile passes a level, and
both closures are one. Adhesion ends where the gap is ``delta_0`` with ``w = -p_0/K``, and begins where it is with ``w = 0``;
contact begins there at once if the gap closes under ``p_0``. Friction is what these two snaps lose, and that of contact.
"""

import numpy as np

from ..numerics.rounding import EPS
from .groups import arc_versine
from .march import Orbit
from .regimes import ORBIT_EDGES
from .solved import Record, Solved

#: longest time over that of a passage up to which speed shows in nothing but friction, for rounding; and up to which the solvers
#: of moving strips may fail next to a release, so that a strip is solved at rest
AT_REST, SLOW = 3e-13, 1e-9


def solve_at_rest(kernel, strips, flat, unloading: bool) -> Solved:
    """Solve dimensionless strips with the generated ``kernel``; those ``flat``, (n,), are in units of K alone."""
    p_0, D, record = strips.p_0, strips.D, Record(kernel, strips)
    # without adhesion contact ends to free, and the reach of adhesion has no part in it
    reach = np.where(p_0 > 0, strips.delta_0, 0.0)
    height = np.where(flat, 0.0, 2.0)
    valley, noise = D - height, EPS * (height + np.abs(D) + p_0)
    released = -valley - p_0 > reach
    free = (D <= -reach) & (released | (not unloading))
    full, hold = (~free & ~released & holds for holds in (valley >= -p_0 - noise, (valley < -p_0 - noise) & (D <= -p_0)))
    record.constant(np.flatnonzero(free), "f")
    record.saturated_adhesion(np.flatnonzero(hold))
    record.saturated_contact(np.flatnonzero(full & ~flat))
    record.constant(np.flatnonzero(full & flat), "c", D[full & flat], 0.0, 1.0)
    wavy, touches, steps = ~(free | full | hold), D > -np.minimum(p_0, reach), released & (p_0 > 0)
    d, b, a, c = (arc_versine(D + low) for low in (reach, np.where(released, np.minimum(p_0, reach), p_0), p_0, p_0 + reach))
    edges = {"x": -np.where(steps, d, b), "b": -b, "a": a, "c": c}
    kinds = {"ac": ~released, "cf": released & (p_0 == 0), "af": steps & ~touches, "afc": steps & touches & strips.snaps}
    kinds["acaf"] = steps & touches & ~strips.snaps
    for sequence, kind in kinds.items():
        k = np.flatnonzero(wavy & kind)
        record.orbits(k, sequence, Orbit.of(sequence, np.array([edges[name][k] for name in ORBIT_EDGES[sequence]])))
    return record.solved
