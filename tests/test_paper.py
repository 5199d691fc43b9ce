"""What the paper reports of its figures, in words: signs, orders, where the friction has its maximum, who causes it.

Few points at rtol = 1e-3; nothing here depends on the third digit.
"""

import numpy as np
import pytest

import hystrip
from hystrip.scene import load_scene, parse_scene

# what these tests share is solved once, and not in every process
pytestmark = pytest.mark.xdist_group("paper")

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
LARGE, SMALL = hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9)
WEAK, STRONG = (hystrip.Dugdale(gamma=gamma, delta_0=1e-8) for gamma in (2.5e-5, 5e-5))
RTOL = 1e-3
V_TWO = np.array([2e-7, 2e-6, 2e-4, 5e-4, 1e-3, 5e-3, 1.0, 10.0])
V_ONE = (1e-5, 1e-4, 1e-3, 5e-3)


@pytest.fixture(scope="module")
def two_levels():
    """Fig. 6: two levels at 0.1 kPa, for the two energies of adhesion."""
    return [hystrip.solve(MATERIAL, a, [LARGE, SMALL], pressure=100.0, velocity=V_TWO, rtol=RTOL) for a in (WEAK, STRONG)]


@pytest.fixture(scope="module")
def laws():
    """Fig. 3: the smaller level alone, up to no nominal pressure."""
    return [hystrip.friction_law(MATERIAL, WEAK, SMALL, V=V, rtol=RTOL, below=0.0) for V in V_ONE]


def test_friction_has_a_maximum_between_slow_and_fast(two_levels):
    for r in two_levels:
        peak = int(np.argmax(r.mu))
        assert 0 < peak < V_TWO.size - 1
        assert (np.diff(r.mu[: peak + 1]) > 0).all() and (np.diff(r.mu[peak:]) < 0).all()
        assert r.mu[0] < 0.01 * r.mu[peak] and r.mu[-1] < 0.01 * r.mu[peak]


def test_friction_vanishes_at_both_ends(two_levels):
    """In proportion to V, and to 1/V."""
    for r in two_levels:
        assert r.mu[1] / r.mu[0] == pytest.approx(10, rel=0.02) and r.mu[-2] / r.mu[-1] == pytest.approx(10, rel=0.02)


def test_the_smaller_level_dominates_at_low_velocity_and_the_larger_at_high(two_levels):
    for r in two_levels:
        at = {V: r.tau_by_level[:, i] for i, V in enumerate(V_TWO)}
        assert at[2e-4][1] > 2 * at[2e-4][0]
        assert at[5e-3][0] > 1.2 * at[5e-3][1]
        assert np.allclose(r.tau_by_level.sum(axis=0), r.tau, rtol=1e-12)
        # the smaller level has its peak at the lower velocity
        assert np.argmax(r.tau_by_level[1]) <= np.argmax(r.tau_by_level[0])


def test_adhesion_raises_friction_and_moves_its_maximum_to_higher_velocity(two_levels):
    weak, strong = two_levels
    assert (strong.mu >= weak.mu * (1 - RTOL)).all()
    assert (strong.mu > 1.1 * weak.mu)[V_TWO >= 5e-4].all()
    assert np.argmax(strong.mu) > np.argmax(weak.mu)
    assert strong.mu.max() > weak.mu.max() and weak.mu.max() == pytest.approx(3.2, abs=0.2)


def test_errors_are_of_the_size_that_was_asked(two_levels):
    """The estimate adds up the levels' errors and the pressure's from above: a small multiple is to be expected."""
    for r in two_levels:
        scale = (MATERIAL.K * LARGE.h + r.adhesion.p_0) * LARGE.h / LARGE.l
        assert (r.tau_error <= 5 * RTOL * (np.abs(r.tau) + 1e-3 * scale)).all()


def test_contact_survives_negative_pressure_more_so_when_slow(laws):
    pull_off = [law.pull_off for law in laws]
    assert pull_off == sorted(pull_off) and pull_off[-1] < 0
    assert pull_off[0] < 3 * pull_off[-1]
    for law in laws:
        assert law(law.pull_off * 1.001) == 0 and law.contact_fraction(law.pull_off * 0.9) > 0


def test_friction_is_positive_at_either_sign_of_pressure_and_has_a_maximum_over_velocity(laws):
    for part in (0.0, 0.5, 0.9):
        assert all(law(part * law.pull_off) > 0 for law in laws)
    at_zero = [float(law(0.0)) for law in laws]
    assert 0 < np.argmax(at_zero) < len(at_zero) - 1


@pytest.mark.parametrize("part", [0.03, 0.5])
@pytest.mark.parametrize("i", range(len(V_ONE)), ids=[f"{V:g}" for V in V_ONE])
def test_a_pressure_above_pull_off_is_carried(laws, i, part):
    """``solve`` finds the penetration the law knows, however narrow the range between pull-off and saturation is."""
    law = laws[i]
    p = law.pull_off + part * (min(law.p_sat, 0.0) - law.pull_off)
    r = hystrip.solve(MATERIAL, WEAK, [SMALL], pressure=p, velocity=V_ONE[i], rtol=RTOL)
    assert not r.pulled_off and r.tau == pytest.approx(float(law(p)), rel=5e-3)
    assert r.contact_fraction == pytest.approx(float(law.contact_fraction(p)), rel=5e-3)


def test_area_and_friction_level_off_at_full_contact():
    law = hystrip.friction_law(MATERIAL, WEAK, SMALL, V=1e-4, rtol=RTOL)
    p = np.linspace(law.pull_off, law.p_sat, 7)[1:]
    assert (np.diff(law.contact_fraction(p)) > 0).all() and (np.diff(law(p)) > 0).all()
    far = law.p_sat + np.array([0.0, 1.0, 1e4])
    assert (law.contact_fraction(far) == 1).all() and (law(far) == law.tau_sat).all()


def test_the_curve_is_multivalued_at_low_velocity():
    """V = 0.1 mm/s: at the same penetration, unloading and loading are different contacts."""
    D = np.linspace(-6e-8, 1e-7, 9)
    unloading, loading = (
        hystrip.solve_level(MATERIAL, WEAK, SMALL, V=1e-4, D=D, branch=branch, rtol=RTOL) for branch in ("unloading", "loading")
    )
    assert (unloading.contact_fraction >= loading.contact_fraction).all()
    assert (loading.contact_fraction[:2] == 0).all() and (unloading.contact_fraction[:2] > 1 - 1e-12).all()
    between = (loading.contact_fraction > 0) & (loading.contact_fraction < 1 - 1e-9)
    assert between.sum() >= 3 and (unloading.tau_mean > loading.tau_mean)[between].all()
    assert not np.allclose(unloading.p_mean[between], loading.p_mean[between], rtol=0.1)


@pytest.mark.parametrize(("adhesion", "first"), [(WEAK, 75), (STRONG, 62)], ids=["weak", "strong"])
def test_strips_of_figure_4(adhesion, first):
    """Level 1 at V = 5 mm/s: strip 0 is partial with discrete zones, the outer ones are saturated."""
    D = hystrip.solve_level(MATERIAL, adhesion, LARGE, V=5e-3, pressure=100.0, rtol=RTOL).D
    theta = np.arange(100) * np.pi / 100
    s = hystrip.solve_strip(MATERIAL, adhesion, l=LARGE.l, A=LARGE.amplitude(theta), D=D - LARGE.drop(theta), V=5e-3)
    assert s.regime[0] == "acaf"
    assert (s.regime[:first] != "c").all() and (s.regime[first:] == "c").all()


def test_equal_strips_of_the_whole_surface_are_those_of_the_level():
    """``strips=N``: the paper's average, at its penetration as at its pressure, with an error estimate that covers it."""
    scene = load_scene("paper_fig5")
    level, V = scene.levels[:1], float(scene.velocity)
    exact = hystrip.solve(scene.material, scene.adhesion, level, pressure=100, velocity=V, rtol=1e-5)
    equal = hystrip.solve(scene.material, scene.adhesion, level, pressure=100, velocity=V, rtol=1e-4, strips=100)
    assert 1e-3 < abs(equal.mu / exact.mu - 1) < 8e-3 and abs(equal.mu - exact.mu) < equal.error_estimate
    D = float(exact.penetration)
    at_D = hystrip.solve(scene.material, scene.adhesion, level, penetration=D, velocity=V, strips=100)
    one = hystrip.solve_level(scene.material, scene.adhesion, level[0], D=D, V=V, strips=100)
    assert (at_D.tau, at_D.pressure) == (one.tau_mean, one.p_mean)
    assert parse_scene(scene.text.replace("velocity", "strips = 100\nvelocity", 1)).strips == 100
