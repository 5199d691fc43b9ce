"""Integrals and piecewise interpolants of many functions at once, by doubling nodes and bisecting intervals.

An interval gets
twice the nodes as long as the rate at which its coefficients fall lets expect that to help, else it is bisected. An integral
is done when the errors of all intervals of its member add up to less than is allowed, and until then those are refined that
have more than their part of it; compare de Boor, "CADRE" (1971), and chapter 6 of Davis & Rabinowitz, "Methods of Numerical
Integration" (1984).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import chebyshev, quadrature
from .convergence import following
from .intervals import Intervals
from .piecewise import Piecewise
from .refinement import Function, Group, Refinement, Samples, Verdict, Work

__all__ = ["FIRST", "LAST", "LIMIT", "Integrals", "Samples", "Work", "approximate", "integrate"]

_EPS = np.finfo(float).eps
#: nodes at first and at most; 7 are the fewest from which a rate can be had, beyond 63 halves are better
FIRST, LAST = 7, 63
#: evaluations that a member may take
LIMIT = 20_000
#: share of an error allowed that is left to intervals in which it can still be made smaller
_LEFT = 0.25
#: roundings of the largest value in a sum over nodes
_ROUNDING = 4


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


class _Integration(Refinement):
    def __init__(self, function, rtol, floor, first, last, limit):
        super().__init__(function, rtol.size, first, last, limit, inner=1)
        self.rtol, self.floor = rtol, floor
        self.values, self.missed, self.given = (np.zeros(floor.shape) for _ in range(3))

    @property
    def errors(self) -> np.ndarray:
        """Estimated error of every member, (M, q)."""
        return self.missed + self.given

    def _estimates(self, group: Group):
        """Integral, what the sum misses, what the values' errors make of it, all (k, q), and the rate (k,)."""
        n, i = group.values.shape[1], group.intervals
        noise = 0.1 * self.rtol[i.member, None] * self.floor[i.member]
        after, rate = following(chebyshev.second_kind(n) @ group.values, noise)
        weights, missed = np.empty(group.values.shape[:2]), np.empty(i.size)
        for low, high, rows in i.kinds():
            weights[rows] = quadrature.weights(n, low, high)
            missed[rows] = quadrature.missed(n, low, high, rate[rows])
        weights *= i.width[:, None]
        value = (weights[:, :, None] * group.values).sum(axis=1)
        given = np.zeros_like(value) if group.errors is None else (np.abs(weights)[:, :, None] * group.errors).sum(axis=1)
        rounding = _ROUNDING * _EPS * i.width[:, None] * np.abs(group.values).max(axis=1)
        return value, (i.width * missed)[:, None] * after + rounding, given, rate

    def _judged(self, groups):
        every = list(groups.values())
        member = np.concatenate([group.intervals.member for group in every])
        value, missed, given = (
            np.concatenate([getattr(group, name) for group in every]) for name in ("summary", "missed", "given")
        )
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
        for n, group in groups.items():
            i = group.intervals.member
            wanted = ~done[i] & (group.missed > part[i]).any(axis=1)
            verdicts.append(Verdict(done[i], wanted, self._promising(n, group.missed, part[i], group.rate)))
        return verdicts

    def _settle(self, group, stuck):
        member, missed = group.intervals.member, group.missed
        if stuck:
            # nothing is concluded from coefficients that do not fall as they should
            missed = np.maximum(missed, group.intervals.width[:, None] * np.ptp(group.values, axis=1))
        for sums, terms in ((self.values, group.summary), (self.missed, missed), (self.given, group.given)):
            np.add.at(sums, member, terms)

    def _jump(self, member, width, left, right):
        np.add.at(self.values, member, 0.5 * width[:, None] * (left + right))
        np.add.at(self.missed, member, 0.5 * width[:, None] * np.abs(left - right))


class _Approximation(Refinement):
    def __init__(self, function, tolerance, members, first, last, limit):
        super().__init__(function, members, first, last, limit, inner=2)
        self.tolerance, self.found = tolerance, []

    def _goal(self, group: Group):
        if callable(self.tolerance):
            return self.tolerance(group.intervals, group.values)
        limits = np.asarray(self.tolerance, float)
        return limits[group.intervals.member] if limits.ndim == 2 else np.broadcast_to(limits, group.values[:, 0].shape)

    def _estimates(self, group: Group):
        n, i = group.values.shape[1], group.intervals
        c = np.empty((i.size, n + 2, group.values.shape[2]))
        for low, high, rows in i.kinds():
            c[rows] = chebyshev.interpolation(n, low > 1, high > 1) @ group.values[rows]
        given = np.zeros_like(c[:, 0]) if group.errors is None else group.errors.max(axis=1)
        after, rate = following(c)
        return c, after / (1 - rate)[:, None], given, rate

    def _judged(self, groups):
        verdicts = []
        for n, group in groups.items():
            goal = np.maximum(self._goal(group), group.given)
            wanted = (group.missed > goal).any(axis=1)
            verdicts.append(Verdict(~wanted, wanted, self._promising(n, group.missed, goal, group.rate)))
        return verdicts

    def _settle(self, group, stuck):
        missed = np.maximum(group.missed, np.ptp(group.values, axis=1)) if stuck else group.missed
        self.found.append((group.intervals, group.summary, missed + group.given))

    def pieces(self) -> Piecewise:
        """All that is settled."""
        return Piecewise.make(self.members, self.found)
