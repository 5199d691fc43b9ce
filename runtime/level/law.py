"""Friction laws of a level: what it carries at a given nominal pressure, on one branch of loading.

A law is a stack of smooth segments in disjoint intervals of pressure, at first one for each branch of the curve (``branches``);
it may jump between them. Where their pressures do not meet, as the curve itself jumps, it is as at the beginning of the next.

Every break of a law leaves kinks behind in the laws of all levels above, three for one and ever weaker ones; each costs panels
over x, y and penetration. So neighbouring segments are ``merged`` where a smooth function is as good as both.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .branches import branches_of, graded, meets, parameter
from .breaks import ONE_BREAK
from .curve import trace
from .error_budget import ErrorBudget
from .saturated import Saturation
from .segment import SLOTS, Cells, Segment, cells_of, segments_of, slot
from .strips import LevelBatch, cut_penetration

#: part of what a law may err that merging may take: laws err by less than a tenth of that
_SHARE = 0.2
#: slots of the smallest cell: a function that takes smaller ones is not smooth enough for few nodes to see all of it
_FINEST = SLOTS // 16
#: parameters at which a merged segment is held against the law; how much more than is seen is feared: of 42 laws none erred by
#: more than a fortieth of it
_CHECKS, _SAFE = np.linspace(0, 1, 130)[1:-1], 1.5
#: how far to either side of a joint its jump is looked at, of all parameters; steps along a segment over which its slope is told
_BESIDE, _STEPS = 1e-6, 32


@dataclass(frozen=True)
class Laws:
    """Means of a level over nominal pressure at n velocities, evaluated for any mixture of them at once.

    Attributes:
        segments: of each law, in order of rising pressure. pull_off: below it there is no contact, (n,).
        p_sat: pressure of saturated contact, (n,); ``saturated`` are the means there, (n, q) (from there on constant, but for
            pressure).
        top: largest pressure a law is known for, to rounding (inf, unless it was cut below ``p_sat``), (n,).
        strips: evaluated for each, (n,). unloading: the branch of loading they follow.
    """

    segments: list[list[Segment]]
    pull_off: np.ndarray
    p_sat: np.ndarray
    saturated: np.ndarray
    top: np.ndarray
    strips: np.ndarray
    unloading: bool

    @property
    def frictions(self) -> np.ndarray:
        """Where the frictions, the level's own and those it carries, stand among the quantities after pressure."""
        return 3 * np.arange(self.saturated.shape[1] // 4)

    @property
    def friction_error(self) -> np.ndarray:
        """Bound of the interpolation error of friction, its own and what it carries, Pa, (n,)."""
        most = [np.max([s.errors.most[1 + self.frictions] for s in row], axis=0, initial=0.0) for row in self.segments]
        return np.array([(_SAFE * error).sum() for error in most])

    @cached_property
    def greatest(self) -> np.ndarray:
        """The largest magnitude of every quantity after pressure, (n, q - 1)."""
        every = zip(self.segments, np.abs(self.saturated), strict=True)
        return np.array([np.max([saturated, *(s.cells.greatest for s in row)], axis=0)[1:] for row, saturated in every])

    @cached_property
    def breaks(self) -> np.ndarray:
        """Pressures at which each law jumps or is not smooth, from pull-off to saturation, ascending, (n, B), padded with inf."""
        rows = []
        for segments, pull_off, p_sat in zip(self.segments, self.pull_off, self.p_sat, strict=True):
            ends = [s.p_low for s in segments if not s.inner_low] + [s.p_high for s in segments if not s.inner_high]
            points = np.unique([e for e in [*ends, pull_off, p_sat] if -np.inf < e <= p_sat])
            # segments that follow one another meet to rounding
            rows.append(points[np.diff(points, append=np.inf) > ONE_BREAK * np.abs(points).max(initial=0.0)])
        return _padded(rows)

    @cached_property
    def at_breaks(self) -> tuple[np.ndarray, np.ndarray]:
        """Change of all friction, own and carried, over where each break may be, and how well that is known, Pa, (n, B) both."""
        # what has no segments is saturated from pull-off on
        everywhere = np.abs(self.saturated[:, 1 + self.frictions]).sum(axis=1, keepdims=True)
        jumps, known_to = np.where(np.isfinite(self.breaks), everywhere, 0.0), np.zeros(self.breaks.shape)
        group, j = np.nonzero(np.isfinite(self.breaks) & np.array([len(row) > 0 for row in self.segments])[:, None])
        if group.size:
            p, sides = self.breaks[group, j], (np.maximum(j - 1, 0), j)
            # a segment is left at one of its ends, and that tells where the law goes over to the next one
            ends = (self._ends[end, self._between[end][group, at]] for end, at in zip((1, 0), sides, strict=True))
            known, near = (self.smooth(group, interval, p[None])[1][1, 0] for interval in sides), ONE_BREAK * np.abs(p).max()
            errors = [np.where(np.abs(end - p) <= near, error, 0.0) for end, error in zip(ends, known, strict=True)]
            left, entered = errors[::-1] if self.unloading else errors
            known_to[group, j] = shift = np.where(left > 0, left, entered)
            # at the break, and from before all pressures where it may be to beyond them: frictions may be steep there
            changes = []
            for reach in (0.0, shift):
                places = zip(sides, (p - reach, p + reach), strict=True)
                below, above = (self.smooth(group, interval, at[None])[0][self.frictions, 0] for interval, at in places)
                below = np.where(p > self.pull_off[group], below, 0.0)
                above = np.where(p < self.p_sat[group], above, self.saturated[group][:, 1 + self.frictions].T)
                changes.append(np.abs(above - below).sum(axis=0))
            jumps[group, j] = np.maximum(*changes)
        return jumps, known_to

    @cached_property
    def _ends(self) -> np.ndarray:
        """Pressures at which all segments, those of one law after another, begin and end, (2, segments)."""
        return np.array([(s.p_low, s.p_high) for row in self.segments for s in row]).T

    @cached_property
    def _cells(self) -> Cells:
        """Quantities of all segments after pressure."""
        return Cells.joined([s.cells for row in self.segments for s in row], slice(1, None))

    @cached_property
    def _errors(self) -> np.ndarray:
        """Errors of friction, its own and what it carries, and of pressure in the middle of every slot, (2, slots). Those of
        pressure are in those of friction too, by its slope, up to all that it changes by along the segment."""
        share, columns = graded((np.arange(SLOTS) + 0.5) / SLOTS), 1 + self.frictions
        every = [(s.errors, s.p_low + (s.p_high - s.p_low) * share) for row in self.segments for s in row]
        friction, pressure = np.array([[errors.along(p, which) for errors, p in every] for which in (columns, [0])])
        (low, high), u = self._ends, np.linspace(0, 1, _STEPS + 1)
        change = np.abs(np.diff(self._cells(*np.broadcast_arrays(u, np.arange(low.size)[:, None]))[self.frictions])).sum(axis=0)
        slope = np.repeat(change / (np.diff(graded(u)) * (high - low)[:, None]), SLOTS // _STEPS, axis=1)
        return np.stack((friction + np.minimum(slope * pressure, change.sum(axis=1)[:, None]), pressure)).reshape(2, -1)

    @cached_property
    def _between(self) -> list[np.ndarray]:
        """The first and the last segment between each break and the next, (n, B) both."""
        counts = np.array([len(row) for row in self.segments])
        upper = _padded([np.array([s.p_high for s in row]) for row in self.segments])
        breaks = np.concatenate((self.breaks, np.full((counts.size, 1), np.inf)), axis=1)
        apart = ONE_BREAK * np.abs(np.where(np.isfinite(breaks), breaks, 0.0)).max(axis=1, keepdims=True)
        ends = [np.count_nonzero(upper[:, None] < p[:, :, None], axis=2) for p in (breaks[:, :-1] + apart, breaks[:, 1:] - apart)]
        start, last = np.cumsum(counts) - counts, np.maximum(counts - 1, 0)
        return [start[:, None] + np.minimum(count, last[:, None]) for count in ends]

    def smooth(self, group: np.ndarray, interval: np.ndarray, p: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Quantities after pressure (q - 1, nodes, m), errors of friction and pressure (2, nodes, m), and how many segments,
        by their parameters, the nodes span (m,); at pressures ``p`` (nodes, m) of the laws ``group`` (m,), between their breaks
        ``interval`` (m,) and the next ones."""
        which, final = (segment[group, interval] for segment in self._between)
        low, high = self._ends
        # mostly there is one segment between two breaks
        for _ in range((final - which).max(initial=0)):
            which = which + ((which < final) & (p > high[which]))
        share = (p - low[which]) / (high - low)[which]
        u = parameter(np.minimum(np.maximum(share, 0.0, out=share), 1.0, out=share))
        return self._cells(u, which), self._errors[:, slot(u, which)], np.ptp(which + u, axis=0)

    def in_segments(self, group: np.ndarray, p: np.ndarray) -> np.ndarray:
        """Quantities of the laws ``group`` at the pressures ``p``, both (m,), that segments are for, shape (m, q)."""
        interval = np.maximum(np.count_nonzero(self.breaks[group] < p[:, None], axis=1) - 1, 0)
        return np.concatenate((p[None], self.smooth(group, interval, p[None])[0][:, 0])).T

    def __call__(self, group: np.ndarray, p: np.ndarray) -> np.ndarray:
        """Quantities (m, q) of the laws ``group`` at pressures ``p``, (m,) both: 0 below pull-off, saturated above ``p_sat``."""
        out = np.where(p[:, None] < self.p_sat[group, None], 0.0, self.saturated[group])
        out[:, 0] = p
        inside = np.flatnonzero((p >= self.pull_off[group]) & (p < self.p_sat[group]))
        if inside.size:
            out[inside] = self.in_segments(group[inside], p[inside])
        return out


def _padded(rows: Sequence[np.ndarray]) -> np.ndarray:
    """Rows of different lengths as one array, at least one wide, with inf for what is not there."""
    out = np.full((len(rows), max((row.size for row in rows), default=1) or 1), np.inf)
    for row, values in zip(out, rows, strict=True):
        row[: values.size] = values
    return out


def _joined(kept: list[Segment], p_sat: float, end: float) -> list[Segment]:
    """The segments up to saturation; those that end where another begins, but for their errors, end there: that is one break.
    The last one ends at ``end``: that is ``p_sat``, or inf where the law is but cut."""
    kept = [s for s in kept if s.p_low < p_sat]
    ends = [*(s.p_low for s in kept[1:]), end]
    return [
        replace(s, p_high=end) if meets(s, abs(end - s.p_high)) else s for s, end in zip(kept, ends[: len(kept)], strict=True)
    ]


def build_laws(
    columns: LevelBatch, rtol: np.ndarray, atol: np.ndarray, saturated: Saturation, p_max: np.ndarray, budget: ErrorBudget | None
) -> Laws:
    """The law of every column (its ``D`` is not used) along its branch, as far up as it is asked for, to ``rtol |value| + atol``.

    ``p_max`` (n,): greatest pressure that will be asked for, inf for the whole law. ``budget``: how much its pressures count."""
    top, unloading = cut_penetration(columns, p_max, saturated.D), columns.branch == "unloading"
    p_max = np.where(top < saturated.D, p_max, np.inf)
    curves, strips = trace(columns, rtol, atol, top, budget)
    kept = branches_of(curves, unloading)
    branches = [(branch, 1e-15 * np.abs(means)) for row, means in zip(kept, saturated.means, strict=True) for branch in row]
    tolerance = np.array([np.maximum(branch.errors.most, least) for branch, least in branches])
    every = iter(segments_of([branch for branch, _ in branches], tolerance))
    ends = zip(kept, saturated.p, np.where(p_max < np.inf, np.inf, saturated.p), strict=True)
    segments = [_joined([next(every) for _ in row], *end) for row, *end in ends]
    pull_off = np.array([row[0].p_low if row else end for row, end in zip(kept, saturated.p, strict=True)])
    top = np.array([row[-1].p_high if row and end < np.inf else end for row, end in zip(segments, p_max, strict=True)])
    top += ONE_BREAK * np.where(np.isfinite(top), np.abs(top), 0.0)
    return Laws(segments, pull_off, saturated.p, saturated.means, top, strips, unloading)


def merged(laws: Laws, rtol: np.ndarray, atol: np.ndarray) -> Laws:
    """The laws with as few segments as stand for them to a part of ``rtol |value| + atol``, ``rtol`` (n,) and ``atol``
    (n, q); what that adds to their errors is added."""
    rows = [list(row[:1]) for row in laws.segments]
    # errors before merging: what one merger adds is not added again by the next
    before = [row[0].errors if row else None for row in rows]
    for k in range(1, max(len(row) for row in laws.segments)):
        pairs = [(i, rows[i][-1], row[k]) for i, row in enumerate(laws.segments) if k < len(row)]
        for (i, low, high), (cells, error) in zip(pairs, _fits(laws, pairs, rtol, atol), strict=True):
            if cells is None:
                rows[i].append(high)
                before[i] = high.errors
            else:
                before[i] = before[i].then(high.errors)
                rows[i][-1] = Segment(low.p_low, high.p_high, cells, before[i].plus(error), low.inner_low, high.inner_high)
    return replace(laws, segments=rows)


def _fits(laws: Laws, pairs: list[tuple[int, Segment, Segment]], rtol, atol) -> list[tuple[Cells | None, np.ndarray]]:
    """Cells that stand for both segments of each pair (law, low, high), with the error that brings; None where there are none."""
    law = np.array([i for i, *_ in pairs])
    low, joint, high = (np.array(v) for v in zip(*((a.p_low, a.p_high, b.p_high) for _, a, b in pairs), strict=True))

    def at(which, u):
        return laws.in_segments(law[which], low[which] + (high - low)[which] * graded(u))

    beside = parameter((joint - low) / (high - low))[:, None] + np.array([-_BESIDE, _BESIDE])
    u = np.concatenate((np.tile(_CHECKS, (law.size, 1)), np.clip(beside, 0.0, 1.0)), axis=1)
    known = at(np.repeat(np.arange(law.size), u.shape[1]), u.ravel()).reshape(*u.shape, -1)
    allowed = _SHARE * (rtol[law, None] * np.abs(known).min(axis=1) + atol[law])
    # a pressure is what it is
    allowed[:, 0] = np.inf
    cells = cells_of(at, allowed, _FINEST)
    fitted = np.array([each(row).T for each, row in zip(cells, u, strict=True)])
    error = _SAFE * np.maximum(np.abs(fitted - known).max(axis=1), np.abs(known[:, -1] - known[:, -2]))
    error[:, 0] = 0.0
    good = (error <= allowed).all(axis=1) & [not each.error.any() for each in cells]
    return [(each, err) if ok else (None, err) for each, err, ok in zip(cells, error, good, strict=True)]
