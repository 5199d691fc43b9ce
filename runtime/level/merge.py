"""Neighbouring segments of a friction law as one, where a smooth function is as good as both.

Every break of a law leaves kinks behind in the laws of all levels above, three for one and ever weaker ones; each costs panels
over x, over y and over penetration. What is no larger than a law may err is no break.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .cells import SLOTS, Cells, cells_of
from .law import Law
from .piece import graded, parameter
from .segment import Segment
from .table import LawTable

#: part of what a law may err that merging may take: laws err by less than a tenth of that
_SHARE = 0.2
#: slots of the smallest cell: a function that takes smaller ones is not smooth enough for few nodes to see all of it
_FINEST = SLOTS // 16
#: parameters at which a merged segment is held against the law, and how much more than there is feared
_CHECKS, _SAFE = np.linspace(0, 1, 130)[1:-1], 1.5
#: how far to either side of a joint its jump is looked at, of all parameters
_BESIDE = 1e-6


def merged(laws: Sequence[Law], rtol: np.ndarray, floors: np.ndarray) -> list[Law]:
    """The laws with as few segments as stand for them to a part of ``rtol (|value| + floors)``, ``rtol`` (n,) and ``floors``
    (n, q); what that adds to their errors is added."""
    table = LawTable(laws)
    rows = [list(law.segments) for law in laws]
    # errors before merging: what one merger adds is not added again by the next
    before = [[s.errors for s in row] for row in rows]
    opens = [[True] * (len(row) - 1) for row in rows]
    while True:
        pairs = [(i, k) for i, row in enumerate(opens) for k in _apart(row)]
        if not pairs:
            break
        found = _fits(table, [(i, rows[i][k], rows[i][k + 1]) for i, k in pairs], rtol, floors)
        for (i, k), (cells, error) in reversed(list(zip(pairs, found, strict=True))):
            if cells is None:
                opens[i][k] = False
                continue
            low, high = rows[i][k : k + 2]
            before[i][k : k + 2] = [before[i][k].then(before[i][k + 1])]
            errors = before[i][k].plus(error)
            rows[i][k : k + 2] = [Segment(low.p_low, high.p_high, cells, errors, low.inner_low, high.inner_high)]
            del opens[i][k]
    return [replace(law, segments=row) for law, row in zip(laws, rows, strict=True)]


def _apart(opens: list[bool]) -> list[int]:
    """Joints that are open, no two of them next to one another."""
    out: list[int] = []
    for k, is_open in enumerate(opens):
        if is_open and (not out or k > out[-1] + 1):
            out.append(k)
    return out


def _fits(table: LawTable, pairs: list[tuple[int, Segment, Segment]], rtol, floors) -> list[tuple[Cells | None, np.ndarray]]:
    """Cells that stand for both segments of each pair (law, low, high), with the error that brings; None where there are none."""
    law = np.array([i for i, *_ in pairs])
    low, joint, high = (np.array(v) for v in zip(*((a.p_low, a.p_high, b.p_high) for _, a, b in pairs), strict=True))

    def values(which, p):
        interval = np.maximum(np.count_nonzero(table.breaks[law[which]] < p[:, None], axis=1) - 1, 0)
        return np.concatenate((p[:, None], table(law[which], interval, p[None])[0][:, 0].T), axis=1)

    def at(which, u):
        return values(which, low[which] + (high - low)[which] * graded(u))

    beside = parameter((joint - low) / (high - low))[:, None] + np.array([-_BESIDE, _BESIDE])
    u = np.concatenate((np.tile(_CHECKS, (law.size, 1)), np.clip(beside, 0.0, 1.0)), axis=1)
    known = at(np.repeat(np.arange(law.size), u.shape[1]), u.ravel()).reshape(*u.shape, -1)
    allowed = _SHARE * rtol[law, None] * (np.abs(known).min(axis=1) + floors[law])
    # a pressure is what it is
    allowed[:, 0] = np.inf
    cells = cells_of(at, allowed, graded, _FINEST)
    fitted = np.array([each(row) for each, row in zip(cells, u, strict=True)])
    error = _SAFE * np.maximum(np.abs(fitted - known).max(axis=1), np.abs(known[:, -1] - known[:, -2]))
    error[:, 0] = 0.0
    good = (error <= allowed).all(axis=1) & [not each.error.any() for each in cells]
    return [(each, err) if ok else (None, err) for each, err, ok in zip(cells, error, good, strict=True)]
