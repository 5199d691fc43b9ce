"""Where a code changes along a line: all changes between points whose codes differ.

Brackets shrink by multisection, or, where a margin is known that vanishes at the change, around the place it foretells. Two
points with different codes enclose a change; where inside it lies is taken from the margin once it tells that well enough: points
next to a fold are dear.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

_POINTS = 1024
#: points remembered on either side of a bracket
_KEPT = 3
#: half width of the look around a foretold place, as a share of what the last point remembered changed of it, and its growth
#: after a miss
_DOUBT, _WIDER = 0.5, 16.0
#: a look is worth it if it is this much narrower than the bracket
_WORTH = 0.2
#: a margin that foretold wrongly this often in a row is not believed
_TRUSTED = 2
#: a place that is taken from the margins alone is held to be off by so much more than they say
_SURE = 64.0
#: points of a look in parts of its half width, towards the side that does not foretell: one well on the other for the next one to
#: build on
_AROUND = np.array((-4.0, -1.0, 1.0))

#: (line, x) -> codes (m,) and margins (m, k) of each point, NaN where unknown
Probe = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class Guide:
    """``foretells(code, other)``: which margin of a point with ``code`` vanishes where that becomes ``other``, -1 for none;
    ``powers`` (k,): the distance to there is like that power of the margin."""

    foretells: Callable[[np.ndarray, np.ndarray], np.ndarray]
    powers: np.ndarray


@dataclass(frozen=True)
class Transitions:
    """Brackets [low, high] of single changes of code, arrays (m,), with the line each lies on and the ``codes`` (m, 2) at its
    ends; sorted along every line."""

    line: np.ndarray
    low: np.ndarray
    high: np.ndarray
    codes: np.ndarray


@dataclass(frozen=True)
class Looks:
    """Points that were looked at before: ``bracket`` (k,) that each lies in or at an end of, ``x``, ``codes``, ``margins`` (k,
    powers)."""

    bracket: np.ndarray
    x: np.ndarray
    codes: np.ndarray
    margins: np.ndarray


def locate(
    probe: Probe,
    guide: Guide,
    line,
    low,
    high,
    code_low,
    code_high,
    width,
    looks: Looks | None = None,
) -> Transitions:
    """Narrow every bracket [low, high] of the ``line`` it lies on to ``width`` or less, all (m,); where a third code shows up in
    between, its transitions are found too. ``code_low``, ``code_high`` are the codes at the ends. ``looks``: what is known of
    every bracket, its ends included."""
    found = []
    brackets = _Brackets.between(line, low, high, code_low, code_high, width, guide.powers.size)
    if looks is not None:
        brackets.x[:] = np.nan
        brackets, _ = brackets.changes(looks.bracket, looks.x, looks.codes, looks.margins)
    for _ in range(80):
        ends, done = brackets.settled(guide)
        found.append((brackets.line[done], *ends[:, done], brackets.codes[done]))
        brackets = brackets.take(~done)
        if not brackets.line.size:
            break
        brackets = brackets.narrowed(probe, guide)
    else:
        found.append((brackets.line, brackets.low, brackets.high, brackets.codes))
    line, low, high, codes = (np.concatenate(parts) for parts in zip(*found, strict=True))
    order = np.lexsort((low, line))
    return Transitions(line[order], low[order], high[order], codes[order])


@dataclass(frozen=True)
class _Brackets:
    """Brackets, arrays (n,), with the points remembered below and above each, the nearest first: ``x`` (n, 2, kept), NaN where
    there is none, ``margins`` (n, 2, kept, k), ``codes`` (n, 2). ``misses``: looks in a row that found it elsewhere than
    foretold."""

    line: np.ndarray
    width: np.ndarray
    codes: np.ndarray
    x: np.ndarray
    margins: np.ndarray
    misses: np.ndarray

    @classmethod
    def between(cls, line, low, high, code_low, code_high, width, k: int) -> _Brackets:
        x = np.full((line.size, 2, _KEPT), np.nan)
        x[:, 0, 0], x[:, 1, 0] = low, high
        codes = np.stack((code_low, code_high), axis=1)
        return cls(line, width, codes, x, np.full((*x.shape, k), np.nan), np.zeros(line.size, int))

    @property
    def low(self):
        return self.x[:, 0, 0]

    @property
    def high(self):
        return self.x[:, 1, 0]

    def take(self, index) -> _Brackets:
        return _Brackets(*(getattr(self, name)[index] for name in ("line", "width", "codes", "x", "margins", "misses")))

    def settled(self, guide: Guide) -> tuple[np.ndarray, np.ndarray]:
        """Ends (2, n) of brackets that are narrow enough, or of what the margins leave of them, and which are either."""
        ends = np.stack((self.low, self.high))
        narrow = ends[1] - ends[0] <= self.width
        place, doubt, _ = self.foretold(guide)
        doubt = _SURE * doubt
        known = (place - doubt > ends[0]) & (place + doubt < ends[1]) & (2 * doubt <= self.width) & (self.misses < _TRUSTED)
        ends[:, known] = place[known] + np.multiply.outer((-1.0, 1.0), np.maximum(doubt[known], 0.0))
        return ends, narrow | known

    def narrowed(self, probe: Probe, guide: Guide) -> _Brackets:
        """The brackets of all changes inside, after a look at some points of each: around the foretold place, or all along."""
        low, high = self.low, self.high
        place, doubt, away = self.foretold(guide)
        doubt = np.maximum(doubt * _WIDER**self.misses, 0.4 * self.width)
        guided = (place > low) & (place < high) & (doubt < _WORTH * (high - low))
        targets, others = np.flatnonzero(guided), np.flatnonzero(~guided)
        # many points at once where there are few brackets: rounds, not strips, are what costs then
        m = int(np.clip(_POINTS // self.line.size, 3, 15))
        rows = np.concatenate((np.repeat(targets, _AROUND.size), np.repeat(others, m)))
        spread = low[others, None] + (high - low)[others, None] * np.arange(1, m + 1) / (m + 1)
        x = np.concatenate(((place[targets, None] + (away * doubt)[targets, None] * _AROUND).ravel(), spread.ravel()))
        # where the look should end it there is no need to build on
        outer = np.concatenate((np.tile(_AROUND < -1, targets.size), np.zeros(spread.size, bool)))
        inside = (x > low[rows]) & (x < high[rows]) & ~(outer & (doubt <= 0.5 * self.width)[rows])
        rows, x = rows[inside], x[inside]
        changes, parents = self.changes(rows, x, *probe(self.line[rows], x))
        missed = guided[parents] & (changes.high - changes.low > 2.1 * doubt[parents])
        changes.misses[:] = np.where(missed, self.misses[parents] + 1, 0)
        return changes

    def foretold(self, guide: Guide) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Where the change should be by the margins of the surer side, and how far off that may be, NaN and inf where nothing is
        known; and the direction away from that side."""
        place, doubt, away = np.full(self.line.size, np.nan), np.full(self.line.size, np.inf), np.ones(self.line.size)
        for side in (0, 1):
            which = guide.foretells(self.codes[:, side], self.codes[:, 1 - side])
            told = np.flatnonzero(which >= 0)
            if told.size:
                margin = np.take_along_axis(self.margins[told, side], which[told, None, None], axis=2)[:, :, 0]
                where, off = _vanishing(self.x[told, side], margin, guide.powers[which[told]])
                better = off < doubt[told]
                place[told[better]], doubt[told[better]], away[told[better]] = where[better], off[better], 1 - 2 * side
        return place, doubt, away

    def changes(self, rows, x, codes, margins) -> tuple[_Brackets, np.ndarray]:
        """The brackets between neighbours that differ among the points remembered and the new ones ``x`` of the brackets
        ``rows``; their parents."""
        own, side, place = np.nonzero(np.isfinite(self.x))
        owner = np.concatenate((own, rows))
        x = np.concatenate((self.x[own, side, place], x))
        codes = np.concatenate((self.codes[own, side], codes))
        margins = np.concatenate((self.margins[own, side, place], margins))
        order = np.lexsort((x, owner))
        owner, x, codes, margins = owner[order], x[order], codes[order], margins[order]
        # what was remembered beyond the ends of a bracket is of no change in it
        low, high = (np.where(np.isnan(v), beyond, v) for v, beyond in ((self.low, -np.inf), (self.high, np.inf)))
        within = (owner[1:] == owner[:-1]) & (x[:-1] >= low[owner[:-1]]) & (x[1:] <= high[owner[1:]])
        last = np.flatnonzero(within & (codes[1:] != codes[:-1]))
        parents = owner[last]
        near_x = np.full((last.size, 2, _KEPT), np.nan)
        near_margins = np.full((*near_x.shape, margins.shape[1]), np.nan)
        for side, (nearest, step) in enumerate(((last, -1), (last + 1, 1))):
            alike = np.ones(last.size, bool)
            for k in range(_KEPT):
                at = np.clip(nearest + step * k, 0, x.size - 1)
                alike &= (nearest + step * k == at) & (owner[at] == parents) & (codes[at] == codes[nearest])
                near_x[alike, side, k], near_margins[alike, side, k] = x[at[alike]], margins[at[alike]]
        ends = np.stack((codes[last], codes[last + 1]), axis=1)
        found = _Brackets(self.line[parents], self.width[parents], ends, near_x, near_margins, np.zeros(last.size, int))
        return found, parents


def _vanishing(x, margin, power) -> tuple[np.ndarray, np.ndarray]:
    """Where ``margin`` (n, 3) at ``x`` vanishes, ``x = place + c margin^p + d margin^(p + 1)``, and how far off that may be."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        u = margin ** power[:, None]
        v = u * margin
        dx, du, dv = (w[:, 1:] - w[:, :1] for w in (x, u, v))
        two = x[:, 0] - u[:, 0] * dx[:, 0] / du[:, 0]
        determinant = du[:, 0] * dv[:, 1] - du[:, 1] * dv[:, 0]
        c = (dx[:, 0] * dv[:, 1] - dx[:, 1] * dv[:, 0]) / determinant
        d = (du[:, 0] * dx[:, 1] - du[:, 1] * dx[:, 0]) / determinant
        three = x[:, 0] - u[:, 0] * c - v[:, 0] * d
        off = np.where(np.isfinite(three), _DOUBT * np.abs(three - two), 0.5 * np.abs(two - x[:, 0]))
    return np.where(np.isfinite(three), three, two), np.where(np.isfinite(off), off, np.inf)
