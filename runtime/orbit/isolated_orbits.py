"""Orbits found by the exhaustive search: isolated, located, certified. The way of the strips that ``direct`` leaves over."""

from dataclasses import dataclass

import numpy as np

from .certificate import edges_admissible, stable
from .groups import ROUNDING, Cycle
from .march import TWO_PI, Orbit
from .refine import refined
from .search import isolate_extremal, located


@dataclass(slots=True)
class IsolatedOrbits:
    """Outcome for n cycles: the extremal orbit, whether there is one, whether it passed its certificate, whether the search
    came to an end, and the evaluations spent."""

    orbit: Orbit
    found: np.ndarray
    certified: np.ndarray
    ended: np.ndarray
    evaluations: np.ndarray

    def of(self, cycle: Cycle) -> dict[str, np.ndarray]:
        """Indices of the orbits found, by sequence of zones."""
        contact = ~np.isnan(self.orbit.b)
        direct = contact & cycle.direct
        kinds = {"acaf": contact & ~direct, "afc": direct & ~cycle.bare, "cf": direct & cycle.bare, "af": ~contact}
        return {sequence: np.flatnonzero(self.found & kind) for sequence, kind in kinds.items()}


def isolated_orbits(kernel, cycle: Cycle, last: bool, known: Orbit | None = None, limit=np.nan) -> IsolatedOrbits:
    """The first (``last``: last) orbit on the onset arc of every cycle. ``known``, ``limit``: see ``isolate_extremal``."""
    result = isolate_extremal(kernel, cycle, last, known, limit)
    out = IsolatedOrbits(result.left, result.found, result.found, ~result.unresolved, result.evaluations)
    # a bracket without width is the orbit itself
    pick = np.flatnonzero(result.found & (result.left.x < result.right.x))
    if pick.size:
        left, right = result.left.take(pick), result.right.take(pick)
        orbit, spent = located(kernel, cycle.take(pick), left, right)
        out.orbit.put(pick, orbit)
        out.evaluations[pick] += spent
        # Newton on the boundary equations is rounded less than the march, where it stays in between
        for sequence, kind in out.of(cycle).items():
            here = np.flatnonzero(np.isin(pick, kind))
            new, converged, blur, used = refined(kernel, sequence, cycle.take(pick[here]), orbit.take(here))
            slack = ROUNDING * TWO_PI + blur
            good = converged & (new.x >= left.x[here] - slack) & (new.x <= right.x[here] + slack)
            out.orbit.put(pick[here[good]], new[good])
            out.evaluations[pick[here]] += used
    out.certified = out.found & out.ended & edges_admissible(kernel, cycle, out.orbit) & stable(kernel, cycle, out.orbit)
    return out
