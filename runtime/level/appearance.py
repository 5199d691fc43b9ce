"""Where a regime appears among the strips of a level, or vanishes, away from its crest.

As the penetration changes, strips somewhere between crest and edge may enter a regime that no strip was in before: an island in y
that grows like the square root of the distance in D, and the level's means with it. Such a penetration ends a piece of the curve.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .strips import Columns

#: points across an island, and penetrations tried at once
_ACROSS, _AT_ONCE = 15, 7
_ROUNDS = 12
#: a break this close to an end of its piece, as a share of it, is left to halving
_CLOSE = 0.02
#: a zone narrower than this many brackets of a transition may hide in one
_UNSEEN = 4.0


@dataclass
class Island:
    """Strips with ``code`` between the thetas ``low`` and ``high`` at penetration ``present``, none of them at ``absent``."""

    column: int
    code: int
    low: float
    high: float
    present: float
    absent: float


def island(column: int, D: np.ndarray, zones: list[np.ndarray]) -> Island | None:
    """The first change in the sequence of codes along y between two of the nodes ``D``; None if there is none.

    ``zones``: ``Averages.zones`` at the nodes. The end nodes are breaks already: what they show may belong to either side.
    """
    for i in range(1, D.size - 2):
        one, two = zones[i], zones[i + 1]
        if len(one) == len(two) and np.all(one[:, 0] == two[:, 0]):
            continue
        ends = (D[i], D[i + 1])
        if len(one) < len(two):
            one, two, ends = two, one, ends[::-1]
        same = 0
        while same < len(two) and one[same, 0] == two[same, 0]:
            same += 1
        code, low, high = one[min(same, len(one) - 1)]
        if high - low <= _UNSEEN * _blind(two, same):
            continue
        return Island(column, int(code), low, high, *ends)
    return None


def _blind(zones: np.ndarray, place: int) -> float:
    """Width of what lies between the zones before and after ``place``: a transition is bracketed no closer than the means need, so a zone of
    that width may be seen at one penetration and not at the next."""
    if 0 < place < len(zones):
        return zones[place, 1] - zones[place - 1, 2]
    return 0.0


def vanishing(columns: Columns, islands: list[Island], strips: np.ndarray) -> np.ndarray:
    """Penetrations at which the islands have shrunk to nothing, all at once; ``strips`` (per column) counts the work."""
    share = np.arange(1, _AT_ONCE + 1) / (_AT_ONCE + 1)
    across = np.arange(_ACROSS + 2) / (_ACROSS + 1)
    for _ in range(_ROUNDS):
        D = np.array([i.present + (i.absent - i.present) * share for i in islands])
        theta = np.array([i.low + (i.high - i.low) * across for i in islands])
        shape = (len(islands), _AT_ONCE, across.size)
        column = np.array([i.column for i in islands])
        every = np.broadcast_to(column[:, None, None], shape).ravel()
        np.add.at(strips, every, 1)
        at = columns.at(every, np.broadcast_to(D[:, :, None], shape).ravel())
        codes = at.codes(np.arange(every.size), np.broadcast_to(theta[:, None, :], shape).ravel()).reshape(shape)
        for k, this in enumerate(islands):
            _narrow(this, D[k], theta[k], codes[k] == this.code)
    return np.array([0.5 * (i.present + i.absent) for i in islands])


def _narrow(this: Island, D, theta, there) -> None:
    """Keep the last penetration at which the island is seen, and its extent there."""
    seen = there.any(axis=1)
    gone = int(np.argmin(seen)) if not seen.all() else seen.size
    if gone < seen.size:
        this.absent = D[gone]
    if gone > 0:
        this.present = D[gone - 1]
        inside = np.flatnonzero(there[gone - 1])
        this.low, this.high = theta[max(inside[0] - 1, 0)], theta[min(inside[-1] + 1, theta.size - 1)]


def is_inside(D_break: float, low: float, high: float) -> bool:
    """Whether a break lies in the interior of a piece."""
    return min(D_break - low, high - D_break) > _CLOSE * (high - low)
