"""Saturated contact of a whole surface: thresholds, the corrected Eq. 16, and the paper's Fig. 7."""

import numpy as np
import pytest

import hystrip

K, T_EPS, T_SIGMA = 1e9, 1e-2, 1e-4
MATERIAL = hystrip.StandardLinearSolid(K, T_EPS, T_SIGMA)
ADHESION = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
LEVELS = [hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9), hystrip.Level(l=5e-9, h=5e-9)]
PRESSURE = 5e6
PEAKS = [level.l / (2 * np.pi * T_SIGMA) for level in LEVELS]


def friction(level, V):
    """Friction stress of saturated contact."""
    return 3 * np.pi**2 / 16 * K * V * (T_EPS - T_SIGMA) * level.h**2 / (level.l**2 + 4 * np.pi**2 * V**2 * T_SIGMA**2)


def threshold(level, V, p_0):
    omega = 2 * np.pi / level.l * V
    return K * level.h * (2 * np.hypot(1, omega * T_EPS) / np.hypot(1, omega * T_SIGMA) - 1) / 4 - p_0


@pytest.fixture
def no_strips(monkeypatch):
    def refuse(*args, **kwargs):
        raise AssertionError("a strip was solved")

    monkeypatch.setattr("hystrip.orbit.abstract_foundation.Foundation.solve", refuse)


@pytest.mark.parametrize(("i", "mu"), [(0, 2.92e-4), (1, 5.83e-5), (2, 1.46e-5)])
def test_figure_7_peaks(no_strips, i, mu):
    V = PEAKS[i] * np.array([0.999, 1.0, 1.001])
    r = hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=PRESSURE, velocity=V)
    share = r.tau_by_level[i] / PRESSURE
    assert r.closed_form.all()
    assert share[1] == pytest.approx(mu, rel=3e-3) and share[1] > share[0] and share[1] > share[2]
    height = 3 * np.pi / 64 * K * (T_EPS / T_SIGMA - 1) * LEVELS[i].h ** 2 / LEVELS[i].l
    assert share[1] * PRESSURE == pytest.approx(height, rel=1e-12)


def test_corrected_equation_16(no_strips):
    V = np.geomspace(1e-6, 1.0, 25)
    p = max(threshold(level, V, 0).max() for level in LEVELS) * 10
    r = hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=p, velocity=V)
    assert r.closed_form.all() and r.counts["strips_solved"] == 0 and r.counts["points_in_closed_form"] == V.size
    shares = np.array([friction(level, V) for level in LEVELS])
    assert np.allclose(r.tau_by_level, shares, rtol=1e-12, atol=0)
    assert np.allclose(r.mu, shares.sum(axis=0) / p, rtol=1e-12, atol=0)
    assert (r.contact_fraction == 1).all() and not r.adhesion_by_level.any() and not r.error_estimate.any()
    assert np.allclose(r.penetration, p / K + 0.75 * LEVELS[0].h, rtol=1e-14)


def test_printed_equation_16_has_another_order():
    """With h to the first power, as printed, the smallest level would have the highest peak."""
    heights = [friction(level, V) for level, V in zip(LEVELS, PEAKS, strict=True)]
    printed = [height / level.h for height, level in zip(heights, LEVELS, strict=True)]
    assert heights == sorted(heights, reverse=True) and printed == sorted(printed)
    assert np.array(heights) / heights[0] == pytest.approx([1, 0.2, 0.05])


def test_figure_7_is_saturated_throughout(no_strips):
    """At its nominal pressure every level is saturated at any velocity, and no strip has to be solved."""
    r = hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=PRESSURE, velocity=np.geomspace(1e-8, 1e4, 25))
    assert r.closed_form.all() and not r.pulled_off.any()


@pytest.mark.parametrize("V", [1e-5, 2e-4, 5e-3, 1.0])
@pytest.mark.parametrize("adhesion", [ADHESION, hystrip.Dugdale(gamma=0)], ids=["adhesive", "bare"])
def test_saturation_pressure(adhesion, V):
    level = LEVELS[1]
    p_sat, step = threshold(level, V, adhesion.p_0), K * level.h  # the natural scale; p_sat itself can be negative
    above = hystrip.solve(MATERIAL, adhesion, [level], pressure=p_sat + 1e-9 * step, velocity=V)
    below = hystrip.solve(MATERIAL, adhesion, [level], pressure=p_sat - 1e-4 * step, velocity=V, rtol=1e-4)
    assert above.p_sat == pytest.approx(p_sat, rel=1e-13)
    assert above.closed_form and not below.closed_form
    assert 0.99 < below.contact_fraction < 1 and below.tau == pytest.approx(float(above.tau), rel=5e-3)


@pytest.mark.parametrize("branch", ["unloading", "loading"])
@pytest.mark.parametrize("edge", ["continuous", "constitutive"])
def test_closed_form_is_what_the_strips_give(edge, branch):
    """``skip=False`` solves the strips. This far above the threshold the loading orbit is saturated, too."""
    level, V, p = LEVELS[1], np.array([1e-4, 5e-3]), 1e6
    known = hystrip.solve(MATERIAL, ADHESION, [level], pressure=p, velocity=V, edge=edge, branch=branch)
    solved = hystrip.solve(MATERIAL, ADHESION, [level], pressure=p, velocity=V, edge=edge, branch=branch, skip=False, rtol=1e-10)
    assert known.closed_form.all() and not solved.closed_form.any()
    for name in ("mu", "tau", "penetration", "contact_fraction"):
        assert np.allclose(getattr(solved, name), getattr(known, name), rtol=1e-10, atol=0), name


def test_by_penetration_and_by_pressure_are_the_same(no_strips):
    V = np.array([1e-4, 5e-3])
    by_pressure = hystrip.solve(MATERIAL, ADHESION, LEVELS[:2], pressure=1e9, velocity=V)
    by_depth = hystrip.solve(MATERIAL, ADHESION, LEVELS[:2], penetration=by_pressure.penetration, velocity=V)
    assert by_depth.closed_form.all() and np.allclose(by_depth.pressure, 1e9, rtol=1e-14)
    assert np.allclose(by_depth.mu, by_pressure.mu, rtol=1e-13, atol=0)


def test_a_law_is_constant_from_saturation_on():
    law = hystrip.friction_law(MATERIAL, ADHESION, LEVELS[1], V=5e-3, rtol=1e-3)
    tau = friction(LEVELS[1], 5e-3)
    assert law.p_sat == pytest.approx(threshold(LEVELS[1], 5e-3, ADHESION.p_0), rel=1e-13)
    assert law.tau_sat == pytest.approx(tau, rel=1e-13)
    assert (law(law.p_sat * np.array([1.0, 1.5, 100.0])) == law.tau_sat).all()
    assert law(law.p_sat * 0.999) == pytest.approx(tau, rel=1e-2)


def test_no_fraction_of_a_law_is_above_one():
    """The interpolants of a law next to saturation were so by roundings."""
    law = hystrip.friction_law(MATERIAL, ADHESION, LEVELS[1], V=1e-3, rtol=1e-3, branch="loading")
    found = law.contact_fraction(np.linspace(law.pull_off, law.p_sat, 400))
    assert found.max() == 1 and found.min() >= 0
