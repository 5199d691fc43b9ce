"""Work is bounded: a point meets its tolerance, or comes back with an honest estimate, not ``converged``, and a warning."""

import warnings
from functools import cache

import numpy as np
import pytest

import hystrip
from hystrip import multilevel
from hystrip.level import averages, curve, interpolation, inverse, lower_levels

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
ADHESION = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
LEVELS = [hystrip.Level(10e-6, 1e-6), hystrip.Level(500e-9, 100e-9)]


def _solve(pressure=100.0, rtol=1e-4):
    return hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=pressure, velocity=1e-3, rtol=rtol)


_exact = cache(_solve)


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
    [(interpolation, "CURVE_LIMIT", 200, "curve"), (averages, "AVERAGE_LIMIT", 30, "average")],
    ids=["curve", "average"],
)
def test_a_point_that_runs_into_a_limit_is_said_to_have_and_bounds_its_error(monkeypatch, module, limit, value, words):
    exact = _exact()
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
    # as friction_law has it at rtol 1e-6
    pull_off = -650.24987102
    at = {"pressure": pull_off * (1 - 1e-4), "V": 1e-3, "rtol": 1e-6}
    assert hystrip.solve_level(MATERIAL, ADHESION, LEVELS[0], **at | {"pressure": pull_off * (1 + 1e-4)}).pulled_off
    assert hystrip.solve_level(MATERIAL, ADHESION, LEVELS[0], **at).converged
    for module in (interpolation, inverse):
        monkeypatch.setattr(module, "CURVE_LIMIT", 0)
    with pytest.warns(hystrip.ConvergenceWarning, match="curve"):
        level = hystrip.solve_level(MATERIAL, ADHESION, LEVELS[0], **at)
    assert not level.converged and level.error_estimate[1] >= abs(level.tau_mean)


def test_equal_strips_say_what_they_are_without_a_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        r = hystrip.solve(MATERIAL, ADHESION, LEVELS, pressure=100.0, velocity=1e-3, rtol=1e-4, strips=5)
    assert not r.converged and r.converged.shape == ()


@pytest.mark.parametrize("strips", [1, 2, 3, 5, 8, 30])
def test_equal_strips_however_few_say_what_they_miss(strips):
    """Also where none of them touches, or one stands for all: the crest and the valley are looked at."""
    bare, level = hystrip.Dugdale(gamma=0), LEVELS[0]
    for adhesion, given in ((bare, {"V": 1e-5, "D": 5e-8}), (bare, {"V": 1e-3, "D": 8e-7}), (ADHESION, {"V": 5e-3, "D": 6e-7})):
        few = hystrip.solve_level(MATERIAL, adhesion, level, **given, strips=strips, rtol=1e-3)
        many = hystrip.solve_level(MATERIAL, adhesion, level, **given, rtol=1e-8)
        means = [np.array([s.p_mean, s.tau_mean, s.contact_fraction, s.adhesion_fraction]) for s in (few, many)]
        assert (np.abs(np.subtract(*means)) <= few.error_estimate + many.error_estimate).all() and not few.converged


def test_tiny_trailing_levels_are_not_solved_and_change_nothing_that_counts():
    """Without adhesion: saturated under next to all pressure, and rubbing next to nothing, they follow in closed form."""
    bare, levels = hystrip.Dugdale(gamma=0), [hystrip.Level(1e-2, 1e-3), hystrip.Level(5e-3, 4e-4), hystrip.Level(1e-8, 1e-10)]
    given = {"pressure": [1e5, 1e9], "velocity": 1e-2, "rtol": 1e-2}
    seen = []
    short = hystrip.solve(MATERIAL, bare, levels, **given, progress=lambda *done: seen.append(done))
    whole = hystrip.solve(MATERIAL, bare, levels, **given, skip=False)
    alone = hystrip.solve(MATERIAL, bare, levels, **(given | {"pressure": 1e5}))
    assert short.counts["strips_solved"] < 0.9 * whole.counts["strips_solved"] and seen[-1] == (2, 2)
    assert (np.abs(short.tau - whole.tau) <= short.tau_error + whole.tau_error).all() and short.converged.all()
    assert short.closed_form.tolist() == [False, True] and short.tau[0] == alone.tau
    assert np.allclose(short.tau_by_level[2], whole.tau_by_level[2], rtol=given["rtol"], atol=0)
    assert np.allclose(short.contact_by_level, whole.contact_by_level, rtol=given["rtol"], atol=0)


def test_fifty_levels_of_a_rough_surface():
    """It once took minutes and gigabytes: the smallest are smaller than atoms."""
    levels = [hystrip.Level(1e-2 * 0.6**i, 1e-3 * 0.55**i) for i in range(50)]
    given = {"pressure": 1e5, "velocity": 1e-2, "rtol": 1e-1}
    fifty, forty = (hystrip.solve(MATERIAL, hystrip.Dugdale(gamma=0), levels[:n], **given) for n in (50, 40))
    assert fifty.converged and fifty.tau_by_level.shape == (50,)
    assert fifty.tau == pytest.approx(float(forty.tau), rel=1e-6)


def test_a_friction_law_says_whether_it_converged(monkeypatch):
    at = {"V": 1e-3, "rtol": 1e-4, "edge": "constitutive"}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        exact = hystrip.friction_law(MATERIAL, ADHESION, LEVELS[1], **at)
    assert exact.converged is True
    monkeypatch.setattr(interpolation, "CURVE_LIMIT", 200)
    with pytest.warns(
        hystrip.ConvergenceWarning, match=r"friction law .* rtol = 0\.0001; V 0\.001: the curve .*l = 5e-07"
    ) as said:
        law = hystrip.friction_law(MATERIAL, ADHESION, LEVELS[1], **at)
    assert law.converged is False and len(said) == 1 and said[0].filename == __file__
    p = np.linspace(law.pull_off + 1, exact.p_sat, 50)
    p = p[np.abs(p[:, None] - np.concatenate((law.breaks, exact.breaks))).min(axis=1) > 1]
    assert np.abs(law(p) - exact(p)).max() <= law.error_estimate + exact.error_estimate


@pytest.mark.parametrize("branch", ["unloading", "loading"])
@pytest.mark.parametrize("p_0", [0.0, 100.0])
@pytest.mark.parametrize("V", [0.0, 1.0])
@pytest.mark.filterwarnings("error")
def test_a_level_whose_valley_is_just_released_is_like_one_next_to_it(V, p_0, branch):
    """At ``D = h - p_0/K - delta_0`` strips as flat as the rounding of D may be free or not; next to it all adhere."""
    adhesion, level = hystrip.Dugdale(p_0=p_0, delta_0=1e-8 * (p_0 > 0)), LEVELS[0]
    D = level.h - p_0 / MATERIAL.K - adhesion.delta_0
    at, beside = (
        hystrip.solve_level(MATERIAL, adhesion, level, V=V, D=d, edge="constitutive", branch=branch, rtol=1e-8 if p_0 else 1e-10)
        for d in (D, D * (1 + 1e-12))
    )
    assert at.strips <= 3 * beside.strips
    assert abs(at.tau_mean - beside.tau_mean) <= at.error_estimate[1] + beside.error_estimate[1] + 1e-9 * abs(beside.tau_mean)
    assert V > 0 or abs(at.tau_mean) <= at.error_estimate[1]


@pytest.mark.parametrize("T_eps", [1e-8, 1e-4, 1e-2])
@pytest.mark.parametrize("branch", ["unloading", "loading"])
@pytest.mark.filterwarnings("error")
def test_without_adhesion_all_strips_are_alike_where_the_valley_is_just_released(T_eps, branch):
    """At ``D = h`` every strip has ``D_j = 2 A``: the level is in contact as far as its middle strip is."""
    material, adhesion, level = hystrip.KelvinVoigt(K=1e9, T_eps=T_eps), hystrip.Dugdale(gamma=0), LEVELS[0]
    strip = hystrip.solve_strip(material, adhesion, l=level.l, A=level.h / 2, D=level.h, V=1e-3, branch=branch)
    found = hystrip.solve_level(material, adhesion, level, V=1e-3, D=level.h, branch=branch, rtol=1e-9)
    assert abs(found.contact_fraction - strip.contact_fraction) <= found.error_estimate[2] + 1e-15
    assert found.strips < 100


def test_without_adhesion_a_small_penetration_keeps_its_digits():
    """So little of a crest touches that it is a paraboloid on a glassy foundation: ``K_g D^2/(2 pi h)``."""
    level, D = hystrip.Level(1e-5, 1e-6), 1e-20
    found = hystrip.solve_level(
        hystrip.StandardLinearSolid(1e9, 1e-2, 1e-4), hystrip.Dugdale(gamma=0), level, V=2e-3, D=D, edge="constitutive", rtol=1e-9
    )
    assert found.p_mean == pytest.approx(1e11 * D**2 / (2 * np.pi * level.h), rel=1e-5)


@pytest.mark.parametrize("branch", ["unloading", "loading"])
@pytest.mark.parametrize("T_sigma", [1e-2, 1e-3])
@pytest.mark.filterwarnings("error")
def test_a_surface_whose_valleys_are_just_released_is_like_one_next_to_it(T_sigma, branch):
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, T_sigma), hystrip.Dugdale(p_0=50.0, delta_0=5e-8)
    given = {"velocity": 1e-3, "edge": "constitutive", "branch": branch}
    for levels in ([hystrip.Level(1e-5, 5e-7)], [hystrip.Level(1e-5, 5e-7), hystrip.Level(1e-6, 5e-9)]):
        at, beside = (hystrip.solve(material, adhesion, levels, penetration=D, **given) for D in (4e-7, 4e-7 * (1 + 1e-12)))
        assert at.counts["strips_solved"] <= 2 * beside.counts["strips_solved"] + 10
        assert abs(at.tau - beside.tau) <= at.tau_error + beside.tau_error + 1e-9 * abs(beside.tau)


@pytest.mark.filterwarnings("error")
def test_a_pressure_is_known_as_well_as_fractions_that_are_steep_over_it_ask_for():
    """Just below where gaps stop to open strips that adhere change over within 1e-4 of the pressure."""
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=4.3834e-7)
    adhesion, level = hystrip.Dugdale(gamma=5.62994e-11, delta_0=1.96736e-9), hystrip.Level(7.70007e-6, 8.37315e-8)
    at = {"V": 7.75746e-7, "D": (level.h - adhesion.delta_0 - adhesion.p_0 / material.K) * (1 - 1e-6), "branch": "loading"}
    exact = hystrip.solve_level(material, adhesion, level, **at)
    found = hystrip.solve_level(material, adhesion, level, **at | {"D": None, "pressure": exact.p_mean}, rtol=1e-6)
    assert found.converged and abs(found.adhesion_fraction - exact.adhesion_fraction) <= 1e-6 * (exact.adhesion_fraction + 1e-3)


@pytest.mark.filterwarnings("error")
def test_friction_that_is_steep_next_to_pull_off_is_as_accurate_as_asked_for():
    """Loading: next to the least pressure that is carried friction changes like the root of the distance from there."""
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1.2425e-3)
    adhesion, level = hystrip.Dugdale(gamma=2.14285e-7, delta_0=1.361e-9), hystrip.Level(8.09344e-7, 8.75034e-8)
    how = {"edge": "constitutive", "branch": "loading"}
    # the pull-off of its law at 1e-11
    how |= {"pressure": -0.58114509510027 * (1 - np.array([1e-7, 4e-7])), "velocity": 2.94e-3}
    coarse, fine = (hystrip.solve(material, adhesion, level, rtol=rtol, **how) for rtol in (5e-3, 1e-6))
    assert coarse.converged.all() and fine.converged.all() and coarse.counts["strips_solved"] < 4_200
    assert (abs(coarse.tau - fine.tau) <= coarse.tau_error).all()


@pytest.mark.filterwarnings("error")
def test_a_level_whose_strips_let_go_all_but_at_once_has_no_piece_between():
    """With a short memory all strips of the smallest level let go at one height of the valley, within 3e-16 m of D."""
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=0.00205486)
    adhesion = hystrip.Dugdale(gamma=1.06382e-05, delta_0=4.67547e-08)
    levels = [hystrip.Level(1e-5, 1.64511e-6), hystrip.Level(5.58329e-6, 1.65357e-6), hystrip.Level(2.84179e-6, 4.559e-7)]
    at = {"pressure": 2.64272, "velocity": 1.87017e-6}
    coarse, fine = (hystrip.solve(material, adhesion, levels, **at, rtol=rtol) for rtol in (1e-3, 1e-5))
    assert coarse.converged.all() and fine.converged.all() and fine.counts["strips_solved"] < 20_000
    assert abs(coarse.tau - fine.tau) <= coarse.tau_error


@pytest.mark.filterwarnings("error")
def test_what_loading_has_passed_by_where_all_strips_let_go_is_left_out():
    """Within 1e-5 of ``h`` all gaps stop to open and pressure falls; nearer rounding decides it strip by strip. The law, built at
    once, is that of single pressures, searched for one by one, on both sides of what is jumped over."""
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1.2743545e-5)
    adhesion = hystrip.Dugdale(gamma=2.95002e-8, delta_0=9.50719e-9)
    levels, how = (
        [hystrip.Level(1e-5, 7.90435e-7), hystrip.Level(1.67879e-6, 1.4224e-7)],
        {"edge": "constitutive", "branch": "loading"},
    )
    V = np.array([2.09173e-6, 4e-6])
    coarse, fine = (hystrip.solve(material, adhesion, levels, pressure=0.425761, velocity=V, rtol=r, **how) for r in (1e-3, 1e-6))
    assert coarse.converged.all() and fine.converged.all() and fine.counts["strips_solved"] < 9_500
    assert (abs(coarse.tau - fine.tau) <= coarse.tau_error).all()
    laws = [hystrip.friction_law(material, adhesion, levels[1], V=v, rtol=1e-5, **how) for v in V]
    p = np.multiply.outer(np.geomspace(0.3, 0.9, 7), [law.p_sat for law in laws])
    each = hystrip.solve_level(material, adhesion, levels[1], V=V, pressure=p, rtol=1e-6, **how)
    for i, law in enumerate(laws):
        known = law.error_estimate + each.error_estimate[1, :, i] + 1e-6 * law.tau_sat
        assert (np.abs(law(p[:, i]) - each.tau_mean[:, i]) <= known).all()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("T_sigma", "gamma", "delta_0", "l", "h", "V", "edge", "most", "p", "tau"),
    [
        # over a millionth of its height all strips let go, and the pressure rises; there are 14,500 strips in all
        (4.11416e-6, 3.64056e-10, 7.53331e-10, 4.346e-7, 7.52729e-8, 1.42871e-7, "constitutive", 30_000,
         [0.0169473, 5.50192], [3.2879153229e-4, 0.04169054205882]),
        # the curve turns next to a break: 22,600
        (8.90379e-4, 4.909323e-5, 7.78257e-8, 1.09356e-5, 9.95524e-7, 6.88221e-3, "constitutive", 45_000,
         [-85.9157, 1286.58], [2.78736867896, 29.78651205717]),
        # below its crest's release a tenth of the curve is part of the law: 4,700, and 10,200 with all of it
        (1e-4, 2.5e-5, 1e-8, 5e-7, 1e-7, 1e-3, "continuous", 8_000, [-705.199, -78.85], [5.95425797203, 134.43083552622]),
    ],
)  # fmt: skip
def test_of_a_curve_above_the_least_pressure_before_nothing_is_interpolated(
    T_sigma, gamma, delta_0, l, h, V, edge, most, p, tau  # noqa: E741
):  # fmt: skip
    """Its law at pressures 0.1 and 30 % of the way from pull-off to saturation, where friction is known at 1e-10."""
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, T_sigma), hystrip.Dugdale(gamma=gamma, delta_0=delta_0)
    law = hystrip.friction_law(material, adhesion, hystrip.Level(l, h), rtol=1e-5, V=V, edge=edge)
    assert law.converged and law.strips < most
    assert (np.abs(law(p) - tau) <= law.error_estimate).all()


def test_loading_has_no_rough_parts(monkeypatch):
    """Nor where the crest changes nowhere: of them only what unloading comes to is interpolated."""
    given = hystrip.StandardLinearSolid(1e9, 1e-2, 1e-4), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8), hystrip.Level(5e-7, 1e-7)
    how = {"V": 1e-3, "branch": "loading", "rtol": 1e-2}
    law, whole = hystrip.friction_law(*given, **how), curve.smooth_intervals
    monkeypatch.setattr(curve, "smooth_intervals", lambda *of: (whole(*of)[0], np.full(1, np.inf)))
    p = np.linspace(law.pull_off, law.p_sat, 50)
    assert (hystrip.friction_law(*given, **how)(p) == law(p)).all()


#: levels with a short memory: T_sigma, gamma, delta_0, l, h, V, edge
SHORT_MEMORY = [
    (1.1991e-7, 1.74732e-9, 2.40596e-9, 2.03999e-6, 8.10676e-8, 4.05772e-6, "continuous"),
    (1.01e-7, 1.036e-9, 1.833e-9, 8.036e-6, 9.099e-8, 1.437e-5, "continuous"),
    (5.265e-6, 1.047e-9, 9.526e-9, 9.745e-7, 3.381e-8, 4.152e-6, "constitutive"),
    (1.312e-3, 1.918e-8, 3.583e-9, 1.572e-5, 6.393e-7, 1.118e-5, "constitutive"),
    (4.149e-3, 7.623e-9, 9.541e-9, 4.756e-7, 9.351e-8, 2.15e-6, "continuous"),
]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("of", "p", "tau"), [
    # pressures 2 % below that where gaps stop to open, 1 % above it, and 5 % below saturation, with their friction, at 1e-9
    (SHORT_MEMORY[0], [17.3833, 17.9155, 19.2536], [0.11579581525489, 0.11679401739103, 0.11836913557731]),
    (SHORT_MEMORY[1], [20.3322, 20.9546, 21.6101], [0.03356713042457, 0.03381205836766, 0.03399058199083]),
    (SHORT_MEMORY[2], [3.41036, 3.51476, 8.49097], [0.057348306322, 0.058818392859, 0.092225964023]),
])  # fmt: skip
def test_what_loading_has_met_before_is_no_part_of_its_law(of, p, tau):
    """Where gaps stop to open the pressure falls like the logarithm of the distance, then rises to what it was and beyond: of all
    between, down to 1e-15 of ``h``, nothing is looked at closely. The law is that of single pressures on both sides of it."""
    T_sigma, gamma, delta_0, l, h, V, edge = of  # noqa: E741
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, T_sigma), hystrip.Dugdale(gamma=gamma, delta_0=delta_0)
    law = hystrip.friction_law(material, adhesion, hystrip.Level(l, h), V=V, edge=edge, branch="loading", rtol=1e-5)
    assert law.converged and law.strips < 15_000
    assert (np.abs(law(p) - tau) <= law.error_estimate + 1e-6 * law.tau_sat).all()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("T_sigma", "gamma", "delta_0", "l", "h", "V", "edge"), SHORT_MEMORY)
def test_a_pressure_is_not_looked_for_in_what_loading_has_met_before(T_sigma, gamma, delta_0, l, h, V, edge):  # noqa: E741
    """Next to the pressure at which gaps stop to open: the curve just above that is not looked at closely, and a crossing
    just below it is not passed by."""
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, T_sigma), hystrip.Dugdale(gamma=gamma, delta_0=delta_0)
    level, how = hystrip.Level(l, h), {"V": V, "edge": edge, "branch": "loading", "rtol": 1e-6}
    opens = h - delta_0 - adhesion.p_0 / material.K
    met = hystrip.solve_level(material, adhesion, level, D=opens * (1 - 1e-9), **how).p_mean
    found = hystrip.solve_level(material, adhesion, level, pressure=met * np.array([1 - 1e-6, 1 + 1e-6]), **how)
    # each by itself takes half of them
    assert found.converged.all() and found.strips < 12_000
    before = np.multiply.outer(1 - np.append(0.0, np.geomspace(1e-8, 0.1, 20)), np.minimum(found.D, opens))
    there = hystrip.solve_level(material, adhesion, level, D=np.vstack((found.D, before)), **how)
    assert (abs(there.p_mean[0] - found.p_mean) <= there.error_estimate[0, 0] + found.error_estimate[0]).all()
    assert (there.p_mean[1:] <= found.p_mean + there.error_estimate[0, 1:] + found.error_estimate[0]).all()


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("T_sigma", "p_0", "delta_0", "l", "h", "V", "above"),
    [(7.2e-7, 0.3127, 2.79e-10, 2.235e-6, 1.208e-8, 2.08e-6, 2e-4), (9e-7, 0.266, 7.27e-11, 1.83e-6, 6.66e-8, 9.1e-7, 7e-5)],
)
def test_what_lies_behind_where_unloading_meets_a_pressure_is_not_looked_at_closely(T_sigma, p_0, delta_0, l, h, V, above):  # noqa: E741
    """Just above where gaps stop to open: below, where it falls like a logarithm, the curve comes near the pressure, too."""
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, T_sigma), hystrip.Dugdale(p_0=p_0, delta_0=delta_0)
    at = {"V": V, "D": (h - delta_0 - p_0 / material.K) * (1 + above), "edge": "constitutive", "rtol": 1e-6}
    known = hystrip.solve_level(material, adhesion, hystrip.Level(l, h), **at)
    found = hystrip.solve_level(material, adhesion, hystrip.Level(l, h), **at | {"D": None, "pressure": known.p_mean})
    assert found.converged and found.strips < 3_000 and found.D == pytest.approx(at["D"], rel=1e-9)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("T_sigma", "gamma", "delta_0", "levels", "pressure", "V"),
    [
        (2.6357e-9, 1.532e-9, 1.15831e-8, [(1e-5, 3.19361e-6), (1.05554e-6, 9.94736e-10)], 7.58029, 3.294e-7),
        (4.7046e-4, 1.3e-11, 2.07728e-8, [(1e-5, 3.781e-8), (3.847e-6, 2.299e-8), (2.193e-7, 6.236e-10)], 1.092, 6.54e-7),
        (1.7525e-9, 1.6e-13, 4.60564e-13, [(5.7205e-6, 4.01448e-8), (1.97052e-7, 1.30912e-8)], 1.7e-3, 1.00118e-9),
        (1.8261e-3, 7.7815e-8, 8.20778e-8, [(1e-5, 5.20653e-8), (5.42988e-7, 1.04119e-7)], 0.1, 1.52853e-6),
    ],
)
def test_what_rounding_decides_is_not_looked_at(T_sigma, gamma, delta_0, levels, pressure, V):
    """All strips let go within less than there is between two numbers, and nearer than that rounding decides each by itself."""
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, T_sigma), hystrip.Dugdale(gamma=gamma, delta_0=delta_0)
    levels, how = [hystrip.Level(*each) for each in levels], {"branch": "loading", "edge": "continuous"}
    coarse, fine = (hystrip.solve(material, adhesion, levels, pressure=pressure, velocity=V, rtol=r, **how) for r in (1e-2, 1e-4))
    assert coarse.converged.all() and fine.converged.all() and fine.counts["strips_solved"] < 8_000
    assert abs(coarse.tau - fine.tau) <= coarse.tau_error


@pytest.mark.filterwarnings("error")
def test_a_pressure_is_not_looked_for_where_the_curve_can_only_fall():
    """On the way to it all strips of a foundation with two times let go within 4e-6 of ``h``, where rounding decides the regimes:
    over what is narrow pressure rises by less than it may err."""
    material = hystrip.Prony(1e9, [3.3393926e9, 1.1034303e8], [2.1465324e-5, 6.9118596e-4])
    adhesion, level = hystrip.Dugdale(gamma=1.2428381e-7, delta_0=8.3911943e-9), hystrip.Level(1e-5, 4.0924018e-7)
    how = {"pressure": 287.81111, "velocity": [1.1071410e-4], "edge": "constitutive", "branch": "loading"}
    coarse, fine = (hystrip.solve(material, adhesion, [level], rtol=rtol, **how) for rtol in (1e-3, 1e-5))
    assert coarse.converged.all() and fine.converged.all() and fine.counts["strips_solved"] < 12_000
    assert abs(coarse.tau - fine.tau) <= coarse.tau_error + fine.tau_error


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("T_sigma", "p_0", "delta_0", "l", "h", "V"),
    [
        (4.2848e-3, 67.1313, 1.18347e-9, 7.35004e-7, 7.55362e-8, 1.8932e-7),
        (2.60939e-3, 111.599, 3.5857e-8, 5.51361e-6, 2.99319e-7, 2.8978e-6),
        # this one carries the pressure below, too
        (1.49398e-5, 34.5153, 1.52995e-8, 1.38769e-5, 3.5311e-7, 5.09525e-6),
    ],
)
def test_unloading_does_not_look_into_what_is_narrower_than_a_pressure_is_known(T_sigma, p_0, delta_0, l, h, V):  # noqa: E741
    """As gaps open that adhere throughout, all strips let go within 1e-10 of ``h``: the curve is least above, and jumps."""
    material, adhesion = hystrip.StandardLinearSolid(1e9, 1e-2, T_sigma), hystrip.Dugdale(p_0=p_0, delta_0=delta_0)
    level, how, opens = hystrip.Level(l, h), {"V": V, "edge": "constitutive", "rtol": 1e-6}, h - delta_0 - p_0 / material.K
    least = hystrip.solve_level(material, adhesion, level, D=opens + 1e-8 * h, **how).p_mean
    found = hystrip.solve_level(material, adhesion, level, pressure=least + np.array([1e-5, -1e-5]) * abs(least), **how)
    assert found.converged.all() and found.strips < 6_000
    assert found.D[0] > opens and not found.D[1] > opens


def test_what_unloading_jumps_over_is_only_looked_at():
    """The same with ever longer memory: strips let go within 1e-9 to 1e-2 of ``h``, while the pressure rises."""
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=0.00205486)
    adhesion = hystrip.Dugdale(gamma=1.06382e-05, delta_0=4.67547e-08)
    levels = [hystrip.Level(1e-5, 1.64511e-6), hystrip.Level(2.84179e-6, 4.559e-7)]
    at = {"pressure": 2.64, "velocity": [2e-6, 5e-6, 2e-5]}
    coarse, fine = (hystrip.solve(material, adhesion, levels, **at, rtol=rtol) for rtol in (1e-3, 1e-6))
    assert coarse.converged.all() and fine.converged.all() and fine.counts["strips_solved"] < 7_000
    assert (abs(coarse.tau - fine.tau) <= coarse.tau_error).all()


def test_a_point_that_errs_by_more_than_is_allowed_is_solved_once_more(monkeypatch):
    """As it is where errors of a law count for more than was foreseen: here as if none of them cancelled, and of laws that at
    first are far too coarse."""
    monkeypatch.setattr(lower_levels, "_CANCELLED", 1.0)
    monkeypatch.setattr(multilevel, "_ATTEMPTS", ((1.0, 1000.0), *multilevel._ATTEMPTS[1:]))
    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=5.225834435113426e-07)
    adhesion = hystrip.Dugdale(gamma=4.5298325052e-06, delta_0=1.46134e-08)
    levels = [hystrip.Level(1e-5, 1.9698e-6), hystrip.Level(1.85077e-6, 3.05468e-7)]
    point = {"pressure": 181.046, "velocity": 0.25602, "branch": "loading", "rtol": 1e-6}
    asked = _count_inversions(monkeypatch)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = hystrip.solve(material, adhesion, levels, **point)
    # penetrations don't rest on laws
    assert len(asked) == 1
    monkeypatch.setattr(multilevel, "_ATTEMPTS", multilevel._ATTEMPTS[:1])
    with pytest.warns(hystrip.ConvergenceWarning):
        once = hystrip.solve(material, adhesion, levels, **point)
    assert found.converged.all() and found.tau_error < once.tau_error
    assert abs(found.tau - once.tau) <= found.tau_error + once.tau_error


def _count_inversions(monkeypatch):
    asked, invert = [], multilevel.invert
    monkeypatch.setattr(multilevel, "invert", lambda *args: asked.append(args) or invert(*args))
    return asked


def test_a_level_alone_is_not_solved_twice_in_the_same_way(monkeypatch):
    monkeypatch.setattr(multilevel.Surface, "converged", lambda self, points: np.zeros(points.error.shape, bool))
    asked = _count_inversions(monkeypatch)
    with pytest.warns(hystrip.ConvergenceWarning):
        hystrip.solve(MATERIAL, ADHESION, LEVELS[:1], pressure=100.0, velocity=1e-3, rtol=1e-4)
    assert [rtol for *_, rtol in asked] == [0.5e-4, 0.15e-4]


@pytest.mark.filterwarnings("ignore::hystrip.ConvergenceWarning")
def test_at_a_jump_itself_only_what_comes_to_the_pressure_is_refined():
    """Either side may be meant, known to 1e-8 of the pressure; refining all of the curve took 126,000 strips."""
    solid, adhesion = hystrip.KelvinVoigt(1e9, 1e-2), hystrip.Dugdale(p_0=3479.2355183194686, delta_0=3.195645856499825e-09)
    at = {"velocity": 4.971320326112065e-06, "edge": "constitutive", "rtol": 1e-3}
    jump = -3232.1369433870477
    here = hystrip.solve(solid, adhesion, LEVELS[0], pressure=jump, **at)
    assert here.counts["strips_solved"] < 5000 and not here.converged
    # 1e-3 Pa below, where it is pulled off, and above, at 1e-8
    assert min(abs(here.tau - [0.0, 0.919398098])) < 1e-4 * here.tau


def test_panels_end_where_pressure_right_after_entry_passes_a_jump():
    """With short memory what strips carry has all but a kink there, which halves approach slowly: 26,400 strips were solved."""
    material = hystrip.StandardLinearSolid(1e9, 1e-2, 7.280510800637773e-07)
    adhesion = hystrip.Dugdale(gamma=9.6766821564e-08, delta_0=2.48052e-09)
    levels = [hystrip.Level(*of) for of in ((1.17599e-06, 4.48768e-08), (4.7621e-07, 6.7058e-09), (2.64429e-07, 4.15812e-09))]
    point = {"pressure": 100.0, "velocity": 1.69144e-4}
    found = hystrip.solve(material, adhesion, levels, rtol=1e-7, **point)
    assert found.converged and found.counts["strips_solved"] < 18_000
    # at 1e-9
    assert abs(found.tau - 5.412130405) <= found.tau_error
