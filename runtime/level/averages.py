"""Averages over y by panels between the transitions of regime.

Inside a panel every strip is in the same regime and the integrand is smooth, but for its ends, where a strip may detach
like a square root at a fold. The substitution ``theta = low + width (3 t^2 - 2 t^3)`` turns such an end into a smooth one, and
Clenshaw-Curtis sums in t, doubled on nested nodes, converge geometrically. Where nodes of one panel disagree about the
regime, the transition between them is located and the panel is split there. Panels end beforehand where a transition is known
(``clinging``, ``Columns.transitions``).

All panels of all columns (a column is one velocity and one penetration) advance together: one batch of strips per round.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from .effort import AVERAGE_LIMIT
from .panels import Panels, Sights, apart, beside, between, hold_none
from .quadrature import interior_nodes, interleaved, mapped, mapped_weights, sum_errors
from .transitions import locate

if TYPE_CHECKING:
    from .strips import Columns

_FIRST, _LAST = 8, 64
#: nodes of a panel whose strips are had without a search: its sum may as well be exact
_COSTLESS = 32
_ROUNDS = 60
#: how far from the flat edge the strip next to it is, in parts of the accuracy; what does not count is asked for to any accuracy
_EDGE, _ANY = 0.01, 0.1
#: how far a strip may be from a transition that is known, in parts of what may err there: values change by a thousand floors
_ASIDE = 0.5e-3
#: roundings of a transition that is known, in the same parts, above which it is located all the same
_BLURRED = 300.0
#: panels a column may have waiting at once
_CROWD = 150
_EPS = np.finfo(float).eps
#: a panel's part of what a column may err, and that of the slivers in which transitions are bracketed
_SHARE, _SLIVER = 0.4, 0.03
#: share of it below which no panel's error is claimed to be: a layer may be too thin to show at its nodes
_TOLD = 1e-5


@dataclass(slots=True)
class Averages:
    """Means over the cell: values and error estimates of shape (columns, q); strips evaluated per column.

    ``zones``: for each column the codes met along y, one row (code, low, high) for each run of panels that share it.
    """

    values: np.ndarray
    errors: np.ndarray
    strips: np.ndarray
    zones: list[np.ndarray] = field(default_factory=list)


def average(
    columns: Columns,
    known: tuple[np.ndarray, np.ndarray],
    floor: np.ndarray,
    rtol: np.ndarray,
    q: int,
) -> Averages:
    """Means ``(1/pi) int_0^pi values d(theta)`` of the ``integrand`` of every column to ``rtol (|value| + floor)``.

    ``known``: columns and interior thetas (k,) known to be transitions. ``floor`` and ``rtol`` have shape (columns, q) and
    (columns,).
    """
    n, (column, theta) = rtol.size, known
    work = _Work(columns, floor, rtol, np.zeros((n, q)), np.zeros((n, q)), np.zeros(n, int))
    cuts = Panels.joined((Panels.unknown(column, theta, theta, q), work.met(*columns.ends_of_clinging(), *known)))
    panels = between(n, cuts)
    for _ in range(_ROUNDS):
        panels = work.refine(panels.take(np.flatnonzero(panels.high > panels.low)))
        # at a penetration where strips sit on a threshold all along y, rounding decides each: no use in splitting further
        crowded = (np.bincount(panels.column, minlength=n)[panels.column] > _CROWD) | (work.strips[panels.column] > AVERAGE_LIMIT)
        if crowded.any():
            work.give_up(panels.take(np.flatnonzero(crowded)))
            panels = panels.take(np.flatnonzero(~crowded))
        if not panels.size:
            break
    else:
        work.give_up(panels)
    work.close_slivers()
    return Averages(work.values / np.pi, work.errors / np.pi, work.strips, work.zones())


@dataclass(slots=True)
class _Work:
    columns: Columns
    floor: np.ndarray
    rtol: np.ndarray
    values: np.ndarray
    errors: np.ndarray
    strips: np.ndarray
    accepted: list[tuple] = field(default_factory=list)
    #: brackets of transitions (column, low, high, how much of it may lie on either side) with what was left out for each, and how
    #: far off that may be
    slivers: list[tuple] = field(default_factory=list)
    sights: Sights = field(init=False)
    #: by how much transitions that are known may be off but for the rounding of a penetration
    unsure: np.ndarray = field(default_factory=lambda: np.empty(0))

    def __post_init__(self):
        every = np.arange(self.rtol.size)
        crest, flat = 0.0 * self.rtol, np.full(every.size, np.pi)
        self.sights = Sights(np.tile(every, 2), np.concatenate((crest, self._edge())), np.concatenate((crest, flat)))

    def met(self, column, theta, rounding, other, known) -> Panels:
        """Brackets of the transitions ``theta`` (m,) of a ``column`` that are known to ``rounding``, away from the ``known`` ones
        of columns ``other``."""
        unsure = _ASIDE * _SLIVER * _SHARE * np.minimum(self.rtol, _ANY)[column]
        aside = np.maximum(unsure, rounding)
        low, high = theta - aside, theta + aside
        # next to the crest rounding is what tells: then strips are asked, as they are where the crest itself changes (``breaks``)
        sharp = rounding <= _BLURRED * unsure
        inside = np.flatnonzero(sharp & (low > 0) & (high < self._edge()[column]) & hold_none(column, low, high, other, known))
        index = inside[apart(column[inside], low[inside], high[inside])]
        column, low, high, self.unsure = column[index], low[index], high[index], unsure[index]
        self.sights.add(np.tile(column, 2), np.concatenate((low, high)))
        return Panels.unknown(column, low, high, self.values.shape[1])

    def zones(self) -> list[np.ndarray]:
        """See ``Averages.zones``."""
        column, code, low, high, *_ = (np.concatenate(v) for v in zip(*self.accepted, strict=True))
        order = np.lexsort((low, column))
        column, code, low, high = column[order], code[order], low[order], high[order]
        first = np.flatnonzero(np.append(True, (column[1:] != column[:-1]) | (code[1:] != code[:-1])))
        last = np.append(first[1:], column.size) - 1
        runs = np.stack((code[first], low[first], high[last]), axis=1)
        ends = np.searchsorted(column[first], np.arange(self.strips.size + 1))
        return [runs[start:stop] for start, stop in zip(ends[:-1], ends[1:], strict=True)]

    def refine(self, panels: Panels) -> Panels:
        """Accept what converges under doubling; return what has to be split."""
        later = []
        self._learn_ends(panels)
        n = _FIRST
        codes, values = self._at_nodes(panels, interior_nodes(n))
        while panels.size:
            mixed = (codes != codes[:, :1]).any(axis=1)
            if n == _FIRST:
                self._learn_ends(panels)
                # what is narrower than the first step shows up at an end that is known
                mixed |= (panels.known & (panels.codes != codes[:, [0, -1]])).any(axis=1)
            if mixed.any():
                later.append(self._split_at_transitions(panels.take(mixed), codes[mixed], values[mixed], n))
            keep = ~mixed
            panels, codes, values = panels.take(keep), codes[keep], values[keep]
            width = (panels.high - panels.low)[:, None]
            fine = width * (mapped_weights(n) @ values)
            rounding = 4 * _EPS * width * np.max(np.abs(values), axis=1, initial=0.0)
            noise = 0.1 * self.rtol[panels.column, None] * self.floor[panels.column]
            error = width * sum_errors(values, noise) + rounding
            done = self._accept(panels, codes[:, 0], values, fine, error, rounding)
            rest = ~done
            panels = panels.take(rest)
            if n == _LAST or not panels.size:
                break
            n *= 2
            codes, values = self._doubled(panels, n, codes[rest], values[rest])
        if panels.size:
            middle, q = 0.5 * (panels.low + panels.high), panels.values.shape[2]
            later.append(Panels.unknown(panels.column, panels.low, middle, q))
            later.append(Panels.unknown(panels.column, middle, panels.high, q))
        return Panels.joined(later) if later else panels

    def _bracket(self, goal, spread, theta):
        """How narrow to bracket a transition at which the values change by ``spread``."""
        goal = _SLIVER * _SHARE * goal
        width = np.min(np.divide(goal, spread, out=np.full_like(goal, np.pi), where=spread > goal / np.pi), axis=1)
        return np.maximum(width, 4 * _EPS * theta)

    def _leave_out(self, column, low, high, low_side, high_side, unsure=None):
        """The sliver of a bracket is left out: for now what it could hold by these values is its value and its error. ``unsure``:
        how much of it may lie on either side, all of it if not given."""
        unsure = high - low if unsure is None else unsure
        value = (high - low)[:, None] * 0.5 * (low_side + high_side)
        np.add.at(self.values, column, value)
        self.slivers.append((column, low, high, unsure, value, unsure[:, None] * np.abs(high_side - low_side)))

    def close_slivers(self) -> None:
        """What the slivers hold, by the panels next to them: to either side of the transition values are as at the ends of
        these."""
        if not self.slivers:
            return
        column, low, high, unsure, value, error = (np.concatenate(v) for v in zip(*self.slivers, strict=True))
        owner, _, starts, ends, first, last = (np.concatenate(v) for v in zip(*self.accepted, strict=True))
        before, after = beside(column, low, owner, ends), beside(column, high, owner, starts)
        known = np.flatnonzero((before >= 0) & (after >= 0))
        sides = np.stack((last[before[known]], first[after[known]]), axis=1)
        # nodes lie like 1 and 4 next to an end: from these to the end, which lies a third further
        places, off = (4 * sides[..., 0, :] - sides[..., 1, :]) / 3, np.abs(sides[..., 1, :] - sides[..., 0, :]).sum(axis=1) / 3
        sliver = (high - low)[known, None]
        better = sliver * 0.5 * places.sum(axis=1)
        np.add.at(self.values, column[known], better - value[known])
        error[known] = unsure[known, None] * 0.5 * np.abs(places[:, 1] - places[:, 0]) + sliver * off
        np.add.at(self.errors, column, error)

    def give_up(self, panels: Panels) -> None:
        """Take panels that do not converge as they are, with the spread of their values as error."""
        where = self.columns
        where.work.limit_reached(where.V[panels.column], where.level.l, "an average over the strips did not converge")
        codes, values = self._at_nodes(panels, interior_nodes(_FIRST))
        width = (panels.high - panels.low)[:, None]
        np.add.at(self.values, panels.column, width * (mapped_weights(_FIRST) @ values))
        np.add.at(self.errors, panels.column, width * (values.max(axis=1) - values.min(axis=1)))
        self._keep(panels, codes[:, 0], values)

    def _keep(self, panels, codes, values):
        """Panels that are summed up, with their values at the two nodes next to either end, the outer one first."""
        self.accepted.append((panels.column, codes, panels.low, panels.high, values[:, :2], values[:, -1:-3:-1]))

    def _accept(self, panels, codes, values, fine, error, rounding):
        # what is not accepted yet counts for the size of the result, not for the result
        total = self.values.copy()
        np.add.at(total, panels.column, fine)
        goal = self.rtol[:, None] * (np.abs(total) + np.pi * self.floor)
        done = (error <= _SHARE * goal[panels.column] + 2 * rounding).all(axis=1)
        if values.shape[1] + 1 < _COSTLESS:
            done &= ~self.columns.costless(codes)
        np.add.at(self.values, panels.column[done], fine[done])
        np.add.at(self.errors, panels.column[done], (error + _TOLD * goal[panels.column] * (error > 0))[done])
        self._keep(panels.take(done), codes[done], values[done])
        return done

    def _doubled(self, panels: Panels, n: int, codes, values):
        """Codes (panels, n - 1) and values (panels, n - 1, q) at the interior nodes, from those at the nodes of n/2."""
        new_codes, new_values = self._at_nodes(panels, interior_nodes(n)[0::2])
        return interleaved(new_codes, codes), interleaved(new_values, values)

    def _at_nodes(self, panels: Panels, t):
        """Codes (panels, nodes) and values (panels, nodes, q) at the parameters ``t``."""
        shape = panels.size, t.size
        theta = panels.low[:, None] + (panels.high - panels.low)[:, None] * mapped(t)
        column, theta = np.repeat(panels.column, t.size), theta.ravel()
        codes, values = self._evaluated(column, theta)
        return codes.reshape(shape), values.reshape(*shape, values.shape[1])

    def _evaluated(self, column, theta) -> list[np.ndarray]:
        """Codes and values of strips (m,); the first time also of the sights."""
        m, first = theta.size, self.sights.codes is None
        if first:
            column, theta = np.concatenate((column, self.sights.column)), np.concatenate((theta, self.sights.theta))
        np.add.at(self.strips, column, 1)
        answers = self.columns.integrand(column, theta)
        if first:
            self.sights.codes, self.sights.values = answers[0][m:], answers[1][m:]
            self._leave_out_met()
        return [answer[:m] for answer in answers]

    def _leave_out_met(self) -> None:
        """Leave out the slivers of the transitions that are known to rounding, now that values at their ends are."""
        met = slice(2 * self.rtol.size, None)
        column, (low, high) = np.split(self.sights.column[met], 2)[0], np.split(self.sights.place[met], 2)
        values = np.split(self.sights.values[met], 2)
        self._leave_out(column, low, high, np.minimum(*values), np.maximum(*values), 2 * self.unsure)

    def _learn_ends(self, panels: Panels) -> None:
        """Fill in what is known of the panels' ends from the sights."""
        sights = self.sights
        if sights.codes is None:
            return
        outermost = panels.low + (np.pi - panels.low) * mapped(interior_nodes(_FIRST)[-1])
        # beyond the strip next to the flat edge a panel may have nodes: then that strip is not its end
        beyond = (panels.high == np.pi) & (outermost >= self._edge()[panels.column])
        for side, place in enumerate((panels.low, np.where(beyond, np.nan, panels.high))):
            at = sights.at(panels.column, place)
            there = np.flatnonzero(at >= 0)
            panels.codes[there, side], panels.values[there, side] = sights.codes[at[there]], sights.values[at[there]]

    def _with_ends(self, panels: Panels, theta, codes, values):
        """Nodes, codes and values with the panels' ends added where these are known (the end nodes twice elsewhere)."""
        places = np.stack((panels.low, np.where(panels.high == np.pi, self._edge()[panels.column], panels.high)), axis=1)
        known, out = panels.known, []
        for ends, inner in ((places, theta), (panels.codes, codes), (panels.values, values)):
            outer = np.where(known.reshape(known.shape + (1,) * (inner.ndim - 2)), ends, inner[:, [0, -1]]).astype(inner.dtype)
            out.append(np.concatenate((outer[:, :1], inner, outer[:, 1:]), axis=1))
        return out

    def _edge(self):
        """Theta next to the flat edge of each column: what lies beyond does not matter at its accuracy."""
        return np.pi * (1 - _EDGE * np.minimum(self.rtol, _ANY))

    def _probe(self, column, theta):
        np.add.at(self.strips, column, 1)
        return self.columns.probe(column, theta)

    def _split_at_transitions(self, panels: Panels, codes, values, n) -> Panels:
        """Locate every transition between neighbouring nodes that disagree; panels end there."""
        t = interior_nodes(n)
        theta = panels.low[:, None] + (panels.high - panels.low)[:, None] * mapped(t)
        if n == _FIRST:
            theta, codes, values = self._with_ends(panels, theta, codes, values)
        row, node = np.nonzero(codes[:, 1:] != codes[:, :-1])
        spread = (values.max(axis=1) - values.min(axis=1))[row]
        # the size of the result is known by what is summed up, and by these panels' own share
        total = self.values + np.pi * self.floor
        np.add.at(total, panels.column, (panels.high - panels.low)[:, None] * np.abs(values).mean(axis=1))
        line = panels.column[row]
        width = self._bracket(self.rtol[line, None] * np.abs(total)[line], spread, theta[row, node + 1])
        low, high, ends = theta[row, node], theta[row, node + 1], (codes[row, node], codes[row, node + 1])
        found = locate(lambda line, x: self._probe(panels.column[line], x), self.columns.guide, row, low, high, *ends, width)
        column = panels.column[found.line]
        self._leave_out(column, found.low, found.high, values.min(axis=1)[found.line], values.max(axis=1)[found.line])
        first = np.concatenate(([True], found.line[1:] != found.line[:-1]))
        last = np.concatenate((found.line[1:] != found.line[:-1], [True]))
        starts = panels.low[found.line]
        starts[~first] = found.high[np.flatnonzero(~first) - 1]
        tail = found.line[last]
        every = np.concatenate((column, panels.column[tail]))
        starts, ends = np.concatenate((starts, found.high[last])), np.concatenate((found.low, panels.high[tail]))
        parts = Panels.unknown(every, starts, ends, values.shape[2])
        # codes alone: what is known of the ends of other panels is too far off
        parts.codes[: found.line.size, 1] = found.codes[:, 0]
        parts.codes[: found.line.size][~first, 0] = found.codes[np.flatnonzero(~first) - 1, 1]
        parts.codes[found.line.size :, 0] = found.codes[last, 1]
        return parts
