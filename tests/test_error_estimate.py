"""The error estimate bounds the error and is not wildly larger; the rules that it is made of, on functions whose integrals are
known."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebval

import hystrip
from hystrip.level.averages import Averages
from hystrip.level.branches import graded
from hystrip.level.inverse import Penetrations
from hystrip.level.strips import QUANTITIES
from hystrip.numerics.chebyshev import coefficients, flat_ended, interpolation_errors, lobatto
from hystrip.numerics.quadrature import by_rules, interior_nodes, mapped, mapped_weights, sum_errors

#: what is no layer next to an end
SMOOTH = np.zeros(1, bool)
TOOLS = Path(__file__).resolve().parents[1] / "tools"

#: functions on [0, 1] with their integrals: smooth, ends like square roots, nearly singular, kinks and jumps that nobody marked
FUNCTIONS = {
    "smooth": (np.exp, np.e - 1),
    "square root": (lambda x: np.sqrt(1 - x), 2 / 3),
    "square roots": (lambda x: np.sqrt(x * (1 - x)), np.pi / 8),
    "pole": (lambda x: 1 / (0.05 + (x - 0.3) ** 2), (np.arctan(0.7 / 0.05**0.5) + np.arctan(0.3 / 0.05**0.5)) / 0.05**0.5),
    "near square root": (lambda x: np.sqrt(1.01 - x), (1.01**1.5 - 0.01**1.5) * 2 / 3),
    "layer": (lambda x: np.exp(-x / 0.01), 0.01 * (1 - np.exp(-100))),
    "kink": (lambda x: np.abs(x - 0.37), 0.37**2 / 2 + 0.63**2 / 2),
    "jump": (lambda x: (x > 0.61).astype(float), 0.39),
}


@pytest.mark.parametrize("n", [8, 16, 32, 64])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_sum_errors_bound_the_error(name, n):
    function, exact = FUNCTIONS[name]
    values = function(mapped(interior_nodes(n)))
    error = abs(mapped_weights(n) @ values - exact)
    estimate = sum_errors(values[None, :, None], np.zeros((1, 1)), SMOOTH)[0, 0]
    assert error <= estimate + 1e-15 * max(exact, 1) * n


@pytest.mark.parametrize("n", [16, 32])
def test_sum_errors_are_not_spoiled_by_a_rougher_quantity(n):
    """Fractions end like square roots where friction has a higher power: they share a pace, not a size."""
    x = mapped(interior_nodes(n))
    both = np.stack((1 / (1.3 - x), (1.02 - x) ** 0.5), axis=1)
    exact = np.array([np.log(1.3 / 0.3), (1.02**1.5 - 0.02**1.5) / 1.5])
    error, estimate = np.abs(mapped_weights(n) @ both - exact), sum_errors(both[None], np.zeros((1, 2)), SMOOTH)[0]
    assert (error <= estimate + 1e-15 * n).all()
    assert estimate[0] < 0.2 * estimate[1]


@pytest.mark.parametrize("n", [32, 64])
@pytest.mark.parametrize("thin", [1e-3, 1e-4, 1e-5])
def test_sum_errors_see_a_layer_at_an_end_that_falls_slowly(n, thin):
    """Coefficients that fall fast from the middle on, until those of the layer are left: the pace among the last ones counts."""
    t = interior_nodes(n)
    function = lambda t: np.exp(mapped(t)) + 0.1 * np.sqrt(mapped(t) + thin)  # noqa: E731
    error = abs(mapped_weights(n) @ function(t) - (np.e - 1 + 0.1 * ((1 + thin) ** 1.5 - thin**1.5) * 2 / 3))
    assert error <= sum_errors(function(t)[None, :, None], np.zeros((1, 1)), SMOOTH)[0, 0] + 1e-15


def test_a_first_change_that_is_small_by_chance_is_not_believed():
    """One quantity hardly moves from rule to rule, another does: where one is not settled none is."""
    sums = np.array([[[5.817381, 0.026171]], [[5.817343, 0.026138]]])
    _, errors = by_rules(lambda rows, rule: sums[rule], (0, 1), np.full((1, 2), np.inf), np.zeros((1, 1)), 0.01, at_once=True)
    assert errors[0, 0] > 5.817343 - 5.816760


def test_sums_that_fall_slowly_miss_what_is_left_of_the_series():
    """Sums whose changes halve miss as much as the last change; a change that is small by chance says little."""
    rules, rows = range(6), np.full((1, 1), 1e-9)
    halving = lambda left, rule: np.full((1, 1), 1 + 0.5**rule)  # noqa: E731
    out, errors = by_rules(halving, rules, rows, 0 * rows, 0.01)
    assert abs(out[0, 0] - 1) <= errors[0, 0] <= 2 * abs(out[0, 0] - 1)
    chance = lambda left, rule: np.array([[(1.0, 1.1, 1.1, 1.05, 1.05, 1.05)[rule]]])  # noqa: E731
    assert by_rules(chance, rules[:3], rows, 0 * rows, 0.25)[1][0, 0] >= 0.01


def test_constants_and_lines_are_summed_without_error():
    for values in (np.ones(7), mapped(interior_nodes(8))):
        assert sum_errors(values[None, :, None], np.zeros((1, 1)), SMOOTH)[0, 0] < 1e-15


def test_rounding_of_one_quantity_does_not_spoil_another():
    """A fraction that is one but for rounding says nothing of how smooth the friction is."""
    t = interior_nodes(32)
    constant = 1 + 1e-16 * np.random.default_rng(1).integers(-1, 2, t.size)
    both = np.stack((np.exp(mapped(t)), constant), axis=1)[None]
    assert sum_errors(both, np.zeros((1, 2)), SMOOTH)[0, 0] < 1e-14


STIFF = hystrip.HalfSpace(1e6, 0.5, [107086.0], [2.56047e-6])
SEVEN = hystrip.HalfSpace(
    1e6,
    0.5,
    [2.86926e6, 3.46337e7, 3.4805e5, 2.34449e7, 7.71613e6, 2.08087e5, 6.66681e6],
    [0.0542056, 1.95065, 26.8149, 93.1046, 6354.29, 1.15622e5, 3.28262e5],
)
LAYERS = {
    "seven times, loading": (SEVEN, 81166.5, 2.87626e-8, 1.04275e-4, 1.9611e-5, 1.23196e-6, 9.597215462236035e-7, "loading"),
    "one time, unloading": (STIFF, 11676.7, 2.64958e-7, 2.66918e-3, 3.34848e-4, 81.8454, 8.216850069083453e-5, "unloading"),
}


@pytest.mark.parametrize("case", LAYERS)
def test_few_coefficients_that_are_small_by_chance_do_not_fall_geometrically(case):
    """The adhesion next to where strips let go is a layer, of which eight nodes showed next to nothing: its error was four to six
    times what was said."""
    material, p_0, delta_0, l, h, V, D, branch = LAYERS[case]  # noqa: E741
    scene = material, hystrip.Dugdale(p_0=p_0, delta_0=delta_0), hystrip.Level(l=l, h=h)
    coarse, fine = (
        hystrip.solve_level(*scene, V=V, D=D, edge="constitutive", branch=branch, rtol=rtol) for rtol in (1e-3, 1e-10)
    )
    for name, error in zip(QUANTITIES, coarse.error_estimate, strict=True):
        assert abs(getattr(coarse, name) - getattr(fine, name)) <= error, name


def _interpolated(function, n):
    """Largest error of the interpolant on n + 1 nodes, and the estimate of it."""
    c = coefficients(function(lobatto(n))[:, None])
    t = np.linspace(0, 1, 1001)
    return np.abs(chebval(2 * t - 1, c[:, 0]) - function(t)).max(), interpolation_errors(c[None], np.zeros((1, 1)), SMOOTH)[0, 0]


@pytest.mark.parametrize("n", [8, 16, 32])
@pytest.mark.parametrize("function", [np.exp, lambda t: 1 / (1.2 - t), lambda t: np.sqrt(1.02 - t), lambda t: np.sqrt(1.1 - t)])
def test_interpolation_errors_bound_the_error(function, n):
    error, estimate = _interpolated(function, n)
    assert error <= estimate + 1e-14


@pytest.mark.parametrize("n", [8, 16, 32])
@pytest.mark.parametrize("power", [1.0, 1.5])
def test_interpolation_errors_do_not_miss_a_kink_that_nobody_marked(power, n):
    """Its coefficients come and go: the estimate holds wherever it lies but for a small factor, and nearly always without."""
    places = np.linspace(0.05, 0.95, 91)
    ratios = [np.divide(*_interpolated(lambda t, x=x: np.maximum(t - x, 0.0) ** power, n)) for x in places]
    assert np.median(ratios) < 0.5 and np.max(ratios) < 5


def _ends(s):
    """Breaks at both ends: a square root at 0, ``s log s`` at 1."""
    left = np.maximum(1 - s, 1e-300)
    return np.sqrt(s) * np.exp(-s) + left * np.log(left)


@pytest.mark.parametrize(("n", "allowed"), [(16, 1e-3), (32, 1e-7), (64, 1e-10)])
def test_what_ends_like_a_square_root_is_interpolated_without_its_ends(n, allowed):
    c = flat_ended(n) @ _ends(graded(lobatto(n)[1:-1]))[:, None]
    t = np.linspace(0, 1, 1001)
    assert np.abs(chebval(2 * t - 1, c[:, 0]) - _ends(graded(t))).max() < allowed


def test_an_interpolant_without_ends_takes_no_notice_of_what_is_on_them():
    """A jump right at the end, as next to a break, belongs to the other side."""
    t = lobatto(32)
    values = np.cos(graded(t))
    ends = chebval([-1.0, 1.0], flat_ended(32) @ values[1:-1])
    assert ends == pytest.approx([1.0, np.cos(1.0)], abs=1e-6)


@pytest.fixture(scope="module")
def tool():
    sys.path.insert(0, str(TOOLS))
    try:
        spec = importlib.util.spec_from_file_location("benchmark_errors", TOOLS / "benchmark_errors.py")
        module = importlib.util.module_from_spec(spec)
        sys.modules[spec.name] = module
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(TOOLS))
    return module


def test_estimates_hold_on_random_surfaces(tool):
    """A short run of tools/benchmark_errors.py."""
    out = tool.survey(scenes=7, seed=1, tolerances=[1e-3, 1e-5], tighter=1e-2, levels=1, first=4, velocities=1)
    assert not out.refused and len(out.points) >= 4
    assert out.bounded == 1 and out.met == 1
    # a median of so few points scatters
    assert out.pessimism < 3 * tool.PESSIMISTIC


def test_a_survey_tells_what_does_not_hold(tool):
    rows = [(0, 0, 1e-3, 1e-6, 1e-5), (1, 0, 1e-3, 2e-5, 1e-5), (2, 0, 1e-3, 2e-3, 3e-3), (3, 0, 1e-3, 1e-14, 0.0)]
    out = tool.Survey(points=rows)
    assert out.bounded == 0.75 and out.met == 0.75 and out.largest == pytest.approx(2) and out.pessimism == pytest.approx(1.5)


def test_a_scene_that_takes_too_long_is_refused(tool):
    out = tool.survey(scenes=1, seed=1, tolerances=[1e-3], tighter=1e-2, levels=1, first=15, velocities=1, limit=0.05)
    assert [number for number, _ in out.refused] == [15] and not out.points


def test_marched_strips_bear_the_estimates_out(tool):
    """A short run with ``--march``: the truth has nothing in common with the library."""
    out = tool.marched(scenes=1, seed=1, tolerances=[1e-3, 1e-5], first=5, accuracy=1e-7)
    assert not out.refused and len(out.points) == 4
    assert out.bounded == 1 and out.met == 1


def test_a_step_within_what_either_average_misses_is_no_slope():
    """Pressure and friction, 0.5 of it, averaged at D and, less well, next to it: friction at the pressure asked for is not told
    by their difference."""
    slope = np.array([[1.0, 0.5, 0.0, 0.0]])
    near, missed = slope + [[0, 4e-7, 0, 0]], np.full((1, 4), 5e-7)
    means = Averages(slope * (1 + 1e-8), np.full((1, 4), 1e-12), np.ones(1, int))
    for errors, off in ((missed, 1e-12), (0 * missed, 3e-7)):
        at = Penetrations(np.zeros(1), near, errors, slope, np.ones(1), *np.zeros((2, 1), bool))
        values, bounds = at.meeting(np.ones(1), means)
        error = abs(values[0, 1] - 0.5)
        assert error <= bounds[0, 1] and (error <= off if errors.any() else error > off)


@pytest.mark.parametrize(("edge", "branch", "D", "mu", "pressure"), [
    # penetrations that 0.05 Pa are carried at; mu and pressure at 1e-11
    ("continuous", "unloading", [5.74063584809e-07, 5.43564235723e-07], [712.0828693, 202.01960642],
     [0.0500000022916, 0.0500000000045]),
    ("continuous", "loading", [8.72667342893e-08, 6.53649089243e-08], [52.659005323, 11.5126748709],
     [0.0499999999953, 0.0499999975393]),
    ("constitutive", "unloading", [5.62241619808e-07, 5.26953051696e-07], [734.9232561, 255.86418293],
     [0.0500000038132, 0.0499999992309]),
    ("constitutive", "loading", [5.48444603417e-08, 2.95600634316e-08], [48.5878886703, 17.9055836163],
     [0.0499999981364, 0.049999998774]),
])  # fmt: skip
def test_friction_coefficients_at_penetrations_err_as_their_pressures_do(edge, branch, D, mu, pressure):
    """Next to no pressure a thousandth of what it is held against is all of it: of mu that was up to 265 times the estimate."""
    of = hystrip.StandardLinearSolid(1e9, 1e-2, 1e-4), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8), hystrip.Level(1e-5, 1e-6)
    how = {"velocity": np.array([3.2e-3, 1e-2]), "edge": edge, "branch": branch}
    found = hystrip.solve(*of, penetration=D, rtol=1e-3, **how)
    assert (np.abs(found.mu - mu) <= found.error_estimate).all()
    assert (found.error_estimate > found.tau_error / np.abs(found.pressure)).all()
    assert (found.error_estimate < 0.1 * found.mu).all()
    assert (np.abs(found.pressure - pressure) <= found.pressure_error).all()
    assert (found.pressure_error > 0).all() and not hystrip.solve(*of, pressure=0.05, rtol=1e-3, **how).pressure_error.any()


def test_a_friction_coefficient_is_not_known_where_the_pressure_of_a_penetration_may_be_zero():
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, 1e-4), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
    level, how = hystrip.Level(1e-5, 1e-6), {"velocity": 1e-2, "edge": "constitutive"}
    D = hystrip.solve(material, adhesion, level, pressure=1e-9, rtol=1e-10, **how).penetration
    with pytest.warns(hystrip.ConvergenceWarning, match=f"penetration {D:g}, velocity 0.01: the pressure .* may be zero"):
        found = hystrip.solve(material, adhesion, level, penetration=[D, -1e-5], rtol=1e-2, **how)
    assert found.error_estimate[0] == np.inf and np.isfinite(found.tau_error).all()
    assert found.pressure_error[0] >= abs(found.pressure[0]) > 0
    assert "error      of mu at most inf (estimate), where the pressure may be zero\n" in found.summary()
    # where nothing touches the pressure is zero, friction as well, and there is no mu
    assert found.converged.tolist() == [False, True] and found.pressure[1] == 0 and np.isnan(found.mu[1])


SLOW = hystrip.StandardLinearSolid(168.7e6, 1.061, 6.496e-3)


@pytest.mark.parametrize("material, adhesion, level, V, D, rtol", [
    (SLOW, {"gamma": 0}, (3.074e-5, 3.971e-6), 5.857e-6, 2.119e-6, 1e-6),
    (SLOW, {"gamma": 0}, (3.074e-5, 3.971e-6), 1.54e-6, 6.624e-7, 1e-9),
    (hystrip.StandardLinearSolid(1.027e6, 3.531, 4.754e-4), {"gamma": 0}, (6.897e-6, 4.365e-7), 3.896e-6, 9.372e-8, 1e-9),
    (hystrip.StandardLinearSolid(7.339e9, 4.596e-3, 3.044e-5), {"gamma": 0}, (6.452e-4, 8.214e-5), 1.615e-2, 6.76e-5, 1e-9),
    (hystrip.StandardLinearSolid(2028e3, 2.137e-2, 4.746e-5), {"gamma": 1.198e-10, "delta_0": 8.629e-9}, (3.82e-6, 6.357e-8),
     3.97e-5, 3.2436e-8, 1e-9),
    (hystrip.Prony(217.1e6, (5.204e9, 9.888e8, 7.943e7), (1.177e-2, 1.312e-2, 2.324)), {"gamma": 1.327e-9, "delta_0": 1.298e-8},
     (1.05e-7, 1.971e-8), 3.807e-10, 9.855e-9, 1e-9),
])  # fmt: skip
def test_fractions_err_by_no_more_than_they_say_where_contacts_vanish(material, adhesion, level, V, D, rtol):
    """Over y a contact sets in like a square root of the distance, with another factor while it is short against ``k V T_sigma``:
    that layer may lie between a panel's end and its outermost node. Estimates were up to 140 times too small."""
    of = material, hystrip.Dugdale(**adhesion), hystrip.Level(*level)
    for edge in ["constitutive"] if isinstance(material, hystrip.Prony) else ["continuous", "constitutive"]:
        found, finer = (hystrip.solve_level(*of, V=V, D=D, edge=edge, rtol=each) for each in (rtol, 1e-12))
        for which in ("contact_fraction", "adhesion_fraction"):
            at, value = QUANTITIES.index(which), getattr(finer, which)
            error = abs(getattr(found, which) - value)
            assert error <= found.error_estimate[at] + finer.error_estimate[at]
            assert error <= rtol * (value + 1e-3)
