"""Refinement of all intervals of all members of a batch together: the function is called once a round, for all new nodes.

What it takes to be done, an integral or an interpolant, is a matter of the two kinds of it in ``adaptive``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from typing import NamedTuple

import numpy as np

from . import chebyshev
from .intervals import Intervals

_EPS = np.finfo(float).eps
#: bisections towards where a label changes: a bracket of any width is down to rounding after so many
_CUTS = 60


class Samples(NamedTuple):
    """What a function may return instead of values (m, q) alone. ``labels`` (m,): integers that are equal wherever the function
    is smooth in between; ``errors`` (m, q): how uncertain the values are."""

    values: np.ndarray
    labels: np.ndarray | None = None
    errors: np.ndarray | None = None


#: (member (m,), x (m,)) -> values (m, q), or ``Samples``
Function = Callable[[np.ndarray, np.ndarray], "np.ndarray | Samples"]


@dataclass(frozen=True)
class Work:
    """Of each member (M,): ``evaluations``; whether it ``converged`` to what was asked for within the limit of work; and
    ``changes``, how often labels showed that an interval was not smooth."""

    evaluations: np.ndarray
    converged: np.ndarray
    changes: np.ndarray


@dataclass
class Group:
    """Intervals with the values (k, n, q) at their nodes, labels (k, n) and errors (k, n, q) or None; and what was concluded from
    them: a ``summary`` (k, ...), what it ``missed`` and the errors ``given`` (k, q), the ``rate`` of the coefficients (k,)."""

    intervals: Intervals
    values: np.ndarray
    labels: np.ndarray | None
    errors: np.ndarray | None
    summary: np.ndarray | None = None
    missed: np.ndarray | None = None
    given: np.ndarray | None = None
    rate: np.ndarray | None = None

    def take(self, index) -> Group:
        """The intervals of a mask."""
        if index.all():
            return self
        arrays = (getattr(self, f.name) for f in fields(self)[1:])
        return Group(self.intervals.take(index), *(None if v is None else v[index] for v in arrays))

    def joined(self, other: Group | None) -> Group:
        """These after those of another group."""
        if other is None or not other.intervals.size:
            return self
        pairs = ((getattr(other, f.name), getattr(self, f.name)) for f in fields(self)[1:])
        intervals = Intervals.joined((other.intervals, self.intervals))
        return Group(intervals, *(None if b is None else np.concatenate((a, b)) for a, b in pairs))

    @property
    def narrow(self) -> np.ndarray:
        """Which can't be cut any more."""
        i = self.intervals
        return i.width <= 64 * _EPS * np.maximum(np.abs(i.low), np.abs(i.high))


@dataclass
class Verdict:
    """On the intervals of a group, masks (k,): ``settled`` as they are; ``wanted`` better, by doubling their nodes where that is
    ``promising``, else by bisection; the others wait."""

    settled: np.ndarray
    wanted: np.ndarray
    promising: np.ndarray


@dataclass
class Refinement:
    """The loop; its kinds say what a group's estimates are, which intervals are done, and what becomes of those."""

    function: Function
    members: int
    first: int
    last: int
    limit: int
    #: strength of the ends at which halves meet
    inner: int
    evaluations: np.ndarray = field(init=False)
    changes: np.ndarray = field(init=False)
    failed: np.ndarray = field(init=False)

    def __post_init__(self):
        self.evaluations, self.changes = np.zeros(self.members, int), np.zeros(self.members, int)
        self.failed = np.zeros(self.members, bool)

    def run(self, intervals: Intervals) -> None:
        """Settle all intervals."""
        fresh, growing, waiting = {self.first: intervals.take(intervals.high > intervals.low)}, {}, {}
        while growing or any(some.size for some in fresh.values()):
            groups = self._sampled(fresh, growing)
            cuts = []
            for n, group in groups.items():
                group, parts = self._smooth(group)
                if group.intervals.size:
                    group.summary, group.missed, group.given, group.rate = self._estimates(group)
                groups[n] = group.joined(waiting.pop(n, None)) if group.intervals.size else waiting.pop(n, group)
                cuts += parts
            # in an order that does not depend on other members, so that sums don't
            groups = {n: group for n, group in sorted((waiting | groups).items()) if group.intervals.size}
            growing, waiting, halves = self._sorted(groups, self._judged(groups) if groups else [])
            # those of what had not converged are not believed to have done so on the fewest nodes
            more = min(2 * self.first + 1, self.last)
            fresh = {n: Intervals.joined(some) for n, some in ((self.first, cuts), (more, halves)) if some}
            if more == self.first and cuts + halves:
                fresh = {more: Intervals.joined(cuts + halves)}

    def _sorted(self, groups: dict[int, Group], verdicts) -> tuple[dict[int, Group], dict[int, Group], list[Intervals]]:
        """What is to be doubled and what waits, by number of nodes, and the halves of the rest, after what is done is settled."""
        cost = np.zeros(self.members, int)
        for (n, group), verdict in zip(groups.items(), verdicts, strict=True):
            verdict.promising &= 2 * n + 1 <= self.last
            for which, count in ((verdict.promising, n + 1), (~verdict.promising, 2 * min(2 * self.first + 1, self.last))):
                cost += count * np.bincount(group.intervals.member[verdict.wanted & which], minlength=self.members)
        ended = self.evaluations + cost > self.limit
        growing, waiting, halves = {}, {}, []
        for (n, group), verdict in zip(groups.items(), verdicts, strict=True):
            member = group.intervals.member
            stuck = verdict.wanted & (ended[member] | group.narrow)
            self.failed[member[stuck]] = True
            doubled, halved = (verdict.wanted & ~stuck & which for which in (verdict.promising, ~verdict.promising))
            for which in (False, True):
                rows = stuck if which else verdict.settled
                if rows.any():
                    self._settle(group.take(rows), stuck=which)
            if doubled.any():
                growing[n] = group.take(doubled)
            if halved.any():
                halves.append(group.intervals.take(halved).halves(self.inner))
            rest = ~(verdict.settled | verdict.wanted)
            if rest.any():
                waiting[n] = group.take(rest)
        return growing, waiting, halves

    def work(self) -> Work:
        """What it took."""
        return Work(self.evaluations, ~self.failed, self.changes)

    def _called(self, member, x) -> Samples:
        found = self.function(member, x)
        np.add.at(self.evaluations, member, 1)
        return found if isinstance(found, Samples) else Samples(found)

    def _sampled(self, fresh: dict[int, Intervals], growing: dict[int, Group]) -> dict[int, Group]:
        """Groups by their number of nodes, after one call of the function."""
        plans = [(n, intervals, chebyshev.nodes(n), None) for n, intervals in fresh.items()]
        plans += [(2 * n + 1, group.intervals, chebyshev.nodes(2 * n + 1)[0::2], group) for n, group in growing.items()]
        x = [intervals.points(t) for _, intervals, t, _ in plans]
        member = [np.repeat(intervals.member, t.size) for _, intervals, t, _ in plans]
        found = self._called(np.concatenate(member), np.concatenate([v.ravel() for v in x]))
        out: dict[int, Group] = {}
        start = 0
        for (n, intervals, _, known), points in zip(plans, x, strict=True):
            some = slice(start, start + points.size)
            start += points.size
            new = [None if v is None else v[some].reshape(*points.shape, *v.shape[1:]) for v in found]
            group = Group(
                intervals, *(new if known is None else map(_interleaved, new, (known.values, known.labels, known.errors)))
            )
            out[n] = group.joined(out.get(n))
        return out

    def _smooth(self, group: Group) -> tuple[Group, list[Intervals]]:
        """The intervals all of whose labels are equal, and the parts of the others beside their first change."""
        if group.labels is None:
            return group, []
        differs = group.labels[:, 1:] != group.labels[:, :-1]
        mixed = differs.any(axis=1) & ~group.narrow & (self.evaluations[group.intervals.member] < self.limit)
        if not mixed.any():
            return group, []
        part = group.take(mixed)
        np.add.at(self.changes, part.intervals.member, 1)
        rows, at = np.arange(part.intervals.size), differs[mixed].argmax(axis=1)
        x = part.intervals.points(chebyshev.nodes(part.values.shape[1]))
        below, above = x[rows, at], x[rows, at + 1]
        left, right = part.values[rows, at].copy(), part.values[rows, at + 1].copy()
        label, live = part.labels[rows, at], rows
        for _ in range(_CUTS):
            middle = 0.5 * (below[live] + above[live])
            inside = (middle > below[live]) & (middle < above[live])
            live, middle = live[inside], middle[inside]
            if not live.size:
                break
            found = self._called(part.intervals.member[live], middle)
            same = found.labels == label[live]
            below[live[same]], left[live[same]] = middle[same], found.values[same]
            above[live[~same]], right[live[~same]] = middle[~same], found.values[~same]
        self._jump(part.intervals.member, above - below, left, right)
        # what ends where a label changes may end like a square root
        return group.take(~mixed), [part.intervals.cut(below, above, strength=2)]

    def _jump(self, member, width, left, right) -> None:
        """A bracket is left out between values ``left`` and ``right`` (k, q)."""

    def _estimates(self, group: Group) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Summary, missed, given and rate of a ``Group``."""
        raise NotImplementedError

    def _judged(self, groups: dict[int, Group]) -> list[Verdict]:
        """What is to become of the groups of either number of nodes."""
        raise NotImplementedError

    def _settle(self, group: Group, stuck: bool) -> None:
        """Take the intervals as they are; ``stuck``: for want of anything better."""
        raise NotImplementedError

    def _promising(self, n: int, missed, goal, rate) -> np.ndarray:
        """Where errors ``missed`` (k, q) with n nodes are expected to become ``goal`` with the most nodes, (k,)."""
        # few coefficients hardly tell a rate
        return (missed * (rate ** (self.last - n))[:, None] <= goal).all(axis=1) | (n == self.first)


def _interleaved(outer, inner):
    """What is had at nested nodes (k, n, ...) in their order."""
    if outer is None:
        return None
    out = np.empty((outer.shape[0], outer.shape[1] + inner.shape[1], *outer.shape[2:]), outer.dtype)
    out[:, 0::2], out[:, 1::2] = outer, inner
    return out
