"""``hystrip fit``: what it says of the moduli, and that the results of one set never stand beside another's."""

import numpy as np
import pytest

from hystrip.scene import load_scene

F = np.geomspace(0.01, 100, 9)
X = 2j * np.pi * F * 0.1
G = 1e6 + 3e6 * X / (1 + X)
FIT = ("--terms", 1, "--pressure", "1e5", "--no-plot")
SHIFTED = """pressure = 1e5
velocity = 1.0
[material]
kind = "half-space"
E = 2e6
nu = 0.5
moduli = [8e6]
times = [1e-3]
[material.shift]
model = "Arrhenius"
E_a = 1e5
T_ref = 293.15
[[levels]]
l = 1e-3
h = 2e-5
"""


def table(names, *moduli, before=""):
    """Rows of one relaxation time, 0.1 s; ``moduli``: factors of what is above, each with the cells before its rows."""
    lines = [names]
    for cells, factor in moduli or ((before, 1.0),):
        lines += [f"{cells}{f!r};{factor * E.real!r};{factor * E.imag!r}" for f, E in zip(F.tolist(), G.tolist(), strict=True)]
    return "\n".join(lines) + "\n"


def test_shear_moduli_of_a_layer_are_called_so(run, tmp_path):
    (tmp_path / "rubber.csv").write_text(table("f [Hz];Storage modulus [Pa];Loss modulus [Pa]"), encoding="utf-8")
    status, out, err = run("fit", "rubber.csv", *FIT, "--length", "2 mm", "--shear")
    scene = tmp_path / "hystrip-out/rubber.fitted.toml"
    assert (status, err) == (0, "") and "read       moduli: of shear, G, as asked for" in out
    for text in (out, scene.read_text(encoding="utf-8")):
        assert "shear moduli, G; Young's modulus is E = 2 (1 + nu) G" in text
    assert abs(float(load_scene(scene).material.single.K) / (1e6 / 2e-3) - 1) < 1e-5
    # a half-space takes E = 2 (1 + nu) G
    assert run("fit", "rubber.csv", *FIT, "--nu", 0.5, "--shear")[0] == 0
    assert abs(float(load_scene(scene).material.E) / 3e6 - 1) < 1e-5
    status, out, err = run("fit", "rubber.csv", *FIT, "--length", "2 mm")
    assert status == 0 and "taken for Young's, E" in out and "2 (1 + nu)" not in out + scene.read_text(encoding="utf-8")


@pytest.mark.parametrize("given", [("--pressure", "1e5"), ("--title", "x"), ("--scene", "absent.toml")])
def test_options_of_a_scene_that_is_not_written_are_said_to_do_nothing(run, tmp_path, given):
    (tmp_path / "rubber.csv").write_text(table("f [Hz];E' [Pa];E'' [Pa]"))
    note = "no scene is written, of which --scene, --pressure and --title are: it takes --nu or --length"
    assert note in run("fit", "rubber.csv", *FIT[:2], FIT[-1], *given)[1]
    assert note not in run("fit", "rubber.csv", *FIT[:2], FIT[-1])[1]
    assert note not in run("fit", "rubber.csv", *FIT, "--nu", 0.5)[1]


def test_each_set_has_its_own_files(run, tmp_path):
    text = table("Set;T [degC];f [Hz];E' [Pa];E'' [Pa]", ("1;0;", 1.0), ("23 °C/b;30;", 2.0))
    (tmp_path / "rep.csv").write_text(text, encoding="utf-8")
    status, out, err = run("fit", "rep.csv", *FIT, "--set", "1", "--nu", 0.5)
    assert (status, err) == (0, "") and "read       temperature of the rows used: 0.0 degC" in out
    folder = tmp_path / "hystrip-out"
    before = {path: path.read_bytes() for path in folder.glob("[!.]*")}
    assert sorted(path.name for path in before) == ["rep.1.fit.csv", "rep.1.fitted.toml"]
    assert "Fitted to rep.csv, set 1:" in (folder / "rep.1.fitted.toml").read_text(encoding="utf-8")
    assert run("fit", "rep.csv", *FIT, "--set", "23 °C/b")[0] == 0
    assert before == {path: path.read_bytes() for path in before}
    added = [path for path in folder.glob("[!.]*") if path not in before]
    assert [path.name for path in added] == ["rep.23 %C2%B0C%2Fb.fit.csv"]
    assert "set 23 °C/b" in added[0].read_text(encoding="utf-8")


def test_a_pressure_keeps_its_digits_and_a_band_its_ends(run, tmp_path):
    """They were rounded to six, and three: a narrow band had one end, and the scene was refused after the work."""
    (tmp_path / "narrow.csv").write_text("f [Hz],E' [MPa],E'' [MPa]\n10,1,0.1\n10.01,1,0.1\n10.02,1,0.1\n")
    given = ("--nu", 0.5, "--terms", 1, "--pressure", "1.23456789 MPa", "--no-plot")
    status, _, err = run("fit", "narrow.csv", *given)
    assert (status, err) == (0, "")
    scene = load_scene(tmp_path / "hystrip-out" / "narrow.fitted.toml")
    assert scene.pressure == 1234567.89 and scene.material.fit.edges == (10.0, 10.02)


def test_several_temperatures_leave_nothing(run, tmp_path):
    text = table("T [degC];f [Hz];E' [Pa];E'' [Pa]", *((f"{20 + 0.5 * i};", 1.0) for i in range(9)))
    (tmp_path / "ramp.csv").write_text(text, encoding="utf-8")
    status, out, err = run("fit", "ramp.csv", *FIT)
    assert status == 2 and out == "" and "81 rows at 20.0 to 24.0 degC" in err and "`hystrip master`" in err
    assert [path.name for path in tmp_path.iterdir()] == ["ramp.csv"]


def test_a_wrong_scene_is_refused_before_the_work(run, tmp_path, monkeypatch):
    (tmp_path / "rubber.csv").write_text(table("f [Hz];E' [Pa];E'' [Pa]"))
    (tmp_path / "surface.txt").write_text("not looked at")
    (tmp_path / "s.toml").write_text("presure = 1e5\n")
    for worker in ("hystrip.dma.fit_prony", "hystrip.roughness.read_surface"):
        monkeypatch.setattr(worker, lambda *_, **__: pytest.fail("work before the scene was looked at"))
    for command in (("fit", "rubber.csv", "--nu", 0.5), ("levels", "surface.txt")):
        status, out, err = run(*command, "--scene", "s.toml", "--no-plot")
        assert (status, out) == (2, "") and err.startswith("hystrip: s.toml: presure: unknown key (did you mean 'pressure'?)")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["rubber.csv", "s.toml", "surface.txt"]


@pytest.mark.parametrize(
    ("remark", "temperature", "said"),
    [
        ("", "'40 degC'", "'40 degC'; allowed: none: rubber.csv states no shift"),
        ("# shift: WLF C_1=8.86 C_2=51.6 T_ref=293.15\n", "200", "200.0; allowed: a finite number > 241.55 (K)"),
    ],
)
def test_a_temperature_that_the_material_cannot_have_is_refused_before_the_work(
    run, tmp_path, monkeypatch, remark, temperature, said
):
    """The scene that comes out could not be solved."""
    (tmp_path / "rubber.csv").write_text(remark + table("f [Hz];E' [Pa];E'' [Pa]"))
    (tmp_path / "s.toml").write_text(f"temperature = {temperature}\n{SHIFTED}")
    monkeypatch.setattr("hystrip.dma.fit_prony", lambda *_, **__: pytest.fail("work before the scene was looked at"))
    status, out, err = run("fit", "rubber.csv", "--nu", 0.5, "--scene", "s.toml", "--no-plot")
    assert (status, out) == (2, "") and err.startswith(f"hystrip: s.toml: temperature: got {said}"), err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["rubber.csv", "s.toml"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--nu", 0.7), "--nu: got 0.7; allowed: a Poisson ratio from 0 to 0.5"),
        (("--length", 0), "--length: got 0.0"),
        (("--terms", 50), "--terms: got 50"),
        (("--per-decade", 0), "--per-decade: got 0.0"),
        (("--low", -1), "--low: got -1.0; allowed: a finite number >= 0 (Hz)"),
        (("--high", -1), "--high: got -1.0; allowed: a finite number >= 0 (Hz)"),
        (("--low", 1000), "--low, --high: got (1000.0, None)"),
        (
            ("--terms", 2, "--per-decade", 1),
            "--accuracy, --terms, --per-decade: got {'terms': 2, 'per_decade': 1.0}; allowed: one of them",
        ),
        (("--shear",), "--shear: got True; allowed: False"),
        (("--decimal", "x"), "--decimal: got 'x'"),
        (("--set", "3"), "--set: got '3'; allowed: None: rubber.csv has no column 'Set'"),
    ],
)
def test_what_is_wrong_with_an_option_names_it(run, tmp_path, arguments, said):
    (tmp_path / "rubber.csv").write_text(table("f [Hz];E' [Pa];E'' [Pa]"))
    status, out, err = run("fit", "rubber.csv", "--pressure", "1e5", "--no-plot", *arguments)
    assert (status, out) == (2, "") and err.startswith(f"hystrip: {said}")
    assert [path.name for path in tmp_path.iterdir()] == ["rubber.csv"]
