"""Friction law of a level: what it carries at a given nominal pressure, on one branch of loading.

The law is a stack of smooth segments in disjoint intervals of pressure, at first one for each branch of the curve
(``branches.py``); it may jump between them. Between segments whose pressures do not meet, where the curve itself jumps, it is
what it is at the beginning of the next one.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .branches import branches_of, meets
from .curve import trace
from .error_budget import ErrorBudget
from .inverse import cut_penetration
from .segment import Segment, segments_of
from .strips import LevelBatch


def _joined(kept: list[Segment], p_sat: float) -> list[Segment]:
    """The segments, those stretched that end next to where another begins, or at saturation, but for their errors: there is one
    break of the law, not two."""
    ends = [*(s.p_low for s in kept[1:]), p_sat]
    return [
        replace(s, p_high=end) if meets(s, abs(end - s.p_high)) else s for s, end in zip(kept, ends[: len(kept)], strict=True)
    ]


@dataclass(frozen=True)
class Law:
    """Means of a level over nominal pressure at one velocity.

    Attributes:
        segments: in order of rising pressure. pull_off: below it there is no contact.
        p_sat: pressure of saturated contact; ``saturated`` are the means there (from there on constant, but for pressure).
        p_top: largest pressure the law is known for (inf, unless it was cut below ``p_sat``).
        unloading: the branch of loading it follows.
    """

    segments: list[Segment]
    pull_off: float
    p_sat: float
    saturated: np.ndarray
    p_top: float
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
        error = np.max([s.errors.most[1 + self.friction_columns] for s in self.segments], axis=0, initial=0.0)
        return float((1.5 * error).sum())

    @cached_property
    def breaks(self) -> np.ndarray:
        """Pressures at which the law jumps or is not smooth, ascending, from pull-off to saturation."""
        ends = [s.p_low for s in self.segments if not s.inner_low] + [s.p_high for s in self.segments if not s.inner_high]
        ends = np.unique([e for e in [*ends, self.pull_off, self.p_sat] if -np.inf < e <= self.p_sat])
        # segments that follow one another meet to rounding
        apart = np.diff(ends, append=np.inf) > 1e-12 * np.abs(ends).max(initial=0.0)
        return ends[apart]

    @property
    def supports(self) -> np.ndarray:
        """Pressures across every segment, from end to end, for the size of what they hold: those at which its means are known."""
        inside = [np.clip([s.p_low, *s.errors.at, s.p_high], s.p_low, s.p_high) for s in self.segments]
        return np.concatenate([*inside, [self.p_sat]])

    def at_breaks(self) -> tuple[np.ndarray, np.ndarray]:
        """Change of friction, its own and what it carries, at each break, and how well the pressure of the break is known, Pa."""
        p = self.breaks
        errors = np.zeros(p.size)
        columns = 1 + self.friction_columns
        # just to either side: what the law says there belongs to one segment each
        aside = 1e-9 * (np.abs(p) + np.abs(p).max(initial=0.0))
        above, below = np.split(self(np.concatenate((p + aside, p - aside)))[:, columns], 2)
        jumps = np.abs(above - below).sum(axis=1)
        for s in self.segments:
            # a segment is left at one of its ends, and that tells where the law goes over to the next one
            left, entered = (s.p_low, s.p_high) if self.unloading else (s.p_high, s.p_low)
            errors[np.abs(p - left) <= aside] = s.errors.along(left, 0)
            outermost = (np.abs(p - entered) <= aside) & (errors == 0)
            errors[outermost] = s.errors.along(entered, 0)
        return jumps, errors

    def __call__(self, p: np.ndarray) -> np.ndarray:
        """Quantities at the nominal pressures ``p`` (m,), shape (m, q): zero below pull-off, saturated above ``p_sat``."""
        out = np.zeros((p.size, self.saturated.size))
        out[:, 0] = p
        high = p >= self.p_sat
        out[high, 1:] = self.saturated[1:]
        rest = np.flatnonzero(~high & (p >= self.pull_off))
        if not rest.size or not self.segments:
            return out
        upper = np.array([s.p_high for s in self.segments])
        which = np.minimum(np.searchsorted(upper, p[rest]), len(self.segments) - 1)
        for i, segment in enumerate(self.segments):
            here = rest[which == i]
            if here.size:
                out[here] = segment(p[here])
        return out


def build_laws(
    columns: LevelBatch,
    rtol: np.ndarray,
    p_full: np.ndarray,
    D_full: np.ndarray,
    saturated: np.ndarray,
    p_max: np.ndarray | None,
    budget: ErrorBudget | None = None,
) -> list[Law]:
    """The friction law of every column (its ``D`` is not used) along its branch of loading, as far up as it will be asked for.

    ``p_full``, ``D_full`` (n,): where the level, and all it carries, is saturated; ``saturated`` (n, q): means there. ``p_max``
    (n,): greatest pressure that will be asked for, or None for the whole law. ``budget``: how much its pressures count.
    """
    p_max = np.full(columns.size, np.inf) if p_max is None else np.maximum(p_max, -columns.adhesion.p_0)
    top, unloading = cut_penetration(columns, p_max, D_full), columns.branch == "unloading"
    p_max = np.where(top < D_full, p_max, np.inf)
    curves = trace(columns, rtol, top, budget)
    kept = branches_of(curves, unloading)
    least = np.repeat(1e-15 * np.abs(saturated), [len(row) for row in kept], axis=0)
    flat = [b for row in kept for b in row]
    every = iter(segments_of(flat, np.maximum(np.reshape([b.errors.most for b in flat], least.shape), least)))
    out = []
    for i, (curve, row) in enumerate(zip(curves, kept, strict=True)):
        segments = _joined([next(every) for _ in row], p_full[i])
        pull_off = row[0].p_low if row else p_full[i]
        p_top = segments[-1].p_high if row and p_max[i] < np.inf else p_max[i]
        out.append(Law(segments, float(pull_off), float(p_full[i]), saturated[i], float(p_top), curve.strips, unloading))
    return out
