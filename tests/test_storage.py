"""Results are saved and loaded equal to the bit; what is no such file is refused with the reason."""

import errno
import subprocess
import sys
from dataclasses import fields

import numpy as np
import pytest

import hystrip

xarray = pytest.importorskip("xarray")

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
ADHESION = hystrip.Dugdale(gamma=2.6e-5, delta_0=1.3e-8)
LEVELS = [hystrip.Level(l=10e-6, h=1e-6), hystrip.Level(l=500e-9, h=100e-9)]
FITTED = hystrip.HalfSpace(
    2e6, 0.49, [1e6], [1 / 3], shift=hystrip.WLF(8.9, 101.6, 293.15), fit=hystrip.inputs.fitted.FittedBand((1 / 3, 1e3), (0.01,))
)


def bits(values):
    values = np.asarray(values)
    return values.dtype, values.shape, values.tobytes()


def same(one, other):
    """Every field, to the bit."""
    assert type(one) is type(other)
    for each in fields(one):
        mine, its = getattr(one, each.name), getattr(other, each.name)
        if isinstance(mine, np.ndarray):
            assert bits(mine) == bits(its), each.name
        elif each.name == "inputs":
            same(mine, its)
        else:
            assert mine == its, each.name


def solve(material=MATERIAL, adhesion=ADHESION, levels=LEVELS[:1], **options):
    return hystrip.solve(material, adhesion, levels, rtol=1e-2, **options)


CASES = {
    "a point": lambda: solve(pressure=100.0, velocity=5e-3),
    "below pull-off, at zero and above": lambda: solve(pressure=[-1e5, 0.0, -0.0, 100.0], velocity=5e-3),
    "a grid of two levels": lambda: solve(levels=LEVELS, pressure=[[100.0], [1e4]], velocity=[1e-3, 5e-3]),
    "penetration": lambda: solve(penetration=[5e-7, 6e-7], velocity=5e-3),
    "both change together": lambda: solve(pressure=[100.0, 200.0], velocity=[1e-3, 5e-3], branch="loading"),
    "equal strips": lambda: solve(pressure=100.0, velocity=[5e-3], strips=10, edge="constitutive"),
    "choices out of arrays": lambda: solve(
        pressure=100.0, velocity=5e-3, edge=np.str_("constitutive"), branch=np.str_("loading")
    ),
    "no points": lambda: solve(pressure=[], velocity=[[1e-3], [2e-3]]),
    "Kelvin-Voigt": lambda: solve(material=hystrip.KelvinVoigt(1e9, 1e-2), pressure=100.0, velocity=5e-3),
    "two times": lambda: solve(
        material=hystrip.Prony(1e9, [1e10, 3e9], [1e-3, 1 / 3]), pressure=1e6, velocity=5e-3, edge="constitutive"
    ),
    "half-space": lambda: solve(material=hystrip.HalfSpace(2e6, 0.49, [1e6], [1 / 3]), pressure=1e6, velocity=[1e-3, 5e-3]),
    "a shift and a fit": lambda: solve(material=FITTED, pressure=1e6, velocity=[1e-3, 5e-3]),
    "another temperature": lambda: solve(material=FITTED, pressure=1e6, velocity=[1e-3, 5e-3], temperature=300.1),
    "a level": lambda: hystrip.solve_level(MATERIAL, ADHESION, LEVELS[0], V=[[1e-3], [5e-3]], D=[5e-7, 6e-7, -1e-6], rtol=1e-2),
    "a level at pressures": lambda: hystrip.solve_level(MATERIAL, ADHESION, LEVELS[0], V=5e-3, pressure=[100, -1e5], rtol=1e-2),
}


@pytest.mark.parametrize("case", CASES)
def test_equal_to_the_bit(case, tmp_path):
    result = CASES[case]()
    path = result.save(tmp_path / "result.nc")
    assert [each.name for each in tmp_path.iterdir()] == ["result.nc"]
    again = hystrip.load(path, type(result))
    same(result, again)
    assert repr(again) == repr(result)
    if isinstance(result, hystrip.Result):
        assert bits(again.p_sat) == bits(result.p_sat)
        again.save(tmp_path / "again.nc")
        same(result, hystrip.load(tmp_path / "again.nc"))


def test_the_scene_goes_along(tmp_path):
    scene = hystrip.load_scene("paper_fig7")
    assert hystrip.load(scene.solve().save(tmp_path / "r.nc")).scene == scene.text


@pytest.fixture
def saved(tmp_path):
    return solve(pressure=5e6, velocity=[1e-3, 5e-3]).save(tmp_path / "r.nc")


def rewritten(path, change):
    with xarray.open_dataset(path, engine="h5netcdf") as file:
        data = file.load()
    change(data)
    data.to_netcdf(path, engine="h5netcdf")


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda data: data.attrs.pop("hystrip_format"), "solve it again"),
        (lambda data: data.attrs.update(hystrip_format=99), "this is format 99"),
        (lambda data: data.attrs.update(hystrip_format=1), "this is format 1, of hystrip .*: solve it again"),
        (lambda data: data.attrs.pop("hystrip_version"), "netCDF of something else"),
        (lambda data: data.attrs.update(hystrip_kind="dream"), "this holds 'dream'"),
    ],
)
def test_files_of_other_versions_are_refused_with_the_reason(saved, change, says):
    rewritten(saved, change)
    with pytest.raises(hystrip.InputError, match=says):
        hystrip.load(saved)


def test_what_is_no_result_is_refused(saved, tmp_path):
    with pytest.raises(hystrip.InputError, match="path: got 3; allowed: the path of a netCDF file"):
        hystrip.load(3)
    with pytest.raises(hystrip.InputError, match="a file that exists"):
        hystrip.load(tmp_path / "absent.nc")
    (tmp_path / "text.nc").write_text("no netCDF")
    with pytest.raises(hystrip.InputError, match="that save"):
        hystrip.load(tmp_path / "text.nc")
    saved.write_bytes(saved.read_bytes()[:1500])
    with pytest.raises(hystrip.InputError, match="that save"):
        hystrip.load(saved)


def test_another_kind_is_refused(saved):
    with pytest.raises(hystrip.InputError, match="holds a LevelSolution; this holds a Result"):
        hystrip.load(saved, hystrip.LevelSolution)


def test_data_frame_has_the_columns_of_the_csv():
    frame = solve(pressure=5e6, velocity=[1e-3, 5e-3]).to_dataframe()
    assert frame["velocity [m/s]"].tolist() == [1e-3, 5e-3] and "mu of level 1" in frame


def test_reprs_are_short_and_say_what_came_out(tmp_path):
    result = solve(pressure=[100.0, -1e5], velocity=5e-3)
    strips = hystrip.solve_strip(MATERIAL, ADHESION, l=1e-5, A=5e-7, D=[2e-7, 2e-5], V=5e-3)
    level = CASES["a level at pressures"]()
    sweep = hystrip.sweep("paper_fig7", over={"velocity": [1e-3, 2e-3]}, out=tmp_path)
    for each, says in (
        (result, ("2 points, 1 level", "error at most", "-1e+05 .. 100 Pa", "1 below pull-off", "StandardLinearSolid")),
        (strips, ("2 strips", "1 in saturated contact")),
        (level, ("2 points", "l = 1e-05 m", "1 point below pull-off")),
        (sweep, ("2 points, 3 levels", "velocity (2): 0.001 .. 0.002 m/s")),
    ):
        text, page = repr(each), each._repr_html_()
        assert len(text.splitlines()) <= 8 and max(map(len, text.splitlines())) < 200
        assert all(part in text for part in says), text
        assert page.startswith("<div>") and page.endswith("</div>") and page.count("<tr>") == page.count("</tr>") > 3


SWEPT = """
pressure = [-1e5, 100.0]
velocity = [1e-3, 5e-3]
rtol = 1e-2
[material]
K = 1e9
T_eps = 1e-2
T_sigma = 1e-4
[adhesion]
gamma = 2.5e-5
delta_0 = 1e-8
[[levels]]
l = 1e-5
h = 1e-6
"""


@pytest.mark.parametrize("over", [{"levels[0].h": [1e-6, 5e-7]}, {"material.T_sigma": [1e-4, 2e-2], "velocity": 5e-3}])
def test_a_sweep_is_kept_with_the_variables_of_a_result(over, tmp_path):
    (tmp_path / "s.toml").write_text(SWEPT)
    sweep = hystrip.sweep(tmp_path / "s.toml", over=over, out=tmp_path / "out")
    data = sweep.to_dataset()
    one = hystrip.solve(MATERIAL, hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8), LEVELS[:1], pressure=[[-1e5], [100.0]],
                        velocity=[1e-3, 5e-3], rtol=1e-2).to_dataset()  # fmt: skip
    assert set(one.variables) <= set(data.variables)
    for name in one.variables:
        assert data[name].dtype == one[name].dtype and data[name].attrs["units"] == one[name].attrs["units"], name
    # T_sigma above T_eps: those points failed, and say no
    assert sweep.failed.keys() == set() or not data.converged.values[data.failed.values != ""].any()
    again = hystrip.load(sweep.save(tmp_path / "s.nc"), hystrip.Sweep)
    assert list(again.columns) == list(sweep.columns)
    for column, values in sweep.columns.items():
        assert again.columns[column] == values if column == "failed" else bits(again.columns[column]) == bits(values), column
    assert again.plan.fingerprint == sweep.plan.fingerprint and again.path == tmp_path / "s.nc"
    assert again.to_dataset().identical(data) and list(again.to_dataframe().columns) == list(sweep.columns)


@pytest.mark.parametrize(
    ("cut", "says"),
    [
        (lambda data: data.isel(velocity=[0]), "not all values of velocity"),
        (lambda data: data.isel(velocity=[1, 0]), "not all values of velocity"),
        (lambda data: data.isel(level=[1, 0]), r"of 2 levels it has \[2, 1\]"),
        (lambda data: data.drop_vars("tau"), "tau"),
    ],
)
def test_a_part_of_a_sweep_is_no_sweep(cut, says, tmp_path):
    over = {"pressure": [50.0, 100.0], "velocity": [1e-3, 5e-3]}
    (tmp_path / "s.toml").write_text(SWEPT + "[[levels]]\nl = 1e-6\nh = 1e-8\n")
    sweep = hystrip.sweep(tmp_path / "s.toml", over=over, out=tmp_path / "out")
    data = sweep.to_dataset()
    data.transpose("velocity", "level", "pressure").to_netcdf(tmp_path / "t.nc")
    assert bits(hystrip.load(tmp_path / "t.nc").columns["mu"]) == bits(sweep.columns["mu"])
    cut(data).to_netcdf(tmp_path / "c.nc")
    with pytest.raises(hystrip.InputError, match=says):
        hystrip.load(tmp_path / "c.nc")


def test_points_of_a_result_may_be_cut_out_levels_not(tmp_path):
    result = solve(levels=LEVELS, pressure=[[5e6], [6e6]], velocity=[1e-3, 5e-3, 7e-3])
    data, path = result.to_dataset(), tmp_path / "r.nc"
    data.isel(velocity=[2, 0]).transpose("velocity", "pressure", "level").to_netcdf(path)
    part = hystrip.load(path, hystrip.Result)
    assert bits(part.mu) == bits(result.mu[:, [2, 0]].T) and bits(part.tau_by_level) == bits(
        result.tau_by_level[:, :, [2, 0]].swapaxes(1, 2)
    )
    for cut in (data.isel(level=[0]), data.drop_vars("penetration")):
        cut.to_netcdf(path)
        with pytest.raises(hystrip.InputError, match="with all that is in it"):
            hystrip.load(path)


@pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
def test_a_disk_that_is_full_brings_nothing_down(tmp_path):
    code = (
        "import hystrip, resource\n"
        "result = hystrip.load_scene('paper_fig7').solve()\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (16384, 16384))\n"
        "try:\n    result.save('a.nc')\n"
        "except OSError as error:\n    print(error.errno, error.filename)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, f"{errno.EFBIG} a.nc\n", "")
    assert not [*tmp_path.iterdir()]
