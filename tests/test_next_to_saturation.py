"""Pressures next to those of saturated contact: a pressure that pushes is always carried,
however little the curve rises above it.

Loading passes them at the end of its way, where contact is all but complete and the mean pressure exceeds the one asked for by
less than a curve is known to.
"""

from functools import cache

import numpy as np
import pytest

import hystrip

LEVEL = hystrip.Level(l=1e-5, h=1e-6)
#: nearer to where unloading leaves it loading takes strips next to the valley to their rounding
SHARES = np.concatenate((-np.logspace(-1, -8, 8), np.logspace(-6, -1, 3)))


def scene(seed):
    """Material, adhesion, velocity and edge closure, of adhesion that is weak or strong beside the waviness."""
    rng = np.random.default_rng((20, seed))
    K, p_0 = 1e9, 1e3 * 10 ** rng.uniform(-2, 0.5)
    adhesion = hystrip.Dugdale(p_0=p_0, delta_0=LEVEL.h * 10 ** rng.uniform(-2, 0.5))
    if seed % 3 == 2:
        material = hystrip.Prony(K, K * 10 ** rng.uniform(-1, 1, 2), [1e-3, 1e-1])
    else:
        material = hystrip.StandardLinearSolid(K, 1e-2, 1e-2 / 10 ** rng.uniform(0.2, 3))
    edge = "continuous" if seed % 3 == 0 else "constitutive"
    return material, adhesion, 1e-5 / (2 * np.pi * 1e-2) * 10 ** rng.uniform(-4, 1), edge


@cache
def saturating(seed):
    """Pressures from which contact is complete, of both branches."""
    material, adhesion, V, edge = scene(seed)
    given = {"pressure": 1e12, "velocity": V, "edge": edge}
    return [float(hystrip.solve(material, adhesion, LEVEL, branch=b, **given).p_sat) for b in ("loading", "unloading")]


@pytest.mark.xdist_group("saturating")  # which are solved once
@pytest.mark.parametrize("branch", ["loading", "unloading"])
@pytest.mark.parametrize("seed", range(6))
def test_a_pressure_that_pushes_is_carried(seed, branch):
    material, adhesion, V, edge = scene(seed)
    given = {"velocity": V, "edge": edge}
    p = np.sort(np.outer([end for end in saturating(seed) if end > 0], 1 + SHARES).ravel())
    rough, fine = (hystrip.solve(material, adhesion, LEVEL, pressure=p, branch=branch, rtol=r, **given) for r in (1e-3, 1e-5))
    assert not (rough.pulled_off | fine.pulled_off).any() and rough.converged.all()
    assert (np.abs(rough.tau - fine.tau) <= rough.tau_error + fine.tau_error).all()
    # pressure over penetration rises on what a branch passes
    assert (np.diff(fine.penetration) > -1e-9 * LEVEL.h).all()


def test_loading_carries_what_two_levels_are_pressed_by():
    """One level, and two: 0.4 Pa below where unloading leaves saturated contact loading was taken to be off, and to be exact."""
    material = hystrip.StandardLinearSolid(1e9, 1e-2, 2.7177215360591086e-05)
    adhesion = hystrip.Dugdale(gamma=0.00019827104714380722, delta_0=2.3853793373729994e-06)
    given = {"pressure": [2100.0, 2122.6, 2123.44, 2124.0], "velocity": 0.0007656502714883709, "branch": "loading"}
    for levels in ([LEVEL], [LEVEL, hystrip.Level(l=1e-6, h=1e-7)]):
        result = hystrip.solve(material, adhesion, levels, rtol=1e-3, **given)
        assert np.ptp(result.mu) < 2e-3 and (result.mu > 0.06).all() and result.converged.all()
    at = hystrip.solve_level(material, adhesion, LEVEL, V=given["velocity"], D=2122.6e-9 + 0.75e-6, branch="loading")
    one = hystrip.solve(material, adhesion, LEVEL, rtol=1e-3, **given | {"pressure": 2122.6})
    assert one.tau == pytest.approx(float(at.tau_mean), rel=1e-8)


def test_adhesion_holds_no_more_than_its_traction_and_fractions_are_such():
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, 1e-4), hystrip.Dugdale(p_0=250.0, delta_0=1e-6)
    level, shares = hystrip.Level(1e-5, 5e-7), np.array([1e-6, 5.6e-10, 1e-13, -1e-13, -5.6e-10, -1e-6])
    for rtol in (1e-3, 1e-6):
        r = hystrip.solve(
            material, adhesion, level, pressure=-250.0 * (1 + shares), velocity=0.01, edge="constitutive", rtol=rtol
        )
        assert r.pulled_off.tolist() == [True] * 3 + [False] * 3
        fractions = np.array([r.contact_fraction, r.adhesion_by_level[0]])
        assert (fractions >= 0).all() and (fractions <= 1).all()
