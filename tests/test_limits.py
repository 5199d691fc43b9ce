"""Identities and limits of single strips that need no other solver: full contact, elastic, fast, slow, flat, without adhesion.

Natural scales: lengths in ``1/k``, ``K = A = 1``, so that ``V T_sigma`` and ``V T_eps`` are alpha and beta; pressure
and friction in ``K A + p_0``, which is near 1 unless said otherwise.
"""

from itertools import product

import numpy as np
import pytest

import hystrip

EDGES, BRANCHES = ("continuous", "constitutive"), ("unloading", "loading")
BOTH = list(product(EDGES, BRANCHES))
LENGTH = 2 * np.pi


@pytest.fixture(autouse=True)
def strict():
    with np.errstate(all="raise", under="ignore"):
        yield


def strip(D, V=1.0, T_eps=1.0, T_sigma=0.1, p_0=0.0, delta_0=0.1, A=1.0, K=1.0, l=LENGTH, **options):  # noqa: E741
    return hystrip.solve_strip(
        hystrip.StandardLinearSolid(K, T_eps, T_sigma), hystrip.Dugdale(p_0=p_0, delta_0=delta_0), l=l, A=A, D=D, V=V, **options
    )


def dissipated(K, p_0, delta_0):
    """Energy that an elastic strip of stiffness K loses each period, per area, if it detaches fully."""
    return np.where(p_0 >= K * delta_0, p_0 * delta_0 + p_0**2 / (2 * K) - K * delta_0**2 / 2, p_0**2 / K)


@pytest.mark.parametrize(("edge", "branch"), BOTH)
def test_full_contact(edge, branch):
    V, T_sigma, p_0 = np.meshgrid([1e-9, 1e-3, 0.3, 1.0, 40.0, 1e6], [0.0, 1e-4, 0.2, 1.0], [0.0, 0.5])
    K, A, l = 3.0, 0.2, 0.7  # noqa: E741
    omega = 2 * np.pi / l * V
    D = 3 * A * (1 + np.hypot(1, omega))  # far above saturation, for either branch
    s = strip(D, V, 1.0, T_sigma, p_0, A=A, K=K, l=l, edge=edge, branch=branch)
    friction = 0.5 * 2 * np.pi / l * A**2 * K * omega * (1 - T_sigma) / (1 + (omega * T_sigma) ** 2)
    assert (s.regime == "c").all() and (s.contact_fraction == 1).all() and (s.adhesion_fraction == 0).all()
    assert np.allclose(s.tau_mean, friction, rtol=1e-13, atol=0)
    assert np.allclose(s.p_mean, K * (D - A), rtol=1e-13, atol=0)


def test_saturation_begins_at_its_threshold():
    V, p_0 = np.array([1e-3, 0.3, 1.0, 40.0]), 0.4
    D = 1 + np.hypot(1, V) / np.hypot(1, 0.1 * V) - p_0
    assert (strip(D * (1 + 1e-9), V, p_0=p_0).regime == "c").all()
    assert (strip(D * (1 - 1e-9), V, p_0=p_0).regime == "ac").all()


@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize(("p_0", "delta_0"), [(0.3, 0.1), (0.1, 0.3), (0.2, 0.2), (0.5, 1e-3), (1e-3, 0.5)])
def test_elastic_strip(p_0, delta_0, branch):
    """T_eps = T_sigma: the only loss is that of two snaps, whatever the velocity."""
    V = np.array([1e-3, 0.2, 5.0, 1e3])
    s = strip(0.1, V, 1.0, 1.0, p_0, delta_0, edge="constitutive", branch=branch)
    assert all("c" in regime and "f" in regime for regime in s.regime)
    assert np.allclose(s.tau_mean * LENGTH, dissipated(1.0, p_0, delta_0), rtol=1e-9)


@pytest.mark.parametrize(("p_0", "delta_0"), [(0.6, 0.1), (0.3, 0.2)])
def test_fast_constitutive_strip_is_glassy(p_0, delta_0):
    """A plateau of friction, that of the elastic strip with the glassy stiffness; what is missing falls as 1/V."""
    T_sigma = 0.4
    V = np.array([1e4, 1e6])
    s = strip(0.5, V, 1.0, T_sigma, p_0, delta_0, edge="constitutive")
    assert all("c" in regime and "f" in regime for regime in s.regime)
    missing = s.tau_mean * LENGTH - dissipated(1 / T_sigma, p_0, delta_0)
    assert np.all(np.abs(missing) < 30 / V) and abs(missing[1]) > 0
    assert missing[0] / missing[1] == pytest.approx(100, rel=0.01)


def test_fast_continuous_strip_is_frozen():
    """The surface has no time to come back between contacts: no friction in the end."""
    V = 10.0 ** np.arange(2, 9)
    s = strip(0.5, V, p_0=0.1)
    assert all("c" in regime and "f" in regime for regime in s.regime)
    assert np.all(np.diff(np.abs(s.tau_mean)) < 0) and abs(s.tau_mean[-1]) < 1e-5


@pytest.mark.parametrize("edge", EDGES)
@pytest.mark.parametrize(("p_0", "delta_0"), [(0.3, 0.1), (0.1, 0.3), (0.5, 1e-3)])
def test_slow_strip_is_elastic(edge, p_0, delta_0):
    V = np.array([1e-3, 1e-5, 1e-7])
    detaching = strip(0.1, V, p_0=p_0, delta_0=delta_0, edge=edge)
    assert all("f" in regime for regime in detaching.regime)
    missing = np.abs(detaching.tau_mean * LENGTH - dissipated(1.0, p_0, delta_0))
    assert np.all(missing < 10 * V)
    engaged = strip(1.9, V, p_0=p_0, delta_0=delta_0, edge=edge)
    assert not any("f" in regime for regime in engaged.regime)
    assert np.all(np.abs(engaged.tau_mean) < 10 * V)


@pytest.mark.parametrize(("edge", "branch"), BOTH)
def test_strip_at_rest_is_the_limit_of_the_slow_one(edge, branch):
    D, p_0 = np.meshgrid(np.linspace(-1, 3, 17), [0.0, 0.05, 0.3])
    D = D + 0.013  # off the thresholds
    rest, slow = (strip(D, V, p_0=p_0, edge=edge, branch=branch) for V in (0.0, 1e-8))
    for name in ("p_mean", "contact_fraction", "adhesion_fraction"):
        assert np.abs(getattr(rest, name) - getattr(slow, name)).max() < 1e-7, name
    assert np.abs(rest.tau_mean - slow.tau_mean).max() < 1e-7


@pytest.mark.parametrize(("edge", "branch"), BOTH)
@pytest.mark.parametrize("V", [3e-9, 1e-10, 1e-12, 1e-15, 1e-17, 1e-30, 1e-300])
def test_the_slowest_strip_is_as_good_as_at_rest(V, edge, branch):
    """The foundation forgets within less than the rounding of a phase: still a solution, the one at rest."""
    D = np.linspace(-1, 3, 17) + 0.013
    rest, slow = (strip(D, v, p_0=0.3, edge=edge, branch=branch) for v in (0.0, V))
    for name in ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction"):
        assert np.abs(getattr(rest, name) - getattr(slow, name)).max() < 1e-7, name


@pytest.mark.parametrize("edge", EDGES)
def test_kelvin_voigt_pressure_is_local(edge):
    T_eps, V = 1.0, np.array([[0.05], [0.7], [4.0]])
    D = np.array([0.2, 1.0, 6.0])
    s = strip(D, V, T_eps, 0.0, 0.2, edge=edge)
    x = np.linspace(-np.pi, np.pi, 401).reshape(-1, 1, 1)
    expected = D - 1 + np.cos(x) + V * T_eps * np.sin(x)  # K (u - V T_eps u_x)
    touching = s.gap(x) == 0
    assert touching.any(axis=0).all()
    assert np.abs(s.pressure(x) - expected)[touching].max() < 1e-12
    assert (s.pressure(x)[touching] >= -0.2 - 1e-13).all()


@pytest.mark.parametrize("T_sigma", [1e-3, 1e-5, 1e-7])
def test_standard_solid_tends_to_kelvin_voigt(T_sigma):
    near, limit = (strip(np.array([0.2, 1.0, 6.0]), 0.7, T_sigma=T, p_0=0.2) for T in (T_sigma, 0.0))
    assert (near.regime == limit.regime).all()
    assert np.abs(near.tau_mean - limit.tau_mean).max() < 5 * T_sigma
    assert np.abs(near.p_mean - limit.p_mean).max() < 5 * T_sigma


def test_long_wave_is_a_parabola():
    """One asperity, K = R_p = T_eps = V = 1, T_sigma = 0.1, b = 0.7: edge, normal and friction force per width."""
    b, k = 0.7, np.array([1e-2, 1e-3, 1e-4])
    s = strip(b**2 / 2, 1.0, A=1 / k**2, l=2 * np.pi / k)
    assert (s.regime == "cf").all()
    found = np.array([s.a, s.b, s.p_mean * 2 * np.pi / k, s.tau_mean * 2 * np.pi / k])
    known = np.array([[0.31652973], [0.7], [0.38150201], [0.10574816]])
    assert np.all(np.abs(found - known) < 0.1 * k**2 + 1e-8)


@pytest.mark.parametrize(("edge", "branch"), BOTH)
@pytest.mark.parametrize("factor", [2.0**-20, 8.0, 1e-6, 1e9])
def test_length_and_velocity_scale_together(edge, branch, factor):
    D = np.linspace(-1, 3, 21)
    given = {"p_0": 0.3, "edge": edge, "branch": branch}
    s, scaled = strip(D, 0.8, **given), strip(D, 0.8 * factor, l=LENGTH * factor, **given)
    assert (s.regime == scaled.regime).all()
    powers = {"p_mean": 0, "contact_fraction": 0, "adhesion_fraction": 0, "tau_mean": -1, **dict.fromkeys("abcd", 1)}
    for name, power in powers.items():
        found, known = getattr(scaled, name) / factor**power, getattr(s, name)
        assert np.allclose(found, known, rtol=1e-11, atol=1e-13, equal_nan=True), name


@pytest.mark.parametrize(("edge", "branch"), BOTH)
def test_flat_strip(edge, branch):
    """A = 0: contact down to -p_0, clinging down to a gap of delta_0, then nothing; loading waits for the undeformed gap."""
    D = np.array([1.0, 0.0, -0.05, -0.15, -0.25, -0.3999, -0.4001, -5.0])
    s = strip(D, np.array([[0.0], [1.0], [1e6]]), p_0=0.3, A=0.0, edge=edge, branch=branch)
    for row, p in zip(s.regime, s.p_mean, strict=True):
        contact, free = row == "c", row == "f"
        assert np.array_equal(p[contact], D[contact]) and not p[free].any() and (p[row == "a"] == -0.3).all()
    assert not s.tau_mean.any()
    last = {"unloading": -0.4, "loading": -0.1}[branch]
    for row in s.regime:
        assert row.tolist() == ["f" if d < last else "c" if d >= -0.3 else "a" for d in D]
    assert np.array_equal(s.gap(0.3), np.broadcast_to(np.where(s.regime == "c", 0.0, s.p_mean - D), s.p_mean.shape))


@pytest.mark.parametrize("unit", [1.0, 1e-9, 1e-18])
def test_a_flat_strip_knows_no_length_but_its_own(unit):
    """Contact ends where the pressure is -p_0, to rounding, however small the penetration is."""
    D = -0.3 * unit * (1 + np.array([1e-14, -1e-14]))
    assert strip(D, p_0=0.3 * unit, delta_0=0.1 * unit, A=0.0).regime.tolist() == ["a", "c"]


def test_nearly_flat_strip_tends_to_the_flat_one():
    D = np.array([1.0, -0.15, -0.35, -5.0])
    flat = strip(D, p_0=0.3, A=0.0)
    for A in (1e-6, 1e-12, 1e-17, 1e-19, 1e-300):
        s = strip(D, p_0=0.3, A=A)
        assert (s.regime == flat.regime).all()
        assert np.abs(s.p_mean - flat.p_mean).max() <= 2 * A + 1e-16


@pytest.mark.parametrize(("edge", "branch"), BOTH)
def test_without_adhesion_its_range_plays_no_part(edge, branch):
    D, V = np.linspace(-0.5, 2.5, 13), np.array([[0.01], [1.0], [100.0]])
    bare = strip(D, V, p_0=0.0, delta_0=0.0, edge=edge, branch=branch)
    assert set(bare.regime.ravel()) <= {"c", "cf", "f"} and not bare.adhesion_fraction.any()
    assert (bare.p_mean >= 0).all()
    assert np.isnan(bare.c).all() and np.isnan(bare.d).all()
    for delta_0 in (1e-300, 0.1, 1e12):
        s = strip(D, V, p_0=0.0, delta_0=delta_0, edge=edge, branch=branch)
        for name in ("p_mean", "tau_mean", "contact_fraction", "regime"):
            assert np.array_equal(getattr(s, name), getattr(bare, name)), name


@pytest.mark.parametrize(("edge", "branch"), BOTH)
def test_without_adhesion_nothing_depends_on_edge_or_branch(edge, branch):
    D = np.linspace(-0.5, 2.5, 13)
    s, other = strip(D, edge=edge, branch=branch), strip(D)
    assert (s.regime == other.regime).all()
    assert np.allclose([s.p_mean, s.tau_mean], [other.p_mean, other.tau_mean], rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize(("edge", "branch"), BOTH)
def test_adhesion_of_unlimited_range(edge, branch):
    """Nothing is ever free: the weight of the adhesion is that of a uniform pull."""
    D, p_0 = np.linspace(-0.5, 3, 15), 0.3
    s = strip(D, p_0=p_0, delta_0=1e12, edge=edge, branch=branch)
    bare = strip(D + p_0)  # the same surface, pulled by -p_0
    assert not any("f" in regime for regime in s.regime)
    assert np.allclose(s.p_mean + p_0, bare.p_mean, rtol=1e-11, atol=1e-13)
    assert np.allclose(s.tau_mean, bare.tau_mean, rtol=1e-11, atol=1e-13)
    assert np.allclose(s.contact_fraction + s.adhesion_fraction, 1, rtol=0, atol=1e-14)


@pytest.mark.parametrize("edge", EDGES)
@pytest.mark.parametrize("p_0", [1e3, 1e9, 1e15])
def test_strong_adhesion_pulls_into_full_contact(edge, p_0):
    D = np.array([-100.0, 0.0, 3.0])
    s = strip(D, p_0=p_0, delta_0=1e-3, edge=edge)
    assert (s.regime == "c").all()
    assert np.allclose(s.p_mean, D - 1, rtol=1e-13)
    assert np.allclose(s.tau_mean, 0.5 * 0.9 / 1.01, rtol=1e-12)


@pytest.mark.parametrize("times", [1, 2])
def test_whether_a_point_snaps_in_does_not_depend_on_the_strip(times):
    """At an exact tie ``J_0 p_0 = delta_0`` every strip snaps in, whatever its amplitude rounds."""
    K, share = 1e9, 100.0
    material = hystrip.StandardLinearSolid(K=K, T_eps=1e-2, T_sigma=1e-4)
    if times == 2:
        material = hystrip.Prony(K=K, moduli=[98e9, 1e9], times=[1e-4, 1e-3])
    A = np.linspace(1e-7, 5e-5, 300)
    for delta_0 in (1e-5, 7e-6, 1.1e-5):
        adhesion = hystrip.Dugdale(p_0=delta_0 * K * share, delta_0=delta_0)
        strips = hystrip.solve_strip(material, adhesion, l=1e-3, A=A, D=0.2 * A, V=1.0, edge="constitutive")
        assert (strips.regime == "afc").any() and not np.isin(strips.regime, ["acaf", "af"]).any()
