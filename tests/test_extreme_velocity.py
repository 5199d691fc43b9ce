"""Sliding so fast that nothing relaxes within a period: every strip ends, and what comes out is the limit of infinite speed."""

import numpy as np
import pytest
from oracle import march

import hystrip
from hystrip.generated import standard_linear_solid
from hystrip.level.saturated import saturated_level
from hystrip.orbit.engine import solve_strips
from hystrip.orbit.groups import Strips
from hystrip.orbit.regimes import SEQUENCES

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
ADHESION = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
LEVELS = [hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9)]
K_GLASSY = MATERIAL.K * MATERIAL.T_eps / MATERIAL.T_sigma
FAST = np.array([1e6, 1e10, 1e15, 1e25])


def _strips(V, edge, branch, n=60):
    """Strips across a level of wavelength 10 um and height 1 um, pressed to many depths."""
    rng = np.random.default_rng(7)
    share, depth = rng.uniform(0, 1, n), rng.uniform(-0.2, 2, n) * 1e-6
    A, D = 0.5e-6 * (1 - share), depth - 1e-6 * share
    return hystrip.solve_strip(MATERIAL, ADHESION, l=10e-6, A=A, D=D, V=V, edge=edge, branch=branch)


@pytest.mark.parametrize("branch", ["unloading", "loading"])
@pytest.mark.parametrize("edge", ["continuous", "constitutive"])
def test_strips_tend_to_those_of_infinite_speed(edge, branch):
    near, *further = (_strips(V, edge, branch) for V in FAST)
    scale = K_GLASSY * 1e-6
    for far, V in zip(further, FAST[1:], strict=True):
        same = far.regime == near.regime
        assert same.sum() >= 59  # one may sit on the end of its branch
        assert np.abs(far.p_mean - near.p_mean)[same].max() <= 1e-5 * scale
        assert np.abs(far.contact_fraction - near.contact_fraction)[same].max() <= 1e-4
        if edge == "continuous":  # friction falls like 1/V, down to the rounding of the pressure
            loss = np.abs(far.tau_mean * V - near.tau_mean * FAST[0])[same]
            assert loss.max() <= 1e-2 * np.abs(near.tau_mean * FAST[0]).max()


@pytest.mark.parametrize("gamma", [2.5e-5, 1.2e-5, 4e-6])  # snaps into contact, nearly does, does not
@pytest.mark.parametrize("V", [1e9, 1e13, 1e25])
def test_a_strip_that_detaches_dissipates_what_its_glassy_stiffness_stores(gamma, V):
    K, delta_0, p_0 = K_GLASSY, 1e-8, gamma / 1e-8
    s = hystrip.solve_strip(
        MATERIAL, hystrip.Dugdale(gamma=gamma, delta_0=delta_0), l=1e-5, A=5e-7, D=5e-8, V=V, edge="constitutive"
    )
    lost = p_0 * delta_0 + p_0**2 / (2 * K) - K * delta_0**2 / 2 if p_0 >= K * delta_0 else p_0**2 / K
    assert s.regime == ("afc" if p_0 >= K * delta_0 else "acaf")
    assert s.tau_mean * 1e-5 == pytest.approx(lost, rel=2e-6 if V < 1e10 else 1e-9)


#: alpha, beta, J, L, p_0, delta_0, D of strips whose gap in the valley comes within rounding of delta_0
HARDLY_HELD = (
    (809886988.5646125, 809886990.3072948, 0.99999999784824, 2.151760010199911e-09,
     0.0001005339251063167, 596.8745942217734, -594.8746947556984),
    (417484937.68140787, 417484938.13165075, 0.9999999989215349, 1.0784650404499434e-09,
     0.00016014403163862692, 265.46826658203145, -263.46842672606306),
    (32614519826.41951, 32615948009.249596, 0.9999562121318787, 4.378786812135962e-05,
     1.5524172272632926e-06, 199.63836596231863, -197.63836751473468),
    (18967979130.179527, 18967979130.179527, 1.0, 0.0,
     0.0030642691602591923, 232.7231848784378, -230.7262491475941),
    (1693589285.266652, 1698668277.7209878, 0.9970100151271738, 0.002989984872826245,
     5.078239605313608e-05, 2379070206.071097, -2379070204.0711474),
)  # fmt: skip


@pytest.mark.parametrize("groups", HARDLY_HELD)
def test_adhesion_that_hardly_holds_in_the_valley_does_so_at_50_digits(groups):
    alpha, beta, J, _, p_0, delta_0, D = groups
    strips = Strips(*(np.array([v]) for v in (*groups, 1.0, J * p_0 >= delta_0)))
    found = solve_strips(standard_linear_solid, strips, unloading=False)
    true = march.solve(alpha, beta, p_0, delta_0, D, closure="constitutive", branch="loading", J=J)
    assert found.certified.all() and SEQUENCES[found.code[0]] == true.sequence == "a"


@pytest.mark.parametrize("branch", ["unloading", "loading"])
@pytest.mark.parametrize("J", [0.0, 1e-9, 1e-13])
def test_next_to_no_instantaneous_compliance_strips_are_right_or_refused(J, branch):
    rng = np.random.default_rng(8)
    for beta in 10.0 ** np.arange(12, 30, 3):
        D, p_0, delta_0 = rng.uniform(-0.1, 1), 10 ** rng.uniform(-4, -1), 10 ** rng.uniform(-3, -0.5)
        solid, adhesion = hystrip.StandardLinearSolid(1.0, beta, J * beta), hystrip.Dugdale(p_0=p_0, delta_0=delta_0)
        scene = {"l": 2 * np.pi, "A": 1.0, "D": D, "V": 1.0, "edge": "constitutive", "branch": branch}
        if beta > 1e18:
            with pytest.raises(hystrip.InputError, match=r"at most 1e\+18"):
                hystrip.solve_strip(solid, adhesion, **scene)
            continue
        found = hystrip.solve_strip(solid, adhesion, **scene)
        true = march.solve(J * beta, beta, p_0, delta_0, D, closure="constitutive", branch=branch, J=J)
        assert found.regime == true.sequence
        assert found.p_mean == pytest.approx(float(true.p_mean), rel=1e-11, abs=1e-11)
        assert found.tau_mean == pytest.approx(float(true.tau_mean), rel=1e-11, abs=1e-11)


@pytest.mark.parametrize(("edge", "branch"), [("constitutive", "unloading"), ("continuous", "loading")])
def test_two_levels_end_and_do_not_change(edge, branch):
    V = FAST[[0, 3]]
    results = hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=100.0, velocity=V, rtol=1e-2, edge=edge, branch=branch)
    assert results.converged.all()
    assert np.ptp(results.contact_fraction) <= 2e-2 * results.contact_fraction.mean()
    friction = results.tau_by_level * (V if edge == "continuous" else 1.0)
    assert (np.ptp(friction, axis=-1) <= 2e-2 * np.abs(friction).mean(axis=-1)).all()


def test_penetration_that_surely_saturates_when_loading_does_not_grow_with_velocity():
    """Else all of a law that stands at small pressures would be lost beside it."""
    levels = saturated_level(MATERIAL, ADHESION, LEVELS[1], np.array([1e-6, 1e3, 1e10]), "loading")
    assert levels.D_sat[2] == levels.D_sat[1] <= MATERIAL.T_eps / MATERIAL.T_sigma * LEVELS[1].h
    assert levels.D_sat[0] <= 1.1 * LEVELS[1].h
