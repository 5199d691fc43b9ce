"""Where the strips of a level change regime.

A level at penetration D is a horizontal segment of the plane of strips (``plane``), ``E = D - h``. Thresholds cross it where a
closed form says. Other curves are met between two strips in different regimes, and located by the equation of the orbit that
ends there, from that orbit's edges. What was located is remembered: neighbouring segments cross the same curve nearby.

Nothing here decides what a strip does: a curve that is not found is met by bisection (and counted), one too many costs a panel.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..numerics.rounding import EPS
from ..orbit.foundation import foundation_of
from ..orbit.regimes import CODE
from . import plane
from .changes import Changes
from .plane import BOUNDARIES, Boundary, Points

if TYPE_CHECKING:
    from .strips import LevelBatch

#: edges of the orbits of a regime, in order of phase
EDGES = {"acaf": "dbac", "afc": "bac", "af": "dc", "ac": "ba", "cf": "ba"}
#: place of each regime in the order in which a strip that is drawn out passes them: up to 1 it is engaged all along
_RANK = np.array([{"c": 0, "a": 1, "ac": 1, "af": 3, "f": 4}.get(sequence, 2) for sequence in CODE])


def straight(columns: LevelBatch) -> list[tuple[np.ndarray, np.ndarray]]:
    """Straight curves ``A = a + b E`` of the plane, (a, b) of shape (n,) each: thresholds in closed form for every state.

    Saturated contact, loss of touch, contact in a gap that adheres throughout, and the greatest and the least pressure of
    saturated contact at the breaks of the law below."""
    one, P = np.ones(columns.size), columns.stretch
    R = foundation_of(columns.material).modulus_ratio(columns.level.k * columns.V)
    rise = np.divide(1.0, R - 1, out=np.full(columns.size, np.inf), where=R > 1)
    found = [(np.where(R > 1, P, 0.0) * np.minimum(rise, np.finfo(float).max), rise)]
    if columns.branch == "loading" or P == 0:
        found.append((-0.5 * (columns.adhesion.delta_0 if P > 0 else 0.0) * one, -0.5 * one))
    if P > 0:
        found.append((-0.5 * P * one, -0.5 * one))
    if columns.carry is not None:
        for level in columns.carry.breaks(columns.group).T / columns.material.K:
            found += [(level / (1 + R), -1 / (1 + R)), (-level * rise, rise)]
    return found


def thresholds(columns: LevelBatch) -> tuple[np.ndarray, np.ndarray]:
    """States and thetas (k,) at which strips pass a threshold in closed form."""
    E, h, P = columns.D - columns.level.h, columns.level.h, columns.stretch
    lines = straight(columns)
    with np.errstate(invalid="ignore", over="ignore"):
        A = np.array([a + b * E for a, b in lines])
    usual = 1 + (columns.branch == "loading" or P == 0)
    if P > 0:
        # a gap that adheres throughout is nowhere wider than delta_0
        A[usual][E + P < -columns.adhesion.delta_0] = -1.0
    # pressures of saturated contact, where there is any
    first = usual + (P > 0)
    A[first:][A[first:] > A[0] * (1 + 1e-9)] = -1.0
    inside = (A > 0) & (2 * A < h) & np.isfinite(A)
    theta = theta_of(columns, np.where(inside, A, 0.0))
    if usual == 2:
        # touch is lost where the profile has dropped by the penetration: next to the crest to all digits of that
        with np.errstate(over="ignore"):
            share = (columns.D + (columns.adhesion.delta_0 if P > 0 else 0.0)) / h if h > 0 else -np.ones(columns.size)
        inside[1] = (share > 0) & (share < 1)
        theta[1] = 2 * np.arcsin(np.sqrt(np.clip(share, 0.0, 1.0)))
    kind, state = np.nonzero(inside)
    return state, theta[kind, state]


def theta_of(columns: LevelBatch, A) -> np.ndarray:
    """``k y`` of the strips with amplitude ``A``, m."""
    # a level without height has one strip, the crest
    h = columns.level.h
    return 2 * np.arccos(np.sqrt(np.clip(2 * A / h, 0.0, 1.0))) if h > 0 else np.zeros(np.shape(A))


def equations(columns: LevelBatch, code: np.ndarray, other: np.ndarray) -> list[tuple[Boundary, np.ndarray]]:
    """Boundaries at which an orbit with ``code`` may give way to one with ``other``, both (m,): each with the rows it is for.

    Orbits are ordered: pressed deeper a strip is more engaged. So unloading leaves an orbit that is engaged all along only where
    that ends itself, and loading one with a free part; contact that appears in an adhesion zone ends neither."""
    own = lambda sequence: code == CODE[sequence]  # noqa: E731
    to_engaged = _RANK[other] <= 1
    found = []
    for boundary in BOUNDARIES:
        rows = own(boundary.sequence)
        if boundary.event == "release":
            rows = rows & (columns.branch == "unloading")
        elif boundary.event == "closing":
            # contact may vanish within a zone that goes on without it, before that ends too
            rows = rows & (other == CODE["acaf"]) | own("acaf") & np.isin(other, [CODE["af"], CODE["f"]])
        else:
            rows = rows & (~to_engaged if columns.branch == "unloading" else other != CODE["f"])
        if rows.any():
            found.append((boundary, np.flatnonzero(rows)))
    return found


def located(columns: LevelBatch, changes: Changes, A: np.ndarray, E: np.ndarray, unknown: str) -> tuple[np.ndarray, np.ndarray]:
    """Where regimes that meet between two strips of the plane do, by the equation of an orbit that ends there; or where its
    greatest pressure passes a break of the law below.

    ``A`` and ``E`` (m, 2) of the ends of the ``changes``; ``unknown`` "A" or "E": the coordinate they differ in. ``columns``: the
    state of each. Returns that coordinate and which were found, (m,); the points of curves are remembered."""
    place, found = _by_threshold(columns, changes, A, E, unknown)
    ends = A if unknown == "A" else E
    low, high = ends.min(axis=1), ends.max(axis=1)
    code = changes.codes % len(CODE)
    for side in (0, 1):
        near, at_A, at_E = changes.edges[:, side], A[:, side], E[:, side]
        none = np.zeros(changes.size)
        kinds = [] if columns.carry is None else _peaks(columns, changes, code)
        kinds += [(b, rows, none, none.astype(int)) for b, rows in equations(columns, code[:, side], code[:, 1 - side])]
        for boundary, rows, pressure, index in kinds:
            rows = rows[~found[rows]]
            if not rows.size:
                continue
            names = ["dbac".index(name) for name in EDGES[boundary.sequence]]
            start = Points(columns.V[rows], at_A[rows], at_E[rows], near[rows][:, names], pressure[rows], index[rows])
            got, good = plane.locate(columns, boundary, start, unknown)
            at = getattr(got, unknown)
            inside = (at > low[rows]) & (at < high[rows])
            good &= inside
            place[rows[good]], found[rows[good]] = at[good], True
            if good.any():
                columns.crossings.remember(columns, boundary, got.take(np.flatnonzero(good)))
    return place, found


def _by_threshold(columns: LevelBatch, changes: Changes, A, E, unknown: str) -> tuple[np.ndarray, np.ndarray]:
    """Where saturated contact opens to a gap that adheres, where free strips are touched when loading, and where the extreme
    pressures of saturated contact, ``K (E + A (1 +- R))``, pass a break of the law below; and which changes are of that kind."""
    code, m = changes.codes % len(CODE), changes.size
    R = foundation_of(columns.material).modulus_ratio(columns.level.k * columns.V)
    contact = code == CODE["c"]
    unloading = columns.branch == "unloading"
    # E + factor A = constant; drawn out, what is engaged all along stays so until it opens, whatever it opens to
    factor, constant = 1 - R, np.full(m, -columns.stretch)
    known = contact.any(axis=1) & (~contact.all(axis=1) if unloading else np.isin(code, [CODE["ac"], CODE["cf"]]).any(axis=1))
    if columns.branch == "loading" or columns.stretch == 0:
        touched = (code == CODE["f"]).any(axis=1) & ~(code == CODE["f"]).all(axis=1)
        reach = columns.adhesion.delta_0 if columns.stretch > 0 else 0.0
        factor, constant, known = np.where(touched, 2.0, factor), np.where(touched, -reach, constant), known | touched
    # a gap that adheres throughout: it closes at its crest, and opens to delta_0 over its valley all along y at once
    adhering = (code == CODE["a"]).any(axis=1)
    closes = adhering & np.isin(code, [CODE["ac"], CODE["c"]]).any(axis=1)
    opens = adhering & (_RANK[code] > 1).any(axis=1) & unloading & (unknown == "E")
    factor, known = np.where(closes, 2.0, np.where(opens, 0.0, factor)), known | closes | opens
    constant = np.where(closes, -columns.stretch, np.where(opens, -columns.stretch - columns.adhesion.delta_0, constant))
    if columns.carry is not None:
        passed = (changes.heights[:, 0] > 0) != (changes.heights[:, 1] > 0)
        breaks = columns.carry.breaks(columns.group) / columns.material.K
        one = contact.all(axis=1) & passed.any(axis=1)
        which = passed.argmax(axis=1)
        constant = np.where(one, breaks[np.arange(m), which % breaks.shape[1]], constant)
        factor = np.where(one & (which < breaks.shape[1]), 1 + R, factor)
        known |= one
    with np.errstate(divide="ignore", invalid="ignore"):
        place = constant - factor * A[:, 0] if unknown == "E" else (constant - E[:, 0]) / factor
    ends = A if unknown == "A" else E
    # a curve over penetration ends at saturation, but for rounding
    low, high = ends.min(axis=1), ends.max(axis=1)
    slack = 64 * EPS * (np.abs(low) + np.abs(high) + columns.level.h)
    return np.clip(place, low, high), known & (place >= low - slack) & (place <= high + slack)


def hides_another(code: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Codes of regimes, (m,) both, that do not follow one another as a strip is drawn out: a third may lie between."""
    return np.abs(_RANK[code % len(CODE)] - _RANK[other % len(CODE)]) > 1


def passed_breaks(changes: Changes) -> tuple[Changes, np.ndarray]:
    """Changes at which pressures pass several breaks of the law below, one for each; the others as they are; and which change
    each is a part of."""
    over = changes.heights > 0
    passed = (over[:, 0] != over[:, 1]) & (changes.codes[:, :1] % len(CODE) == changes.codes[:, 1:] % len(CODE))
    parent, which = np.nonzero(passed)
    several = passed.sum(axis=1)[parent] > 1
    parent, which = parent[several], which[several]
    one = np.setdiff1d(np.arange(changes.size), parent)
    parts = changes.take(parent)
    others = np.arange(over.shape[2]) != which[:, None]
    # of the other breaks nothing is known, so that they are not passed
    parts.heights = np.where(others[:, None], np.nan, parts.heights)
    return Changes.joined([changes.take(one), parts]), np.concatenate((one, parent))


def _peaks(columns: LevelBatch, changes: Changes, code) -> list[tuple[Boundary, np.ndarray, np.ndarray, np.ndarray]]:
    """Changes at which nothing happens but that the greatest pressure passes one break: boundaries, their rows; and pressures and
    numbers of breaks, of every change."""
    passed = (changes.heights[:, 0] > 0) != (changes.heights[:, 1] > 0)
    breaks = columns.carry.breaks(columns.group)
    which = passed.argmax(axis=1)
    alone = (code[:, 0] == code[:, 1]) & passed.any(axis=1) & (which < breaks.shape[1])
    pressure = breaks[np.arange(changes.size), which % breaks.shape[1]]
    rows = {sequence: np.flatnonzero(alone & (code[:, 0] == CODE[sequence])) for sequence in ("acaf", "afc", "ac", "cf")}
    return [(Boundary(sequence, "peak"), some, pressure, which) for sequence, some in rows.items() if some.size]
