"""A half-space: every level slides over a foundation of its own."""

import pickle

import numpy as np
import pytest

import hystrip

LEVELS = [hystrip.Level(l=1e-3, h=2e-5), hystrip.Level(l=1e-4, h=3e-6), hystrip.Level(l=2e-5, h=3e-7)]
NONE = hystrip.Dugdale(gamma=0)
RUBBER = hystrip.HalfSpace(E=2e6, nu=0.49, moduli=[8e6], times=[1e-3])


@pytest.mark.parametrize("n", [0, 1, 2, 3])
def test_friction_in_full_contact_is_that_of_the_half_space(n):
    """Each of the three waves of Eq. 4 by itself: ``1/2 k A^2 Im E*/(1 - nu^2) q/2``, cos kx cos ky with half of that and
    q = sqrt(2) k."""
    material = hystrip.HalfSpace(E=2e6, nu=0.3, moduli=[8e6, 3e6, 5e7][:n], times=[1e-3, 1e-5, 1e-8][:n])
    V = np.geomspace(1e-4, 100, 9)
    result = hystrip.solve(material, NONE, LEVELS, pressure=1e12, velocity=V, edge="constitutive")
    assert result.closed_form.all()
    for level, tau in zip(LEVELS, result.tau_by_level, strict=True):
        k, A = level.k, level.h / 4
        x = 1j * k * V[:, None] * np.array(material.times)
        loss = (x / (1 + x) @ np.array(material.moduli)).imag / (1 - 0.3**2)
        waves = k * A**2 * loss * (0.5 * k / 2 + 0.25 * np.sqrt(2) * k / 2)
        assert tau == pytest.approx(waves, rel=1e-13, abs=0)


@pytest.mark.parametrize(("adhesion", "rtol"), [(NONE, 1e-3), (hystrip.Dugdale(p_0=3e3, delta_0=1e-8), 1e-2)])
def test_lower_levels_rub_on_the_foundation_of_their_own_wavelength(adhesion, rtol):
    """Two levels in partial contact against the law of the lower one, averaged over the contact of many strips of the upper."""
    V, D, upper, lower = 0.02, 1.2e-5, *LEVELS[:2]
    result = hystrip.solve(RUBBER, adhesion, LEVELS[:2], penetration=D, velocity=V, rtol=rtol, edge="constitutive")
    local = RUBBER.at_wavelength(lower.l)
    assert local.K == pytest.approx(10 * RUBBER.at_wavelength(upper.l).K, rel=1e-14)
    how = {"V": V, "edge": "constitutive"}
    law = hystrip.friction_law(local, adhesion, lower, rtol=rtol, **how)
    n, m = 100, 1000
    theta = (np.arange(n) + 0.5) * np.pi / n
    A, depth = upper.amplitude(theta)[:, None], (D - upper.drop(theta))[:, None]
    strips = hystrip.solve_strip(RUBBER, adhesion, l=upper.l, A=A, D=depth, **how)
    x = ((np.arange(m) + 0.5) / m - 0.5) * upper.l
    touching = strips.gap(x) <= 0
    carried = np.where(touching, law(np.where(touching, strips.pressure(x), 0.0)), 0.0).mean()
    assert 0.1 < result.contact_by_level[0] < 0.9
    assert result.tau_by_level[1] == pytest.approx(carried, rel=3 * rtol)
    assert result.tau_by_level[0] == pytest.approx(strips.tau_mean.mean(), rel=3 * rtol)


def test_paths_with_and_without_the_family_of_strips_agree(monkeypatch):
    points = {"pressure": [2e4, 1e5], "velocity": 0.02, "rtol": 1e-5}
    fast = hystrip.solve(RUBBER, NONE, LEVELS[:2], **points)
    monkeypatch.setattr(hystrip.multilevel, "are_families", lambda *_: False)
    slow = hystrip.solve(RUBBER, NONE, LEVELS[:2], **points)
    assert slow.tau_by_level == pytest.approx(fast.tau_by_level, rel=3e-5)


def test_glassy_modulus_is_that_of_fast_deformation():
    """The limit of E(i omega), and of the foundation of every level."""
    material = hystrip.HalfSpace(E=2e6, nu=0.3, moduli=[8e6, 3e6, 5e7], times=[1e-3, 1e-5, 1e-8])
    fast = 1j * 1e16 * np.array(material.times)
    assert material.E_glassy == pytest.approx(abs(material.E + fast / (1 + fast) @ np.array(material.moduli)), rel=1e-14)
    assert material.E_glassy == material.modulus.K_glassy
    local = material.at_wavelength(1e-4)
    assert local.K_glassy / local.K == pytest.approx(material.E_glassy / material.E, rel=1e-14)
    assert hystrip.HalfSpace(E=2e6, nu=0.3).E_glassy == 2e6


def test_saturation_is_seen_level_by_level():
    """Just above the threshold of the closed form every level is saturated by itself at the least pressure above it."""
    result = hystrip.solve(RUBBER, NONE, LEVELS, pressure=1e12, velocity=0.02)
    law = hystrip.friction_law(RUBBER, NONE, LEVELS[1], V=0.02, rtol=1e-3)
    assert law.tau_sat == pytest.approx(result.tau_by_level[1], rel=1e-13)
    assert law.p_sat == pytest.approx(
        hystrip.friction_law(RUBBER.at_wavelength(1e-4), NONE, LEVELS[1], V=0.02, rtol=1e-3).p_sat, rel=1e-13
    )


def test_material_is_checked_and_travels():
    assert pickle.loads(pickle.dumps(RUBBER)) == RUBBER
    assert hystrip.HalfSpace(E=1e6, nu=0.5).n == 0
    assert RUBBER != hystrip.HalfSpace(E=2e6, nu=0.5, moduli=[8e6], times=[1e-3])
    for arguments, field, allowed in (
        ({"E": 0.0, "nu": 0.5}, "material.E", "(Pa)"),
        ({"E": 1e6, "nu": 0.6}, "material.nu", "from 0 to 0.5"),
        ({"E": 1e6, "nu": -0.1}, "material.nu", ">= 0"),
        ({"E": 1e6, "nu": 0.5, "moduli": [-1.0], "times": [1.0]}, "material.moduli[0]", "(Pa)"),
        ({"E": 1e6, "nu": 0.5, "moduli": [[1.0, 2.0]], "times": [1.0]}, "material.moduli[0]", "a single number"),
        ({"E": 1e6, "nu": 0.5, "moduli": [1.0], "times": []}, "material.moduli, material.times", "as many"),
    ):
        with pytest.raises(hystrip.InputError) as refused:
            hystrip.HalfSpace(**arguments)
        assert refused.value.field == field and allowed in refused.value.allowed, refused.value
    with pytest.raises(TypeError, match="foundation for each level"):
        hystrip.orbit.foundation.foundation_of(RUBBER)


def test_summary_and_dataset_hold_the_half_space():
    result = hystrip.solve(RUBBER, NONE, LEVELS[:2], pressure=1e5, velocity=[0.01, 0.02], rtol=1e-2)
    assert "HalfSpace: E = 2e+06 Pa, nu = 0.49, moduli[0] = 8e+06 Pa, times[0] = 0.001 s" in result.summary()
    pytest.importorskip("xarray")
    assert '"nu": 0.49' in result.to_dataset().attrs["material"]


def test_constant_is_the_one_that_is_derived():
    sympy = pytest.importorskip("sympy")
    from hystrip.derivation.half_space import half_space
    from hystrip.inputs.half_space import SHAPE

    wave, foundation = half_space()  # raises if a step does not verify
    assert SHAPE == pytest.approx(float(foundation.value), rel=1e-15)
    assert all(check.outcome == "exact zero" for each in (wave, foundation) for check in each.checks)
    assert sympy.simplify(foundation.value - (2 + sympy.sqrt(2)) / 3) == 0
