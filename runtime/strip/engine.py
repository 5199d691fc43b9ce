"""The extremal periodic orbit of every strip of a batch.

Why these are the extremal orbits. The period map of a material point preserves the order "engaged before free, then by
z = w - J_0 p": in a gap two states keep their distance in z up to a positive factor, in contact likewise, and a state
that is engaged earlier stays so. Therefore iterates from the deepest contact rise to the most engaged periodic orbit and
iterates from infinitely far fall to the least engaged one, and there is no longer period.

* Always engaged states contract onto one candidate: saturated contact, saturated adhesion, or contact with saturated
  adhesion. If its inequalities hold it is the most engaged orbit; nothing more engaged exists.
* Every other orbit but the free one has an onset phase and is a zero of the onset map's defect ``r``. ``search`` returns the
  first (or last) of them and proves that it passed over none.
* The free orbit is the least engaged one, where it is admissible: ``D <= -delta_0`` (``D <= 0`` without adhesion).

``unloading`` asks in the order engaged, first zero, free; ``loading`` in the order free, last zero, engaged.
"""

from dataclasses import dataclass, fields, replace

import numpy as np

from .certificate import always_adhering, edges_admissible, stable
from .march import Orbit, between, lies_between
from .polish import polish
from .problem import Cycle, Strips, adhesive_cycle, bare_cycle
from .regimes import CODE
from .search import SearchResult, isolate, locate

#: Strips solved at a time: their working arrays stay in the cache, and memory stays bounded.
CHUNK = 4096
#: Largest correction that an orbit may still ask for: this much, or this many times what rounding leaves uncertain, which
#: itself must not be worse than near a fold.
_CONVERGED, _ROUNDINGS, _COARSEST = 1e-13, 32, 1e-6
_UNDECIDED = -1
_EPS = np.finfo(float).eps
#: distances in roundings of D at which a strip on the end of a branch is settled
_SHIFTS = (8, 64, 512)


@dataclass(slots=True)
class Solved:
    """Solutions of a batch, arrays of shape (n,): regime code (``regimes.CODE``), edges as phases (NaN where absent),
    dimensionless means and fractions, work, and which strips passed their certificate."""

    code: np.ndarray
    d: np.ndarray
    b: np.ndarray
    a: np.ndarray
    c: np.ndarray
    p_mean: np.ndarray
    tau_mean: np.ndarray
    contact_fraction: np.ndarray
    adhesion_fraction: np.ndarray
    certified: np.ndarray
    evaluations: np.ndarray

    @classmethod
    def empty(cls, n: int) -> "Solved":
        edges = [np.full(n, np.nan) for _ in range(4)]
        values = [np.full(n, np.nan) for _ in range(4)]
        return cls(np.full(n, _UNDECIDED, np.int8), *edges, *values, np.zeros(n, bool), np.zeros(n))

    def take(self, index) -> "Solved":
        return Solved(*(getattr(self, f.name)[index] for f in fields(self)))

    def put(self, index, other: "Solved") -> None:
        for f in fields(self):
            getattr(self, f.name)[index] = getattr(other, f.name)


def solve_strips(kernel, strips: Strips, unloading: bool) -> Solved:
    """Solve a batch with the generated ``kernel``; ``certified`` is false for every strip that must not be used."""
    solved = Solved.empty(strips.size)
    for start in range(0, strips.size, CHUNK):
        part = slice(start, min(start + CHUNK, strips.size))
        solved.put(part, _Batch(kernel, strips.take(part), unloading).solve())
    _settle(kernel, strips, solved, unloading)
    return solved


def _settle(kernel, strips: Strips, solved: Solved, unloading: bool) -> None:
    """Decide strips that sit on the end of a branch to the last bits, where the tests of its two sides contradict each other.

    Which side they belong to is below the rounding of the inputs. They get the solution a few roundings of D further along the way their
    branch is followed: the unloading orbit is continuous towards larger D, the loading orbit towards smaller.
    """
    for roundings in _SHIFTS:
        index = np.flatnonzero(~solved.certified)
        if not index.size:
            return
        these = strips.take(index)
        shift = roundings * _EPS * (1 + np.abs(these.D) + these.p_0 + these.delta_0)
        nearby = replace(these, D=these.D + (shift if unloading else -shift))
        again = _Batch(kernel, nearby, unloading).solve()
        again.evaluations += solved.evaluations[index]
        solved.put(index[again.certified], again.take(np.flatnonzero(again.certified)))


class _Batch:
    def __init__(self, kernel, strips: Strips, unloading: bool):
        self.kernel, self.strips, self.unloading = kernel, strips, unloading
        self.solved = Solved.empty(strips.size)

    def solve(self) -> Solved:
        adhesive = self.strips.p_0 > 0
        self._without_adhesion(np.flatnonzero(~adhesive))
        index = np.flatnonzero(adhesive)
        if self.unloading:
            index = self._engaged(index)
            index = self._onset(index)
            self._free(index)
        else:
            index = self._free(index)
            index = self._onset(index)
            self._engaged(index)
        return self.solved

    # -- the three kinds of orbit; each decides what it can and returns the indices of the strips it could not ------------

    def _free(self, index):
        s = self.strips
        free = s.D[index] <= -s.delta_0[index]
        self._set(index[free], "f", 0.0, 0.0, 0.0, 0.0)
        return index[~free]

    def _engaged(self, index):
        s = self.strips.take(index)
        full = s.D - 1 + s.p_0 >= self.kernel.modulus_ratio(s.alpha, s.beta)
        self._saturated_contact(index[full])
        clinging = ~full & (s.D <= -s.p_0)
        reaches = 2 - s.D - s.p_0 <= s.delta_0  # the foundation is never above -p_0, so the valley's gap is at least this
        hold = index[clinging & reaches]
        self._set(hold, "a", -self.strips.p_0[hold], 0.0, 0.0, 1.0)
        partial = np.flatnonzero(~full & ~clinging & reaches)
        engaged = full | (clinging & reaches)
        if partial.size:
            ok = self._contact_with_saturated_adhesion(index[partial])
            engaged[partial[ok]] = True
        return index[~engaged]

    def _onset(self, index):
        """Orbits that are free once per period."""
        if not index.size:
            return index
        cycle = adhesive_cycle(self.kernel, self.strips.take(index))
        result = isolate(self.kernel, cycle, last=not self.unloading)
        orbit, failed = self._located(index, cycle, result)
        contact = ~np.isnan(orbit.b)
        kinds = {
            "acaf": contact & ~cycle.direct,
            "afc": contact & cycle.direct,
            "af": ~contact,
        }
        for sequence, kind in kinds.items():
            pick = np.flatnonzero(result.found & kind)
            if pick.size:
                self._finish(index[pick], sequence, cycle.take(pick), orbit.take(pick), ~failed[pick])
        undecided = result.unresolved & ~result.found
        self.solved.code[index[undecided]] = CODE["acaf"]
        return index[~result.found & ~undecided]

    def _without_adhesion(self, index):
        if not index.size:
            return
        s = self.strips.take(index)
        full = s.D - 1 >= self.kernel.modulus_ratio(s.alpha, s.beta)
        free = ~full & (s.D <= 0)
        self._saturated_contact(index[full])
        self._set(index[free], "f", 0.0, 0.0, 0.0, 0.0)
        rest = index[~full & ~free]
        if rest.size:
            cycle = bare_cycle(self.kernel, self.strips.take(rest))
            result = isolate(self.kernel, cycle, last=False)
            orbit, failed = self._located(rest, cycle, result)
            self._finish(rest, "cf", cycle, orbit, result.found & ~failed)

    def _contact_with_saturated_adhesion(self, index):
        """Solve as the strip without adhesion at ``D + p_0``; returns which are admissible."""
        strips = self.strips.take(index)
        cycle = bare_cycle(self.kernel, strips)
        result = isolate(self.kernel, cycle, last=False)
        orbit, failed = self._located(index, cycle, result)
        ok = np.zeros(index.size, bool)
        pick = np.flatnonzero(result.found & ~failed)
        ok[pick] = always_adhering(self.kernel, strips.take(pick), cycle.take(pick), orbit.take(pick))
        pick = np.flatnonzero(ok)
        if pick.size:
            self._finish(index[pick], "ac", cycle.take(pick), orbit.take(pick), np.ones(pick.size, bool))
        return ok

    def _located(self, index, cycle: Cycle, result: SearchResult) -> tuple[Orbit, np.ndarray]:
        """Orbits at the isolated zeros, and which of them failed to converge."""
        orbit = result.left.take(np.arange(index.size))
        failed = result.unresolved.copy()
        self.solved.evaluations[index] += result.evaluations
        pick = np.flatnonzero(result.found)
        left, right, cycle = result.left.take(pick), result.right.take(pick), cycle.take(pick)
        orbit.put(pick, between(left, right))
        # Newton on the boundary equations, from in between, may stand in for the march where it stays in between
        rest = np.ones(pick.size, bool)
        for sequence, kind in _kinds(cycle, left, right).items():
            here = np.flatnonzero(kind)
            if here.size:
                ends = left.take(here), right.take(here)
                new, converged, spent = _polished(self.kernel, sequence, cycle.take(here), between(*ends), ends)
                inside = converged & lies_between(new, *ends)
                self.solved.evaluations[index[pick[here]]] += spent
                orbit.put(pick[here[inside]], new.take(np.flatnonzero(inside)))
                rest[here[inside]] = False
        rest = np.flatnonzero(rest)
        if rest.size:
            at_zero, missed, spent = locate(self.kernel, cycle.take(rest), left.take(rest), right.take(rest))
            orbit.put(pick[rest], at_zero)
            failed[pick[rest]] |= missed
            self.solved.evaluations[index[pick[rest]]] += spent
        return orbit, failed

    # -- writing results ---------------------------------------------------------------------------------------------

    def _saturated_contact(self, index):
        s = self.strips.take(index)
        p_mean, tau_mean = self.kernel.means_c(*_arguments(s))
        self._set(index, "c", p_mean, tau_mean, 1.0, 0.0)

    def _set(self, index, sequence, p_mean, tau_mean, contact, adhesion):
        out = self.solved
        out.code[index] = CODE[sequence]
        out.p_mean[index], out.tau_mean[index] = p_mean, tau_mean
        out.contact_fraction[index], out.adhesion_fraction[index] = contact, adhesion
        out.certified[index] = True

    def _finish(self, index, sequence, cycle: Cycle, orbit: Orbit, usable):
        """Certify and write orbits that all have the same sequence of zones."""
        strips = self.strips.take(index)
        certified = usable & edges_admissible(self.kernel, cycle, orbit) & stable(self.kernel, cycle, orbit)
        out = self.solved
        out.code[index] = CODE[sequence]
        out.certified[index] = certified
        good = np.flatnonzero(certified)
        edges, s = _edges(sequence, orbit), strips.take(good)
        means = getattr(self.kernel, "means_ac" if sequence == "cf" else f"means_{sequence}")
        where = index[good]
        out.p_mean[where], out.tau_mean[where] = means(*edges[:, good], *_arguments(s))
        contact = np.where(np.isnan(orbit.b), 0.0, orbit.a - orbit.b)[good] / (2 * np.pi)
        out.contact_fraction[where] = contact
        if sequence == "cf":
            out.adhesion_fraction[where] = 0.0
        elif sequence == "ac":
            out.adhesion_fraction[where] = 1 - contact
        else:
            out.adhesion_fraction[where] = (orbit.c - orbit.x)[good] / (2 * np.pi) - contact
        if sequence in ("ac", "cf"):
            out.b[where], out.a[where] = orbit.b[good], orbit.a[good]
        else:
            out.b[where], out.a[where], out.c[where] = orbit.b[good], orbit.a[good], orbit.c[good]
            if sequence != "afc":
                out.d[where] = orbit.x[good]


def _arguments(s: Strips):
    return s.alpha, s.beta, s.J, s.L, s.p_0, s.delta_0, s.D, s.chi


def _edges(sequence: str, orbit: Orbit) -> np.ndarray:
    """Unknown edges of the regime's boundary equations."""
    return np.array(
        {
            "acaf": (orbit.x, orbit.b, orbit.a, orbit.c),
            "afc": (orbit.x, orbit.a, orbit.c),
            "af": (orbit.x, orbit.c),
            "ac": (orbit.b, orbit.a),
            "cf": (orbit.b, orbit.a),
        }[sequence]
    )


def _kinds(cycle: Cycle, left: Orbit, right: Orbit) -> dict[str, np.ndarray]:
    """Which isolated zeros are certain to be of which regime: both ends of the interval are."""
    contact = ~np.isnan(left.b) & ~np.isnan(right.b) & ~left.engaged & ~right.engaged
    return {
        "acaf": contact & ~cycle.direct,
        "afc": contact & cycle.direct & ~cycle.bare,
        "cf": contact & cycle.bare,
        "af": np.isnan(left.b) & np.isnan(right.b) & ~left.engaged & ~right.engaged,
    }


def _polished(kernel, sequence: str, cycle: Cycle, orbit: Orbit, ends=None) -> tuple[Orbit, np.ndarray, np.ndarray]:
    """The orbit with its edges refined, whether nothing was left to correct, and the evaluations it took.

    ``ends``: orbits from an earlier and a later onset, between whose edges those of this one lie.
    """
    bounds = (-np.inf, np.inf)
    if ends is not None:
        one, two = (_edges(sequence, end) for end in ends)
        bounds = np.minimum(one, two), np.maximum(one, two)
    # the cycle of an always adhering strip is the bare one, shifted: its boundary equations are those of "ac" at p_0 = 0
    refined = polish(kernel, "ac" if sequence in ("ac", "cf") else sequence, cycle.strips, _edges(sequence, orbit), bounds)
    e = refined.edges
    if sequence == "acaf":
        new = Orbit(e[0], e[1], e[2], e[3], orbit.engaged, orbit.r, orbit.w_end)
    elif sequence == "afc":
        new = Orbit(e[0], e[0], e[1], e[2], orbit.engaged, orbit.r, orbit.w_end)
    elif sequence == "af":
        new = Orbit(e[0], orbit.b, orbit.a, e[1], orbit.engaged, orbit.r, orbit.w_end)
    else:
        new = Orbit(e[0], e[0], e[1], e[1], orbit.engaged, orbit.r, orbit.w_end)
    limit = np.where(refined.stalled, _ROUNDINGS * np.minimum(refined.attainable, _COARSEST), 0.0)
    converged = refined.correction <= _CONVERGED + limit
    return new, converged, refined.evaluations
