"""Curves of the plane of strips: at a point that an equation locates the regimes of strips really meet."""

import numpy as np
import pytest

import hystrip
from hystrip.level.averages import level_means
from hystrip.level.changes import Changes
from hystrip.level.plane import BOUNDARIES, Boundary
from hystrip.level.regime_map import locate_boundaries, thresholds
from hystrip.level.strips import LevelBatch
from hystrip.orbit.regimes import CODE

K = 1e9


def _random(seed, branch, several=False):
    """A level with anything between weak and strong adhesion, at three velocities, on a foundation with one time or several."""
    rng = np.random.default_rng(seed)
    length = 10 ** rng.uniform(-7, -4)
    h = length * 10 ** rng.uniform(-1.7, -0.6)
    material = hystrip.StandardLinearSolid(K, 1e-2, 1e-2 * 10 ** rng.uniform(-3, -0.1))
    adhesion = hystrip.Dugdale(p_0=K * h * 10 ** rng.uniform(-1.5, 1.5), delta_0=h * 10 ** rng.uniform(-2.5, 0))
    V = 10 ** rng.uniform(-2, 3, 3) * length / (2 * np.pi * 1e-2)
    edge = ["continuous", "constitutive"][rng.integers(2)]
    if several:
        edge, times = "constitutive", np.geomspace(1e-2, 1e-12, 5)
        material = hystrip.Prony(K, list(K * 10 ** rng.uniform(-1, 1, 5)), list(times))
    return LevelBatch(material, adhesion, hystrip.Level(l=length, h=h), edge, branch, V, np.zeros(3))


@pytest.mark.parametrize("several", [False, True], ids=["one time", "times over ten decades"])
@pytest.mark.parametrize("branch", ["unloading", "loading"])
def test_located_points_are_where_regimes_meet(branch, several):
    """Along the crest, from free to saturated: what an equation says of the place between neighbours in different regimes."""
    told = asked = wrong = 0
    kinds = set()
    for seed in range(6 if several else 30):
        columns = _random(seed, branch, several)
        h, P, reach = columns.level.h, columns.stretch, columns.adhesion.delta_0
        D = np.linspace(-(2 * P + reach), 2 * h + P, 60 if several else 120)
        state, x = np.repeat(np.arange(3), D.size), np.tile(D, 3)
        crest = lambda state, x, columns=columns: columns.at(state, x).evaluate(np.arange(x.size), np.zeros(x.size))  # noqa: E731
        answers = [v.reshape(3, D.size, *v.shape[1:]) for v in crest(state, x)]
        changes, *_ = Changes.between(np.arange(3), np.tile(D, (3, 1)), answers)
        line, codes = changes.line, changes.codes
        E = np.stack((changes.low, changes.high), axis=1) - h
        place, found = locate_boundaries(columns.at(line, changes.low), changes, np.full(E.shape, 0.5 * h), E, "E")
        asked, told = asked + line.size, told + int(found.sum())
        # drawn out, what is engaged all along opens by its threshold, whatever it opens to
        assert branch == "loading" or found[np.isin(codes, [CODE["c"], CODE["a"]]).any(axis=1)].all()
        kinds |= set(columns.crossings.points)
        below, above = (crest(line[found], place[found] + h + shift * h)[0] for shift in (-1e-6, 1e-6))
        wrong += int((below == above).sum())
    assert asked > (30 if several else 100) and told > 0.6 * asked
    # where a third regime lies between two samples the equation of one of them may tell of a curve that is hidden
    assert wrong <= 0.02 * told
    assert {b.event for b in BOUNDARIES} - {"peak", "release" if branch == "loading" else ""} == {kind.event for kind in kinds}


def test_thresholds_are_where_saturated_contact_ends():
    columns = _random(3, "unloading")
    R = np.hypot(1, columns.level.k * columns.V * 1e-2) / np.hypot(1, columns.level.k * columns.V * columns.material.T_sigma)
    D = 0.25 * columns.level.h * (1 + R) + 0.5 * columns.level.h - columns.stretch
    columns = columns.at(np.arange(3), D)
    state, theta = thresholds(columns)
    for shift, saturated in ((-1e-9, False), (1e-9, True)):
        codes = columns.evaluate(state, theta + shift)[0]
        at = np.abs(columns.level.amplitude(theta) * (1 + R[state]) - (D[state] - columns.level.drop(theta) + columns.stretch))
        here = at < 1e-9 * columns.level.h
        assert here.any() and ((codes[here] == CODE["c"]) == saturated).all()


def test_both_points_are_found_where_a_curve_turns():
    """Free strips between crest and valley appear as a fold turns: penetrations next to there cross it twice."""
    material, adhesion = hystrip.StandardLinearSolid(K, 1e-2, 1e-4), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
    level, V = hystrip.Level(l=10e-6, h=1e-6), np.full(24, 1e-2)
    columns = LevelBatch(material, adhesion, level, "continuous", "unloading", V, np.linspace(0.36, 0.38, 24) * level.h)
    level_means(columns, np.full(24, 1e-4))
    turn = 0.382436550468  # located by the strips that let go first
    near = columns.at(np.zeros(6, int), (turn - np.geomspace(1e-3, 1e-9, 6)) * level.h)
    state, theta = (np.concatenate(v) for v in zip(*columns.crossings.predicted(near), strict=True))
    A = level.amplitude(theta)
    folds = [np.sort(A[(state == k) & (A > 0.08 * level.h) & (A < 0.15 * level.h)]) for k in range(6)]
    assert all(fold.size >= 2 and fold[-1] > fold[0] for fold in folds)
    width = [fold[-1] - fold[0] for fold in folds]
    # like a square root of the distance
    assert np.allclose(np.diff(np.log(width)), 0.5 * np.log(10 ** (-6 / 5)), rtol=0.05)


def test_both_points_are_found_next_to_the_valley():
    """The same where a curve turns so close to the valley that all amplitudes on it are small."""
    material, adhesion = hystrip.StandardLinearSolid(K, 1e-2, 8.835e-6), hystrip.Dugdale(gamma=2.744e-10, delta_0=3.43554e-10)
    level, V = hystrip.Level(l=2.62737e-7, h=6.78941e-8), np.full(8, 3.25677e-5)
    columns = LevelBatch(material, adhesion, level, "constitutive", "unloading", V, np.linspace(0.9852, 0.985312, 8) * level.h)
    level_means(columns, np.full(8, 1e-6))
    turns = columns.crossings.turned(columns)
    turn = turns.E[np.abs(turns.E / level.h + 1 - 0.985312).argmin()] / level.h + 1
    near = columns.at(np.zeros(3, int), (turn - np.geomspace(1e-6, 1e-8, 3)) * level.h)
    means = level_means(near, np.full(3, 1e-6))
    # free strips in between
    assert all(CODE["f"] in zones.code for zones in means.zones)
    width = [np.diff([zones.low[k], zones.high[k]])[0] for zones in means.zones for k in np.flatnonzero(zones.code == CODE["f"])]
    assert np.allclose(np.diff(np.log(width)), -0.5 * np.log(10), rtol=0.05)


def test_a_curve_that_is_known_does_not_hide_a_thin_zone_next_to_it():
    """Next to strips that cling all along, a thousandth of a period is in partial contact: no node of a panel meets it."""
    material, adhesion = hystrip.StandardLinearSolid(K, 1e-2, 1e-4), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
    level, rtol = hystrip.Level(l=10e-6, h=1e-6), 1e-4
    D, one = np.linspace(-0.066, -0.045, 12) * level.h, np.full(1, 1e-3)
    alone = [
        level_means(LevelBatch(material, adhesion, level, "continuous", "unloading", one, D[[k]]), np.full(1, rtol))
        for k in range(12)
    ]
    columns = LevelBatch(material, adhesion, level, "continuous", "unloading", np.repeat(one, 12), D)
    level_means(columns, np.full(12, rtol))
    release = next(points for boundary, points in columns.crossings.points.items() if boundary.event == "release")
    columns.crossings.points = {Boundary("ac", "release"): release}  # the fold next to it is forgotten
    again = level_means(columns, np.full(12, rtol))
    for k in range(12):
        assert (
            again.zones[k].code.tolist() == alone[k].zones[0].code.tolist() == [CODE[s] for s in ("acaf", "f", "acaf", "ac", "c")]
        )
        assert (np.abs(again.values[k] - alone[k].values[0]) <= again.errors[k] + alone[k].errors[0]).all()


def test_islands_end_where_their_curve_turns():
    """The free strips of the curve above vanish at its turn, whose place is known to the square of that along the curve."""
    material, adhesion = hystrip.StandardLinearSolid(K, 1e-2, 1e-4), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
    level, V, turn = hystrip.Level(l=10e-6, h=1e-6), np.full(8, 1e-2), 0.382436550468
    columns = LevelBatch(material, adhesion, level, "continuous", "unloading", V, np.linspace(0.3, 0.38, 8) * level.h)
    level_means(columns, np.full(8, 1e-4))
    turns = columns.crossings.turned(columns)
    near = np.flatnonzero(np.abs(turns.E / level.h + 1 - turn) < 1e-6)
    assert near.size == 1 and abs(turns.E[near[0]] / level.h + 1 - turn) < 1e-11 and turns.way[near[0]] == 1
    theta = 2 * np.arccos(np.sqrt(2 * turns.A[near] / level.h))
    for aside, free in ((-1e-8, True), (1e-8, False)):
        at = columns.at(np.zeros(1, int), (turn + aside) * level.h * np.ones(1))
        assert (at.codes(np.zeros(1, int), theta)[0] == CODE["f"]) == free
    # asked again nothing is located anew
    known = columns.crossings.turned(columns)
    assert known.size == turns.size
    # next to the turn, on the far side, the strips bend like sqrt(s^2 + distance): the panels end there
    for aside in (1e-12, 1e-9, 1e-6):
        one = columns.at(np.zeros(1, int), (turn + aside) * level.h * np.ones(1))
        rough, fine = (level_means(one, np.full(1, rtol)) for rtol in (1e-3, 1e-11))
        assert (np.abs(rough.values - fine.values) <= rough.errors + fine.errors).all()


def test_a_fold_of_a_short_free_zone_is_told_by_its_equation():
    """On a stiff foundation strips that are loaded are held all along once hardly anything of their free zone is left: the fold
    is found from orbits whose free zone is thousands of times as long."""
    material = hystrip.StandardLinearSolid(K, 1e-2, 5e-7)
    adhesion, level = hystrip.Dugdale(gamma=2.35e-9, delta_0=8e-10), hystrip.Level(l=5.6e-8, h=1.46e-9)
    D = np.geomspace(1e-9, 3e-6, 12)
    columns = LevelBatch(material, adhesion, level, "continuous", "loading", np.full(12, 0.57), D)
    means = level_means(columns, np.full(12, 1e-4))
    assert sum((CODE["acaf"] in z.code) and (CODE["ac"] in z.code) for z in means.zones) >= 6
    assert columns.work.bisected <= 0.03 * columns.work.solved


@pytest.mark.parametrize(("T_sigma", "gamma", "delta_0", "l", "h", "V"), [
    (1.2381e-4, 7.8212e-9, 1.70792e-9, 7.03226e-8, 1.42635e-8, 8.5625e-5),
    (2.8255e-7, 2.594e-7, 4.13988e-10, 3.92195e-8, 3.225e-9, 0.126229),
])  # fmt: skip
def test_a_fold_where_adhesion_barely_ends_is_told_by_its_equation(T_sigma, gamma, delta_0, l, h, V):  # noqa: E741
    """What loading lets go of is held all along from where the load at its release is a hundredth of the step there, or less: the
    slope of the onset map, a quotient, hardly changes before."""
    material, adhesion = hystrip.StandardLinearSolid(K, 1e-2, T_sigma), hystrip.Dugdale(gamma=gamma, delta_0=delta_0)
    columns = LevelBatch(
        material, adhesion, hystrip.Level(l=l, h=h), "constitutive", "loading", np.full(12, V), np.linspace(0.02, 3, 12) * h
    )
    means = level_means(columns, np.full(12, 1e-4))
    assert sum((CODE["acaf"] in z.code) and (CODE["ac"] in z.code) for z in means.zones) >= 8
    assert columns.work.bisected <= 0.03 * columns.work.solved


@pytest.mark.parametrize("branch", ["unloading", "loading"])
@pytest.mark.parametrize("V", [2e-9, 1e-7, 1e-5])
def test_where_contact_appears_with_short_memory_is_told_by_its_equation(V, branch):
    """Without memory w is ``-p_0/K`` all through adhesion, and contact appears where the crest of a strip comes that deep, at
    ``E + 2 A = -p_0/K``; and the load at an edge tells nothing of the rate of the gap there, nor whether it lets go."""
    material, adhesion = hystrip.StandardLinearSolid(K, 1e-2, 5.7e-8), hystrip.Dugdale(gamma=6.2e-10, delta_0=3.9e-9)
    level, memory = hystrip.Level(l=2.6e-6, h=1.6e-8), 2 * np.pi / 2.6e-6 * V * 1e-2
    columns = LevelBatch(material, adhesion, level, "constitutive", branch, np.full(8, V), np.linspace(0.05, 0.95, 8) * level.h)
    means = level_means(columns, np.full(8, 1e-4))
    met = [(D, z.low[k]) for D, z in zip(columns.D, means.zones, strict=True) for k in np.flatnonzero(z.code == CODE["af"])]
    assert len(met) >= 4 and columns.work.bisected <= 0.03 * columns.work.solved
    for D, theta in met:
        nearest = np.arccos(np.sqrt((level.h - D - columns.stretch) / level.h)) * 2
        assert abs(theta - nearest) < 0.01 * memory**2 + 1e-12
