"""Many pressures, or penetrations, at one velocity: what was looked at along the curve for one of them is known to all others."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import hystrip
from hystrip.level.inverse import _walks
from hystrip.level.strips import LevelBatch
from hystrip.level.walk import growing

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
SURFACE = MATERIAL, hystrip.Dugdale(p_0=2500.0, delta_0=1e-8), [hystrip.Level(5e-7, 1e-7)]
PRESSURES = np.geomspace(1, 1e4, 4)


@pytest.mark.parametrize(
    ("branch", "p_0", "level", "V", "most"),
    [("unloading", 500.0, hystrip.Level(5e-6, 1e-6), 7e-3, 1e3), ("loading", 2500.0, hystrip.Level(5e-7, 1e-7), 7e-4, 2e4)],
)
def test_pressures_of_one_velocity_share_what_is_looked_at(branch, p_0, level, V, most):
    def solve(p):
        adhesion = hystrip.Dugdale(p_0=p_0, delta_0=1e-8)
        return hystrip.solve(MATERIAL, adhesion, [level], pressure=p, velocity=V, branch=branch, rtol=1e-6)

    every = np.geomspace(1, most, 48)
    together, alone = solve(every), [solve(p) for p in every[::12]]
    known, error = (np.array([getattr(one, name) for one in alone]).squeeze() for name in ("tau", "tau_error"))
    assert together.converged.all()
    assert (np.abs(together.tau.squeeze()[::12] - known) <= 0.1 * error + 1e-15 * known).all()
    assert together.counts["strips_solved"] < 0.4 * 12 * sum(one.counts["strips_solved"] for one in alone)


@pytest.mark.parametrize("given_by", [{"pressure": PRESSURES}, {"D": np.linspace(-1e-8, 9e-8, 3)}], ids=["pressures", "D"])
def test_velocities_share_nothing(given_by):
    """Not even the work: what is taken from another velocity may be put right by refinement, and does not show in friction."""
    V = np.array([1e-4, 7e-4, 1e-2])

    def solve(V):
        return hystrip.solve_level(*SURFACE[:2], SURFACE[2][0], V=V, rtol=1e-6, **given_by)

    together, alone = solve(V[:, None]), [solve(each) for each in V]
    assert together.converged.all() and together.strips == pytest.approx(sum(one.strips for one in alone), rel=2e-3)
    for name in ("D", "p_mean", "tau_mean"):
        assert getattr(together, name) == pytest.approx(np.array([getattr(one, name) for one in alone]), rel=1e-12)


@pytest.mark.parametrize("branch", ["unloading", "loading"])
def test_penetrations_that_are_near_share_a_look_below(branch):
    def solve(D):
        return hystrip.solve_level(*SURFACE[:2], SURFACE[2][0], V=7e-4, D=D, branch=branch, rtol=1e-4)

    D = np.linspace(-3e-8, 1.5e-7, 200)
    together, alone = solve(D), [solve(each) for each in D[::40]]
    for name, size in (("p_mean", 100.0), ("tau_mean", 20.0)):
        each = np.array([getattr(one, name) for one in alone])
        assert getattr(together, name)[::40] == pytest.approx(each, rel=1e-4, abs=1e-4 * size)
    assert together.strips < 0.8 * sum(one.strips for one in alone) * 40


def test_of_a_part_that_another_pressure_has_looked_at_a_pressure_knows_better_what_may_carry_it():
    """Just above the least of a dip, in a part 9 nm wide in which the dip is 26 pm from a break: it was met below the jump, its
    friction 0.14 % off, where a pressure at the other end of the part was asked for as well."""
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1.5181648423385812e-07)
    adhesion, level = hystrip.Dugdale(gamma=8.355334495300001e-10, delta_0=8.34457e-11), hystrip.Level(1e-5, 6.1254e-7)
    found = hystrip.solve(material, adhesion, [level], pressure=[144.16422070345027, 153.12], velocity=4.09977e-5, rtol=1e-6)
    # the first by itself, at 1e-10
    assert found.converged.all() and abs(found.tau[0] - 2.81559000409376) <= found.tau_error[0]


def test_what_is_shared_is_known_as_well_as_the_least_pressure_needs():
    V = np.array([7e-4, 7e-4, 1e-3])
    columns = LevelBatch(MATERIAL, SURFACE[1], SURFACE[2][0], "continuous", "unloading", V, np.zeros(3))
    walks, finest = _walks(columns, np.array([1.0, 1e6, 1e6]), np.full(3, np.inf), 1e-3, 1.0)
    assert walks[0].rough == walks[1].rough < walks[2].rough
    assert walks[0].finest == finest[0] == finest[1] < finest[2] == walks[1].finest


penetrations = st.floats(-1e3, 1e3).filter(lambda D: D == 0 or abs(D) > 1e-6)


@given(st.lists(penetrations, min_size=1, max_size=9), st.floats(1e-3, 10), st.booleans())
def test_a_way_leads_from_all_that_arrive_to_its_end(arrive, width, down):
    last = min(arrive) - 5.0 if down else max(arrive) + 5.0
    parts = growing(arrive, last, width)
    parts = parts[::-1] if down else parts
    assert (parts[0][0], parts[-1][1]) == ((last, max(arrive)) if down else (min(arrive), last))
    assert all(a[1] == b[0] and a[0] < a[1] for a, b in pairwise(parts))
    for low, high in parts:
        if any(low < D < high for D in arrive):
            # what arrives inside a part has next to nothing of it in vain: it is a short one
            assert high - low <= 2 * width * (1 + 1e-9) or (last in (low, high) and high - low <= 4 * width)


def test_a_way_grows_from_where_it_begins():
    widths = [high - low for low, high in growing([0.0], -63.0, 1.0)]
    assert widths == [1, 2, 4, 8, 16, 32]


def test_a_way_of_no_length_has_no_parts():
    assert growing([0.0, 0.0], 0.0, 1.0) == []


def test_parts_are_no_shorter_than_a_rounding_of_where_they_are():
    parts = growing([1e-3], 1e-3 + 1e-17, 1e-30)
    assert parts[-1][1] == 1e-3 + 1e-17 and all(low < high for low, high in parts)
