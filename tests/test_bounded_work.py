"""Work is bounded: a point meets its tolerance, or comes back with an honest estimate, not ``converged``, and a warning."""

import warnings

import numpy as np
import pytest

import hystrip
from hystrip.level import averages, curve, inverse

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
ADHESION = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
LEVELS = [hystrip.Level(10e-6, 1e-6), hystrip.Level(500e-9, 100e-9)]


def _solve(pressure=100.0, rtol=1e-4):
    return hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=pressure, velocity=1e-3, rtol=rtol)


def _floor(level):
    return 1e-3 * (MATERIAL.K * level.h + ADHESION.p_0) * level.h / level.l


def test_what_converges_says_so_without_a_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        r = _solve(pressure=[100.0, 1e7])
    assert r.converged.dtype == bool and r.converged.shape == r.mu.shape and r.converged.all()
    assert (r.tau_error <= r.rtol * (np.abs(r.tau) + _floor(LEVELS[0]))).all()


@pytest.mark.parametrize(
    ("module", "limit", "value", "words"),
    [(curve, "CURVE_LIMIT", 200, "curve"), (averages, "AVERAGE_LIMIT", 30, "average")],
    ids=["curve", "average"],
)
def test_a_point_that_runs_into_a_limit_is_said_to_have_and_bounds_its_error(monkeypatch, module, limit, value, words):
    exact = _solve()
    monkeypatch.setattr(module, limit, value)
    with pytest.warns(hystrip.ConvergenceWarning, match=rf"1 of 2 points.*pressure 100, velocity 0\.001: .*{words}") as said:
        r = _solve(pressure=[100.0, 1e7])
    assert len(said) == 1 and said[0].filename == __file__
    assert r.converged.tolist() == [False, True]
    assert np.isfinite(r.tau_error).all()
    assert abs(r.tau[0] - exact.tau) <= r.tau_error[0]
    assert r.tau_error[0] > r.rtol * (r.tau[0] + _floor(LEVELS[0]))


def test_a_branch_that_the_work_leaves_undecided_is_not_claimed(monkeypatch):
    """So near to pull-off that coarse curves do not tell whether their minimum is passed."""
    law = hystrip.friction_law(MATERIAL, ADHESION, LEVELS[0], V=1e-3, rtol=1e-6)
    at = {"pressure": law.pull_off * (1 - 1e-4), "V": 1e-3, "rtol": 1e-6}
    assert hystrip.solve_level(MATERIAL, ADHESION, LEVELS[0], **at).converged
    for module in (curve, inverse):
        monkeypatch.setattr(module, "CURVE_LIMIT", 0)
    with pytest.warns(hystrip.ConvergenceWarning, match="curve"):
        level = hystrip.solve_level(MATERIAL, ADHESION, LEVELS[0], **at)
    assert not level.converged and level.error_estimate[1] >= abs(level.tau_mean)


def test_equal_strips_say_what_they_are_without_a_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        r = hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=100.0, velocity=1e-3, rtol=1e-4, strips=5)
    assert not r.converged and r.converged.shape == ()
