"""What a look at a few nodes of a curve leaves out: what loading passes by before the least pressure, and unloading above it."""

import numpy as np
import pytest

import hystrip
from hystrip.level.interpolation import Intervals
from hystrip.level.look import BENDS, between_nodes, unloading_meets
from hystrip.numerics.quadrature import Stage, interior_nodes


def _looked(curve, *ends, column=0, error=0.0, rough=False, n=6):
    """The intervals between the ``ends``, with the pressure ``curve(D)`` at their nodes; and those with their ends."""
    low, high = np.array(ends[:-1], float), np.array(ends[1:], float)
    intervals = Intervals.of(np.full(low.size, column), low, high, np.zeros(column + 1), np.zeros((column + 1, 1)))
    intervals.rough[:] = rough
    at = intervals.at(interior_nodes(n))
    values = curve(at)[:, :, None]
    return Stage(intervals, n, (values, np.full(values.shape, error))), np.column_stack((low, at, high))


def test_a_straight_curve_is_known_on_to_its_ends():
    stage, D = _looked(lambda D: 3 * D - 1, 0, 0.5, 2)
    p, beyond = between_nodes(stage, D, 1.0)
    assert p == pytest.approx(3 * D - 1, abs=1e-14) and beyond == pytest.approx(0, abs=1e-14)


def test_nodes_may_coincide_in_what_is_as_narrow_as_rounding():
    stage, D = _looked(lambda D: 3 * D - 1, 1 - 2e-16, 1, 1 + 1e-15)
    assert (np.diff(D) == 0).any()
    p, beyond = between_nodes(stage, D, 1.0)
    assert p == pytest.approx(2, abs=1e-13) and (beyond < 1e-13).all()


@pytest.mark.parametrize("curve", [np.square, np.cos, lambda D: np.exp(-3 * D)])
def test_between_nodes_a_curve_keeps_within_its_bounds(curve):
    stage, D = _looked(curve, 0, 0.7, 1.3)
    p, beyond = between_nodes(stage, D, BENDS[0])
    for row, ends, slack in zip(D, p, beyond, strict=True):
        inside = curve(row[1:-2, None] + np.diff(row)[1:-1, None] * np.linspace(0, 1, 11))
        pairs = np.stack((ends[1:-2], ends[2:-1]))
        assert (inside.min(axis=1) >= pairs.min(axis=0) - slack[1:-1]).all()
        assert (inside.max(axis=1) <= pairs.max(axis=0) + slack[1:-1]).all()


def _met(curve, *ends, n=6, **of):
    """From where to where unloading may come to pressures in each of the intervals between the ``ends``: None, or both."""
    stage, D = _looked(curve, *ends, n=n, **of)
    meets, _ = unloading_meets(stage, D, BENDS[n > 6])
    return [(row[:-1][some].min(), row[1:][some].max()) if some.any() else None for row, some in zip(D, meets, strict=True)]


def test_unloading_comes_to_all_of_a_curve_that_rises():
    assert _met(lambda D: D, 0, 0.5, 2) == [(0, 0.5), (0.5, 2)]
    stage, D = _looked(lambda D: D, 0, 0.5, 2)
    _, ceiling = unloading_meets(stage, D, BENDS[0])
    assert ceiling[1] == np.inf and ceiling[0] == pytest.approx(0.5, abs=2e-3) and ceiling[0] >= 0.5


def test_unloading_comes_to_nothing_above_the_least_pressure_before():
    """Pressed in from 1 on; drawn out of it the pressure is 2.3 higher: only below -1.3 it comes to what it was not yet at."""
    curve = lambda D: np.where(D > 1, D - 1, D + 1.3)  # noqa: E731
    low, high = _met(curve, -3, 1, 2)[0]
    assert low == -3 and -1.3 < high < 0
    assert _met(curve, -1.1, 1, 2)[0] is None


def test_errors_leave_open_whether_it_comes_to_it():
    curve = lambda D: np.where(D > 1, D, 0.02 + 0.1 * D)  # noqa: E731
    curve_above = lambda D: np.where(D > 1, D - 1, 0.05 + 0.1 * D)  # noqa: E731
    assert _met(curve, 0, 1, 2)[0] == (0, 1)
    assert _met(curve_above, 0, 1, 2)[0] is None and _met(curve_above, 0, 1, 2, error=0.02)[0] is not None


@pytest.mark.parametrize("n", [6, 12])
@pytest.mark.parametrize("rough", [False, [True, False]])
def test_what_rises_from_a_break_is_not_followed(rough, n):
    """Drawn out from 0, where it is least, the pressure rises all along."""
    assert _met(lambda D: np.where(D > 0, D, -2 * D), -1, 0, 1, rough=rough, n=n)[0] is None


def test_what_rises_from_a_break_at_once_is_not_followed():
    """Like a logarithm, as with short memory all strips let go: what is next to the break is all but as low as that."""
    curve = lambda D: np.where(D > 0, D, 1e-3 * np.log1p(-100 * np.minimum(D, 0.0)))  # noqa: E731
    assert _met(curve, -1, 0, 1, n=12, error=1e-6)[0] is None


@pytest.mark.parametrize("falls", [0.2, 1.0, 5.0])
@pytest.mark.parametrize("rises", [0.5, 1.0, 5.0])
@pytest.mark.parametrize("rough", [False, [True, True, False]])
def test_a_least_pressure_at_a_break_is_not_passed_over(falls, rises, rough):
    """A curve that is least at the break between two intervals, and only next to it below the least pressure before."""

    def curve(D):
        return np.where(D > 2, D - 2, np.where(D > 1, rises * (D - 1), falls * (1 - D)) - 0.005 * rises)

    low, high = _met(curve, 0, 1, 2, 3, rough=rough)[1]
    assert low <= 1 and high >= 1.005


def test_columns_have_nothing_to_do_with_each_other():
    stages = [_looked(np.square, -1, 0, 1, column=k, error=0.0) for k in (0, 1)]
    both = Stage(
        Intervals.joined([s.parts for s, _ in stages]),
        6,
        tuple(np.concatenate(v) for v in zip(*(s.known for s, _ in stages), strict=True)),
    )
    meets, ceiling = unloading_meets(both, np.concatenate([D for _, D in stages]), BENDS[0])
    assert (meets[:2] == meets[2:]).all() and (ceiling[:2] == ceiling[2:]).all()


def test_a_level_whose_strips_cling_all_but_at_once_is_not_followed_there():
    """With short memory the pressure of the second level falls by a fifth within 1e-12 of its height, before it is least: 88,800
    strips were solved for it, and 9 s taken, where others take one."""
    levels = [(1e-05, 2.58748e-06), (3.78627e-06, 9.34202e-07), (5.60906e-07, 5.75013e-09), (6.33188e-08, 1.39991e-08)]
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=3.1071629427318798e-06)
    adhesion = hystrip.Dugdale(gamma=0.000105528021712, delta_0=6.25544e-07)
    point = {"pressure": 157.408, "velocity": 1.21219e-05, "branch": "loading"}
    rough, fine = (
        hystrip.solve(material, adhesion, [hystrip.Level(*of) for of in levels], **point, rtol=r) for r in (1e-3, 1e-5)
    )
    assert fine.counts["strips_solved"] < 40_000
    assert abs(rough.tau - fine.tau) <= rough.tau_error + fine.tau_error
    assert fine.mu == pytest.approx(0.11820426149, rel=1e-7)
