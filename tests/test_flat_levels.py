"""Flat levels, in truth or to the last digit: they rub nothing, and pass on what presses them."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hystrip

pytestmark = pytest.mark.filterwarnings("error")
SOLID = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
RUBBER = hystrip.HalfSpace(E=1e6, nu=0.5, moduli=[1e7], times=[1e-4])
SERIES = hystrip.Prony(K=1e9, moduli=(1e10, 3e9), times=(1e-4, 1e-2))
NONE, STICKY = hystrip.Dugdale(gamma=0), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
#: all but the first without a square that is a number
FLAT = (0.0, 5e-324, 1e-310, 1e-200)
few = settings(max_examples=8, deadline=None, derandomize=True, database=None)


def _solve(adhesion, levels, material=SOLID, **load):
    levels = [hystrip.Level(*level) for level in levels]
    load = ({} if "penetration" in load else {"pressure": 200.0}) | {"velocity": 2e-3, "rtol": 1e-4} | load
    return hystrip.solve(material, adhesion, levels, **load)


@cache
def _once(adhesion, levels, branch):
    return _solve(adhesion, levels, branch=branch)


@pytest.mark.parametrize("adhesion", [NONE, STICKY], ids=["dry", "sticky"])
@few
@given(
    wavy=st.lists(st.integers(0, 5), min_size=1, max_size=2, unique=True).map(sorted),
    heights=st.lists(st.sampled_from(FLAT), min_size=6, max_size=6),
    levels=st.integers(2, 3), branch=st.sampled_from(["unloading", "loading"]),
)  # fmt: skip
def test_flat_levels_change_nothing(adhesion, wavy, heights, levels, branch):
    wavy = [i % levels for i in wavy]
    lengths = [1e-5 / 3**i for i in range(levels)]
    every = tuple((length, length / 12 if i in wavy else heights[i]) for i, length in enumerate(lengths))
    rest = tuple(level for i, level in enumerate(every) if i in wavy)
    flat, alone = _once(adhesion, every, branch), _once(adhesion, rest, branch)
    assert flat.converged and alone.converged
    # where they touch late they are interpolated like others
    rounding = 2e-4 if branch == "loading" and adhesion is STICKY else 1e-14
    assert flat.mu == pytest.approx(float(alone.mu), rel=rounding)
    if rounding < 1e-13:
        assert flat.contact_fraction == alone.contact_fraction and flat.error_estimate <= 1.001 * alone.error_estimate
    assert all(flat.tau_by_level[i] <= 1e-12 * flat.tau for i in range(levels) if i not in wavy)


@pytest.mark.parametrize("levels", [[(1e-5, 0.0)], [(1e-5, 0.0), (1e-6, 0.0), (5e-7, 1e-310)]])
def test_a_plane_rubs_nothing(levels):
    for load in ({"pressure": [200.0, 0.0, -5.0]}, {"penetration": [2e-7, 0.0, -5e-9]}):
        dry = _solve(NONE, levels, **load)
        assert (np.nan_to_num(dry.mu) == 0).all() and dry.contact_fraction.tolist() == [1, 1, 0]
        assert dry.penetration[0] == pytest.approx(2e-7, rel=1e-12)
        assert np.allclose(dry.pressure[:2], [200.0, 0.0]) and dry.error_estimate.tolist()[:1] == [0.0]


def test_a_flat_first_level_is_pressed_like_the_foundation():
    levels = [(1e-5, 0.0), (1e-6, 0.0), (5e-7, 1e-7)]
    by_pressure, alone = _solve(NONE, levels, pressure=[-3.0, 200.0, 1e5]), _solve(NONE, levels[2:], pressure=[-3.0, 200.0, 1e5])
    assert np.allclose(by_pressure.mu, alone.mu, rtol=1e-12) and np.isnan(by_pressure.penetration[0])
    assert np.allclose(by_pressure.penetration[1:], [2e-7, 1e-4], rtol=1e-12)
    by_depth = _solve(NONE, levels, penetration=[-1e-9, 2e-7, 1e-4])
    assert np.allclose(by_depth.mu[1:], alone.mu[1:], rtol=1e-12) and by_depth.contact_fraction[0] == 0


STEPPED, SHALLOW = hystrip.Dugdale(p_0=1000, delta_0=1e-8), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-12)
LOADING, AT_REST, ALONE = {"branch": "loading"}, {"velocity": 0.0}, {"pressure": 0.0}
SEVERAL = {"edge": "constitutive"}
DEGENERATE = {
    "a lower plane": (SOLID, STICKY, [(1e-5, 1e-6), (5e-7, 0.0)], {}),
    "an interval without width": (SOLID, SHALLOW, [(1e-5, 1e-30)], LOADING | ALONE),
    "all but planes": (SOLID, STICKY, [(1e-5, 1e-200), (5e-7, 1e-310), (2.5e-7, 1e-30)], LOADING | AT_REST | ALONE),
    "next to nothing below": (SOLID, STEPPED, [(1e-5, 1e-6), (2e-6, 2e-7), (1e-7, 5e-324)], LOADING | {"velocity": 1e30}),
    "a plane above": (SOLID, NONE, [(1e-5, 0.0), (1e-5, 1e-6), (5e-7, 5e-15)], AT_REST),
    "a plane above, hardly a wave": (RUBBER, NONE, [(1e-5, 0.0), (5e-7, 5e-15), (1e-7, 1e-30)], LOADING | ALONE),
    "a plane and next to nothing": (RUBBER, STEPPED, [(1e-5, 0.0), (1e-5, 5e-7), (5e-7, 1e-30)], {"pressure": 1e4}),
    "hardly a wave above others": (SOLID, STICKY, [(1e-5, 0.0), (5e-6, 1e-30), (2.5e-6, 2.5e-14)], LOADING | ALONE),
    "loaded below no pressure": (SOLID, STICKY, [(1e-5, 1e-6), (5e-7, 0.0), (2.5e-7, 2.5e-8)], LOADING | {"pressure": -1.0}),
    "several times at rest": (SERIES, NONE, [(1e-5, 1e-30), (5e-7, 2.5e-8)], LOADING | AT_REST | SEVERAL),
    "several times, next to at rest": (SERIES, STEPPED, [(1e-5, 5e-7), (5e-6, 5e-14)], SEVERAL | {"velocity": 1e-30}),
}


@pytest.mark.parametrize("scene", DEGENERATE.values(), ids=DEGENERATE)
def test_scenes_of_which_next_to_nothing_is_left(scene):
    """Each ended in a warning of NumPy, did not converge, or was refused."""
    material, adhesion, levels, load = scene
    result = _solve(adhesion, levels, material, **load)
    assert result.converged and np.isfinite(result.error_estimate) or result.pressure == 0
    result.summary()


#: pressures at which a plane clings, Pa, and one at which it does not; friction of the wave alone that
#: the planes below carry, at 1e-7
HELD, BEYOND = [-1.0, -8.0, 3.0], -10.1
ALONE_LOADED = [60.402462805, 28.372090498, 65.164976487]


@pytest.mark.parametrize("height", [1e-200, 1e-13])
def test_a_plane_that_is_loaded_jumps_into_contact(height):
    """It clings at ``D = -delta_0``; from there on it carries ``K D``. (Parts of the way there once grew from no width.)"""
    result = _solve(STICKY, [(1e-5, height), (5e-7, 1e-7)], pressure=[*HELD, BEYOND], branch="loading")
    assert result.pulled_off.tolist() == [False, False, False, True]
    assert result.penetration[:3] == pytest.approx(np.array(HELD) / SOLID.K, rel=1e-3)
    assert result.tau[:3] == pytest.approx(ALONE_LOADED, rel=1e-3)
    assert result.tau[3] == 0 and (result.contact_by_level[:, 3] == 0).all()


def test_a_plane_clings_where_the_wave_on_it_has_let_go():
    held = _solve(STICKY, [(1e-5, 0.0), (5e-7, 1e-7)], pressure=[-2499.0, -2501.0])
    assert held.pulled_off.tolist() == [False, True] and held.contact_by_level[:, 0].tolist() == [1.0, 0.0]
    assert held.penetration[0] == pytest.approx(-2.499e-6) and (held.tau == 0).all() and held.converged.all()
    assert _solve(STICKY, [(5e-7, 1e-7)], pressure=-2499.0).pulled_off
