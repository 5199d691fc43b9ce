"""Neighbouring segments of a friction law as one, where a smooth function is as good as both.

Every break of a law leaves kinks behind in the laws of all levels above, three for one and ever weaker ones; each costs panels
over x, over y and over penetration. What is no larger than a law may err is no break.
"""

from dataclasses import replace

import numpy as np

from .cells import SLOTS, Cells, cells_of
from .law import Laws
from .piece import graded, parameter
from .segment import Segment

#: part of what a law may err that merging may take: laws err by less than a tenth of that
_SHARE = 0.2
#: slots of the smallest cell: a function that takes smaller ones is not smooth enough for few nodes to see all of it
_FINEST = SLOTS // 16
#: parameters at which a merged segment is held against the law, and how much more than there is feared
_CHECKS, _SAFE = np.linspace(0, 1, 130)[1:-1], 1.5
#: how far to either side of a joint its jump is looked at, of all parameters
_BESIDE = 1e-6


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
    cells = cells_of(at, allowed, graded, _FINEST)
    fitted = np.array([each(row).T for each, row in zip(cells, u, strict=True)])
    error = _SAFE * np.maximum(np.abs(fitted - known).max(axis=1), np.abs(known[:, -1] - known[:, -2]))
    error[:, 0] = 0.0
    good = (error <= allowed).all(axis=1) & [not each.error.any() for each in cells]
    return [(each, err) if ok else (None, err) for each, err, ok in zip(cells, error, good, strict=True)]
