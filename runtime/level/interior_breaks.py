"""Where a regime appears among the strips of a level, or vanishes, away from its crest.

As the penetration changes, strips somewhere between crest and edge may enter a regime that no strip was in before: an island in y
that grows like the square root of the distance in D, and the level's means with it. Such a penetration ends a piece of the curve.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce

import numpy as np

from .boundaries import located
from .changes import Changes, locate_changes
from .plane import Boundary, Points, turning_point
from .strips import LevelBatch

#: points across an island, and how often they are drawn closer to where it vanishes
_ACROSS, _ROUNDS, _FEW = 9, 5, 2
#: how closely the ends of strips are located, as a share of the way on which the island vanishes, and how much more so from round
#: to round
_FIRST_WIDTH, _SHARPER = 1e-3, 1 / 64
_EPS = np.finfo(float).eps
#: a break this close to an end of its piece, as a share of it, is left to halving
_CLOSE = 0.02
#: a zone narrower than this many brackets of a transition may hide in one
_UNSEEN = 4.0


@dataclass
class IsolatedRegime:
    """Strips with ``code`` between the thetas ``low`` and ``high`` at penetration ``present``, none of them at ``absent``."""

    column: int
    code: int
    low: float
    high: float
    present: float
    absent: float


def island(column: int, D: np.ndarray, zones: list[np.ndarray], negligible: float) -> IsolatedRegime | None:
    """The first change in the sequence of codes along y between two of the nodes ``D``; None if there is none.

    ``zones``: ``Averages.zones`` at the nodes; those no wider than ``negligible`` don't count.
    """
    for i in range(D.size - 1):
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
        if high - low <= max(_UNSEEN * _blind(two, same), negligible):
            continue
        return IsolatedRegime(column, int(code), low, high, *ends)
    return None


def _blind(zones: np.ndarray, place: int) -> float:
    """Width of what lies between the zones before and after ``place``: a transition is bracketed no closer than the means need,
    so a zone of that width may be seen at one penetration and not at the next."""
    if 0 < place < len(zones):
        return zones[place, 1] - zones[place - 1, 2]
    return 0.0


def locate_vanishing(columns: LevelBatch, islands: list[IsolatedRegime], strips: np.ndarray, roughly: bool) -> np.ndarray:
    """Penetrations at which the islands have shrunk to nothing, all at once; ``strips`` (per column) counts the work.
    NaN: it is not absent at all.

    At a fixed theta the island's code ends at some penetration, located like any transition; the island vanishes at the extreme
    of these over theta: where the curve turns on which they lie, or at the vertex of their parabola, drawn closer and closer,
    where no curve is known. ``roughly``: to a few digits only.
    """
    number, out = np.arange(len(islands)), np.full(len(islands), np.nan)
    column, code, present, absent, low, high = (
        np.array([getattr(i, name) for i in islands]) for name in ("column", "code", "present", "absent", "low", "high")
    )
    for attempt in range(_FEW if roughly else _ROUNDS):
        here, way = np.arange(number.size), absent - present
        theta = low[:, None] + (high - low)[:, None] * np.linspace(0, 1, _ACROSS)
        width = np.maximum(
            np.abs(way) * _FIRST_WIDTH * _SHARPER**attempt, 16 * _EPS * np.maximum(np.abs(absent), columns.level.h)
        )
        ends, still, curves = _ends(columns, column, code, theta, present, absent, width, strips)
        share = (ends - present[:, None]) / way[:, None]
        share = np.where(np.isnan(share), 0.0, share)
        last = np.argmax(share, axis=1)
        best = np.clip(last, 1, _ACROSS - 2)
        left, centre, right = (share[here, best + k] for k in (-1, 0, 1))
        bend = left - 2 * centre + right
        at = np.clip(np.divide(0.5 * (left - right), bend, out=np.zeros(here.size), where=bend < 0), -1.0, 1.0)
        top = np.where(bend < 0, centre + at * (0.5 * (right - left) + 0.5 * bend * at), share.max(axis=1))
        # where the code lasts longest there is the vertex, or it is at an end
        low, high = theta[here, best - 1], theta[here, best + 1]
        turn = np.where(last == best, _turns(columns, curves, here * _ACROSS + best, theta.ravel()), ends[here, last])
        known = (turn - present) / way
        told = (known >= share.max(axis=1)) & (known < 1) & np.isin(here * _ACROSS + last, list(curves))
        out[number] = np.where(still.any(axis=1), np.nan, np.where(told, turn, present + top * way))
        left = ~told & ~still.any(axis=1)
        if not left.any():
            break
        number, column, code, present, absent, low, high = (v[left] for v in (number, column, code, present, absent, low, high))
    return out


def _turns(columns: LevelBatch, curves: dict[int, tuple[Boundary, Points]], line: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """Penetrations (m,) at which the curves turn that the strips ``line`` (m,) met, of those at ``theta``; NaN: not found."""
    out = np.full(line.size, np.nan)
    A = columns.level.amplitude(theta)
    reach = np.minimum(np.abs(A[line - 1] - A[line]), np.abs(A[line + 1] - A[line]))
    for boundary in {curves[i][0] for i in line.tolist() if i in curves}:
        at = np.array([k for k, i in enumerate(line.tolist()) if i in curves and curves[i][0] == boundary])
        start = reduce(Points.joined, (curves[i][1] for i in line[at].tolist()))
        turn, found = turning_point(columns, boundary, start, reach[at])
        out[at[found]] = turn.E[found] + columns.level.h
    return out


def _ends(
    columns: LevelBatch, column, code, theta, present, absent, width, strips
) -> tuple[np.ndarray, np.ndarray, dict[int, tuple[Boundary, Points]]]:
    """Penetration between ``present`` and ``absent`` at which each strip (islands, across) loses the island's code, NaN where it
    has not got it or keeps it; which keep it; and by strip the point of a curve that was met last."""
    shape = theta.shape
    every = np.arange(theta.size)
    row, theta = every // shape[1], theta.ravel()
    start, stop = present[row], absent[row]
    amplitude, h = columns.level.amplitude(theta), columns.level.h
    curves: dict[int, tuple[Boundary, Points]] = {}

    def probe(line, D):
        np.add.at(strips, column[row[line]], 1)
        codes, values, heights, edges = columns.at(column[row[line]], D).evaluate(np.arange(D.size), theta[line])
        return codes, heights, edges, values

    def equation(changes):
        line = changes.line
        E = np.stack((changes.low, changes.high), axis=1) - h
        place, found, met = located(
            columns.at(column[row[line]], changes.low), changes, np.tile(amplitude[line, None], 2), E, "E"
        )
        for boundary, which, points in met:
            curves.update((line[i], (boundary, points.take([k]))) for k, i in enumerate(which.tolist()))
        told = np.flatnonzero(found)
        return told, place[told] + h

    ends = [
        v.reshape(2, theta.size, *v.shape[1:]).swapaxes(0, 1) for v in probe(np.tile(every, 2), np.concatenate((start, stop)))
    ]
    codes = ends[0]
    at = np.flatnonzero((codes[:, 0] == code[row]) & (codes[:, 1] != code[row]))
    out = np.full(theta.size, np.nan)
    still = (codes[:, 1] == code[row]).reshape(shape)
    if not at.size:
        return out.reshape(shape), still, curves
    falls = (stop < start)[at]
    ends = [np.where(falls.reshape(-1, *[1] * (v.ndim - 1)), v[at, ::-1], v[at]) for v in ends]
    changes = Changes(at, np.minimum(start, stop)[at], np.maximum(start, stop)[at], *ends)
    found, _ = locate_changes(probe, equation, changes, width[row[at]])
    # of several changes the one next to where the island is present
    order = np.argsort(np.where((stop < start)[found.line], -found.low, found.low))
    for i in order[::-1]:
        out[found.line[i]] = found.low[i] if stop[found.line[i]] > start[found.line[i]] else found.high[i]
    return out.reshape(shape), still, curves


def is_inside(D_break: float, low: float, high: float) -> bool:
    """Whether a break lies in the interior of a piece."""
    return min(D_break - low, high - D_break) > _CLOSE * (high - low)
