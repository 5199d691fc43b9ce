"""The extremal periodic orbit of a cycle, with a proof that no more extremal one was passed over.

The return map of a material point preserves order (see ``engine``), so the onset map T is monotone, and may only jump
upward. Hence the most engaged orbit with a free part is the first zero of ``r`` from the left, and the least engaged the
last one. A zero is skipped by no one: an interval is left behind only when a bound excludes every zero in it.

Exclusion. Write ``R(x) = r(x) exp(x/beta)``; then ``beta R' = exp(x/beta)(N - F)``, ``F = H + delta_0``. From the left end of an
interval, where r > 0, ``r exp(..) >= r_left - fall (exp((x - x_left)/beta) - 1)`` with ``fall >= F - N``; and likewise from the
right end. Where ``N < F`` throughout, R falls strictly: a change of sign brackets exactly one zero, a stable orbit. All other
intervals are divided, into three parts more each time: most searches end in the first or second round, and for those next to a
fold or a graze, which go on, the way to rounding is short.
"""

import numpy as np

from hystrip.generated.stable import GONE

from ..numerics.roots import falling_root
from ..numerics.rounding import EPS
from .groups import TWO_PI, Cycle, arc_versine
from .march import LEAST_PHASE, Orbit, march, next_onset
from .sensitivity import falls, over, slope_bounds


class Search:
    """Search for the first (``last``: last) zero of r on the onset arc of every cycle of a batch.

    The frontier advances from one end of the arc; all behind it is excluded. ``known``: periodic orbits (r = 0) of some of the
    cycles, x NaN for the others; nothing beyond them is looked at. ``limit``: onsets before which (``last``: after which) no
    orbit has its own, NaN where there is no such bound.
    """

    def __init__(self, kernel, cycle: Cycle, last: bool, known: Orbit, limit):
        self.kernel, self.cycle, self.last, self.known = kernel, cycle, last, known
        self.sign = -1.0 if last else 1.0  # sign of r on the excluded side
        self.start = np.fmin(cycle.centre + cycle.half_d, limit) if last else np.fmax(cycle.centre - cycle.half_d, limit)
        n = cycle.size
        self.found, self.left, self.right = np.zeros(n, bool), Orbit.blank(n), Orbit.blank(n)

    def march(self, index, x):
        return march(self.kernel, self.cycle.take(index), x)

    def run(self) -> tuple[np.ndarray, Orbit, Orbit]:
        """Which arcs (n,) hold an orbit, and marches left (r >= 0) and right (r <= 0) of it, between whose onsets it lies."""
        index = self._within_reach(self._without_memory(np.flatnonzero(self.cycle.half_d > 0)))
        if index.size:
            index, frontier, stop = self._start(index)
            beyond, parts = stop, 3
            while index.size:
                index, frontier, beyond, stop = self._advance(index, frontier, beyond, stop, parts)
                parts += 3
        return self.found, self.left, self.right

    def _without_memory(self, index):
        """Settle the cycles in which w decays to nothing before the next onset, whatever the onset was; returns the others.

        The earliest onset is engaged longest. If it forgets, all do: each leads to the phase where the undeformed surface comes
        within reach, ``u = -delta_0``.
        """
        quick = index[self.cycle.strips.beta[index] < TWO_PI / GONE]
        if not quick.size:
            return index
        first = self.march(quick, (self.cycle.centre - self.cycle.half_d)[quick])
        s = self.cycle.strips.take(quick)
        forgets = np.flatnonzero(~first.engaged & (first.x + TWO_PI - first.c > GONE * s.beta))
        # a surface that stays out of reach has no onset to lead to
        reach = s.D + s.delta_0
        meets = forgets[reach[forgets] > 0]
        orbit = self.march(quick[meets], -arc_versine(reach[meets]))
        orbit.r = np.zeros(meets.size)
        self._isolated(quick[meets], orbit, orbit)
        return np.setdiff1d(index, quick[forgets])

    def _within_reach(self, index):
        """The cycles whose next onset is not missed where adhesion ends as late as it can; no other has an onset. That next one
        bounds the first."""
        if self.last or not index.size:
            return index
        part = self.cycle.take(index)
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            x = next_onset(self.kernel, part, part.centre + TWO_PI - part.half_c, -1)
        self.start[index] = np.fmax(self.start[index], x)
        return index[~np.isnan(x)]

    def _start(self, index):
        """Marches from both ends of the arc; a known orbit stands for the far one."""
        cycle, stop, known = self.cycle.take(index), self.known.take(index), self.known.x[index]
        open_ = np.flatnonzero(np.isnan(known))
        far = (cycle.centre + self.sign * cycle.half_d)[open_]
        both = self.march(np.append(index, index[open_]), np.append(self.start[index], far))
        frontier = both.take(slice(index.size))
        stop.put(open_, both.take(slice(index.size, None)))
        # before all orbits r is positive: where rounding says otherwise the bound on them is not used
        end = cycle.centre - self.sign * cycle.half_d
        blurred = np.flatnonzero((self.sign * frontier.r <= 0) & ~frontier.engaged & (frontier.x != end))
        if blurred.size:
            frontier.put(blurred, self.march(index[blurred], end[blurred]))
        # r has the other sign at the very start only where the orbit sits there, to rounding, or where the strip stays
        # engaged through the period: from the last onset on, then, from every onset
        at_start = self.sign * frontier.r <= 0
        # rounding may push a known orbit past the end
        accepted = np.flatnonzero((at_start & ~frontier.engaged) | (~at_start & (self.sign * (known - frontier.x) <= 0)))
        self._isolated(index[accepted], frontier.take(accepted), frontier.take(accepted))
        keep = ~at_start | (frontier.engaged & (not self.last))
        keep[accepted] = False
        keep = np.flatnonzero(keep)
        return index[keep], frontier.take(keep), stop.take(keep)

    def _advance(self, index, frontier: Orbit, beyond: Orbit, stop: Orbit, parts: int):
        """Divide the interval from each frontier to the onset ``beyond`` into ``parts``; exclude them, and what is left up
        to ``stop``, one after another, until one is not excluded: it brackets an orbit, or is divided in the next round."""
        n = index.size
        inner = frontier.x + (beyond.x - frontier.x) * (np.arange(1, parts)[:, None] / parts)
        points = Orbit.joined([frontier, self.march(np.tile(index, parts - 1), inner.ravel()), beyond, stop])
        here, there = points.take(slice(0, -n)), points.take(slice(n, None))
        excluded, unique = self._judged(np.tile(index, parts + 1), here, there)
        excluded, unique = excluded.reshape(parts + 1, n), unique.reshape(parts + 1, n)
        ended = excluded.all(axis=0)
        first = np.where(ended, parts, excluded.argmin(axis=0)) * n + np.arange(n)
        found = np.flatnonzero(unique.ravel()[first] & ~ended)
        outer, inner = here.take(first[found]), there.take(first[found])
        known = np.flatnonzero(inner.r == 0)  # the orbit itself
        outer.put(known, inner.take(known))
        left, right = (inner, outer) if self.last else (outer, inner)
        # an orbit at the last bit before the strip stays engaged: the nearest one that is released stands for it
        squeezed = np.flatnonzero(left.engaged)
        left.put(squeezed, right.take(squeezed))
        self._isolated(index[found], left, right)
        ended[found] = True
        keep = np.flatnonzero(~ended)
        return index[keep], here.take(first[keep]), there.take(first[keep]), stop.take(keep)

    def _judged(self, index, here: Orbit, there: Orbit) -> tuple[np.ndarray, np.ndarray]:
        """Which intervals from ``here``, behind which all is excluded, to ``there`` hold no zero of r, and which exactly one."""
        left, right = (there, here) if self.last else (here, there)
        changes = (self.sign * there.r <= 0) & ~there.engaged & (there.x != here.x)
        tiny = np.abs(there.x - here.x) <= 4 * EPS * np.maximum(np.abs(there.x), np.abs(here.x)) + LEAST_PHASE
        excluded, unique = right.engaged | (tiny & ~changes), changes & tiny
        open_ = np.flatnonzero(~excluded & ~unique)
        index, left, right, changes = index[open_], left.take(open_), right.take(open_), changes[open_]
        cycle = self.cycle.take(index)
        unique[open_] = changes & ~left.engaged & falls(self.kernel, cycle, left, right)
        excluded[open_] = ~changes & excludes(self.kernel, cycle, left, right, self.last)
        return excluded, unique

    def _isolated(self, index, left: Orbit, right: Orbit):
        self.found[index] = True
        self.left.put(index, left)
        self.right.put(index, right)


def located(kernel, cycle: Cycle, left: Orbit, right: Orbit) -> Orbit:
    """The one zero of r between the onsets of ``left`` and ``right``."""
    x = falling_root(lambda x, index: march(kernel, cycle.take(index), x).r, left.x, right.x)
    orbit = march(kernel, cycle, x)
    # at the last bit before the strip stays engaged
    held = np.flatnonzero(orbit.engaged)
    orbit.put(held, left.take(held))
    return orbit


def excludes(kernel, cycle: Cycle, left: Orbit, right: Orbit, last: bool) -> np.ndarray:
    """True where bounds of the slope leave no zero of r between two onsets at which r has the sign of the excluded side."""
    (fall, rise), beta = slope_bounds(kernel, cycle, left, right), cycle.strips.beta
    sign, (of_left, of_right) = (-1.0, (rise, fall)) if last else (1.0, (fall, rise))
    near = _reach(beta, np.where(left.engaged, 0.0, sign * left.r), of_left, 1.0)
    far, width = _reach(beta, sign * right.r, of_right, -1.0), right.x - left.x
    return near + far > width


def _reach(beta, margin, rate, way):
    """Distance, in the direction of travel or (``way`` -1) against it, over which ``margin - rate way (exp(way x/beta) - 1)`` is
    positive."""
    ratio = way * over(np.maximum(margin, 0.0), rate)
    ends = (ratio > -1) & (ratio < np.inf)
    return np.where(ends, way * beta * np.log1p(np.where(ends, ratio, 0.0)), np.inf)
