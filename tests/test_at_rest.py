"""Strips at rest, and nearly so: the elastic strip, in closed form, with friction in proportion to speed where nothing snaps."""

import numpy as np
import pytest

import hystrip
from hystrip.orbit import abstract_foundation
from hystrip.orbit.at_rest import AT_REST, SLOW
from hystrip.orbit.foundation import foundation_of
from hystrip.orbit.groups import snaps_in
from hystrip.orbit.modes.extremal import Search
from hystrip.orbit.regimes import CODE

MATERIALS = {
    "one time": hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-3),
    "two times": hystrip.Prony(K=1e9, moduli=(1e10, 3e9), times=(1e-4, 1e-2)),
}
CASES = [("one time", "continuous"), ("one time", "constitutive"), ("two times", "constitutive")]
BRANCHES = ["unloading", "loading"]


def _strips(n: int, seed: int, nearest: float):
    """p_0, delta_0 and D of strips next to where regimes of the elastic strip meet: half of them at least ``nearest`` away."""
    rng = np.random.default_rng(seed)
    p_0, delta_0 = 10 ** rng.uniform(-3, 1, (2, n))
    p_0[::7] = 0.0
    ends = [2 - p_0, 2 - p_0 - delta_0, -p_0, -delta_0, np.full(n, 2.0)]
    shift = np.where(
        rng.random(n) < 0.5, rng.uniform(-1, 1, n), 10 ** rng.uniform(np.log10(nearest), -3, n) * rng.choice([-1, 1], n)
    )
    return p_0, delta_0, np.choose(rng.integers(0, len(ends), n), ends) + shift


def _solve(material, edge, branch, times, p_0, delta_0, D):
    """Strips whose longest time over that of their passage is ``times``."""
    foundation = foundation_of(MATERIALS[material])
    rate = np.broadcast_to(times / float(np.max(foundation.longest_time)), D.shape)
    strips = foundation.strips(rate, D, p_0, delta_0, edge, snaps_in(foundation.J * p_0, delta_0))
    none = np.zeros(D.size, bool)
    return strips, foundation._solve(strips, none, np.broadcast_to(times, D.shape), branch == "unloading")


@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize(("material", "edge"), CASES)
def test_slow_strips_tend_to_those_at_rest(material, edge, branch):
    """Against the solvers of moving strips, at a speed at which these see 1e-7 of the elastic strip."""
    p_0, delta_0, D = _strips(1000, 3, 1e-4)
    _, still = _solve(material, edge, branch, 0.0, p_0, delta_0, D)
    assert still.certified.all()
    strips, slow = _solve(material, edge, branch, 1e-7, p_0, delta_0, D)
    same = slow.code == still.code
    # adhesion that is weak beside the creep may be passed over
    assert same.mean() > 0.99
    scale = (1 + p_0)[same]
    assert (np.abs(slow.p_mean - still.p_mean)[same] < 1e-6 * scale).all()
    assert (np.abs(slow.tau_mean - still.tau_mean)[same] < 1e-5 * scale).all()
    for name in ("contact_fraction", "adhesion_fraction"):
        assert np.abs(getattr(slow, name) - getattr(still, name))[same].max() < 1e-4
    held = np.flatnonzero(same & np.isnan(still.c) & (slow.tau_mean > 0))
    slower = _solve(material, edge, branch, 1e-13, p_0, delta_0, D)[1]
    assert np.allclose(slower.tau_mean[held], 1e-6 * slow.tau_mean[held], rtol=1e-5)
    assert held.size > 200


@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize(("material", "edge"), CASES)
def test_what_is_lost_at_rest_is_lost_in_two_snaps(material, edge, branch):
    p_0, delta_0, D = _strips(2000, 4, 1e-12)
    _, s = _solve(material, edge, branch, 0.0, p_0, delta_0, D)
    free = np.isin(s.code, [CODE["acaf"], CODE["afc"], CODE["af"]])
    lost = np.where(p_0 >= delta_0, p_0 * delta_0 + p_0**2 / 2 - delta_0**2 / 2, p_0**2)
    assert np.allclose(2 * np.pi * s.tau_mean[free], lost[free], rtol=1e-9, atol=1e-13)
    assert (s.tau_mean[~free] == 0).all() and free.sum() > 400
    # w = p/K: contact carries the profile, from where it passes -p_0 (or what it met there) on
    whole = s.code == CODE["c"]
    assert np.allclose(s.p_mean[whole], (D - 1)[whole], atol=1e-14)


@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize(("material", "edge"), CASES)
def test_no_speed_is_too_low(material, edge, branch):
    """Next to where a strip is released rounding hides from the solvers of moving strips what happens: they refused 1 in 100."""
    speeds = [1e-17, AT_REST, 2 * AT_REST, 1e-12, 1e-11, 1e-10]
    strips = _strips(1500 if material == "one time" else 300, 5, 1e-17)
    times, (p_0, delta_0, D) = np.repeat(speeds, strips[0].size), np.tile(strips, len(speeds))
    _, s = _solve(material, edge, branch, times, p_0, delta_0, D)
    assert s.certified.all()
    _, still = _solve(material, edge, branch, 0.0, p_0, delta_0, D)
    same = s.code == still.code
    assert (same.reshape(len(speeds), -1).mean(axis=1) > 0.9).all()
    # a release in the middle of the valley is known like the root of the rounding of D
    same &= np.abs(2 - D - p_0 - delta_0) > 1e-8
    assert (np.abs(s.p_mean - still.p_mean)[same] < ((1e-11 + 100 * times) * (1 + p_0))[same]).all()


@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize("times", [4e-13, 6e-13, 1e-12])
def test_a_contact_all_but_a_period_long_is_not_none(branch, times):
    """Within rounding of saturated contact the edges of the gap are in the wrong order; the contact came out without length."""
    of = np.array([[0.0030263420823940955], [0.7593508551350551], [1.9969736579176058]])
    _, s = _solve("two times", "constitutive", branch, times, *of)
    assert s.certified and s.contact_fraction == pytest.approx(1.0, abs=1e-6) and s.p_mean == pytest.approx(of[2] - 1, abs=1e-9)


def test_strips_are_left_to_the_limit_by_need_alone(monkeypatch):
    """Above ``AT_REST`` what the solvers certify stands; above ``SLOW`` nothing else does."""
    asked = []
    inner = abstract_foundation.solve_at_rest
    monkeypatch.setattr(abstract_foundation, "solve_at_rest", lambda k, s, *rest: asked.append(s.size) or inner(k, s, *rest))
    p_0, delta_0, D = _strips(1000, 6, 1e-3)
    for times in (2 * AT_REST, 0.5 * SLOW, 2 * SLOW):
        _solve("one time", "constitutive", "unloading", times, p_0, delta_0, D)
    assert sum(asked) < 20


def test_a_search_that_gets_nowhere_ends(monkeypatch):
    """Two of these strips are left to the limit at rest; they took 300 rounds each."""
    rounds, step = [], Search.step
    monkeypatch.setattr(Search, "step", lambda search, number: rounds.append(number) or step(search, number))
    p_0, delta_0, D = _strips(200, 3, 1e-10)
    _, s = _solve("two times", "constitutive", "unloading", 1e-11, p_0, delta_0, D)
    assert s.certified.all() and max(rounds) < 20


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("material", MATERIALS.values(), ids=MATERIALS)
def test_levels_at_rest(material):
    levels = [hystrip.Level(1e-5, 1e-6), hystrip.Level(1e-6, 1e-7)]
    for adhesion in (hystrip.Dugdale(p_0=1000, delta_0=1e-8), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)):
        at = {"pressure": 1e3, "rtol": 1e-3, "edge": "constitutive"}
        slow, still = (hystrip.solve(material, adhesion, levels, velocity=v, **at) for v in (1e-12, [0.0, 1e-30, 1e-20]))
        assert still.converged.all() and (np.abs(still.mu - slow.mu) <= still.error_estimate + slow.error_estimate + 1e-6).all()
    still.summary()
