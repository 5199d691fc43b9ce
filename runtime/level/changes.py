"""Where a code changes along a line: the slow way, for what no equation tells.

Between two points whose codes differ lies a change. Its bracket is halved; where a height is known that passes zero at the
change, false position (Illinois; Dowell and Jarratt, BIT 11, 1971, 168) is quicker.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np

from ..numerics.rounding import EPS

#: more than enough to halve any bracket of numbers in double precision to nothing
_ROUNDS = 100
#: how far beside a place that an equation tells it is checked, as a share of the bracket
_ASIDE = 1e-6

#: (line, x) -> codes (m,), heights (m, k), edges (m, 4) and values (m, q)
Probe = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, ...]]
#: (changes) -> changes of which equations tell all there is (k,), and where that is; one of several places may stand for each
Equation = Callable[["Changes"], tuple[np.ndarray, np.ndarray]]


@dataclass
class Changes:
    """Brackets of single changes, arrays (m,): the ``line`` each lies on, ``low`` and ``high``; and what is known at the ends:
    ``codes`` (m, 2), ``heights`` (m, 2, k), ``edges`` (m, 2, 4), ``values`` (m, 2, q)."""

    line: np.ndarray
    low: np.ndarray
    high: np.ndarray
    codes: np.ndarray
    heights: np.ndarray
    edges: np.ndarray
    values: np.ndarray

    def take(self, index) -> Changes:
        return Changes(*(getattr(self, f.name)[index] for f in fields(self)))

    @classmethod
    def joined(cls, some: list[Changes]) -> Changes:
        return cls(*(np.concatenate([getattr(c, f.name) for c in some]) for f in fields(cls)))

    @property
    def size(self) -> int:
        return self.line.size


def locate_changes(
    probe: Probe, equation: Equation, changes: Changes, width: np.ndarray, checked: bool = True
) -> tuple[Changes, int]:
    """Narrow every bracket to ``width`` (m,) or to neighbouring numbers; where a third code shows up inside, there are two.

    Where an ``equation`` tells the place, both ends are there, with the codes and values that were known; or, ``checked``, with
    those found next to it, and what else changes in the bracket is located too. Returns the changes, and how many points it took
    where no equation told.
    """
    found, halved = [], 0
    weight, stayed = np.ones((changes.size, 2)), np.full(changes.size, -1)
    for _ in range(_ROUNDS):
        finest = 4 * EPS * np.maximum(np.abs(changes.low), np.abs(changes.high))
        done = changes.high - changes.low <= np.maximum(width, finest)
        found.append(changes.take(done))
        changes, width, weight, stayed = changes.take(~done), width[~done], weight[~done], stayed[~done]
        if not changes.size:
            break
        parent, place = equation(changes)
        if parent.size:
            exact, wide = changes.take(parent), width[parent]
            left = np.setdiff1d(np.arange(changes.size), parent)
            changes, width, weight, stayed = changes.take(left), width[left], weight[left], stayed[left]
            if checked:
                exact, others, parent = _beside(probe, exact, place)
                changes, width = Changes.joined([changes, others]), np.concatenate((width, wide[parent]))
                weight = np.concatenate((weight, np.ones((others.size, 2))))
                stayed = np.concatenate((stayed, np.full(others.size, -1)))
            else:
                exact.low[:] = exact.high[:] = place
            found.append(exact)
            if not changes.size:
                break
        halved += changes.size
        share = _share(changes, weight, width)
        x = changes.low + share * (changes.high - changes.low)
        answers = probe(changes.line, x)
        codes = answers[0]
        low, high = codes != changes.codes[:, 0], codes != changes.codes[:, 1]
        parts, weights, ends = [], [], []
        for side, which in ((0, np.flatnonzero(low)), (1, np.flatnonzero(high))):
            part = changes.take(which)
            end = 1 - side
            (part.high if side == 0 else part.low)[:] = x[which]
            part.codes[:, end], part.heights[:, end], part.edges[:, end], part.values[:, end] = (v[which] for v in answers)
            parts.append((part, width[which]))
            # an end that stays twice in a row counts half as much the next time (Illinois)
            w = np.ones((which.size, 2))
            w[:, side] = np.where(stayed[which] == side, 0.5 * weight[which, side], 1.0)
            weights.append(w)
            ends.append(np.full(which.size, side))
        changes = Changes.joined([part for part, _ in parts])
        width = np.concatenate([w for _, w in parts])
        weight, stayed = np.concatenate(weights), np.concatenate(ends)
    found.append(changes)
    out = Changes.joined(found)
    return out.take(np.lexsort((out.low, out.line))), halved


def _beside(probe: Probe, changes: Changes, place: np.ndarray) -> tuple[Changes, Changes, np.ndarray]:
    """What a look to either side of the ``place`` told for every change makes of it: the changes there, what else changes between
    there and the ends, and of which change each of these is a part."""
    aside = _ASIDE * (changes.high - changes.low)
    sides = np.maximum(place - aside, changes.low), np.minimum(place + aside, changes.high)
    answers = probe(np.tile(changes.line, 2), np.concatenate(sides))
    below, above = ([v[: place.size] for v in answers], [v[place.size :] for v in answers])
    known = [getattr(changes, f.name) for f in fields(Changes)[3:]]
    lower = [np.stack((v[:, 0], new), axis=1) for v, new in zip(known, below, strict=True)]
    upper = [np.stack((new, v[:, 1]), axis=1) for v, new in zip(known, above, strict=True)]
    exact = Changes(changes.line, place, place, *(np.stack(pair, axis=1) for pair in zip(below, above, strict=True)))
    others = Changes.joined(
        [Changes(changes.line, changes.low, sides[0], *lower), Changes(changes.line, sides[1], changes.high, *upper)]
    )
    differ = lambda some: np.flatnonzero(some.codes[:, 0] != some.codes[:, 1])  # noqa: E731
    more = differ(others)
    return exact.take(differ(exact)), others.take(more), more % place.size


def _share(changes: Changes, weight, width) -> np.ndarray:
    """Where in its bracket to look next: half-way, or where the height vanishes whose sign differs at the ends."""
    share = np.full(changes.size, 0.5)
    if not changes.heights.shape[2]:
        return share
    low, high = changes.heights[:, 0], changes.heights[:, 1]
    passed = (low > 0) != (high > 0)
    alone = np.flatnonzero(passed.sum(axis=1) == 1)
    which = passed[alone].argmax(axis=1)
    a, b = low[alone, which] * weight[alone, 0], high[alone, which] * weight[alone, 1]
    usable = np.isfinite(a) & np.isfinite(b) & (a != b)
    alone, a, b = alone[usable], a[usable], b[usable]
    # no closer to an end than what has to be known anyway
    edge = np.minimum(0.4 * width[alone] / (changes.high - changes.low)[alone], 0.5)
    share[alone] = np.clip(a / (a - b), edge, 1 - edge)
    return share
