"""What a result can do: a labelled dataset, a summary, a picture."""

import dataclasses
import json
import warnings
from functools import cache

import numpy as np
import pytest

import hystrip
from hystrip import regimes_by_level as look
from hystrip.display import percent
from hystrip.plots import save
from hystrip.regimes_by_level import PULLED_OFF, regimes_by_level
from hystrip.scene import load_scene
from hystrip.summary import deborah, peak_velocities
from hystrip.tables import friction_rows

xarray = pytest.importorskip("xarray")

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
ADHESION = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
LEVELS = [hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9), hystrip.Level(l=5e-9, h=5e-9)]


def solved(pressure, velocity, levels=LEVELS):
    return hystrip.solve(MATERIAL, ADHESION, levels, pressure=pressure, velocity=velocity, rtol=1e-2)


@pytest.fixture(scope="module")
def grid():
    return solved(np.array([[5e6], [1e7]]), [1e-4, 1e-3, 1e-2])


def test_dataset_is_labelled(grid):
    data = grid.to_dataset()
    assert data.mu.dims == ("pressure", "velocity") and data.tau_by_level.dims == ("level", "pressure", "velocity")
    assert data.pressure.values.tolist() == [5e6, 1e7] and data.velocity.values.tolist() == [1e-4, 1e-3, 1e-2]
    assert data.mu.sel(pressure=1e7, velocity=1e-3).item() == grid.mu[1, 1]
    assert data.wavelength.values.tolist() == [level.l for level in LEVELS]
    for name in [*data.variables]:
        assert data[name].attrs["units"] and data[name].attrs["long_name"], name
    assert np.allclose(data.mu_by_level.sum("level"), data.mu, rtol=1e-14)
    assert data.attrs["hystrip_version"] == hystrip.__version__
    assert json.loads(data.attrs["material"])["T_sigma"] == 1e-4


@pytest.mark.parametrize(
    ("pressure", "velocity", "dims"),
    [(5e6, 1e-3, ()), (5e6, [1e-3], ("velocity",)), (5e6, [1e-3, 2e-3], ("velocity",)), ([5e6, 6e6], 1e-3, ("pressure",)),
     ([5e6, 6e6], [1e-3, 2e-3], ("point",)), ([[5e6], [6e6]], 1e-3, ("pressure", "point"))],
)  # fmt: skip
def test_dimensions_follow_what_changes(pressure, velocity, dims):
    assert solved(pressure, velocity).to_dataset().mu.dims == dims


def test_netcdf_round_trip(grid, tmp_path):
    data = grid.to_dataset()
    data.to_netcdf(tmp_path / "r.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "r.nc", engine="h5netcdf") as again:
        assert again.load().identical(data)


def test_scene_text_goes_along():
    scene = load_scene("paper_fig7")
    assert scene.solve().to_dataset().attrs["scene"] == scene.text


def test_summary_says_it_all(grid):
    text = grid.summary()
    for part in (
        "share of mu",
        "pull-off",
        "level 1 (all the area):\n              100 %  saturated contact",
        "level 3 (the contact of level 2, 100 % of the area):\n              100 %  saturated contact",
        "saturated from",
        "real contact",
        "closed form",
        "error",
        "De = k V T_eps",
        "p_sat alone",
    ):
        assert part in text
    assert deborah(grid)[1, 0, 2] == pytest.approx(2 * np.pi / 5e-7 * 1e-2 * 1e-2)
    assert peak_velocities(grid) == pytest.approx([1e-5 / (2e-4 * np.pi), 5e-7 / (2e-4 * np.pi), 5e-9 / (2e-4 * np.pi)])


def test_a_penetration_that_was_given_is_told_and_a_bound_on_saturation_as_such():
    one = hystrip.solve(MATERIAL, ADHESION, LEVELS[:1], penetration=4e-6, velocity=5e-3, branch="loading", rtol=1e-2)
    assert "penetration   4e-06 m" in repr(one) and "penetration 4e-06 m, pressure" in one.summary()
    text, least = one.summary(), f"{one.p_sat:.4g}"
    assert (
        f"level 1 is saturated from {least} Pa at the latest" in text and f" {least} " in text.split("saturated [m/s]")[1][:200]
    )


@cache
def two_levels(branch):
    """In partial contact, and the regimes of their strips."""
    result = hystrip.solve(MATERIAL, ADHESION, LEVELS[:2], pressure=100, velocity=5e-3, branch=branch, rtol=1e-2)
    return result, regimes_by_level(result, 0)


@pytest.mark.xdist_group("two levels")  # which are solved once
@pytest.mark.parametrize("branch", ["unloading", "loading"])
def test_regimes_of_every_level_agree_with_the_result(branch):
    """Two levels in partial contact: the strips looked at have the contact that the averages have."""
    result, (first, second) = two_levels(branch)
    assert first.area == 1 and second.area == result.contact_by_level[0]
    for i, each in enumerate((first, second)):
        assert each.contact == pytest.approx(result.contact_by_level[i], rel=0.02)
        assert sum(each.shares.values()) == pytest.approx(1, abs=1e-12)
    # adhesion lets level 1 pull: where its local pressure is below pull-off of level 2 there is no contact
    assert 0.2 < second.shares[PULLED_OFF] < 0.3
    # one text tells one contact of level 1, and no more digits of shares than are known
    text = result.summary()
    assert f"(the contact of level 1, {percent(result.contact_by_level[0])} of the area)" in text
    assert f"{100 * second.shares[PULLED_OFF]:6.0f} %  {PULLED_OFF}" in text


@pytest.mark.xdist_group("two levels")
@pytest.mark.parametrize("branch", ["unloading", "loading"])
def test_shares_of_regimes_are_known_as_well_as_is_said(branch, monkeypatch):
    result, rough = two_levels(branch)
    monkeypatch.setattr(look, "_STRIPS", 600)
    monkeypatch.setattr(look, "_DEPTHS", (120, 60, 36))
    monkeypatch.setattr(look, "_FEWER", 120)
    for one, other in zip(rough, regimes_by_level(result, 0), strict=True):
        names = one.shares.keys() | other.shares
        assert max(abs(one.shares.get(name, 0) - other.shares.get(name, 0)) for name in names) < 0.01


@pytest.mark.parametrize("p_0", [90.0, 1e5])
def test_regimes_of_a_lower_level_that_is_loaded_while_it_is_pulled(p_0):
    """It holds on to a pull as its law does: less than the most that its first strips, clinging, pull."""
    adhesion, levels = hystrip.Dugdale(p_0=p_0, delta_0=1.3e-7), [LEVELS[0], hystrip.Level(l=5.5e-7, h=4.3e-8)]
    how = {"penetration": 2.5e-7, "velocity": 7e-6, "edge": "constitutive", "branch": "loading", "rtol": 1e-2}
    result = hystrip.solve(MATERIAL, adhesion, levels, **how)
    _, second = regimes_by_level(result, 0)
    assert second.contact == pytest.approx(result.contact_by_level[1], rel=0.02)


@pytest.mark.parametrize(("T_sigma", "gamma", "delta_0", "levels", "pressure", "velocity"), [
    # next to all that level 2 carries lies between two penetrations of a first look
    (5.928e-7, 3.605e-8, 6.261e-9, [(1e-5, 4.895e-7), (8.685e-7, 1.94e-7), (2.036e-7, 6.524e-9)], 80.3, 0.1687),
    # so does where level 3 is pulled off
    (2.543e-4, 5.85e-7, 1.806e-8, [(1e-5, 2.505e-7), (1.115e-6, 8.014e-8), (6.823e-7, 5.978e-8)], 59.6, 8.22e-6),
])  # fmt: skip
def test_regimes_of_levels_that_carry_pressures_unevenly(T_sigma, gamma, delta_0, levels, pressure, velocity):
    of = hystrip.StandardLinearSolid(1e9, 1e-2, T_sigma), hystrip.Dugdale(gamma=gamma, delta_0=delta_0)
    at = {"pressure": pressure, "velocity": velocity, "edge": "constitutive", "rtol": 1e-2}
    result = hystrip.solve(*of, [hystrip.Level(*each) for each in levels], **at)
    for each, contact in zip(regimes_by_level(result, 0), result.contact_by_level, strict=True):
        assert each.contact == pytest.approx(contact, rel=0.02)


def test_regimes_of_no_contact_and_without_the_lower_level():
    assert regimes_by_level(solved(-1e5, 5e-3, LEVELS[:1]), 0) == []
    flat = hystrip.solve(MATERIAL, hystrip.Dugdale(gamma=0), LEVELS[:2], penetration=-1e-6, velocity=1e-3)
    (alone,) = regimes_by_level(flat, 0)
    assert alone.shares == {"no interaction": pytest.approx(1)} and alone.contact == 0


def test_summary_of_zero_pressure_and_of_no_contact():
    level = [hystrip.Level(l=500e-9, h=100e-9)]
    assert "zero pressure" in solved(0.0, 5e-3, level).summary()
    assert "below pull-off" in solved(-1e5, 5e-3, level).summary()


@pytest.mark.parametrize("branch", ["unloading", "loading"])
def test_summary_where_nothing_touches(branch):
    text = hystrip.solve(MATERIAL, hystrip.Dugdale(gamma=0), LEVELS, pressure=-5, velocity=1e-3, branch=branch).summary()
    assert "p = -5 Pa: " in text and "nothing touches\n" in text and "regimes of strips" not in text


@pytest.mark.filterwarnings("error")
def test_summary_says_that_its_pull_off_did_not_converge(monkeypatch):
    """And does not warn of a law that nobody asked for."""
    law = cache(hystrip.level_law.friction_law)

    def unconverged(*of, **how):
        warnings.warn("the friction law did not converge", hystrip.ConvergenceWarning, stacklevel=2)
        return dataclasses.replace(law(*of, **how), converged=False)

    monkeypatch.setattr(hystrip.level_law, "friction_law", law)
    result = solved(-5.0, 5e-3, LEVELS[:1])
    assert " Pa; regimes" in result.summary()
    monkeypatch.setattr(hystrip.level_law, "friction_law", unconverged)
    assert " Pa (not converged); regimes" in result.summary()


def test_no_friction_under_a_pull_is_no_minus_zero():
    for result in (solved(-1e5, 5e-3), solved(-200.0, 0.0)):
        columns = friction_rows(result)
        assert all(columns[name] == 0 and not np.signbit(columns[name]) for name in ("mu", "mu of level 1", "mu of level 2"))


def test_a_result_without_points():
    none = solved([], [[1e-3], [2e-3]])
    assert none.mu.shape == (2, 0) and none.to_dataset().mu.shape == (2, 0)
    assert "points     0" in none.summary() and "no points" in none.summary()


@pytest.mark.parametrize("load", [{"D": []}, {"D": np.zeros((0, 2)), "strips": 5}, {"pressure": []}])
@pytest.mark.parametrize("gamma", [0, 2.5e-5])
def test_a_level_without_points(load, gamma):
    none = hystrip.solve_level(MATERIAL, hystrip.Dugdale(gamma=gamma, delta_0=1e-8), hystrip.Level(1e-5, 1e-6), V=1e-3, **load)
    assert none.p_mean.size == 0 and none.error_estimate.shape == (4, *none.D.shape) and none.strips == 0
    assert "0 points" in repr(none) and none.to_dataset().p_mean.shape == none.D.shape
    with pytest.raises(hystrip.InputError, match="^l: got"):
        hystrip.solve_strip(hystrip.HalfSpace(1e6, 0.5, [1e7], [1e-3]), hystrip.Dugdale(gamma=0), l=[], A=1e-8, D=0, V=0)


def test_pictures(grid, tmp_path):
    save(grid.plot(), tmp_path / "velocity.svg")
    save(solved([5e6, 1e7], 1e-3).plot(), tmp_path / "pressure.png")
    law = hystrip.friction_law(MATERIAL, hystrip.Dugdale(gamma=0), LEVELS[1], V=5e-3, rtol=1e-2)
    save(law.plot(), tmp_path / "law.png")
    strip = hystrip.solve_strip(MATERIAL, ADHESION, l=500e-9, A=5e-8, D=2e-8, V=5e-3)
    save(strip.plot(), tmp_path / "strip.png")
    assert all((tmp_path / name).stat().st_size > 1000 for name in ("velocity.svg", "pressure.png", "law.png", "strip.png"))
    for pressure, points in ((5e6, "1 point"), ([5e6, 5e6], "2 points")):
        with pytest.raises(hystrip.InputError, match=f"got '{points}'; .* one is no curve"):
            solved(pressure, 1e-3).plot()


def test_a_summary_tells_pull_off_where_a_level_is_unloaded_to_it():
    solid, sticky = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
    for branch, told in (("unloading", True), ("loading", False)):
        at = {"pressure": 200.0, "velocity": 2e-3, "rtol": 1e-3, "branch": branch}
        text = hystrip.solve(solid, sticky, hystrip.Level(5e-7, 1e-7), **at).summary()
        assert ("pull-off of level 1 at" in text) == told and "regimes of strips (shares mostly within 1 % of the whole):" in text
