"""The extremal periodic orbit of every strip of a batch.

Why these are the extremal orbits. The period map of a material point preserves the order "engaged before free, then by
z = w - J_0 p": in a gap two states keep their distance in z up to a positive factor, in contact likewise, and a state
that is engaged earlier stays so. Therefore iterates from the deepest contact rise to the most engaged periodic orbit and
iterates from infinitely far fall to the least engaged one, and there is no longer period.

* Always engaged states contract onto one candidate: saturated contact, saturated adhesion, or contact with saturated
  adhesion. If its inequalities hold it is the most engaged orbit; nothing more engaged exists.
  Where it is not, bounds on all orbits (``orbit_bounds``) mostly tell without solving for it.
* Every other orbit but the free one has an onset phase and is a zero of the onset map's defect ``r``. Most of the first (or last)
  of them are found by Newton from a rough start, which may find any periodic orbit, or none: what it finds counts only with the
  certificate of an orbit and the proof that no more extremal one exists. All else is left to ``search``, which passes over none.
* The free orbit is the least engaged one, where it is admissible: ``D <= -delta_0`` (``D <= 0`` without adhesion).

``unloading`` asks in the order engaged, first zero, free; ``loading`` in the order free, last zero, engaged.
"""

import numpy as np

from .certificate import STABLE, attracting, edges_admissible, greatest_gap, saturates, stable
from .chain import follow, refined, start
from .groups import ROUNDING, TWO_PI, Cycle, Strips, adhesive_cycle, bare_cycle
from .march import Orbit, between
from .orbit_bounds import bounds_after_contact, is_extremal, least_engaged_bounds, orbit_bounds
from .search import Search, located
from .sensitivity import falls
from .solved import Record, Solved, settle

#: strips solved at a time: memory stays bounded. Fewer cost more calls, more leave the cache
CHUNK = 131072


def solve_strips(kernel, strips: Strips, unloading: bool) -> Solved:
    """Solve a batch with the generated ``kernel``; ``certified`` is false for every strip that must not be used."""
    if strips.size > CHUNK // 128:
        # one large block, freed at once: glibc then keeps freed memory, up to twice as much, for the next batches
        np.empty(31 * CHUNK)
    solved = _Batch(kernel, strips, unloading).solve()
    settle(lambda nearby: _Batch(kernel, nearby, unloading).solve(), strips, solved, unloading)
    return solved


class _Batch:
    """Strips, and what is known of them so far."""

    def __init__(self, kernel, strips: Strips, unloading: bool):
        self.kernel, self.strips, self.unloading = kernel, strips, unloading
        self.record = Record(kernel, strips)

    def solve(self) -> Solved:
        adhesive = self.strips.p_0 > 0
        self._without_adhesion(np.flatnonzero(~adhesive))
        index = np.flatnonzero(adhesive)
        for i in range(0, index.size, CHUNK):
            self._with_adhesion(index[i : i + CHUNK])
        return self.record.solved

    # -- stages: each decides what it can and returns the other strips -----------------------------------------------------------

    def _with_adhesion(self, index):
        if self.unloading:
            index, partial = self._saturated(index)
        else:
            index = self._free(index)
        if not index.size:
            return
        cycle = adhesive_cycle(self.kernel, self.strips.among(index))
        bounds = orbit_bounds(self.kernel, cycle) if self.unloading else least_engaged_bounds(self.kernel, cycle)
        self.record.solved.searched[index] = cycle.half_d > 0
        if self.unloading:
            rest, ends = self._contact_with_saturated_adhesion(index, partial & bounds.engaged)
            index, cycle, bounds = index[rest], cycle.among(rest), bounds.among(rest)
            bounds.a = np.where(bounds.engaged, ends, bounds.a)
        if index.size:
            index = self._free_once(index, cycle, bounds)
        if self.unloading:
            self._free(index)
        else:
            self._contact_with_saturated_adhesion(*self._saturated(index))

    def _free(self, index):
        s = self.strips
        free = s.D[index] <= np.where(s.p_0[index] > 0, -s.delta_0[index], 0.0)
        self.record.constant(index[free], "f")
        return index[~free]

    def _saturated(self, index):
        """Also which of the others may be in contact with saturated adhesion."""
        s = self.strips.among(index)
        full = saturates(self.kernel, s)
        self.record.saturated_contact(index[full])
        clings = ~full & (2 - s.D - s.p_0 <= s.delta_0)
        hold = clings & (s.D <= -s.p_0)
        self.record.saturated_adhesion(index[hold])
        rest = ~full & ~hold
        return index[rest], clings[rest]

    def _without_adhesion(self, index):
        index, _ = self._saturated(self._free(index))
        if index.size:
            self.record.orbits(index, "cf", *self._unique(index, "cf"))

    def _contact_with_saturated_adhesion(self, index, ask):
        """Solve those to ``ask`` of as strips without adhesion at ``D + p_0``; returns which of all have no such orbit, and
        before which phase contact ends in all that they have, NaN where nothing tells."""
        rest, ends, ask = np.ones(index.size, bool), np.full(index.size, np.nan), np.flatnonzero(ask)
        if ask.size:
            orbit, certified = self._unique(index[ask], "ac")
            # there is such an orbit without a limit to the gap: one that is not found is not certified, never passed over
            strips = self.strips.among(index[ask])
            within = ~certified | (greatest_gap(self.kernel, strips, orbit.a) <= strips.delta_0)
            self.record.orbits(index[ask], "ac", orbit, certified & within)
            rest[ask], ends[ask] = ~within, orbit.a + STABLE
        return np.flatnonzero(rest), ends[rest]

    def _unique(self, index, sequence: str) -> tuple[Orbit, np.ndarray]:
        """The orbits of bare cycles, and which are certified. Where p does not step the onset map contracts everywhere
        (``sensitivity``): an orbit that is found is the only one."""
        self.record.solved.searched[index] = True
        cycle = bare_cycle(self.kernel, self.strips.among(index))
        orbit, certified = _followed(self.kernel, cycle, sequence, start(self.kernel, cycle, sequence))
        rest = np.flatnonzero(~certified)
        if rest.size:
            orbit[rest], certified[rest], _ = _isolated(self.kernel, cycle.take(rest), False, orbit.take(rest))
        return orbit, certified

    def _bounds_by_engaged(self, index, cycle: Cycle, ends) -> Orbit:
        """Bounds from the orbits that would be engaged all along if gaps had no limit, in contact until ``ends`` if known."""
        more = np.flatnonzero(np.isnan(ends))
        if more.size:
            orbit, certified = self._unique(index[more], "ac")
            ends[more[certified]] = orbit.a[certified] + STABLE
        out = bounds_after_contact(self.kernel, cycle, ends, np.zeros(ends.size))
        out.x[np.isinf(out.x)] = np.nan  # there is an onset, however little rounding leaves of it
        return out

    def _free_once(self, index, cycle: Cycle, bounds: Orbit):
        """Orbits that are free once per period: the first (``loading``: last) on the onset arc of every cycle. ``bounds`` on all
        orbits: of the most engaged state, for ``loading`` of the least engaged one."""
        kernel, last, s, known = self.kernel, not self.unloading, cycle.strips, Orbit.blank(cycle.size)
        none, proven = (cycle.half_d <= 0) | np.isinf(bounds.x), np.zeros(cycle.size, bool)
        # where D <= -p_0 nothing touches (``orbit_bounds``)
        zones = {"acaf": ~cycle.direct & (s.D > -s.p_0), "afc": cycle.direct, "af": ~cycle.direct & ~cycle.touched}
        for sequence, may_be in zones.items():
            pick = np.flatnonzero(~none & may_be & np.isnan(known.x))
            if pick.size:
                part, limits = cycle.among(pick), None if last else bounds.take(pick)
                orbit, good = _followed(kernel, part, sequence, start(kernel, part, sequence, limits))
                pick, part, orbit = pick[good], part.take(good), orbit.take(good)
                known[pick], proven[pick] = orbit, is_extremal(kernel, part, orbit, bounds.take(pick), last)
        rest = np.flatnonzero(~proven & ~np.isnan(known.x) & np.isnan(bounds.x) & (not last))
        if rest.size:
            part, orbit = cycle.among(rest), known.take(rest)
            bounds[rest] = limits = self._bounds_by_engaged(index[rest], part, bounds.a[rest])
            proven[rest] = falls(kernel, part, limits, orbit)
        rest = np.flatnonzero(~none & ~proven)
        if rest.size:
            known[rest], proven[rest], exists = _isolated(kernel, cycle.among(rest), last, known.take(rest), bounds.x[rest])
            none[rest] = ~exists
        for sequence, kind in _kinds(cycle, known).items():
            self.record.orbits(index, sequence, known, proven & kind)
        return index[none]


def _kinds(cycle: Cycle, orbit: Orbit) -> dict[str, np.ndarray]:
    """Which orbits have which sequence of zones."""
    contact = ~np.isnan(orbit.b)
    return {"acaf": contact & ~cycle.direct, "afc": contact & cycle.direct & ~cycle.bare, "cf": cycle.bare, "af": ~contact}


def _followed(kernel, cycle: Cycle, sequence: str, edges: np.ndarray) -> tuple[Orbit, np.ndarray]:
    """Orbits of ``sequence`` that Newton finds from ``edges`` (k, n), and which are certified; x is NaN where none is."""
    out, certified, bare = Orbit.blank(cycle.size), np.zeros(cycle.size, bool), sequence in ("ac", "cf")
    found, good = follow(kernel, cycle, sequence, edges)
    here = np.flatnonzero(good)
    # next to a fold or a graze the search knows better
    orbit, good, _ = refined(kernel, sequence, cycle.among(here), Orbit.of(sequence, found[:, here]))
    here, orbit = here[good], orbit.take(good)
    part = cycle.among(here)
    good = edges_admissible(kernel, part, orbit)
    if not bare:
        good &= attracting(kernel, part, orbit)
    out[here[good]], certified[here[good]] = orbit[good], True
    return out, certified


def _isolated(kernel, cycle: Cycle, last: bool, known: Orbit, limit=np.nan) -> tuple[Orbit, np.ndarray, np.ndarray]:
    """Orbits by the exhaustive search, which of them are certified, and which exist. ``known``, ``limit``: see
    ``Search``."""
    exists, orbit, beyond = Search(kernel, cycle, last, known, limit).run()
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
    return orbit, exists & edges_admissible(kernel, cycle, orbit) & stable(kernel, cycle, orbit), exists


def _refined_within(kernel, cycle: Cycle, orbit: Orbit, left: Orbit, right: Orbit, blurred: bool):
    """Orbits refined where that leads to one with its onset between those of ``left`` and ``right``, where that is.
    ``blurred``: see ``refined``."""
    inside = np.zeros(cycle.size, bool)
    for sequence, kind in _kinds(cycle, orbit).items():
        here = np.flatnonzero(kind)
        if here.size:
            part = cycle.take(here)
            new, converged, blur = refined(kernel, sequence, part, orbit.take(here), True, blurred)
            slack = ROUNDING * TWO_PI + blur
            good = converged & (new.x >= left.x[here] - slack) & (new.x <= right.x[here] + slack)
            good[good] = edges_admissible(kernel, part.take(good), new[good])
            inside[here] = good
            orbit.put(here[good], new[good])
    return orbit, inside
