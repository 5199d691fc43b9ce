"""Integrals and piecewise interpolants of many functions at once, by doubling nodes and bisecting intervals.

All intervals of all members advance together: in each round the function is called once, for all new nodes. An interval gets
twice the nodes as long as the rate at which its coefficients fall lets expect that to help, else it is bisected. An integral
is done when the errors of all intervals of its member add up to less than is allowed, and until then those are refined that
have more than their part of it; compare de Boor, "CADRE" (1971), and chapter 6 of Davis & Rabinowitz, "Methods of Numerical
Integration" (1984).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from . import chebyshev, quadrature
from .convergence import following
from .intervals import Intervals
from .piecewise import Piecewise

_EPS = np.finfo(float).eps
#: nodes at first and at most; 7 are the fewest from which a rate can be had, beyond 63 halves are better
FIRST, LAST = 7, 63
#: evaluations that a member may take
LIMIT = 20_000
#: bisections towards where a label changes: a bracket of any width is down to rounding after so many
_CUTS = 60
#: share of an error allowed that is left to intervals in which it can still be made smaller
_LEFT = 0.25
#: roundings of the largest value in a sum over nodes
_ROUNDING = 4


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


@dataclass(frozen=True)
class Integrals:
    """Integrals ``values`` (M, q) with their estimated ``errors`` (M, q), and the work of each."""

    values: np.ndarray
    errors: np.ndarray
    work: Work


def integrate(
    function: Function,
    intervals: Intervals,
    rtol: np.ndarray,
    floor: np.ndarray,
    *,
    first: int = FIRST,
    last: int = LAST,
    limit: int = LIMIT,
) -> Integrals:
    """Integrals of ``function`` over all intervals of every member, to ``rtol (|value| + floor)``.

    ``rtol`` (M,), ``floor`` (M, q). Nodes grow from ``first`` to ``last``, doubled and one more each time. Where ``limit``
    evaluations of a member are reached, or the values' own errors are larger than what is allowed, the error says so.
    """
    loop = _Integration(function, np.asarray(rtol, float), np.asarray(floor, float), first, last, limit)
    loop.run(intervals)
    return Integrals(loop.values, loop.errors, loop.work())


def approximate(
    function: Function,
    intervals: Intervals,
    tolerance: np.ndarray | Callable[[Intervals, np.ndarray], np.ndarray],
    members: int,
    *,
    first: int = FIRST,
    last: int = LAST,
    limit: int = LIMIT,
) -> tuple[Piecewise, Work]:
    """Chebyshev series of ``function`` on the intervals, or on parts of them, each to its tolerance.

    ``tolerance``: greatest error (q,), (members, q), or ``tolerance(intervals, values (k, n, q))`` -> (k, q). Where a tolerance
    is not reached (``limit``, or an interval that can't be cut any more) the errors of the pieces say so. Every interval is
    covered.

    Towards an end of a strength above 1 the function has to be flat in t: so 4 for an end like a square root, 2 for one like
    its cube or a regular one. Nodes lie less well next to an end of strength 1, where the error is up to n times that in
    between.
    """
    loop = _Approximation(function, tolerance, members, first, last, limit)
    loop.run(intervals)
    return loop.pieces(), loop.work()


@dataclass
class _Group:
    """Intervals with the values (k, n, q) at their nodes, labels (k, n) and errors (k, n, q) or None."""

    intervals: Intervals
    values: np.ndarray
    labels: np.ndarray | None
    errors: np.ndarray | None

    def take(self, index) -> _Group:
        labels, errors = (None if v is None else v[index] for v in (self.labels, self.errors))
        return _Group(self.intervals.take(index), self.values[index], labels, errors)

    def joined(self, other: _Group | None) -> _Group:
        if other is None or not other.intervals.size:
            return self
        pairs = ((getattr(other, name), getattr(self, name)) for name in ("values", "labels", "errors"))
        return _Group(
            Intervals.joined((other.intervals, self.intervals)),
            *(None if b is None else np.concatenate((a, b)) for a, b in pairs),
        )

    @property
    def narrow(self) -> np.ndarray:
        """Which can't be cut any more."""
        i = self.intervals
        return i.width <= 64 * _EPS * np.maximum(np.abs(i.low), np.abs(i.high))


@dataclass
class _Verdict:
    """On the intervals of a group, masks (k,): ``settled`` as they are; ``wanted`` better, by doubling their nodes where that is
    ``promising``, else by bisection; the others wait."""

    settled: np.ndarray
    wanted: np.ndarray
    promising: np.ndarray


@dataclass
class _Loop:
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
                groups[n] = group.joined(waiting.pop(n, None))
                cuts += parts
            # in an order that does not depend on other members, so that sums don't
            groups = {n: group for n, group in sorted((waiting | groups).items()) if group.intervals.size}
            growing, waiting, halves = self._sorted(groups, self._judged(groups))
            # those of what had not converged are not believed to have done so on the fewest nodes
            more = min(2 * self.first + 1, self.last)
            fresh = {n: Intervals.joined(some) for n, some in ((self.first, cuts), (more, halves)) if some}
            if more == self.first and cuts + halves:
                fresh = {more: Intervals.joined(cuts + halves)}

    def _sorted(self, groups: dict[int, _Group], verdicts) -> tuple[dict[int, _Group], dict[int, _Group], list[Intervals]]:
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

    def _sampled(self, fresh: dict[int, Intervals], growing: dict[int, _Group]) -> dict[int, _Group]:
        """Groups by their number of nodes, after one call of the function."""
        plans = [(n, intervals, chebyshev.nodes(n), None) for n, intervals in fresh.items()]
        plans += [(2 * n + 1, group.intervals, chebyshev.nodes(2 * n + 1)[0::2], group) for n, group in growing.items()]
        x = [intervals.points(t) for _, intervals, t, _ in plans]
        member = [np.repeat(intervals.member, t.size) for _, intervals, t, _ in plans]
        found = self._called(np.concatenate(member), np.concatenate([v.ravel() for v in x]))
        out: dict[int, _Group] = {}
        start = 0
        for (n, intervals, _, known), points in zip(plans, x, strict=True):
            some = slice(start, start + points.size)
            start += points.size
            new = [None if v is None else v[some].reshape(*points.shape, *v.shape[1:]) for v in found]
            group = _Group(intervals, *(new if known is None else map(_interleaved, new, _arrays(known))))
            out[n] = group.joined(out.get(n))
        return out

    def _smooth(self, group: _Group) -> tuple[_Group, list[Intervals]]:
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

    def _judged(self, groups: dict[int, _Group]) -> list[_Verdict]:
        raise NotImplementedError

    def _settle(self, group: _Group, stuck: bool) -> None:
        raise NotImplementedError

    def _promising(self, n: int, missed, goal, rate) -> np.ndarray:
        """Where errors ``missed`` (k, q) with n nodes are expected to become ``goal`` with the most nodes, (k,)."""
        # few coefficients hardly tell a rate
        return (missed * (rate ** (self.last - n))[:, None] <= goal).all(axis=1) | (n == self.first)


def _arrays(group: _Group):
    return group.values, group.labels, group.errors


def _interleaved(outer, inner):
    """What is had at nested nodes (k, n, ...) in their order."""
    if outer is None:
        return None
    out = np.empty((outer.shape[0], outer.shape[1] + inner.shape[1], *outer.shape[2:]), outer.dtype)
    out[:, 0::2], out[:, 1::2] = outer, inner
    return out


class _Integration(_Loop):
    def __init__(self, function, rtol, floor, first, last, limit):
        super().__init__(function, rtol.size, first, last, limit, inner=1)
        self.rtol, self.floor = rtol, floor
        self.values, self.missed, self.given = (np.zeros(floor.shape) for _ in range(3))

    @property
    def errors(self) -> np.ndarray:
        """Estimated error of every member, (M, q)."""
        return self.missed + self.given

    def _estimates(self, group: _Group):
        """Integral, what the sum misses, what the values' errors make of it, all (k, q), and the rate (k,)."""
        n, i = group.values.shape[1], group.intervals
        noise = 0.1 * self.rtol[i.member, None] * self.floor[i.member]
        after, rate = following(chebyshev.second_kind(n) @ group.values, noise)
        weights, missed = np.empty(group.values.shape[:2]), np.empty(i.size)
        for low, high in np.unique(np.stack((i.strength_low, i.strength_high)), axis=1).T.tolist():
            rows = (i.strength_low == low) & (i.strength_high == high)
            weights[rows] = quadrature.weights(n, low, high)
            missed[rows] = quadrature.missed(n, low, high, rate[rows])
        weights *= i.width[:, None]
        value = (weights[:, :, None] * group.values).sum(axis=1)
        given = np.zeros_like(value) if group.errors is None else (np.abs(weights)[:, :, None] * group.errors).sum(axis=1)
        rounding = _ROUNDING * _EPS * i.width[:, None] * np.abs(group.values).max(axis=1)
        return value, (i.width * missed)[:, None] * after + rounding, given, rate

    def _judged(self, groups):
        if not groups:
            return []
        found = [self._estimates(group) for group in groups.values()]
        member = np.concatenate([group.intervals.member for group in groups.values()])
        value, missed, given, _ = (np.concatenate(v) for v in zip(*found, strict=True))
        total, open_, uncertain = self.values.copy(), np.zeros_like(self.values), self.given.copy()
        for sums, terms in ((total, value), (open_, missed), (uncertain, given)):
            np.add.at(sums, member, terms)
        # sums better than the values are known are of no use
        goal = np.maximum(self.rtol[:, None] * (np.abs(total) + self.floor), uncertain)
        budget = np.maximum(goal - self.missed, _LEFT * goal)
        done = (open_ <= budget).all(axis=1)
        self.failed |= (self.missed > goal).any(axis=1)
        part = budget / np.maximum(np.bincount(member, minlength=done.size), 1)[:, None]
        verdicts = []
        for (n, group), (_, missed, _, rate) in zip(groups.items(), found, strict=True):
            i = group.intervals.member
            wanted = ~done[i] & (missed > part[i]).any(axis=1)
            verdicts.append(_Verdict(done[i], wanted, self._promising(n, missed, part[i], rate)))
        return verdicts

    def _settle(self, group, stuck):
        value, missed, given, _ = self._estimates(group)
        member = group.intervals.member
        if stuck:
            # nothing is concluded from coefficients that do not fall as they should
            missed = np.maximum(missed, group.intervals.width[:, None] * np.ptp(group.values, axis=1))
        for sums, terms in ((self.values, value), (self.missed, missed), (self.given, given)):
            np.add.at(sums, member, terms)

    def _jump(self, member, width, left, right):
        np.add.at(self.values, member, 0.5 * width[:, None] * (left + right))
        np.add.at(self.missed, member, 0.5 * width[:, None] * np.abs(left - right))


class _Approximation(_Loop):
    def __init__(self, function, tolerance, members, first, last, limit):
        super().__init__(function, members, first, last, limit, inner=2)
        self.tolerance, self.found = tolerance, []

    def _goal(self, group: _Group):
        if callable(self.tolerance):
            return self.tolerance(group.intervals, group.values)
        limits = np.asarray(self.tolerance, float)
        return limits[group.intervals.member] if limits.ndim == 2 else np.broadcast_to(limits, group.values[:, 0].shape)

    def _estimates(self, group: _Group):
        n, i = group.values.shape[1], group.intervals
        c = np.empty((i.size, n + 2, group.values.shape[2]))
        flat = i.strength_low > 1, i.strength_high > 1
        for kind in np.unique(np.stack(flat), axis=1).T.tolist():
            rows = (flat[0] == kind[0]) & (flat[1] == kind[1])
            c[rows] = chebyshev.interpolation(n, *kind) @ group.values[rows]
        given = np.zeros_like(c[:, 0]) if group.errors is None else group.errors.max(axis=1)
        after, rate = following(c)
        return c, after / (1 - rate)[:, None], given, rate

    def _judged(self, groups):
        verdicts = []
        for n, group in groups.items():
            _, missed, given, rate = self._estimates(group)
            goal = np.maximum(self._goal(group), given)
            wanted = (missed > goal).any(axis=1)
            verdicts.append(_Verdict(~wanted, wanted, self._promising(n, missed, goal, rate)))
        return verdicts

    def _settle(self, group, stuck):
        c, missed, given, _ = self._estimates(group)
        if stuck:
            missed = np.maximum(missed, np.ptp(group.values, axis=1))
        self.found.append((group.intervals, c, missed + given))

    def pieces(self) -> Piecewise:
        return Piecewise.make(self.members, self.found)
