"""Levels, laws and several levels on foundations with several relaxation times."""

import numpy as np
import pytest

import hystrip

TAU, K, K_1 = 1e-3, 1e9, 7e9
ONE = hystrip.StandardLinearSolid(K, TAU * (1 + K_1 / K), TAU)
#: the same foundation for the solver with two modes: the second branch is next to nothing
TWO = hystrip.Prony(K, [K_1, 1e-6], [TAU, 1.0])
ADHESION = hystrip.Dugdale(p_0=500.0, delta_0=5e-8)
LEVELS = [hystrip.Level(l=1e-5, h=1e-6), hystrip.Level(l=5e-7, h=1e-7)]
HOW = {"edge": "constitutive"}


def test_the_second_solver_reduces_to_the_first():
    from hystrip.orbit.foundation import foundation_of
    from hystrip.orbit.modes.foundation import ManyTimes
    from hystrip.orbit.single import SingleTime

    assert isinstance(foundation_of(TWO), ManyTimes) and isinstance(foundation_of(ONE), SingleTime)


@pytest.mark.parametrize("branch", ["unloading", "loading"])
def test_a_level_at_penetrations(branch):
    D = [-5e-8, 1e-7, 6e-7, 5e-6]
    one, two = (
        hystrip.solve_level(m, ADHESION, LEVELS[0], V=[[1e-4], [1e-2]], D=D, branch=branch, rtol=1e-7, **HOW) for m in (ONE, TWO)
    )
    for name, scale in (("p_mean", K * 1e-6), ("tau_mean", K * 1e-7), ("contact_fraction", 1.0), ("adhesion_fraction", 1.0)):
        assert np.abs(getattr(one, name) - getattr(two, name)).max() < 1e-9 * scale, name


def test_a_law():
    one, two = (hystrip.friction_law(m, ADHESION, LEVELS[1], V=1e-4, rtol=1e-4, **HOW) for m in (ONE, TWO))
    assert two.pull_off == pytest.approx(one.pull_off, rel=1e-6)
    assert two.p_sat == pytest.approx(one.p_sat, rel=1e-12) and two.tau_sat == pytest.approx(one.tau_sat, rel=1e-12)
    p = np.linspace(0.9 * one.pull_off, 1.1 * one.p_sat, 23)
    assert np.allclose(two(p), one(p), rtol=0, atol=2e-4 * np.abs(one(p)).max())


def test_two_levels():
    """The lower level's law acts in the contact of the upper one: pressure there passes its breaks."""
    one, two = (hystrip.solve(m, ADHESION, LEVELS, penetration=3e-7, velocity=[1e-4, 1e-2], rtol=1e-3, **HOW) for m in (ONE, TWO))
    assert not one.closed_form.any() and (one.tau_by_level[1] > 0).all()
    assert np.all(np.abs(one.tau_by_level - two.tau_by_level) <= one.tau_error + two.tau_error + 1e-9)
    assert np.allclose(one.mu, two.mu, rtol=2e-3)


def test_a_saturated_level_is_in_closed_form():
    material = hystrip.Prony(K, [3e9, 2e10], [1e-3, 1e-1])
    V, level = np.array([1e-4, 1e-2, 1.0]), LEVELS[0]
    skipped = hystrip.solve(material, ADHESION, [level], pressure=1e6, velocity=V, **HOW)
    solved = hystrip.solve(material, ADHESION, [level], pressure=1e6, velocity=V, skip=False, rtol=1e-10, **HOW)
    assert skipped.closed_form.all() and not solved.closed_form.any()
    assert np.allclose(skipped.mu, solved.mu, rtol=1e-10, atol=0)
    omega = level.k * V
    loss = sum(K_i * omega * tau / (1 + (omega * tau) ** 2) for K_i, tau in zip(material.moduli, material.times, strict=True))
    # strips of amplitude (h/4)(1 + cos ky): the mean of its square is 3/8 (h/2)^2
    assert np.allclose(skipped.tau, 0.5 * level.k * (3 / 8) * (level.h / 2) ** 2 * loss, rtol=1e-12, atol=0)
