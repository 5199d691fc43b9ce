"""Orbits found by the exhaustive search: isolated, located, certified. The way of the strips that ``direct`` leaves over."""

from dataclasses import dataclass

import numpy as np

from .certificate import edges_admissible, stable
from .groups import Cycle
from .march import Orbit, between, lies_between
from .refine import refined
from .search import SearchResult, isolate_extremal, locate


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
        kinds = {"acaf": contact & ~cycle.direct, "afc": contact & cycle.direct, "af": ~contact}
        return {sequence: np.flatnonzero(self.found & kind) for sequence, kind in kinds.items()}


def isolated_orbits(kernel, cycle: Cycle, last: bool, known: Orbit | None = None, limit=np.nan) -> IsolatedOrbits:
    """The first (``last``: last) orbit on the onset arc of every cycle. ``known``, ``limit``: see ``isolate_extremal``."""
    result = isolate_extremal(kernel, cycle, last, known, limit)
    orbit, spent = _located(kernel, cycle, result)
    certified = result.found & ~result.unresolved & edges_admissible(kernel, cycle, orbit) & stable(kernel, cycle, orbit)
    return IsolatedOrbits(orbit, result.found, certified, ~result.unresolved, result.evaluations + spent)


def _located(kernel, cycle: Cycle, result: SearchResult) -> tuple[Orbit, np.ndarray]:
    """Orbits at the isolated zeros, and the evaluations spent on each."""
    orbit = result.left.take(np.arange(cycle.size))
    spent = np.zeros(cycle.size)
    # a bracket without width is the orbit itself
    pick = np.flatnonzero(result.found & (result.left.x < result.right.x))
    if not pick.size:
        return orbit, spent
    left, right, cycle = result.left.take(pick), result.right.take(pick), cycle.take(pick)
    orbit.put(pick, between(left, right))
    # Newton on the boundary equations, from in between, may stand in for the march where it stays in between
    rest = np.ones(pick.size, bool)
    for sequence, kind in _kinds(cycle, left, right).items():
        here = np.flatnonzero(kind)
        if here.size:
            ends = left.take(here), right.take(here)
            new, converged, blur, used = refined(kernel, sequence, cycle.take(here), between(*ends), ends)
            inside = np.flatnonzero(converged & lies_between(new, *ends, blur))
            spent[pick[here]] += used
            orbit.put(pick[here[inside]], new.take(inside))
            rest[here[inside]] = False
    rest = np.flatnonzero(rest)
    if rest.size:
        at_zero, used = locate(kernel, cycle.take(rest), left.take(rest), right.take(rest))
        orbit.put(pick[rest], at_zero)
        spent[pick[rest]] += used
    return orbit, spent


def _kinds(cycle: Cycle, left: Orbit, right: Orbit) -> dict[str, np.ndarray]:
    """Which isolated zeros are certain to be of which regime: both ends of the interval are."""
    released = ~left.engaged & ~right.engaged
    contact = ~np.isnan(left.b) & ~np.isnan(right.b) & released
    return {
        "acaf": contact & ~cycle.direct,
        "afc": contact & cycle.direct & ~cycle.bare,
        "cf": contact & cycle.bare,
        "af": np.isnan(left.b) & np.isnan(right.b) & released,
    }
