"""Penetrations at which a level's means over penetration are not smooth.

The crest strip (y = 0) has everywhere the highest profile: the means lose smoothness where it changes regime, and where the flat
edge does. Unloading with adhesion it need not be the last to let go: what is pressed in less is drawn out of reach later.

As the penetration changes, strips somewhere between crest and edge may enter a regime that no strip was in before: an island in
y that grows with the distance in D or its square root, and the level's means with it. Such a penetration ends a piece, too. With
a level below, islands are nested: around a minimum of the peak pressure every break of its law is passed down and up again.
"""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ..inputs.adhesion import Dugdale
from ..numerics.rounding import EPS
from ..orbit.batch import Batch, Ranges
from .changes import ASIDE, Changes, locate_changes
from .regime_map import OPENS, by_equation, hides_another, straight, theta_of
from .strips import LevelBatch

#: breaks nearer than this to one another, in heights, are one; those of laws, relative to the largest
ONE_BREAK = 1e-12
#: penetrations of a scan where regimes follow one another
_SCAN = 32
#: strips looked at across an island and along its way, and how often at most, ever closer to where it vanishes: the tip of a
#: wedge between two strips is less than a step along the way beyond where they lose it
_ACROSS, _ALONG, _ROUNDS = 12, 8, 20
#: width in theta of an island that is close enough to where it ends to find the turn of its curve from
_CLOSE = 1e-2
#: what an island may add to the means that is left aside, over their goal
_LEFT = 0.3


def reach(adhesion: Dugdale, K: float) -> float:
    """Distance, m, from the undeformed foundation beyond which every strip is free on either branch."""
    # w is never above -p_0/K where it adheres, and after a step it recovers by J_0 p_0 <= p_0/K at most
    return float(2 * adhesion.p_0 / K + (adhesion.delta_0 if adhesion.p_0 > 0 else 0.0))


def first_contact(columns: LevelBatch) -> float:
    """A penetration at and below which every strip of the level is free."""
    a = columns.adhesion
    if columns.branch == "loading":
        return -(a.delta_0 if a.p_0 > 0 else 0.0)
    return -reach(a, columns.material.K) * (1 + 1e-9)


def between_breaks(columns: LevelBatch, column: np.ndarray, D: np.ndarray) -> tuple[np.ndarray, ...]:
    """Intervals between the penetrations at which a curve may not be smooth, from the first to the last of the penetrations ``D``
    (m, points) of each ``column`` (m,), by the changes these show.

    Returns rows, lower and upper ends, ascending, (k,); and the least D at which the crest of each row changes regime, or inf."""
    h, m = columns.level.h, column.size

    def probe(line, x):
        return columns.at(column[line], x).evaluate(np.arange(x.size), np.zeros(x.size))

    def equation(changes):
        parent, place = by_equation(columns.at(column[changes.line], changes.low), changes, "E")
        return parent, place, hides_another(*changes.codes[parent].T)

    answers = [v.reshape(*D.shape, *v.shape[1:]) for v in probe(np.repeat(np.arange(m), D.shape[1]), D.ravel())]
    changes, *_ = Changes.between(np.arange(m), D, answers)
    width = 16 * EPS * np.maximum(np.maximum(np.abs(changes.low), np.abs(changes.high)), max(h, columns.stretch))
    changes, _ = locate_changes(probe, equation, changes, width)
    touched = np.full(m, np.inf)
    np.minimum.at(touched, changes.line, changes.high)
    # the flat strip of the valley has no amplitude; where gaps can open over it strips that load may begin to jump, too
    c = straight(columns)[1]
    c[OPENS] = columns.opens if columns.stretch > 0 else np.nan
    valley = h + c.T[column]
    inside = (D[:, :1] < valley) & (valley < D[:, -1:])
    row = np.concatenate((changes.line, np.nonzero(inside)[0], np.repeat(np.arange(m), 2)))
    ends = np.concatenate((changes.high, valley[inside], D[:, [0, -1]].ravel()))
    order = np.lexsort((ends, row))
    row, ends = row[order], ends[order]
    apart = np.flatnonzero((np.diff(row) == 0) & (np.diff(ends) > ONE_BREAK * h))
    return row[apart], ends[apart], ends[apart + 1], touched


def scan(columns: LevelBatch, top: np.ndarray) -> np.ndarray:
    """Penetrations at which to look, (n, m): dense where regimes follow one another, geometric above, up to saturation."""
    a = columns.adhesion
    bottom = first_contact(columns)
    span = 2 * columns.level.h + a.delta_0 + 2 * a.p_0 / columns.material.K
    near = bottom + np.minimum(span, top - bottom)[:, None] * np.linspace(0, 1, _SCAN)
    ratio = np.maximum((top - bottom) / np.maximum(near[:, -1] - bottom, 1e-300), 1.0)
    far = bottom + (near[:, -1] - bottom)[:, None] * ratio[:, None] ** np.linspace(0, 1, _SCAN // 4 + 1)
    return np.concatenate((near, far[:, 1:]), axis=1)


@dataclass(frozen=True)
class Zones(Batch):
    """Zones of one column in order of theta: ``code``, ends ``low`` and ``high``, (k,); and the values averaged, next to both
    ends (``first``, ``last``) and on the ``mean``, (k, q)."""

    code: np.ndarray
    low: np.ndarray
    high: np.ndarray
    first: np.ndarray
    last: np.ndarray
    mean: np.ndarray

    def standing_out(self, k: int) -> np.ndarray:
        """How far the mean of zone ``k`` is from the values next to it in the neighbouring zones, (q,)."""
        beside = [*self.last[max(k - 1, 0) : k], *self.first[k + 1 : k + 2]]
        return np.abs(self.mean[k] - beside).max(axis=0, initial=0.0) if beside else np.zeros(self.mean.shape[1])


def zones_along_y(columns: int, state, code, low, high, first, last, total) -> list[Zones]:
    """Zones of every column from panels (m,) of the columns ``state``: codes, ends, values at both, and integrals ``total``."""
    order = np.lexsort((low, state))
    state, code, low, high, first, last, total = (v[order] for v in (state, code, low, high, first, last, total))
    start = np.flatnonzero(np.append(True, (state[1:] != state[:-1]) | (code[1:] != code[:-1])))
    stop = np.append(start[1:], state.size) - 1
    width = np.add.reduceat(high - low, start)[:, None]
    every = Zones(code[start], low[start], high[stop], first[start], last[stop], np.add.reduceat(total, start) / width)
    ends = np.searchsorted(state[start], np.arange(columns + 1))
    return [every.take(slice(*pair)) for pair in pairwise(ends)]


@dataclass
class Islands(Ranges):
    """Regimes along y, (n,): strips of a ``column`` with ``code`` between the thetas ``low`` and ``high`` at penetration
    ``present``, none of them at ``absent``. ``weight``: what that adds to the means over their goal."""

    column: np.ndarray
    code: np.ndarray
    present: np.ndarray
    absent: np.ndarray
    weight: np.ndarray


def islands(column: int, D: np.ndarray, zones: list[Zones], goal: np.ndarray) -> list[Islands]:
    """Regimes along y that appear or vanish between two neighbouring nodes ``D``, of which ``zones`` are known: those of the two
    nodes where one moves the means most, beside the ``goal`` (q,) of their errors. Islands may be nested, and vanish in turn."""
    most: list[Islands] = []
    for i in range(D.size - 1):
        one, two = zones[i], zones[i + 1]
        if np.array_equal(one.code, two.code):
            continue
        ends = (D[i], D[i + 1])
        if one.code.size < two.code.size:
            one, two, ends = two, one, ends[::-1]
        same = np.append(one.code[: two.code.size] != two.code, True).argmax()
        gone = np.setdiff1d(one.code, two.code)
        places = [np.flatnonzero(one.code == code) for code in gone] or [np.array([min(same, one.code.size - 1)])]
        found = []
        for k in places:
            low, high = one.low[k[0]], one.high[k[-1]]
            weight = max(float(((high - low) / np.pi * one.standing_out(j) / goal).max()) for j in k)
            if weight > _LEFT:
                found.append(Islands(*(np.array([v]) for v in (low, high, column, one.code[k[0]], *ends, weight))))
        most = max(most, found, key=lambda some: max((each.weight[0] for each in some), default=0.0))
    return most


def locate_vanishing(columns: LevelBatch, some: Islands) -> np.ndarray:
    """Penetrations (n,) at which islands have shrunk so far that what is left does not tell; NaN: one is not absent at all.

    Where a curve turns, if an island ends there; else where it is lost when followed."""
    out = _vanish_at_turns(columns, some)
    left = np.flatnonzero(np.isnan(out))
    if left.size:
        out[left] = _followed(columns, some.take(left))
    return out


def _followed(columns: LevelBatch, whole: Islands) -> np.ndarray:
    """``locate_vanishing`` by ever smaller grids of strips across an island and along the way to its end, that move with it; the
    curves around are located, and a turn of one of them that is found so is the end."""
    number, out, here, low, high = np.arange(whole.size), np.full(whole.size, np.nan), whole, whole.low, whole.high
    # ends and penetrations of the islands where they are looked at last, and where they were close to their end first
    tips, wider = np.full((2, 3, out.size), np.nan)
    density, start, stop, drift = whole.weight / whole.width, *np.array([[0.0], [1.0], [0.0]]).repeat(number.size, axis=1)
    for _ in range(_ROUNDS):
        present, way = here.present, here.absent - here.present
        tip, far = np.array((low, high, present + way * start)), (high - low > _CLOSE) | np.isnan(wider[0, number])
        tips[:, number], wider[:, number[far]] = tip, tip[:, far]
        across = (np.arange(_ACROSS) + 0.5) / _ACROSS
        step = (high - low) / _ACROSS
        share = start[:, None] + (stop - start)[:, None] * np.linspace(0, 1, _ALONG)
        # an island may be far narrower than it moves
        moved = drift[:, None] * (share - start[:, None])
        theta = np.clip((low[:, None] + (high - low)[:, None] * across)[:, None] + moved[:, :, None], 0.0, np.pi)
        D = (present[:, None] + way[:, None] * share)[:, :, None].repeat(_ACROSS, axis=2)
        which = np.repeat(here.column, _ALONG * _ACROSS)
        np.add.at(columns.spent, which, 1)
        codes = columns.at(which, D.ravel()).codes(np.arange(which.size), theta.ravel())
        has = codes.reshape(D.shape) == here.code[:, None, None]
        # the last along the way that any strip has it, and from where to where there
        row = np.where(has.any(axis=2), np.arange(_ALONG), 0).max(axis=1)
        each = np.arange(number.size)
        first, last = has.argmax(axis=2), _ACROSS - 1 - has[:, :, ::-1].argmax(axis=2)
        middle, at = 0.5 * step[:, None] * (first + last), share[each, row] - start
        drift += np.divide(middle[each, row] - middle[:, 0], at, out=np.zeros_like(at), where=(at > 0) & has[:, 0].any(axis=1))
        low, high = low + moved[each, row] + step * ([-1], [2]) + step * (first[each, row], last[each, row])
        keeps = (row == _ALONG - 1) & (stop == 1)
        further = share[each, np.minimum(row + 2, _ALONG - 1)]
        start, stop = share[each, row], np.where(row == _ALONG - 1, np.minimum(2 * stop - start, 1.0), further)
        out[number] = np.where(keeps, np.nan, present + way * 0.5 * (start + stop))
        done = keeps | (density * (high - low) <= _LEFT)
        done |= np.abs(way * (stop - start)) <= 16 * EPS * np.maximum(np.abs(here.absent), columns.level.h)
        if done.all():
            break
        number, here, low, high, density, start, stop, drift = (
            v[~done] for v in (number, here, low, high, density, start, stop, drift)
        )
    # nodes next to the end are expected to cross the curves there; and one of them may turn
    ended = np.flatnonzero(~np.isnan(out))
    whole = whole.take(ended)
    for at in (wider, tips):
        _locate_around(columns, whole.column, *at[:, ended])
    low, high, present = wider[:, ended]
    turns = _vanish_at_turns(columns, replace(whole, low=low, high=high, present=present))
    out[ended] = np.where(np.isnan(turns), out[ended], turns)
    return out


def _locate_around(columns: LevelBatch, column, low, high, D) -> None:
    """Locate the curves between the middles of islands and their ends, thetas ``low`` and ``high`` (n,), at ``D`` (n,)."""
    theta = np.clip(np.stack((low, 0.5 * (low + high), high), axis=1), 0.0, np.pi)
    np.add.at(columns.spent, column, 3)
    answers = columns.at(np.repeat(column, 3), np.repeat(D, 3)).evaluate(np.arange(theta.size), theta.ravel())
    known = [v.reshape(*theta.shape, *v.shape[1:]) for v in answers]
    changes, row, _ = Changes.between(np.arange(D.size), theta, known)
    by_equation(columns.at(column[row], D[row]), changes, "A")


def _vanish_at_turns(columns: LevelBatch, some: Islands) -> np.ndarray:
    """Penetrations at which islands (n,) end at the turn of a curve, the one nearest to where they are absent; NaN where no turn
    has them on the one side and not on the other."""
    turns, column, out = columns.crossings.turned(columns), some.column, np.full(some.size, np.nan)
    D, theta, away = turns.E + columns.level.h, theta_of(columns, turns.A), some.absent - some.present
    share = (D - some.present[:, None]) / away[:, None]
    inside = (columns.V[column, None] == turns.velocity) & (share > 0) & (share < 1)
    island, turn = np.nonzero(inside & (theta > some.low[:, None]) & (theta < some.high[:, None]))
    if island.size:
        beside = D[turn] + ASIDE * away[island] * np.array([[-1], [1]])
        np.add.at(columns.spent, column[island], 2)
        at = columns.at(np.tile(column[island], 2), beside.ravel())
        has = at.codes(np.arange(at.size), np.tile(theta[turn], 2)).reshape(2, -1) == some.code[island]
        ends = np.flatnonzero(has[0] & ~has[1])
        ends = ends[np.argsort(share[island[ends], turn[ends]])]
        out[island[ends]] = D[turn[ends]]
    return out
