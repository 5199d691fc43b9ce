"""Friction law of a level: what it carries at a given nominal pressure, on one branch of loading.

Unloading follows the largest penetration at which the level carries the pressure: from saturation downwards a part of the curve
counts only where its pressure lies below everything above it. Loading follows the smallest: from the first contact upwards
only where the pressure lies above everything below. What remains is a stack of monotone branches in disjoint intervals of
pressure; the law may jump between them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .cells import Cells
from .chebyshev import Piece, parameter
from .curve import Curve
from .resample import Inverse, resampled

_GRID = np.linspace(0, 1, 65)
#: parameters at which turns are looked for: one may hide next to an end, where every piece is flat
_NEAR = 0.5 ** np.arange(10, 6, -1)
_TURNS = np.concatenate(([0.0], _NEAR, _GRID[1:-1], 1 - _NEAR[::-1], [1.0]))
_EPS = np.finfo(float).eps
#: points looked at at once where one is narrowed down, and rounds
_INSIDE, _NARROWINGS = np.linspace(0, 1, 17)[1:-1], 14


@dataclass(frozen=True, slots=True)
class Branch:
    """A monotone part of a curve: piece and parameters between which pressure rises from ``p_low`` to ``p_high``.

    ``cells``: its quantities over u, ``p = p_low + (p_high - p_low) graded(u)``, in which they are smooth where they are over the
    piece's own parameter, and where the curve turns.
    ``soft_low``, ``soft_high``: the law goes on smoothly beyond that end, in another branch.
    """

    piece: Piece
    t_low: float
    t_high: float
    p_low: float
    p_high: float
    cells: Cells | None = None
    soft_low: bool = False
    soft_high: bool = False

    def values(self, p: np.ndarray) -> np.ndarray:
        """Quantities at the pressures ``p`` (m,), shape (m, q)."""
        if self.cells is None:
            return self.piece.values(self.parameter(p))
        share = np.clip((p - self.p_low) / (self.p_high - self.p_low), 0.0, 1.0)
        return self.cells(parameter(share))

    def parameter(self, p: np.ndarray) -> np.ndarray:
        """t at which the pressure is ``p`` (m,), clipped to the branch."""
        return Inverse([self]).parameter(np.zeros(p.size, int), p)

    def reaches(self, p: float) -> float:
        """t at which the one pressure ``p`` is reached, clipped to the branch."""
        if p <= self.p_low:
            return self.t_low
        if p >= self.p_high:
            return self.t_high
        return _where_it_ends(lambda t: self.piece.first(t)[0] < p, self.t_low, self.t_high)


def branches(curve: Curve, unloading: bool) -> list[Branch]:
    """Branches that load control follows, in order of rising pressure."""
    parts = [part for piece in curve.pieces for part in rising(piece)]  # from high D to low D
    kept = []
    if unloading:
        least = np.inf
        for part in parts:
            cut = _below(part, least)
            if cut is not None:
                kept.append(cut)
                least = cut.p_low
        return kept[::-1]
    # while the first strips cling the pressure falls with D: what seems to rise there is known to, or it does not count
    certain = (k for k, part in enumerate(reversed(parts)) if part.p_high - part.p_low > 2 * part.piece.error[0])
    most = -np.inf
    for part in parts[::-1][next(certain, 0) :]:
        cut = _above(part, most)
        if cut is not None:
            kept.append(cut)
            most = cut.p_high
    return kept


def rising(piece: Piece) -> list[Branch]:
    """Maximal parts of a piece in which pressure rises with D, from high to low D."""
    value = piece.first(_TURNS)[0]
    steps, last = np.diff(value), _TURNS.size - 1
    rising = steps > 0
    # next to the ends rounding tells nothing: there it goes on as before
    rounded = np.abs(steps) <= 16 * _EPS * np.abs(value).max()
    for inner in range(_NEAR.size, 0, -1):
        for outer, k in ((inner - 1, inner), (last - inner, last - inner - 1)):
            rising[outer] = rising[k] if rounded[outer] else rising[outer]
    parts = []
    i = len(rising)
    while i > 0:
        if not rising[i - 1]:
            i -= 1
            continue
        j = i
        while i > 0 and rising[i - 1]:
            i -= 1
        t_low = _turn(piece, max(i - 1, 0), min(i + 1, last), falls_first=True) if i > 0 else 0.0
        t_high = _turn(piece, max(j - 1, 0), min(j + 1, last), falls_first=False) if j < last else 1.0
        ends = piece.first(np.array([t_low, t_high]))[0]
        if t_high > t_low and ends[1] > ends[0]:
            soft = piece.soft_low and t_low == 0.0, piece.soft_high and t_high == 1.0
            parts.append(Branch(piece, t_low, t_high, float(ends[0]), float(ends[1]), None, *soft))
    return parts


def _turn(piece: Piece, i: int, j: int, falls_first: bool) -> float:
    """Zero of dp/dt between points i and j of ``_TURNS``, before which pressure falls or rises: at an end its slope says
    nothing."""
    return _where_it_ends(lambda t: (piece.first(t)[1] < 0) == falls_first, _TURNS[i], _TURNS[j])


def _where_it_ends(holds: Callable[[np.ndarray], np.ndarray], low: float, high: float) -> float:
    """Point between two up to which something ``holds`` ((k,) -> (k,))."""
    for _ in range(_NARROWINGS):
        inside = low + (high - low) * _INSIDE
        before = holds(inside)
        k = int(np.argmin(before)) if not before.all() else before.size
        low, high = (low if k == 0 else inside[k - 1]), (high if k == before.size else inside[k])
    return float(0.5 * (low + high))


def _below(part: Branch, least: float) -> Branch | None:
    if part.p_low >= least:
        return None
    if part.p_high <= least:
        return part
    t = part.reaches(least)
    soft = part.soft_high and _meets(part, part.p_high - least)
    return replace(part, t_high=t, p_high=least, soft_high=soft) if t > part.t_low else None


def _above(part: Branch, most: float) -> Branch | None:
    if part.p_high <= most:
        return None
    if part.p_low >= most:
        return part
    t = part.reaches(most)
    soft = part.soft_low and _meets(part, most - part.p_low)
    return replace(part, t_low=t, p_low=most, soft_low=soft) if part.t_high > t else None


def _meets(part: Branch, overlap: float) -> bool:
    """Whether a part overlaps its neighbour by no more than the curve is uncertain: then they are one."""
    return overlap <= 2 * part.piece.error[0] + 64 * _EPS * (abs(part.p_low) + abs(part.p_high))


def _joined(kept: list[Branch], p_sat: float) -> list[Branch]:
    """The branches, those stretched that end next to where another begins, or at saturation, but for their errors: there is one
    break of the law, not two."""
    ends = [*(b.p_low for b in kept[1:]), p_sat]
    return [
        replace(b, p_high=end) if _meets(b, abs(end - b.p_high)) else b for b, end in zip(kept, ends[: len(kept)], strict=True)
    ]


@dataclass(frozen=True)
class Law:
    """Means of a level over nominal pressure at one velocity.

    Attributes:
        branches: in order of rising pressure. pull_off: below it there is no contact.
        p_sat: pressure of saturated contact; ``saturated`` are the means there (from there on constant, but for pressure).
        p_top: largest pressure the law was built for (``p_sat``, unless it was cut below that).
        error: bound of the interpolation error of each quantity, (q,).
        unloading: the branch of loading it follows.
    """

    branches: list[Branch]
    pull_off: float
    p_sat: float
    saturated: np.ndarray
    p_top: float
    error: np.ndarray
    strips: int
    unloading: bool

    @property
    def friction_columns(self) -> np.ndarray:
        """Where the frictions, the level's own and those it carries, stand among the quantities after pressure."""
        below = (self.saturated.size - 4) // 4
        return 3 * np.arange(1 + below)

    @property
    def friction_error(self) -> float:
        """Bound of the interpolation error of friction, its own and what it carries, Pa."""
        return float(self.error[1 + self.friction_columns].sum())

    @property
    def breaks(self) -> np.ndarray:
        """Pressures at which the law jumps or is not smooth, ascending, from pull-off to saturation."""
        ends = [b.p_low for b in self.branches if not b.soft_low] + [b.p_high for b in self.branches if not b.soft_high]
        ends = np.unique([e for e in [*ends, self.pull_off, self.p_sat] if -np.inf < e <= self.p_sat])
        # branches that follow one another meet to rounding
        apart = np.diff(ends, append=np.inf) > 1e-12 * np.abs(ends).max(initial=0.0)
        return ends[apart]

    def at_breaks(self) -> tuple[np.ndarray, np.ndarray]:
        """Change of friction, its own and what it carries, at each break, and how well the pressure of the break is known, Pa."""
        p = self.breaks
        jumps, errors = np.zeros(p.size), np.zeros(p.size)
        columns = 1 + self.friction_columns
        # just to either side: what the law says there belongs to one branch each
        aside = 1e-9 * (np.abs(p) + np.abs(p).max(initial=0.0))
        jumps = np.abs(self(p + aside)[:, columns] - self(p - aside)[:, columns]).sum(axis=1)
        for b in self.branches:
            # a branch is left at one of its ends, and that tells where the law goes over to the next one
            left, entered = (b.p_low, b.p_high) if self.unloading else (b.p_high, b.p_low)
            errors[np.abs(p - left) <= aside] = b.piece.error[0]
            outermost = (np.abs(p - entered) <= aside) & (errors == 0)
            errors[outermost] = b.piece.error[0]
        return jumps, errors

    def __call__(self, p: np.ndarray) -> np.ndarray:
        """Quantities at the nominal pressures ``p`` (m,), shape (m, q): zero below pull-off, saturated above ``p_sat``."""
        out = np.zeros((p.size, self.saturated.size))
        out[:, 0] = p
        high = p >= self.p_sat
        out[high, 1:] = self.saturated[1:]
        rest = np.flatnonzero(~high & (p >= self.pull_off))
        if not rest.size or not self.branches:
            return out
        upper = np.array([b.p_high for b in self.branches])
        which = np.minimum(np.searchsorted(upper, p[rest]), len(self.branches) - 1)
        for i, branch in enumerate(self.branches):
            here = rest[which == i]
            if here.size:
                out[here] = branch.values(p[here])
        return out


def laws_of(curves: Sequence[Curve], unloading: bool, p_sat: np.ndarray, saturated: np.ndarray, cut: np.ndarray) -> list[Law]:
    """The friction laws along one branch of loading of traced curves. ``p_sat``, ``cut`` (n,): pressures of saturation, and
    whether a curve ends before it; ``saturated`` (n, q): means there."""
    kept = [branches(curve, unloading) for curve in curves]
    flat = [b for row in kept for b in row]
    least = np.repeat(1e-15 * np.abs(saturated), [len(row) for row in kept], axis=0)
    errors = np.array([b.piece.error for b in flat]).reshape(least.shape)
    fine = iter(resampled(flat, np.maximum(errors, least)))
    out = []
    for i, (curve, row) in enumerate(zip(curves, kept, strict=True)):
        error = np.max([b.piece.error for b in row], axis=0) if row else np.zeros(saturated.shape[1])
        joined = _joined([next(fine) for _ in row], p_sat[i])
        pull_off, p_top = (row[0].p_low if row else p_sat[i]), (joined[-1].p_high if cut[i] and row else p_sat[i])
        out.append(
            Law(joined, float(pull_off), float(p_sat[i]), saturated[i], float(p_top), 1.5 * error, curve.strips, unloading)
        )
    return out
