"""How a sweep is cut into batches that take a few seconds each, whatever a point costs.

The points, in their order, are cut into blocks, which are independent of one another and so can be solved side by side.
A block is solved in batches one after the other: the first is small, and each later one has a size that follows from the
work of the one before. Work is counted, not timed: it does not depend on the machine, so neither do the batches, nor the
last digits of the numbers; a sweep that was killed is cut like one that was not.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .plan import Plan

#: seconds that a batch is to take: a kill loses so much for each worker; longer ones use the vectorised solver better
_AIM = 5.0
#: seconds of a call of the solver, and of a strip with one relaxation time: 20 to 50 ms and 25 to 100 microseconds measured
_CALL, _STRIP = 0.03, 6e-5
#: a batch of n points takes like n^0.6 (one material) to n (a material for each point): between the inverses of both
_POWER = 1.4
#: a batch is at most so many times as large as the one before: a few points do not tell what the next cost
_GROWTH = 4
#: points of the first batch on one and two levels, and on more: about a second each
_FIRST = {1: 128, 2: 32}
_FIRST_OF_MANY = 8
#: blocks of a large sweep, at least; and points of a block, at most
_BLOCKS, _LARGEST = 64, 4096


def work_of(result: Any) -> float:
    """Work behind a result in nominal seconds, counted: the same on every machine. None: a call that failed."""
    if result is None:
        return _CALL
    times = getattr(result.material, "n", 1)
    return _CALL + _STRIP * max(times, 1) * result.counts["strips_solved"]


def first_size(plan: Plan) -> int:
    """Points of the first batch of a block."""
    if plan.batch:
        return plan.batch
    first = _FIRST.get(plan.levels, _FIRST_OF_MANY)
    # a lone velocity takes like several in a call of their own
    return max(1, min(first, plan.points_of_a_call * max(first // 8, 1)))


def next_size(plan: Plan, size: int, work: float) -> int:
    """Points of the batch after one of ``size`` points that took ``work``."""
    if plan.batch:
        return plan.batch
    factor = (_AIM / max(work, 1e-9)) ** _POWER
    return max(1, round(size * min(max(factor, 1 / _GROWTH), _GROWTH)))


def blocks(plan: Plan) -> Iterator[range]:
    """Points of every block."""
    least = _GROWTH * _FIRST.get(plan.levels, _FIRST_OF_MANY)
    size = plan.batch or min(max(least, -(-plan.size // _BLOCKS)), _LARGEST)
    for first in range(0, plan.size, size):
        yield range(first, min(first + size, plan.size))
