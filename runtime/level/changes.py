"""Where a code changes along a line: the slow way, for what no equation tells.

Between two points whose codes differ lies a change. Its bracket is divided in three: a call for two strips costs as one for one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..numerics.rounding import EPS
from ..orbit.batch import Ranges

#: more than enough to divide any bracket of numbers in double precision to nothing
_ROUNDS = 100
#: how far beside a place that an equation tells it is checked, as a share of the bracket
ASIDE = 1e-6

#: (line, x) -> codes (m,), values (m, q), pressures over breaks (m, k) and edges (m, 4)
Probe = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, ...]]
#: (changes) -> which of them equations locate completely, places (several for some), whether another may lie next to it; (k,)
Equation = Callable[["Changes"], tuple[np.ndarray, np.ndarray, np.ndarray]]


@dataclass
class Changes(Ranges):
    """Brackets of single changes, arrays (m,): the ``line`` each lies on, ``low`` and ``high``; and what is known at the ends:
    ``codes`` (m, 2), ``values`` (m, 2, q), ``over_breaks`` (m, 2, k), ``edges`` (m, 2, 4)."""

    line: np.ndarray
    codes: np.ndarray
    values: np.ndarray
    over_breaks: np.ndarray
    edges: np.ndarray

    @property
    def passed(self) -> np.ndarray:
        """Which pressures over breaks change sign, (m, k)."""
        return (self.over_breaks[:, 0] > 0) != (self.over_breaks[:, 1] > 0)

    @classmethod
    def between(cls, line: np.ndarray, x: np.ndarray, known) -> tuple[Changes, np.ndarray, np.ndarray]:
        """Brackets between neighbouring points ``x`` (lines, points) whose codes differ, with their rows and first points.
        ``known``: codes, values, pressures over breaks and edges at the points, (lines, points, ...)."""
        row, first = np.nonzero(known[0][:, 1:] != known[0][:, :-1])
        both = row[:, None], np.stack((first, first + 1), axis=1)
        return cls(*x[both].T, line[row], *(v[both] for v in known)), row, first


def locate_changes(probe: Probe, equation: Equation, changes: Changes, width: np.ndarray) -> tuple[Changes, int]:
    """Narrow every bracket to ``width`` (m,) or to neighbouring numbers; where a third code shows up inside, there are two.

    Where an ``equation`` tells the place, both ends are there, with the codes and values that were known; where that is doubtful,
    with those next to it, and other changes of the bracket are located too. Returns also how many points were tried without it.
    """
    found, divided = [], 0
    for _ in range(_ROUNDS):
        finest = 4 * EPS * np.maximum(np.abs(changes.low), np.abs(changes.high))
        done = changes.width <= np.maximum(width, finest)
        found.append(changes.take(done))
        changes, width = changes.take(~done), width[~done]
        if not changes.size:
            break
        parent, place, doubtful = equation(changes)
        # rounding may push it out of its bracket, which would then come back as it was
        place = np.clip(place, changes.low[parent], changes.high[parent])
        settled, at = parent[~doubtful], place[~doubtful]
        found.append(replace(changes.take(settled), low=at, high=at))
        left, where = np.setdiff1d(np.arange(changes.size), settled), np.full(changes.size, np.nan)
        where[parent[doubtful]] = place[doubtful]
        changes, width, where = changes.take(left), width[left], where[left]
        if not changes.size:
            break
        located, low, high = ~np.isnan(where), changes.low[:, None], changes.high[:, None]
        divided += 2 * np.count_nonzero(~located)
        beside = np.clip(where[:, None] + ASIDE * (high - low) * [-1, 1], low, high)
        x = np.where(located[:, None], beside, low + (high - low) * [1 / 3, 2 / 3])
        answers = [v.reshape(*x.shape, *v.shape[1:]) for v in probe(np.repeat(changes.line, 2), x.ravel())]
        ends = changes.codes, changes.values, changes.over_breaks, changes.edges
        known = [np.concatenate((end[:, :1], new, end[:, 1:]), axis=1) for end, new in zip(ends, answers, strict=True)]
        changes, row, part = Changes.between(changes.line, np.concatenate((low, x, high), axis=1), known)
        exact = located[row] & (part == 1)
        at = where[row[exact]]
        found.append(replace(changes.take(exact), low=at, high=at))
        changes, width = changes.take(~exact), width[row[~exact]]
    out = Changes.joined([*found, changes])
    return out.take(np.lexsort((out.low, out.line))), divided
