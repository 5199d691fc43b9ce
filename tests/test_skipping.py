"""What a scene does not need is left out, is counted, and leaves the result as it is."""

from dataclasses import replace

import numpy as np
import pytest

import hystrip
from hystrip.level.strips import LevelBatch, WorkCounters, cut_penetration
from hystrip.multilevel import Surface

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
WEAK = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
LEVELS = [hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9)]


def test_saturated_points_solve_no_strip():
    V = np.geomspace(1e-5, 1e-1, 50)
    r = hystrip.solve(MATERIAL, WEAK, LEVELS, pressure=1e6, velocity=V)
    assert r.closed_form.all() and r.counts["strips_solved"] == 0 and r.counts["points_in_closed_form"] == V.size


def test_below_pull_off_nothing_is_carried():
    r = hystrip.solve(MATERIAL, WEAK, LEVELS, pressure=-2e3, velocity=[1e-3], rtol=1e-3)
    assert r.pulled_off.all() and r.mu[0] == 0 and r.counts["points_below_pull_off"] == 1


@pytest.mark.filterwarnings("error")
def test_a_velocity_below_pull_off_asks_for_no_law():
    """Beside one at which the surface touches it costs what it costs alone; no tolerance of a law is without end."""
    material, adhesion = replace(MATERIAL, T_sigma=3.934e-5), hystrip.Dugdale(gamma=1.207e-8, delta_0=1.8305e-10)
    levels = hystrip.Level(l=1e-5, h=1.4092e-7), hystrip.Level(l=1.268e-6, h=6.863e-8)
    V, given = np.array([2.904e-5, 3.4526e-4]), {"pressure": -8.196, "edge": "continuous", "rtol": 1e-3}
    both, on, off = (hystrip.solve(material, adhesion, levels, velocity=some, **given) for some in (V, V[:1], V[1:]))
    assert both.pulled_off.tolist() == [False, True] and both.tau[0] == on.tau[0]
    assert both.counts["strips_solved"] == on.counts["strips_solved"] + off.counts["strips_solved"]


@pytest.mark.parametrize("levels", [LEVELS[:1], LEVELS])
def test_the_closed_form_is_what_solving_gives(levels):
    """With skipping off every strip is solved: the same but for rounding of the sum over strips."""
    given = {"pressure": 1e4, "velocity": [1e-3], "rtol": 1e-6}
    on, off = (hystrip.solve(MATERIAL, WEAK, levels, skip=skip, **given) for skip in (True, False))
    assert on.counts["points_in_closed_form"] == 1 and off.counts["points_in_closed_form"] == 0
    scale = (MATERIAL.K * levels[0].h + WEAK.p_0) * levels[0].h / levels[0].l
    assert np.abs(on.tau_by_level - off.tau_by_level).max() <= 1e-13 * scale


def test_all_levels_are_saturated_exactly_where_the_least_local_pressure_saturates_the_lower():
    V, K = 1e-3, MATERIAL.K
    alpha, beta = (2 * np.pi / np.array([level.l for level in LEVELS]) * V * T for T in (MATERIAL.T_sigma, MATERIAL.T_eps))
    lift = [K * level.h * (2 * r - 1) / 4 for level, r in zip(LEVELS, np.hypot(1, beta) / np.hypot(1, alpha), strict=True)]
    threshold = sum(lift) - WEAK.p_0
    given = {"velocity": V, "rtol": 1e-2, "pressure": threshold * np.array([1 - 1e-6, 1 + 1e-6])}
    assert hystrip.solve(MATERIAL, WEAK, LEVELS, **given).closed_form.tolist() == [False, True]


@pytest.mark.parametrize("branch", ["unloading", "loading"])
@pytest.mark.parametrize(
    "material", [MATERIAL, hystrip.Prony(K=1e9, moduli=[3e9, 9e10], times=[1e-3, 1e-4])], ids=["one time", "two times"]
)
def test_the_fastest_velocity_decides_for_all(material, branch):
    """Thresholds grow with V: the short way over the fastest velocity, and the threshold of every point, say the same."""
    V, p = np.geomspace(1e-7, 10, 20), np.geomspace(10, 1e9, 15)[:, None]
    surface = Surface(material, WEAK, LEVELS, "constitutive", branch, 1e-6, True, WorkCounters())
    each = np.array([[surface.full(V[j : j + 1], row, True)[0] for j in range(V.size)] for row in p])
    assert np.array_equal(each, [surface.full(V, np.broadcast_to(row, V.shape), True) for row in p])
    assert each.any() and not each.all() and (np.diff(each.astype(int), axis=1) <= 0).all()


def test_saturated_points_among_others_are_bit_identical():
    V = np.array([1e-5, 2e-3, 3e-5])
    given = {"pressure": 1e3, "rtol": 1e-3}
    together, alone = (
        hystrip.solve(MATERIAL, WEAK, LEVELS[:1], velocity=V, **given),
        hystrip.solve(MATERIAL, WEAK, LEVELS[:1], velocity=V[::2], **given),
    )
    assert together.closed_form.tolist() == [True, False, True] and alone.closed_form.all()
    for name in ("mu", "tau_by_level", "penetration", "contact_by_level", "adhesion_by_level", "p_sat", "error_estimate"):
        assert np.array_equal(getattr(together, name)[..., ::2], getattr(alone, name)), name


@pytest.mark.parametrize("branch", ["unloading", "loading"])
@pytest.mark.parametrize("edge", ["continuous", "constitutive"])
def test_partial_contact_is_bit_identical_without_skipping(edge, branch):
    given = {"pressure": 100.0, "velocity": [5e-3], "rtol": 1e-3, "edge": edge, "branch": branch}
    levels = LEVELS if branch == "unloading" else LEVELS[:1]
    on, off = (hystrip.solve(MATERIAL, WEAK, levels, skip=skip, **given) for skip in (True, False))
    for name in ("mu", "tau_by_level", "penetration", "contact_by_level", "error_estimate"):
        assert np.array_equal(getattr(on, name), getattr(off, name)), name
    assert on.counts["strips_decided_by_threshold"] > 0


@pytest.mark.parametrize("branch", ["unloading", "loading"])
@pytest.mark.parametrize("edge", ["continuous", "constitutive"])
def test_no_penetration_above_the_cut_carries_less(edge, branch):
    """Averaged over a period the foundation is elastic: p_mean = K w_mean >= K (D - 3 h/4)."""
    level = LEVELS[0]
    D = np.linspace(-0.1, 3, 25) * level.h
    v = hystrip.solve_level(MATERIAL, WEAK, level, V=2e-3, D=D, edge=edge, branch=branch, rtol=1e-4)
    assert (v.p_mean >= MATERIAL.K * (D - 0.75 * level.h) * (1 - 1e-12) - 1e-9).all()
    columns = LevelBatch(MATERIAL, WEAK, level, edge, branch, np.full(D.size, 2e-3), D)
    assert (cut_penetration(columns, v.p_mean, np.full(D.size, np.inf)) >= D).all()


def test_fewer_digits_take_fewer_strips():
    counts = [
        hystrip.solve(MATERIAL, WEAK, LEVELS[:1], pressure=100.0, velocity=[1e-3, 2e-2], rtol=rtol).counts["strips_solved"]
        for rtol in (1e-3, 1e-5, 1e-7, 1e-9)
    ]
    assert counts == sorted(counts) and counts[-1] > counts[0]
