"""The extremal orbit of every cycle of a batch.

Most are found by Newton from a rough start, which may find any periodic orbit, or none. What it finds counts only with the
certificate of an orbit and the proof that no more extremal one exists. All else is left to ``search``, which passes over none.
"""

from dataclasses import dataclass

import numpy as np

from .balance import exclude_out_of_reach
from .batch import Batch
from .certificate import attracting, edges_admissible, stable
from .chain import follow, refined
from .groups import ROUNDING, Cycle
from .march import TWO_PI, Orbit, between
from .orbit_bounds import FAST, is_extremal
from .regimes import CODE
from .search import isolate_extremal, located
from .solved import UNDECIDED
from .start import start

#: alpha from which a period moves the foundation by so little that rounding blurs what joins one edge to the next
FROZEN = 1e6


@dataclass(slots=True)
class Extremal(Batch):
    """Extremal orbits of n cycles: edges, regime code, and which are certified and proven to be extremal.

    A cycle that is proven to have no such orbit is ``UNDECIDED``; all others that are not certified must not be used.
    """

    orbit: Orbit
    code: np.ndarray
    certified: np.ndarray

    @classmethod
    def blank(cls, n: int) -> "Extremal":
        """None found."""
        return cls(Orbit.blank(n), np.full(n, UNDECIDED, np.int8), np.zeros(n, bool))


def extremal(kernel, cycle: Cycle, last: bool, bounds: Orbit) -> Extremal:
    """The first (``last``: last) orbit on the onset arc of every cycle. ``bounds`` on all orbits: of the most engaged state, for
    ``last`` of the least engaged one."""
    s, out = cycle.strips, Extremal.blank(cycle.size)
    none = (cycle.half_d <= 0) | np.isinf(bounds.x)
    # along every orbit w is at least -p_0: a crest that does not come as deep makes no contact
    touches = s.D + s.p_0 > s.noise()
    if last:
        # next to saturated contact a less engaged orbit is rare: ask the search, which sees that first
        possible = ~none & (s.D - 1 + s.p_0 < kernel.modulus_ratio(s.alpha, s.beta))
        alone = ~cycle.touched
    else:
        hanging = np.flatnonzero(~none & (s.D <= -s.delta_0) & (s.beta > FAST))
        if hanging.size:
            none[hanging] = exclude_out_of_reach(kernel, cycle.among(hanging))
        possible, alone = ~none, np.ones(cycle.size, bool)
    for sequence, may_be in (("acaf", ~cycle.direct & touches), ("afc", cycle.direct), ("af", ~cycle.direct & alone)):
        pick = np.flatnonzero(possible & may_be & np.isnan(out.orbit.x))
        if pick.size:
            part, limits = cycle.among(pick), bounds.take(pick)
            found = _followed(kernel, part, sequence, start(kernel, part, sequence, None if last else limits))
            here = np.flatnonzero(found.certified)
            pick, found, limits = pick[here], found.take(here), limits.take(here)
            found.certified = is_extremal(kernel, part.among(here), found.orbit, limits, last)
            out.put(pick, found)
            bounds.put(pick, limits)
    rest = np.flatnonzero(~none & ~out.certified)
    if rest.size:
        _isolate(kernel, cycle, last, out, rest, bounds.x[rest])
    return out


def unique(kernel, cycle: Cycle, sequence: str) -> Extremal:
    """The orbits of bare cycles, ``sequence`` "cf" or "ac". Where p does not step the onset map contracts everywhere
    (``sensitivity``): an orbit that is found is the only one."""
    out = _followed(kernel, cycle, sequence, start(kernel, cycle, sequence))
    rest = np.flatnonzero(~out.certified)
    if rest.size:
        _isolate(kernel, cycle, False, out, rest)
    out.code[:] = CODE[sequence]
    return out


def _followed(kernel, cycle: Cycle, sequence: str, edges: np.ndarray) -> Extremal:
    """Orbits of ``sequence`` that Newton finds from ``edges`` (k, n); x is NaN where none is certified."""
    out, bare = Extremal.blank(cycle.size), sequence in ("ac", "cf")
    found, good = follow(kernel, cycle, sequence, edges)
    if sequence in ("acaf", "afc"):
        # the links along the chain lose what a period changes to rounding; the start is as good as an orbit
        frozen = np.flatnonzero(~good & (cycle.strips.alpha > FROZEN))
        found[:, frozen], good[frozen] = edges[:, frozen], True
    here = np.flatnonzero(good)
    # next to a fold or a graze the search knows better
    orbit, good, _ = refined(kernel, sequence, cycle.among(here), Orbit.of(sequence, found[:, here]))
    here, orbit = here[good], orbit.take(good)
    part = cycle.among(here)
    good = edges_admissible(kernel, part, orbit)
    if not bare:
        good &= attracting(kernel, part, orbit)
    here = here[good]
    out.orbit[here], out.code[here], out.certified[here] = orbit[good], CODE[sequence], True
    return out


def _isolate(kernel, cycle: Cycle, last: bool, out: Extremal, rest, limit=np.nan) -> None:
    """Replace the orbits of the cycles ``rest`` in ``out`` by those of the exhaustive search. ``limit``: see
    ``isolate_extremal``."""
    cycle = cycle.among(rest)
    exists, orbit, beyond = isolate_extremal(kernel, cycle, last, out.orbit.take(rest), limit)
    # a bracket without width is the orbit itself
    pick = np.flatnonzero(exists & (orbit.x < beyond.x))
    if pick.size:
        part, left, right = cycle.take(pick), orbit.take(pick), beyond.take(pick)
        new, inside = _refined_within(kernel, part, between(left, right), left, right, blurred=False)
        left_out = np.flatnonzero(~inside)
        if left_out.size:
            part, left, right = part.take(left_out), left.take(left_out), right.take(left_out)
            found = located(kernel, part, left, right)
            # Newton on the boundary equations is rounded less than the march
            new[left_out], _ = _refined_within(kernel, part, found, left, right, blurred=True)
        orbit.put(pick, new)
    direct = np.where(cycle.direct, CODE["afc"], CODE["acaf"])
    code = np.where(exists, np.where(np.isnan(orbit.b), CODE["af"], direct), UNDECIDED).astype(np.int8)
    certified = exists & edges_admissible(kernel, cycle, orbit) & stable(kernel, cycle, orbit)
    out.put(rest, Extremal(orbit, code, certified))


def _refined_within(kernel, cycle: Cycle, orbit: Orbit, left: Orbit, right: Orbit, blurred: bool):
    """Orbits refined where that leads to one with its onset between those of ``left`` and ``right``, where that is.
    ``blurred``: see ``refined``."""
    contact, inside = ~np.isnan(orbit.b), np.zeros(cycle.size, bool)
    kinds = {"acaf": contact & ~cycle.direct, "afc": cycle.direct & ~cycle.bare, "cf": cycle.bare, "af": ~contact}
    for sequence, kind in kinds.items():
        here = np.flatnonzero(kind)
        if here.size:
            part = cycle.take(here)
            new, converged, blur = refined(kernel, sequence, part, orbit.take(here), blurred)
            slack = ROUNDING * TWO_PI + blur
            good = converged & (new.x >= left.x[here] - slack) & (new.x <= right.x[here] + slack)
            good[good] = edges_admissible(kernel, part.take(good), new[good])
            inside[here] = good
            orbit.put(here[good], new[good])
    return orbit, inside
