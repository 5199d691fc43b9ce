"""Averages over y by panels between the transitions of regime.

Inside a panel every strip is in the same regime and the integrand is smooth, but for its ends, where a strip may detach
like a square root at a fold. The substitution ``theta = low + width sin^2(pi t/2)`` turns such an end into a smooth one, and
Clenshaw-Curtis sums in t, doubled on nested nodes, converge geometrically. Where nodes of one panel disagree about the
regime, the transition between them is located by bisection and the panel is split there.

All panels of all columns (a column is one velocity and one penetration) advance together: one batch of strips per round.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from .transitions import locate

#: (column, theta) -> (regime code, values): arrays (m,), (m,) -> (m,), (m, q)
Integrand = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]

#: (column, theta) -> the integrand's codes alone
Codes = Callable[[np.ndarray, np.ndarray], np.ndarray]

_FIRST, _LAST = 8, 64
_ROUNDS = 60
#: panels a column may have waiting at once
_CROWD = 150
_EPS = np.finfo(float).eps
#: how much the last doubling may be trusted to have gained over the one before
_GAIN = 0.5


@dataclass(slots=True)
class Averages:
    """Means over the cell: values and error estimates of shape (columns, q); strips evaluated per column.

    ``zones``: for each column the codes met along y, one row (code, low, high) for each run of panels that share it.
    """

    values: np.ndarray
    errors: np.ndarray
    strips: np.ndarray
    zones: list[np.ndarray] = field(default_factory=list)


@dataclass(slots=True)
class _Panels:
    column: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def take(self, index):
        return _Panels(self.column[index], self.low[index], self.high[index])

    @property
    def size(self):
        return self.column.size


def average(
    integrand: Integrand, codes_at: Codes, starts: list[np.ndarray], floor: np.ndarray, rtol: np.ndarray, q: int
) -> Averages:
    """Means ``(1/pi) int_0^pi values d(theta)`` of every column to ``rtol (|value| + floor)``.

    ``starts``: for each column the interior thetas known to be transitions, sorted. ``floor`` and ``rtol`` have shape
    (columns, q) and (columns,).
    """
    n = len(starts)
    edges = [np.concatenate(([0.0], s, [np.pi])) for s in starts]
    panels = _Panels(
        np.repeat(np.arange(n), [e.size - 1 for e in edges]),
        np.concatenate([e[:-1] for e in edges]),
        np.concatenate([e[1:] for e in edges]),
    )
    work = _Work(integrand, codes_at, floor, rtol, np.zeros((n, q)), np.zeros((n, q)), np.zeros(n, int), [])
    for _ in range(_ROUNDS):
        panels = work.refine(panels.take(np.flatnonzero(panels.high > panels.low)))
        # at a penetration where strips sit on a threshold all along y, rounding decides each: no use in splitting further
        crowded = np.bincount(panels.column, minlength=n)[panels.column] > _CROWD
        if crowded.any():
            work.give_up(panels.take(np.flatnonzero(crowded)))
            panels = panels.take(np.flatnonzero(~crowded))
        if not panels.size:
            break
    else:
        work.give_up(panels)
    return Averages(work.values / np.pi, work.errors / np.pi, work.strips, work.zones())


@dataclass(slots=True)
class _Work:
    integrand: Integrand
    codes_at: Codes
    floor: np.ndarray
    rtol: np.ndarray
    values: np.ndarray
    errors: np.ndarray
    strips: np.ndarray
    accepted: list[tuple]

    def zones(self) -> list[np.ndarray]:
        """See ``Averages.zones``."""
        column, code, low, high = (np.concatenate(v) for v in zip(*self.accepted, strict=True))
        order = np.lexsort((low, column))
        column, code, low, high = column[order], code[order], low[order], high[order]
        rows = np.stack((code, low, high), axis=1)
        out = []
        for part in np.split(rows, np.searchsorted(column, np.arange(1, self.strips.size))):
            first = np.concatenate(([True], part[1:, 0] != part[:-1, 0])) if part.size else np.empty(0, bool)
            runs = part[first]
            if runs.size:
                runs[:, 2] = np.append(part[np.flatnonzero(first)[1:] - 1, 2], part[-1, 2])
            out.append(runs)
        return out

    def refine(self, panels: _Panels) -> _Panels:
        """Accept what converges under doubling; return what has to be split."""
        later = []
        nodes = None
        previous = None
        n = _FIRST
        while panels.size and n <= _LAST:
            codes, values = self._sample(panels, n, nodes)
            mixed = (codes != codes[:, :1]).any(axis=1)
            if mixed.any():
                later.append(self._split_at_transitions(panels.take(mixed), codes[mixed], values[mixed], n))
            keep = ~mixed
            panels, codes, values = panels.take(keep), codes[keep], values[keep]
            width = (panels.high - panels.low)[:, None]
            fine = width * np.einsum("j,pjq->pq", mapped_weights(n), values)
            coarse = width * np.einsum("j,pjq->pq", mapped_weights(n // 2), values[:, 1::2])
            change = np.abs(fine - coarse)
            if previous is None:
                coarser = width * np.einsum("j,pjq->pq", mapped_weights(n // 4), values[:, 3::4])
                before = np.abs(coarse - coarser)
            else:
                before = previous[keep]
            gain = np.divide(change, before, out=np.ones_like(change), where=before > change)
            rounding = 4 * _EPS * width * np.max(np.abs(values), axis=1, initial=0.0)
            error = change * np.maximum(gain, _GAIN) + rounding
            done = self._accept(panels, codes[:, 0], fine, error, rounding)
            rest = ~done
            panels, nodes, previous = panels.take(rest), (codes[rest], values[rest]), change[rest]
            n *= 2
        if panels.size:
            middle = 0.5 * (panels.low + panels.high)
            later.append(_Panels(panels.column, panels.low, middle))
            later.append(_Panels(panels.column, middle, panels.high))
        if not later:
            return panels
        return _Panels(*(np.concatenate([getattr(p, f) for p in later]) for f in ("column", "low", "high")))

    def give_up(self, panels: _Panels) -> None:
        """Take panels that do not converge as they are, with the spread of their values as error."""
        codes, values = self._sample(panels, _FIRST, None)
        width = (panels.high - panels.low)[:, None]
        np.add.at(self.values, panels.column, width * np.einsum("j,pjq->pq", mapped_weights(_FIRST), values))
        np.add.at(self.errors, panels.column, width * (values.max(axis=1) - values.min(axis=1)))
        self.accepted.append((panels.column, codes[:, 0], panels.low, panels.high))

    def _tolerance(self, column):
        goal = self.rtol[:, None] * (np.abs(self.values) + np.pi * self.floor)
        return 0.2 * goal[column]

    def _accept(self, panels, codes, fine, error, rounding):
        # what is not accepted yet counts for the size of the result, not for the result
        total = self.values.copy()
        np.add.at(total, panels.column, fine)
        goal = self.rtol[:, None] * (np.abs(total) + np.pi * self.floor)
        done = (error <= 0.2 * goal[panels.column] + 2 * rounding).all(axis=1)
        np.add.at(self.values, panels.column[done], fine[done])
        np.add.at(self.errors, panels.column[done], error[done])
        self.accepted.append((panels.column[done], codes[done], panels.low[done], panels.high[done]))
        return done

    def _sample(self, panels: _Panels, n: int, known):
        """Codes (panels, n - 1) and values (panels, n - 1, q) at the interior nodes; ``known`` are those of n/2."""
        t = interior_nodes(n)
        if known is not None:
            t = t[0::2]
        theta = panels.low[:, None] + (panels.high - panels.low)[:, None] * np.sin(0.5 * np.pi * t) ** 2
        column = np.broadcast_to(panels.column[:, None], theta.shape)
        np.add.at(self.strips, column.ravel(), 1)
        codes, values = self.integrand(column.ravel(), theta.ravel())
        codes, values = codes.reshape(theta.shape), values.reshape(*theta.shape, -1)
        if known is None:
            return codes, values
        all_codes = np.empty((panels.size, n - 1), codes.dtype)
        all_values = np.empty((panels.size, n - 1, values.shape[2]))
        all_codes[:, 0::2], all_codes[:, 1::2] = codes, known[0]
        all_values[:, 0::2], all_values[:, 1::2] = values, known[1]
        return all_codes, all_values

    def _codes(self, column, theta):
        np.add.at(self.strips, column, 1)
        return self.codes_at(column, theta)

    def _split_at_transitions(self, panels: _Panels, codes, values, n) -> _Panels:
        """Locate every transition between neighbouring nodes that disagree; panels end there."""
        t = interior_nodes(n)
        theta = panels.low[:, None] + (panels.high - panels.low)[:, None] * np.sin(0.5 * np.pi * t) ** 2
        row, node = np.nonzero(codes[:, 1:] != codes[:, :-1])
        spread = (values.max(axis=1) - values.min(axis=1))[row]
        goal = 0.02 * self._tolerance(panels.column[row])
        width = np.min(np.divide(goal, spread, out=np.full_like(goal, np.pi), where=spread > goal / np.pi), axis=1)
        width = np.maximum(width, 4 * _EPS * theta[row, node + 1])
        found = locate(
            lambda line, x: self._codes(panels.column[line], x),
            row,
            theta[row, node],
            theta[row, node + 1],
            codes[row, node],
            codes[row, node + 1],
            width,
        )
        # the sliver of a bracket is left out: what it could hold is its value and its error
        column, sliver = panels.column[found.line], (found.high - found.low)[:, None]
        low_side, high_side = values.min(axis=1)[found.line], values.max(axis=1)[found.line]
        np.add.at(self.values, column, sliver * 0.5 * (low_side + high_side))
        np.add.at(self.errors, column, sliver * 0.5 * (high_side - low_side))
        first = np.concatenate(([True], found.line[1:] != found.line[:-1]))
        last = np.concatenate((found.line[1:] != found.line[:-1], [True]))
        starts = panels.low[found.line]
        starts[~first] = found.high[np.flatnonzero(~first) - 1]
        tail = found.line[last]
        return _Panels(
            np.concatenate((column, panels.column[tail])),
            np.concatenate((starts, found.high[last])),
            np.concatenate((found.low, panels.high[tail])),
        )


@lru_cache
def interior_nodes(n: int) -> np.ndarray:
    """Interior Clenshaw-Curtis nodes on (0, 1)."""
    j = np.arange(1, n)
    return np.sin(0.5 * np.pi * j / n) ** 2


@lru_cache
def mapped_weights(n: int) -> np.ndarray:
    """Clenshaw-Curtis weights at the interior nodes, times the derivative of the substitution (zero at both ends)."""
    j = np.arange(1, n)
    m = np.arange(1, n // 2 + 1)
    b = np.where(m == n / 2, 1.0, 2.0)
    angle = 2 * np.outer(j, m) * np.pi / n
    weights = (2 / n) * (1 - (b * np.cos(angle) / (4 * m**2 - 1)).sum(axis=1)) / 2
    return weights * 0.5 * np.pi * np.sin(np.pi * interior_nodes(n))
