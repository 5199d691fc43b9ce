"""Ninety wrong scenes and calls: each ends with one message, a non-zero status, and no file."""

import importlib.util
import sys

import pytest
from scene_text import ONE_LEVEL

SCENES = [  # what is replaced, by what, and what the message says: the field, the value, what is allowed
    ("K = 1e9", "K = -1", ["material.K", "-1", "> 0"]),
    ("K = 1e9", "K = 0", ["material.K", "0", "> 0"]),
    ("K = 1e9", "K = nan", ["material.K", "nan", "finite"]),
    ("K = 1e9", "K = inf", ["material.K", "inf", "finite"]),
    ("K = 1e9", "K = true", ["material.K", "True", "number"]),
    ("K = 1e9", 'K = "1 GPa"', ["material.K", "1 GPa", "Pa/m"]),
    ("K = 1e9", 'K = "1e9"', ["material.K", "1e9", "without quotes"]),
    ("K = 1e9", "", ["material.K", "missing", "stiffness"]),
    ("K = 1e9", "k = 1e9", ["material.k", "did you mean 'K'"]),
    ("K = 1e9", "K = [1e9]", ["material.K", "[1000000000.0]", "number"]),
    ("T_eps = 0.01", "T_eps = -0.01", ["material.T_eps", "-0.01"]),
    ("T_sigma = 1e-4", "T_sigma = -1e-4", ["material.T_sigma", "-0.0001"]),
    ("T_sigma = 1e-4", "T_sigma = 0.02", ["material.T_sigma", "0.02", "T_eps"]),
    ("[material]", '[material]\nmodel = "maxwell"', ["material.model", "maxwell", "standard_linear_solid"]),
    ("gamma = 2.5e-5", "gamma = -1", ["adhesion.gamma", "-1"]),
    ("gamma = 2.5e-5", "", ["adhesion", "neither gamma nor p_0"]),
    ("gamma = 2.5e-5", "gamma = 1\np_0 = 1", ["adhesion", "all three", "two of the three"]),
    ("delta_0 = 1e-8", "", ["adhesion.delta_0", "missing", "since there is adhesion"]),
    ("delta_0 = 1e-8", "delta_0 = 0", ["adhesion.delta_0", "0", "> 0"]),
    ("delta_0 = 1e-8", "delta = 1e-8", ["adhesion.delta", "did you mean 'delta_0'"]),
    ("l = 1e-5", "l = 0", ["levels[0].l", "0", "> 0"]),
    ("l = 1e-5", 'l = "10 umm"', ["levels[0].l", "umm", "not known"]),
    ("h = 1e-6", "h = -1e-6", ["levels[0].h", "-1e-06"]),
    ("h = 1e-6", "h = 1e-6\nvelocity = 1", ["levels[0].velocity", "above the first [table]"]),
    ("[[levels]]\nl = 1e-5\nh = 1e-6\n", "", ["levels", "missing", "[[levels]]"]),
    ("[[levels]]", "[levels]", ["levels", "[[levels]]"]),
    ("pressure = 100", "", ["neither pressure nor penetration"]),
    ("pressure = 100", "pressure = 1\npenetration = 1e-7", ["both pressure and penetration"]),
    ("pressure = 100", 'pressure = "0,1 kPa"', ["pressure", "0,1 kPa"]),
    ("pressure = 100", "pressure = []", ["pressure", "[]", "one value or more"]),
    ("velocity = 5e-3", "velocity = -5e-3", ["velocity", "-0.005"]),
    ("velocity = 5e-3", "velocity = [1e-3, nan]", ["velocity[1]", "nan", "finite"]),
    ("velocity = 5e-3", "velocity = {start = 1, stop = 2}", ["velocity.num", "missing", "integer"]),
    ("velocity = 5e-3", 'velocity = {start = 0, stop = 2, num = 3, spacing = "log"}', ["velocity.start", "0", "> 0"]),
    ("velocity = 5e-3", "velocity = {start = 1, stop = 2, num = 1}", ["velocity.num", "1", "from 2"]),
    ("velocity = 5e-3", "velocity = {start = 1, end = 2, num = 3}", ["velocity.end", "unknown key"]),
    ("pressure = 100", 'pressure = 100\nedge = "sharp"', ["edge", "sharp", '"constitutive"']),
    ("pressure = 100", 'pressure = 100\nbranch = "both"', ["branch", "both", '"loading"']),
    ("pressure = 100", f'title = "{"x" * 201}"\npressure = 100', ["title", "xxx", "at most 200 characters"]),
    ("velocity = 5e-3", "velocity = {start = -1e308, stop = 1e308, num = 3}", ["velocity.start", "-1e+308", "up to 1e+40"]),
    ("pressure = 100", "pressure = 100\nrtol = 0", ["rtol", "0", "1e-12 to 0.1"]),
    ("pressure = 100", "pressure = 100\nstrip = 8", ["strip", "unknown key", "did you mean 'strips'"]),
    ("pressure = 100", "pressure = 100\nstrips = 0", ["strips", "0", "from 1 to 1000000"]),
    ("pressure = 100", "pressure = 100\npressure = 100", ["not valid TOML", "line 2"]),
    ("pressure = 100", "pressure 100", ["not valid TOML", "line 1"]),
    # as people write who have not read the README to its end
    ("K = 1e9", "K = 1,0e9", ["not valid TOML", "line 4"]),
    ("[[levels]]", "[[level]]", ["level", "did you mean 'levels'"]),
    ("[material]", "[Material]", ["Material", "did you mean 'material'"]),
    ("velocity = 5e-3", 'velocity = "5 mm"', ["velocity", "5 mm", "'mm' is a unit of something else"]),
    ("velocity = 5e-3", "velocity = {start = 1e-5, stop = 1, num = 1000000000000}", ["velocity.num", "from 2 to 1000000"]),
    ("pressure = 100", "pressure = 100\nrtol = 1e-15", ["rtol", "1e-15", "1e-12 to 0.1"]),
    ("T_eps = 0.01", "T_eps = 1e400", ["material.T_eps", "inf", "finite"]),
    ("[material]", '[material]\nmodel = "kelvin_voigt"', ["material.T_sigma", "another model", "K, T_eps"]),
    ("T_eps = 0.01\nT_sigma = 1e-4", 'model = "prony"\nmoduli = [1e9, 2e9]\ntimes = [1e-3]', ["as many moduli as times"]),
    ("h = 1e-6\n", "h = 1e-6\n[[levels]]\nl = 1e-4\nh = 1e-5\n", ["levels[1].l", "0.0001", "the largest wave comes first"]),
]

scans = pytest.mark.skipif(not importlib.util.find_spec("SurfaceTopography"), reason="needs the extra roughness")
CALLS = [
    (["solve", "absent.toml"], ["absent.toml", "no such file"]),
    (["solve", "paper_fig66"], ["did you mean 'paper_fig6'"]),
    (["solve", "binary"], ["did you mean 'binary.toml'"]),
    (["solve", "folder"], ["folder", "this is a folder"]),
    (["solve", "binary.toml"], ["binary.toml", "UTF-8"]),
    (["solve", "/dev/zero"], ["/dev/zero", "no regular file"]),
    (["solve"], ["Missing argument"]),
    (["solve", "paper_fig6", "--out", "binary.toml"], ["--out", "binary.toml", "a folder"]),
    (["solve", "paper_fig6", "--outt", "x"], ["No such option"]),
    (["solv"], ["No such command", "solve"]),
    (["sweep", "absent.toml"], ["absent.toml", "no such file"]),
    (["sweep", "paper_fig5"], ["paper_fig5", "nothing is swept"]),
    (["sweep", "paper_fig7", "--workers", "0"], ["hystrip: --workers: got 0", ">= 1"]),
    (["sweep", "paper_fig7", "--batch", "0"], ["hystrip: --batch: got 0", ">= 1"]),
    (["sweep", "paper_fig7", "--over", "levels[9].h=1"], ["hystrip: --over: got 'levels[9].h'", "one of levels[0].l"]),
    (["sweep", "paper_fig7", "--out", "binary.toml"], ["--out", "binary.toml", "a folder"]),
    (["sweep", "paper_fig7", "--scheduler", "nonsense"], ["hystrip: scheduler nonsense: no Dask scheduler answers"]),
    (["sweep", "paper_fig7", "--scheduler", ""], ["hystrip: --scheduler: got ''", "the address of a Dask scheduler"]),
    (["figures", "fig9"], ["figures", "fig9", "fig3"]),
    (["show", "paper_fig7", "--level", "4"], ["--level", "4", "1 to 3"]),
    (["show", "paper_fig7", "--strip", "0", "--level", "2"], ["--level", "2", "1 with --strip"]),
    (["show", "paper_fig7", "--map", "--pressure", "-1e9"], ["the surface is pulled off"]),
    (["show", "paper_fig7", "--velocity", "-1"], ["--velocity", "-1", ">= 0"]),
    (["init", "nowhere/scene.toml"], ["nowhere/scene.toml", "folder that exists"]),
    (["init", "binary.toml"], ["binary.toml", "--force"]),
    (["regenerate", "--out", "binary.toml"], ["--out", "binary.toml", "a folder"]),
    (["solve", "paper_fig7", "extra"], ["unexpected extra argument", "extra"]),
    (["sweep", "paper_fig7", "--workers", "two"], ["--workers", "valid integer"]),
    (["figures", "3"], ["figures", "'3'", "fig3"]),
    (["fit", "absent.csv", "--length", "1 mm", "--pressure", "1 MPa"], ["absent.csv"]),
    (["fit", "binary.toml", "--length", "1 mm", "--pressure", "1 MPa"], ["binary.toml"]),
    pytest.param(["levels", "absent.nc", "--pressure", "1 MPa"], ["absent.nc", "a measured surface"], marks=scans),
    (["audit", "--out", "binary.toml"], ["--out", "binary.toml", "a folder"]),
    (["regenerate", "binary.toml", "--out", "solver"], ["binary.toml"]),
    (["sweep", "keys.toml"], ["hystrip: keys.toml: batch: unknown key"]),  # of the scene, not the option --batch
]
OUT = {"solve": 1, "sweep": 1, "show": 1, "figures": 0, "master": 1, "fit": 1, "levels": 1, "regenerate": 0, "audit": 0}
CALLS += [([name, *["paper_fig7"] * count, "--out", ""], ["'--out'", "got ''", "a folder"]) for name, count in OUT.items()]


def files_in(folder):
    return {path: path.read_bytes() if path.is_file() else None for path in folder.rglob("*")}


def fails(run, folder, arguments):
    before = files_in(folder)
    status, out, err = run(*arguments)
    assert status not in (0, None)
    assert out == "" and "Traceback" not in err and err.strip()
    assert files_in(folder) == before
    return err


@pytest.mark.parametrize(("old", "new", "said"), SCENES, ids=[f"{new}"[:40] for _, new, _ in SCENES])
def test_wrong_scene(run, tmp_path, old, new, said):
    assert ONE_LEVEL.count(old) == 1
    (tmp_path / "mine.toml").write_text(ONE_LEVEL.replace(old, new), encoding="utf-8")
    message = fails(run, tmp_path, ["solve", "mine.toml"])
    assert message.startswith("hystrip: mine.toml: ") and message.count("\n") == 1
    for part in said:
        assert part in message


@pytest.mark.parametrize(("arguments", "said"), CALLS, ids=lambda given: " ".join(given))
def test_wrong_call(run, tmp_path, arguments, said):
    (tmp_path / "folder").mkdir()
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    (tmp_path / "keys.toml").write_text(f"batch = 3\n{ONE_LEVEL}")
    message = fails(run, tmp_path, arguments)
    for part in said:
        assert part in message


@pytest.mark.skipif(sys.platform == "win32", reason="links need a privilege there")
def test_a_link_to_nothing_is_refused_before_the_work(run, tmp_path):
    (tmp_path / "link").symlink_to("nowhere")
    message = fails(run, tmp_path, ["solve", "paper_fig6", "--out", "link"])
    assert "--out" in message and "link to nothing" in message
