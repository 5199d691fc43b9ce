"""Where a regime appears among the strips of a level, or vanishes, away from its crest.

As the penetration changes, strips somewhere between crest and edge may enter a regime that no strip was in before: an island in y
that grows like the square root of the distance in D, and the level's means with it. Such a penetration ends a piece of the curve.
"""

from __future__ import annotations

import numpy as np

from .strips import Columns

_POINTS = np.arange(1, 16) / 16
_EPS = np.finfo(float).eps
#: a break this close to an end of its piece, as a share of it, is that end
_CLOSE = 1e-6


def appearance(columns: Columns, column: int, D: np.ndarray, zones: list[np.ndarray], strips: np.ndarray) -> float | None:
    """A penetration between two of the nodes ``D`` at which the sequence of codes along y changes; None if it never does.

    ``zones``: ``Averages.zones`` at the nodes. ``strips``: count of strips, increased.
    """
    # the ends of a piece are breaks already: what its end nodes show may belong to either side
    for i in range(1, D.size - 2):
        ones, others = zones[i][:, 0], zones[i + 1][:, 0]
        if ones.size == others.size and np.all(ones == others):
            continue
        longer = zones[i] if ones.size > others.size else zones[i + 1]
        shorter = others if ones.size > others.size else ones
        island = _island(longer, shorter)
        with_it, without = (D[i], D[i + 1]) if ones.size > others.size else (D[i + 1], D[i])
        found = _bisect(columns, column, *island, with_it, without, strips)
        if min(found - D[0], D[-1] - found) > _CLOSE * (D[-1] - D[0]):
            return found
    return None


def _island(longer: np.ndarray, shorter: np.ndarray):
    """Code and extent of the first zone of ``longer`` that ``shorter`` does not have."""
    same = 0
    while same < shorter.size and longer[same, 0] == shorter[same]:
        same += 1
    row = longer[min(same, len(longer) - 1)]
    return int(row[0]), float(row[1]), float(row[2])


def _bisect(columns: Columns, column: int, code: int, low: float, high: float, with_it: float, without: float, strips):
    """Penetration at which the island [low, high] of strips with ``code`` has shrunk to nothing."""
    for _ in range(60):
        if abs(with_it - without) <= 8 * _EPS * max(abs(with_it), abs(without), columns.level.h):
            break
        middle = 0.5 * (with_it + without)
        theta = np.concatenate(([low], low + (high - low) * _POINTS, [high]))
        index = np.full(theta.size, column)
        codes = columns.at(index, np.full(theta.size, middle)).codes(np.arange(theta.size), theta)
        strips[column] += theta.size
        inside = np.flatnonzero(codes == code)
        if inside.size:
            with_it = middle
            low, high = theta[max(inside[0] - 1, 0)], theta[min(inside[-1] + 1, theta.size - 1)]
        else:
            without = middle
    return 0.5 * (with_it + without)
