"""A law is as accurate as what is asked of it; rims that hold on after the crest are found; laws on cells; whose error a break
has."""

import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))

import survey

import hystrip
from hystrip.level.branches import Errors, Piece, branches_of, parameter, rising
from hystrip.level.error_budget import ErrorBudget
from hystrip.level.interpolation import Intervals, weighed
from hystrip.level.inverse import Penetrations, Walk
from hystrip.level.law import Laws
from hystrip.level.segment import cells_of, segments_of
from hystrip.level.strips import LevelBatch, WorkCounters
from hystrip.multilevel import Surface, _Solve

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
ADHESION = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
LEVELS = (hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9))
PRESSURE, V, RTOL = 100.0, np.array([5e-4, 2e-2]), 1e-5
#: velocities at which much of the law is asked for on little of the surface, and a tolerance at which that takes more nodes
FAST, FINE = np.array([1e-2, 3e-2]), 1e-7


def budget(share, friction=1.0):
    """One point that asks pressures from -1 to 1 Pa evenly on a ``share`` of the surface."""
    return ErrorBudget(np.array([0]), np.array([[-1.0, 1.0]]), np.array([[0.0, share]]), np.array([friction]))


def test_what_is_met_on_less_of_the_surface_may_err_by_as_much_more():
    (all_of_it, of_all), (tenth, of_tenth) = (budget(share).share_between(0, -1.0, 1.0) for share in (1.0, 0.1))
    assert all_of_it == pytest.approx(10 * tenth) and of_tenth == pytest.approx(10 * of_all)
    # two parts of a law may err by as much
    assert all_of_it == 2.0 and of_all == 0.5


def test_half_the_pressures_are_met_half_as_often():
    (whole, _), (half, _) = (budget(0.1).share_between(0, low, 1.0) for low in (-1.0, 0.0))
    assert half == pytest.approx(0.5 * whole)


def test_the_most_demanding_point_of_a_group_counts():
    both = ErrorBudget(np.array([0, 0, 1]), np.tile([-1.0, 1.0], (3, 1)), np.array([[0, 1e-4], [0, 1.0], [0, 1e-4]]), np.ones(3))
    (one, of_one), (other, of_other) = (both.share_between(group, -1.0, 1.0) for group in (0, 1))
    assert one > 1e3 * other and of_one < 1e-3 * of_other


def test_pressures_nobody_meets_are_easiest():
    for low, high in ((2.0, 1.0), (5.0, 6.0)):
        share, friction = budget(0.5).share_between(0, low, high)
        assert share < 1e-5 and friction > 1e5
    further = budget(0.5).further_down(2)
    assert (
        further.share_between(0, -1.0, 1.0) == further.share_between(0, 5.0, 6.0) == (1.0, 0.5)
        and further.share_between(0, 2.0, 1.0)[0] < 1e-5
    )


def _weighed(share, p, friction, ceiling=np.inf):
    """Absolute accuracy of quantities of an interval in which pressures and frictions are these, and fractions 0.5, where one
    point meets pressures from -1 to 1 Pa evenly on a ``share`` of the surface; at rtol 1e-3."""
    columns = LevelBatch(MATERIAL, ADHESION, LEVELS[0], "continuous", "unloading", V[:1], np.zeros(1))
    values = np.stack(np.broadcast_arrays(p, friction, 0.5, 0.5), axis=1)
    one = Intervals.of(np.zeros(1, int), np.zeros(1), np.ones(1), np.full(1, 1e-3), np.zeros((1, 4)))
    out = weighed(columns, budget(share, 1e3), replace(one, ceiling=np.full(1, ceiling)), [values])
    return out.atol[0]


def test_an_interval_is_as_accurate_as_the_surface_that_meets_its_pressures():
    p, friction = np.linspace(-0.5, 0.5, 9), np.linspace(100.0, 200.0, 9)
    everywhere, tenth = (_weighed(share, p, friction) for share in (2.0, 0.2))
    # an error of friction on a share of the surface, against what the point may err
    assert tenth[1] == pytest.approx(1e-3 * 1e3 / (2 * 0.1)) and everywhere[1] == pytest.approx(0.1 * tenth[1])
    # that of itself, and as much as a fraction counts there
    assert tenth[2:] == pytest.approx(tenth[1] / 100 * 0.5 + 1e-3 / (2 * 0.1), rel=1e-2)
    assert tenth[0] == pytest.approx(tenth[1] / 100, rel=1e-2)
    # nobody comes above the ceiling
    assert (_weighed(2.0, p + 1.0, friction, ceiling=0.0) > 1e3 * everywhere).all()


@pytest.mark.parametrize("friction", [0.0, 100.0, 100 * (1 + 1e-300)])
@pytest.mark.parametrize("p", [np.zeros(9), np.linspace(-0.5, 0.5, 9)], ids=["no pressure", "pressures"])
def test_an_interval_in_which_nothing_rises_may_err_by_numbers(p, friction):
    with np.errstate(all="raise", under="ignore"):
        found = _weighed(1.0, p, np.append(np.full(8, friction), friction + 1e-310))
    assert np.isfinite(found).all() and (found >= 0).all()


def test_no_interval_is_asked_for_more_than_the_law():
    atol = _weighed(1e3, np.linspace(-0.5, 0.5, 9), np.linspace(1e4, 2e4, 9))
    assert 0 <= atol[1] < 1e-3 * 1e4


def test_a_piece_that_may_be_coarser_is_no_worse_where_friction_is_large():
    """Means err relative to themselves, interpolation relative to the least: between pressures over which friction grows tenfold
    the means erred ten times what the piece may (24,559 strips in three attempts, not converged)."""
    result = hystrip.solve(**survey.draw(20261231, 485))
    assert result.converged.all() and result.counts["strips_solved"] < 12_000


def test_a_fraction_that_hardly_counts_does_not_drive_the_work():
    """Where saturated adhesion begins to hold, at slow sliding, the adhering fraction goes like a logarithm of the penetration:
    halving after halving of a law (31,756 strips), on pressures that next to none of the surface meets."""
    material, adhesion = (
        hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=5e-7),
        hystrip.Dugdale(gamma=2.4e-11, delta_0=4e-10),
    )
    levels = hystrip.Level(1e-5, 2e-7), hystrip.Level(1.66667e-6, 8.33335e-8)
    result = hystrip.solve(material, adhesion, levels, pressure=0.6, velocity=3.1831e-6, rtol=1e-4)
    assert result.converged and result.counts["strips_solved"] < 4000
    # with every fraction to 1e-3
    assert np.allclose(result.contact_by_level, [0.04460895, 0.02368630], atol=1e-7)
    assert np.allclose(result.adhesion_by_level, [0.00117501, 0.00054308], atol=1e-7)


def _friction(monkeypatch=None, V=V, rtol=RTOL):
    if monkeypatch is not None:
        # every pressure asked for everywhere: no law is coarser than the result
        monkeypatch.setattr(ErrorBudget, "share_between", lambda *_: (2.0, 0.0))
    return hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=PRESSURE, velocity=V, rtol=rtol)


def test_coarser_laws_give_the_same_friction_for_less(monkeypatch):
    weighted, even = _friction(), _friction(monkeypatch)
    floor = 1e-3 * (MATERIAL.K * LEVELS[0].h + ADHESION.p_0) * LEVELS[0].h / LEVELS[0].l
    assert (np.abs(weighted.tau - even.tau) <= RTOL * (np.abs(even.tau) + floor)).all()
    assert (weighted.tau_error <= RTOL * (np.abs(even.tau) + floor)).all()
    even = _friction(monkeypatch, FAST, FINE)
    monkeypatch.undo()
    assert _friction(V=FAST, rtol=FINE).counts["strips_solved"] < 0.9 * even.counts["strips_solved"]


@pytest.mark.parametrize(
    ("V", "edge", "least"),
    [(3e-4, "continuous", -1128.56145436), (3e-4, "constitutive", -1128.56145436), (5e-3, "continuous", -663.52136315)],
)
def test_unloading_ends_where_no_penetration_carries_less(V, edge, least):
    """Pull-off against a scan of equal strips over all penetrations, where the crest and where the rims hold longest."""
    law = hystrip.friction_law(MATERIAL, ADHESION, LEVELS[1], V=V, edge=edge, rtol=1e-3, below=-500.0)
    # of 300 penetrations from -2.42 to -0.2 um, 400 strips each: a jump in y costs one part in 400 of what jumps
    assert law.pull_off == pytest.approx(least, abs=ADHESION.p_0 / 400)


def test_cells_follow_functions_as_closely_as_asked():
    def functions(which, x):
        smooth = np.stack((np.sqrt(x + 1e-3), np.exp(-x) * np.cos(9 * x)), axis=1)
        return np.where(which[:, None] == 0, smooth, np.cos(np.stack((x, 40 * x), axis=1)))

    tolerance = np.array([[1e-7, 1e-9], [1e-4, 1e-5]])
    every = cells_of(functions, tolerance)
    x = np.random.default_rng(1).random(2000)
    for k, cells in enumerate(every):
        assert (np.abs(cells(x).T - functions(np.full(x.size, k), x)).max(axis=0) <= tolerance[k]).all()
        assert not cells.error.any()
    assert every[0].size.min() < every[0].size.max()


def test_cells_say_what_they_miss():
    def steps(which, x):
        return np.where(x < 0.3, 0.0, which + 1.0)[:, None]

    x = parameter((np.arange(200_000) + 0.5) / 200_000)
    for k, cells in enumerate(cells_of(steps, np.array([[1e-9], [1e-9]]))):
        assert 0 < np.abs(cells(x).T - steps(np.full(x.size, k), x)).mean() < cells.error[0]


def constant(error):
    """Errors that are the same everywhere, (q,)."""
    return Errors(np.zeros(1), error[None])


def _branch(p_low, p_high, error, friction=1.0):
    """A branch along which pressure and two other quantities rise evenly, and friction by so much per pressure."""
    middle, half = 0.5 * (p_high + p_low), 0.5 * (p_high - p_low)
    rise = np.array([1.0, friction, 1.0, 1.0])
    return rising([Piece(p_low, p_high, np.array([middle * rise, half * rise]), constant(np.full(4, error)))])[0][0]


@pytest.mark.parametrize("unloading", [True, False])
@pytest.mark.parametrize("joints", [(), (0.0, 1.5)])
def test_a_break_is_known_as_well_as_the_branch_that_ends_there(unloading, joints):
    """Whether the law goes on smoothly in another segment at its far end, or ends there."""
    places = np.sort([-1.0, 1.0, 2.0, *joints])
    branches = [_branch(low, high, 1e-2 if high <= 1.0 else 1e-6) for low, high in pairwise(places)]
    segments = [
        replace(s, inner_low=s.p_low in joints, inner_high=s.p_high in joints)
        for s in segments_of(branches, np.full((len(branches), 4), 1e-9))
    ]
    laws = Laws([segments], np.array([-1.0]), np.array([2.0]), np.zeros((1, 4)), np.full(1, np.inf), np.zeros(1, int), unloading)
    jumps, errors = (dict(zip(laws.breaks[0], told[0], strict=True)) for told in laws.at_breaks)
    assert errors == {-1.0: 1e-2, 1.0: 1e-6 if unloading else 1e-2, 2.0: 1e-6}
    # friction goes with the pressure: before the break and beyond it, wherever that is, it differs by as much
    assert jumps[1.0] == pytest.approx(2 * errors[1.0], rel=1e-3)


def test_friction_may_jump_by_most_right_at_a_break():
    """It falls from 3 Pa at pull-off, which is known to 0.5 Pa: half a pascal further on it is less, but no less is lost."""
    segments, ends = segments_of([_branch(-3.0, -1.0, 0.5, friction=-1.0)], np.full((1, 4), 1e-9)), np.array([[-3.0], [-1.0]])
    laws = Laws([segments], *ends, np.zeros((1, 4)), np.full(1, np.inf), np.zeros(1, int), True)
    assert laws.at_breaks[0][0, 0] == pytest.approx(3.0, rel=1e-6)


def test_a_break_that_is_hardly_known_may_hide_as_much_friction_as_is_around_it():
    """The second level's law, asked for on a thousandth of the surface down there, misses a dip of its curve: it ends a Pa above
    the pull-off, at a small jump, where the friction is large."""
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=3.3136196144642875e-05)
    adhesion = hystrip.Dugdale(gamma=1.0247356077156405e-07, delta_0=1.3776163472605357e-09)
    levels = [
        hystrip.Level(1e-05, 1.335664606003326e-07),
        hystrip.Level(8.038478085790302e-07, 3.7451142021671425e-08),
        hystrip.Level(6.425763651437568e-08, 1.8980205476647202e-08),
    ]
    at = {"pressure": 12.023912567691406, "velocity": 0.00502483171755842}
    found = hystrip.solve(material, adhesion, levels, rtol=1e-5, **at)
    # at 1e-8
    assert found.converged and abs(found.tau - 0.757188212971) <= found.tau_error


def test_loading_does_not_begin_where_the_curve_only_seems_to_rise():
    """While strips begin to cling the pressure falls from 0; a ripple on it, within its error, is no branch."""
    ripple = np.zeros((10, 4))
    ripple[[0, 1, 9]] = np.array([-40.0, -40.0, 0.6])[:, None]
    falling, rise = (
        Piece(-1.0, 0.0, ripple, constant(np.full(4, 2.0))),
        Piece(0.0, 1.0, np.array([[10.0] * 4, [90.0] * 4]), constant(np.full(4, 1e-6))),
    )
    assert len(rising([falling])[0]) > 0
    ((branch,),) = branches_of([[rise, falling]], unloading=False)
    assert branch.p_low == pytest.approx(-80.0) and branch.p_high == pytest.approx(100.0)


@pytest.mark.parametrize("unloading", [True, False])
@pytest.mark.parametrize("at_once", [True, False])
def test_a_pressure_in_a_jump_of_the_curve_has_the_friction_of_a_mixture(unloading, at_once):
    """From 1 to 3 Pa the curve jumps at D = 1, its friction from 1 to 5 Pa."""
    line = lambda *ends: np.array([np.mean(ends, axis=0), 0.5 * np.subtract(*ends[::-1])])  # noqa: E731
    none = constant(np.zeros(2))
    pieces = [Piece(0.0, 1.0, line((0, 0), (1, 1)), none), Piece(1.0, 2.0, line((3, 5), (4, 6)), none)]
    walk = Walk(0, unloading, 2.0, 1e-6, 1e-6, [], goal=1e-6)
    for some in [pieces] if at_once else [[piece] for piece in (pieces[::-1] if unloading else pieces)]:
        (row,) = branches_of([[*walk.known, *some]], unloading)
        walk.advance(some, row, False)
    assert walk.root.D == pytest.approx(1.0) and walk.root.slope[1] == pytest.approx(2.0)


@pytest.mark.parametrize("in_jump", [True, False])
def test_what_lower_levels_carry_in_a_jump_of_the_curve_is_uncertain(in_jump):
    """Level 1 meets 1 of 2 Pa next to the jump, where its friction is 3 and that of level 2 is 5 Pa."""
    surface = Surface(MATERIAL, ADHESION, LEVELS, "continuous", "unloading", 1e-3, True, WorkCounters())
    solve = _Solve(surface, np.ones(1), np.full(1, 2.0), True)
    values = np.array([[1.0, 3.0, 0.5, 0.0, 5.0, 0.5, 0.0, 0.0]])
    root = replace(Penetrations.at(np.ones(1)), slope=np.array([[1.0, 1.0, 0.25, 1.0]]), in_jump=np.array([in_jump]))
    solve._write(np.zeros(1, int), root, SimpleNamespace(values=values, errors=np.zeros_like(values)))
    assert solve.out.tau[:, 0].tolist() == [4.0, 5.0]
    # the pressure is met to half: friction goes from 3 to 4, contact from 0.5 to 0.75, and what is carried goes with both
    assert solve.out.error[0] == pytest.approx(1.0 + (1 / 4 + 0.25 / 0.75) * 5.0 + (5.0 if in_jump else 0.0), rel=1e-15)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("T_sigma", "gamma", "delta_0", "levels", "pressure", "V", "rtol", "how", "exact"),
    [
        # exact: at a thousandth of rtol
        (
            2.99e-9,
            3.22e-11,
            2.083e-8,
            [(1e-5, 3.06e-8), (3.665e-6, 2.885e-7)],
            1.964e-3,
            1.3032,
            2e-5,
            ("unloading", "continuous"),
            7.27072209e-6,
        ),
        (
            5.56e-4,
            6.395e-18,
            3.24e-14,
            [(1e-5, 1.35e-9), (2.65e-6, 7.94e-7)],
            3.06e-4,
            5.1,
            5e-5,
            ("loading", "continuous"),
            3.3130714395e-10,
        ),
    ],
)
def test_a_lower_level_that_is_far_rougher_errs_by_no_more_than_the_friction_of_level_1(
    T_sigma, gamma, delta_0, levels, pressure, V, rtol, how, exact
):
    """Its own natural scale is a thousand times that of what is asked for."""
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, T_sigma), hystrip.Dugdale(gamma=gamma, delta_0=delta_0)
    levels, how = [hystrip.Level(*each) for each in levels], dict(zip(("branch", "edge"), how, strict=True))
    r = hystrip.solve(material, adhesion, levels, pressure=pressure, velocity=V, rtol=rtol, **how)
    assert r.converged.all() and r.counts["strips_solved"] < 5_000
    assert abs(r.tau - exact) <= r.tau_error
