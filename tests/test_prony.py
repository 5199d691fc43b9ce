"""Materials with several relaxation times: their forms, what they reduce to, what is refused."""

import numpy as np
import pytest

import hystrip
from hystrip import InputError, Prony

RNG = np.random.default_rng(4)
N = 200
STRIPS = {"l": 1e-5, "A": 1e-6, "D": RNG.uniform(-1.5e-6, 3e-6, N), "V": 10.0 ** RNG.uniform(-7, -1, N)}
ADHESION = hystrip.Dugdale(p_0=2e3, delta_0=3e-7)
NUMBERS = ("p_mean", "tau_mean", "contact_fraction", "adhesion_fraction", "a", "b", "c", "d")


def solve(material, branch="unloading", edge="constitutive", adhesion=ADHESION, **changed):
    return hystrip.solve_strip(material, adhesion, **(STRIPS | changed), edge=edge, branch=branch)


def largest_difference(one, two):
    """Over all numbers, relative to their natural scales; NaN with NaN."""
    scales = dict.fromkeys(NUMBERS[4:], STRIPS["l"]) | {
        "p_mean": 3e3,
        "tau_mean": 2e3,
        "contact_fraction": 1.0,
        "adhesion_fraction": 1.0,
    }
    worst = 0.0
    for name in NUMBERS:
        x, y = getattr(one, name), getattr(two, name)
        assert np.array_equal(np.isnan(x), np.isnan(y))
        worst = max(worst, float(np.nan_to_num(np.abs(x - y)).max()) / scales[name])
    return worst


@pytest.mark.parametrize("branch", ["unloading", "loading"])
def test_one_time_is_the_standard_linear_solid(branch):
    K, K_1, tau = 1e9, 7e9, 1e-3
    solid = hystrip.StandardLinearSolid(K, tau * (1 + K_1 / K), tau)
    one = solve(solid, branch)
    for many in (Prony(K, [K_1], [tau]), Prony(K, [2e9, 0.0, 5e9], [tau, 1.0, tau])):
        assert many.n == 1
        assert largest_difference(one, solve(many, branch)) == 0


@pytest.mark.parametrize("branch", ["unloading", "loading"])
def test_the_solver_for_two_times_agrees_with_that_for_one(branch):
    """Two nearly equal times, and one modulus next to nothing, do not reduce: the solver with two modes has to find
    what the one with one mode does."""
    K, K_1, tau = 1e9, 7e9, 1e-3
    one = solve(hystrip.StandardLinearSolid(K, tau * (1 + K_1 / K), tau), branch)
    near = solve(Prony(K, [3e9, 4e9], [tau, tau * (1 + 1e-14)]), branch)
    faint = solve(Prony(K, [K_1, 1e-7], [tau, 1.0]), branch)
    assert largest_difference(one, near) < 1e-12
    assert np.array_equal(one.regime, faint.regime)
    assert largest_difference(one, faint) < 1e-12


def test_kelvin_voigt_is_the_limit_of_small_T_sigma():
    limit = solve(hystrip.KelvinVoigt(1e9, 1e-3))
    assert largest_difference(limit, solve(hystrip.StandardLinearSolid(1e9, 1e-3, 0.0))) == 0
    assert largest_difference(limit, solve(hystrip.KelvinVoigt(1e9, 1e-3), edge="continuous")) == 0
    near = solve(hystrip.StandardLinearSolid(1e9, 1e-3, 1e-15))
    assert np.mean(near.regime == limit.regime) > 0.99
    same = near.regime == limit.regime
    assert np.abs(near.p_mean - limit.p_mean)[same].max() < 1e-5 * 3e3


def test_no_branch_is_the_elastic_foundation():
    elastic = solve(hystrip.StandardLinearSolid(1e9, 1e-3, 1e-3))
    assert largest_difference(elastic, solve(Prony(1e9, [], []))) < 1e-12
    assert largest_difference(elastic, solve(Prony(1e9, [0.0, 0.0], [1.0, 2.0]))) < 1e-12


@pytest.mark.parametrize("seed", range(20))
def test_retardation_form_is_the_same_foundation(seed):
    rng = np.random.default_rng(seed)
    n = rng.integers(1, 7)
    given = Prony(10.0 ** rng.uniform(3, 10), 10.0 ** rng.uniform(3, 10, n), 10.0 ** rng.uniform(-8, 4, n))
    J_0, J, lambdas = given.retardation
    assert J_0 + sum(J) == pytest.approx(1 / given.K, rel=1e-12)
    assert all(tau < lam for tau, lam in zip(given.times, lambdas, strict=True))
    assert all(lam < tau for lam, tau in zip(lambdas, given.times[1:], strict=False))
    rate = 1j * 10.0 ** np.arange(-6.0, 10)
    stiffness = given.K + sum(K_i * rate * tau / (1 + rate * tau) for K_i, tau in zip(given.moduli, given.times, strict=True))
    compliance = J_0 + sum(J_j / (1 + rate * lam) for J_j, lam in zip(J, lambdas, strict=True))
    assert np.abs(stiffness * compliance - 1).max() < 1e-12
    # the way back: the distance of a time from its neighbour is known to rounding of the times, and the moduli with it
    back = Prony.from_retardation(1 / J_0, J, lambdas)
    assert back.K == pytest.approx(given.K, rel=1e-12) and back.n == given.n
    found = back.K + sum(K_i * rate * tau / (1 + rate * tau) for K_i, tau in zip(back.moduli, back.times, strict=True))
    assert np.abs(found / stiffness - 1).max() < 1e-11


def test_full_contact_friction_is_the_loss_modulus():
    """1/2 k A^2 Im K*(kV) of a wave in full contact, to rounding, for two and three times."""
    V, l, A = 10.0 ** np.arange(-8.0, 3), 1e-5, 1e-6  # noqa: E741
    for moduli, times in (([3e9, 2e10], [1e-3, 1e-1]), ([1e8, 3e9, 2e10], [1e-6, 1e-3, 10.0])):
        omega = 2 * np.pi / l * V
        loss = sum(K_i * omega * tau / (1 + (omega * tau) ** 2) for K_i, tau in zip(moduli, times, strict=True))
        s = hystrip.solve_strip(Prony(1e9, moduli, times), ADHESION, l=l, A=A, D=1e-3, V=V, edge="constitutive")
        assert set(s.regime) == {"c"}
        assert np.allclose(s.tau_mean, 0.5 * (2 * np.pi / l) * A**2 * loss, rtol=1e-13, atol=0)


def test_high_speed_is_the_elastic_strip_of_the_glassy_stiffness():
    material = Prony(1e9, [3e9, 2e10], [1e-3, 1e-1])
    glassy = hystrip.StandardLinearSolid(material.K_glassy, 1.0, 1.0)
    strips = {"D": 2e-7, "V": 1e9, "branch": "loading"}
    fast, elastic = solve(material, **strips), solve(glassy, **strips)
    assert fast.tau_mean == pytest.approx(elastic.tau_mean, rel=1e-5) and elastic.tau_mean > 0


def test_slow_motion_is_the_elastic_strip_of_the_relaxed_stiffness():
    """At V = 0 every phase has time to come to rest, whatever the times: only the snaps of the elastic strip dissipate."""
    material = Prony(1e9, [3e9, 2e10], [1e-3, 1e-1])
    relaxed = hystrip.StandardLinearSolid(1e9, 0.0, 0.0)
    # p_0/K is less than the amplitude: strips let go, and snap back
    adhesion = hystrip.Dugdale(p_0=200.0, delta_0=1e-9)
    for branch in ("unloading", "loading"):
        slow, elastic = (solve(each, branch, adhesion=adhesion, V=0.0) for each in (material, relaxed))
        for name in NUMBERS[:2]:
            assert np.abs(getattr(slow, name) - getattr(elastic, name)).max() < 1e-11 * 3e3, name
        assert np.sum(elastic.tau_mean > 2.0) > 50


@pytest.mark.parametrize(
    "arguments, field, says",
    [
        ({"K": 0.0}, "material.K", "> 0"),
        ({"K": np.nan}, "material.K", "finite"),
        ({"moduli": [1e9, -1.0]}, "material.moduli[1]", ">= 0"),
        ({"times": [1.0, 0.0]}, "material.times[1]", "> 0"),
        ({"times": [1.0]}, "material.moduli, material.times", "as many moduli as times"),
        ({"times": 3.0}, "material.times", "a sequence"),
        ({"moduli": "1e9"}, "material.moduli", "a sequence"),
    ],
)
def test_refused(arguments, field, says):
    with pytest.raises(InputError) as error:
        Prony(**({"K": 1e9, "moduli": [1e9, 2e9], "times": [1e-3, 1.0]} | arguments))
    assert error.value.field == field and says in str(error.value)


def test_continuous_is_refused_with_the_reason():
    material = Prony(1e9, [1e9, 2e9], [1e-3, 1.0])
    level = hystrip.Level(l=1e-5, h=1e-6)
    for call in (
        lambda: hystrip.solve_strip(material, ADHESION, l=1e-5, A=1e-6, D=0.0, V=1e-3),
        lambda: hystrip.solve_level(material, ADHESION, level, V=1e-3, D=0.0),
        lambda: hystrip.solve(material, ADHESION, [level], pressure=1e3, velocity=1e-3),
    ):
        with pytest.raises(InputError, match="not determined") as error:
            call()
        assert error.value.field == "edge"


def test_many_times_need_no_solver_of_their_own():
    """Two branches, split in halves of equal times, among eight that carry next to nothing, over eight decades."""
    split = [(0.5 * modulus, time) for modulus, time in ((3e9, 1e-3), (2e10, 1e-1)) for _ in range(2)]
    light = [(1e-3, 10.0 ** (k + 0.5)) for k in range(-6, 2)]
    many = Prony(1e9, *zip(*split, *light, strict=True))
    assert many.n == 10
    few, all_of_them = (solve(each) for each in (Prony(1e9, [3e9, 2e10], [1e-3, 1e-1]), many))
    assert np.allclose(all_of_them.p_mean, few.p_mean, rtol=1e-9) and np.allclose(all_of_them.tau_mean, few.tau_mean, rtol=1e-8)


def test_materials_are_immutable_and_compare_by_value():
    one, two = (Prony(1e9, [2e9, 1e9], times) for times in ([1.0, 1e-3], [1.0, 1e-3]))
    assert one == two and hash(one) == hash(two) and one != Prony(1e9, [2e9, 1e9], [1.0, 2e-3])
    assert one.times == (1e-3, 1.0) and one.moduli == (1e9, 2e9)
    with pytest.raises(AttributeError):
        one.K = 2.0
