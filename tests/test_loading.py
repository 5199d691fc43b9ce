"""Solvers outside the package: loading, versions, permission, scenes and the command line."""

import copy
import json
import os
import pickle
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import hystrip
import hystrip.generated
from hystrip import InputError
from hystrip.generated.modes import of_operators
from hystrip.inputs.materials import kernel_of
from hystrip.inputs.model import ModelMaterial
from hystrip.orbit.foundation import foundation_of
from hystrip.scene import parse_scene
from hystrip.scene.errors import SceneError

ADHESION = hystrip.Dugdale(p_0=2e3, delta_0=3e-7)
MODULI, TIMES = (3e9, 2e10), (1e-3, 1e-1)

SCENE = """
penetration = 3e-7
velocity = [1e-4, 1e-2]
edge = "constitutive"
rtol = 1e-3
[material]
model = "prony"
K = "1 GPa/m"
moduli = ["3 GPa/m", 2e10]
times = ["1 ms", 0.1]
{solver}
[[levels]]
l = 1e-5
h = 1e-6
"""


@pytest.fixture
def folder(tmp_path):
    """A solver folder as `hystrip regenerate` writes it: that of the package, under another name."""
    target = tmp_path / "my_solver"
    shutil.copytree(Path(hystrip.generated.__file__).parent, target, ignore=shutil.ignore_patterns("__pycache__", "audit"))
    return target


def _edit(file, old, new):
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def test_what_holds_a_loaded_solver_is_pickled_with_its_folder(folder, tmp_path):
    solver = hystrip.load_solver(folder)
    series = hystrip.Prony(1e9, MODULI, TIMES, solver=solver)
    held = (
        solver,
        series,
        hystrip.HalfSpace(1e6, 0.5, MODULI, TIMES, solver=solver),
        solver.material("generalised", K=1e9, K_i=MODULI, tau_i=TIMES),
        hystrip.solve_strip(series, ADHESION, l=1e-5, A=1e-6, D=0.0, V=1e-3, edge="constitutive"),
    )
    pickled = [pickle.dumps(each) for each in held]
    again = [pickle.loads(each) for each in pickled]
    assert again[:-1] == list(held[:-1]) and list(map(hash, again[:-1])) == list(map(hash, held[:-1]))
    assert again[-1].p_mean == held[-1].p_mean and again[-1].pressure(1e-6) == held[-1].pressure(1e-6)
    assert copy.deepcopy(held[3]) == held[3]
    # in another process, which has not loaded it yet
    (tmp_path / "material").write_bytes(pickled[3])
    code = f"import pickle; print(pickle.load(open({str(tmp_path / 'material')!r}, 'rb')))"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.strip() == repr(held[3])
    # other code may give other numbers
    (folder / "stable.py").write_text((folder / "stable.py").read_text() + "\n# changed\n")
    for each in pickled[:-1]:
        with pytest.raises(InputError, match=r"solver.*changed since"):
            pickle.loads(each)


def test_a_loaded_solver_solves_as_the_package_does(folder):
    solver = hystrip.load_solver(folder)
    assert "generalised" in set(solver.models)
    strips = {"l": 1e-5, "A": 1e-6, "D": np.linspace(-1e-6, 2e-6, 7), "V": 1e-3, "edge": "constitutive"}
    ours = hystrip.solve_strip(hystrip.Prony(1e9, MODULI, TIMES), ADHESION, **strips)
    for material in (
        hystrip.Prony(1e9, MODULI, TIMES, solver=solver),
        solver.material("generalised", K=1e9, K_i=MODULI, tau_i=TIMES),
    ):
        theirs = hystrip.solve_strip(material, ADHESION, **strips)
        assert np.array_equal(ours.p_mean, theirs.p_mean) and np.array_equal(ours.tau_mean, theirs.tau_mean)
        level = hystrip.solve_level(material, ADHESION, hystrip.Level(1e-5, 1e-6), V=1e-3, D=3e-7, edge="constitutive", rtol=1e-3)
        assert np.isfinite(level.p_mean)
    assert "rtol 0.001; generalised" in str(level)


def test_a_branch_that_is_idle_changes_nothing(folder):
    solver = hystrip.load_solver(folder)
    (K_1, K_2), (tau_1, tau_2) = MODULI, TIMES
    idle = ((K_1, 0.0, K_2), (tau_1, 1e-2, tau_2)), ((K_1, K_2, 1e9), (tau_1, tau_2, 0.0))
    rates = [
        foundation_of(solver.material("generalised", K=1e9, K_i=moduli, tau_i=times)).lossiest_rate
        for moduli, times in ((MODULI, TIMES), *idle)
    ]
    assert rates[1:] == pytest.approx(rates[:1] * 2, rel=1e-6)
    elastic = hystrip.Prony(1e9, [0.0], [1e-3], solver=solver)
    assert foundation_of(elastic).longest_time == 0


def test_parameters_of_a_loaded_model_are_checked(folder):
    solver = hystrip.load_solver(folder)
    given = {"K": 1e9, "K_i": MODULI, "tau_i": TIMES}
    for changed, field in (
        ({"K": "x"}, "material.K"),
        ({"K": -1.0}, "material"),
        ({"K_i": 1e9}, "material.K_i"),
        ({"tau_i": (1.0, np.inf)}, "material.tau_i"),
        ({"T": 1.0}, "material.T"),
    ):
        with pytest.raises(InputError) as error:
            solver.material("generalised", **(given | changed))
        assert error.value.field == field
    with pytest.raises(InputError, match="a model of the solver"):
        solver.material("no_such", **given)
    with pytest.raises(InputError, match="material.tau_i.*2 numbers"):
        solver.material("generalised", **given | {"tau_i": (1e-3, 1e-2, 1e-1)})


def test_a_solver_for_another_number_of_times_is_refused(folder):
    _edit(folder / "generalised.py", "MODES = None", "MODES = 2")
    with pytest.raises(InputError, match="a Prony series of 5 different times"):
        hystrip.solve_strip(
            hystrip.Prony(1e9, [1e9] * 5, [1, 2, 3, 4, 5], solver=hystrip.load_solver(folder)),
            ADHESION,
            l=1.0,
            A=1.0,
            D=0.0,
            V=1.0,
            edge="constitutive",
        )


def test_a_model_with_the_names_of_a_prony_series_but_other_units_does_not_solve_one(folder):
    _edit(folder / "generalised.py", '"K_i": ("Pa/m"', '"K_i": ("1"')
    with pytest.raises(InputError, match="a solver for a Prony series of 2 different times"):
        kernel_of(hystrip.Prony(1e9, MODULI, TIMES, solver=hystrip.load_solver(folder)))


@pytest.mark.parametrize("given", [{}, {"p_0": 1e-2}])
def test_a_model_may_have_no_parameters_or_one_that_is_named_as_a_length_of_the_strip(given):
    kernel = SimpleNamespace(
        MODEL="own",
        MODES=1,
        MODE_PARAMETERS=(),
        MATERIAL={name: ("s", "time") for name in given},
        material_modes=lambda p_0=1e-2: of_operators((1.0, p_0), (1e-9, 1e-2 * 1e-9 * p_0)),
    )
    strips = {"l": 1e-5, "A": 1e-6, "D": np.linspace(-1e-6, 2e-6, 7), "V": 1e-3}
    own, shipped = (
        hystrip.solve_strip(material, ADHESION, **strips)
        for material in (ModelMaterial(kernel, given), hystrip.StandardLinearSolid(1e9, 1e-2, 1e-4))
    )
    assert own.p_mean == pytest.approx(shipped.p_mean, rel=1e-12)


def test_parameters_of_a_model_do_not_take_the_place_of_what_a_refused_strip_is(monkeypatch):
    """A user's V hid the velocity, D the penetration; p_0 was hidden by the traction, a K that is none by the stiffness."""
    names = {"V": "s", "D": "s", "p_0": "Pa/m", "K": "s", "G": "Pa/m"}

    def material_modes(V, D, p_0, K, G):
        return of_operators((1.0, V + K, V * K), (1 / p_0, (D + 1e-2) / p_0, D * 1e-2 / p_0))

    kernel = SimpleNamespace(
        MODEL="own",
        MODES=2,
        MODE_PARAMETERS=(),
        MATERIAL={name: (unit, "own") for name, unit in names.items()},
        material_modes=material_modes,
    )
    material = ModelMaterial(kernel, {"V": 3e-2, "D": 1e-3, "p_0": 1e9, "K": 2e-3, "G": 4.0})
    foundation = foundation_of(hystrip.Prony(1e9, MODULI, TIMES))
    foundation.material = material
    refused = SimpleNamespace(certified=np.array([False]), size=1)
    monkeypatch.setattr(type(foundation), "_solve", lambda *_: refused)
    strip = (np.array([value]) for value in (1e-5, 1e-7, 2e-8, 1e-3, 2e3, 3e-7))
    with pytest.raises(hystrip.SolverError) as error:
        foundation.solve(*strip, "constitutive", "unloading")
    own = "material.V=0.03, material.D=0.001, material.p_0=1000000000.0, material.K=0.002, G=4.0"
    named = f"l=1e-05, A=1e-07, D=2e-08, V=0.001, {own}, K=1000000000.0, p_0=2000.0, delta_0=3e-07, edge="
    assert f"strip 0: {named}" in str(error.value)


def test_another_interface_is_refused_and_says_how_to_regenerate(folder):
    _edit(folder / "generalised.py", "INTERFACE = 1", "INTERFACE = 0")
    with pytest.raises(InputError, match="emitted for 0.*hystrip regenerate my_model.py --out"):
        hystrip.load_solver(folder)


@pytest.mark.parametrize("spoil", ["nothing", "broken", "empty"])
def test_what_is_no_solver_is_refused(tmp_path, folder, spoil):
    if spoil == "nothing":
        folder = tmp_path / "absent"
    elif spoil == "broken":
        (folder / "modes.py").write_text("raise RuntimeError('spoilt')")
    else:
        (folder / "__init__.py").write_text("MODELS = ()")
    with pytest.raises(InputError) as error:
        hystrip.load_solver(folder)
    assert error.value.field == "solver"


def test_a_scene_has_prony_series():
    scene = parse_scene(SCENE.format(solver=""))
    assert scene.material == hystrip.Prony(1e9, MODULI, TIMES)
    result = scene.solve()
    assert np.isfinite(result.mu).all() and "Prony" in result.summary()
    assert list(json.loads(result.to_dataset().attrs["material"])["moduli"]) == list(scene.material.moduli)


@pytest.mark.parametrize(
    "old, new, field, says",
    [
        ("times", "T_eps", "material.T_eps", "a key of another model"),
        ('times = ["1 ms", 0.1]', "", "material.times", "missing"),
        ('"1 ms", 0.1', '"1 ms"', "material.moduli", "as many"),
        ('"1 ms", 0.1', '"1 ms", "0.1 m"', "material.times[1]", "unit of something else"),
        ('"prony"', '"pronny"', "material.model", "prony"),
        ('edge = "constitutive"', "", "edge", "not determined"),
    ],
)
def test_scene_errors_name_the_key(old, new, field, says):
    with pytest.raises(SceneError) as error:
        parse_scene(SCENE.format(solver="").replace(old, new)).solve()
    assert error.value.field.startswith(field) and says in str(error.value)


def test_a_scene_runs_a_solver_only_where_that_is_allowed(folder, run):
    path = folder.parent / "scene.toml"
    path.write_text(SCENE.format(solver='solver = "my_solver"'))
    with pytest.raises(SceneError, match="allow_solver=True") as error:
        hystrip.load_scene(path)
    assert error.value.field == "material.solver" and "--allow-solver" in str(error.value)
    allowed = hystrip.load_scene(path, allow_solver=True).solve()
    ours = parse_scene(SCENE.format(solver="")).solve()
    assert np.array_equal(allowed.mu, ours.mu)

    out = folder.parent / "out"
    for command in (["solve", path, "--no-plot"], ["sweep", path]):
        status, _, err = run(*command, "--out", out)
        assert status == 2 and "--allow-solver" in err and not out.exists()
    assert run("solve", path, "--no-plot", "--allow-solver", "--out", out)[0] == 0
    assert run("sweep", path, "--allow-solver", "--out", out)[0] == 0
    rows = (out / "scene.sweep.csv").read_text().splitlines()
    assert len([row for row in rows if not row.startswith("#")]) == 3


def test_regenerate_wants_a_folder_for_a_users_model(tmp_path, run):
    model = tmp_path / "my_model.py"
    for text, arguments, says in (
        ("", [model], "--out"),
        (None, [model, "--out", tmp_path / "out"], "declares MODEL"),
        ("MODEL = 3", [model, "--out", tmp_path / "out"], "admissible model"),
        ("MODEL = []", [model, "--out", tmp_path / "out"], "at least one model"),
        ("raise SystemExit(0)", [model, "--out", tmp_path / "out"], "does not end the process"),
    ):
        model.unlink(missing_ok=True)
        if text is not None:
            model.write_text(text)
        status, _, err = run("regenerate", *arguments)
        assert status == 2 and says in err
        assert not (tmp_path / "out").exists()


def test_a_solver_of_ones_own_is_checked_against_its_model(folder, run, monkeypatch):
    """What stands beside the model file in its folder, not what the package ships; both are named, or none."""
    import hystrip.derivation

    model = folder.parent / "my_model.py"
    model.write_text("from hystrip.derivation import prony_model\nMODEL = prony_model('my_rubber')\n")
    seen = []
    monkeypatch.setattr(hystrip.derivation, "check", lambda *at, models, progress: seen.append((*at, models)) or ())
    status, out, _ = run("check", model, "--folder", folder)
    assert status == 0 and "what the derivation emits" in out
    ((checked, (own,)),) = seen
    assert Path(checked) == folder and own.name == "my_rubber"
    for arguments, says in (
        ([model], "--folder: got None; allowed: the folder"),
        (["--folder", folder], "MODEL: got None; allowed: the file"),
        ([model, "--folder", folder.parent], "hystrip regenerate` wrote"),
        ([folder / "absent.py", "--folder", folder], "a Python file that declares MODEL"),
    ):
        status, _, err = run("check", *arguments)
        assert status == 2 and says in err
    assert run("check")[0] == 0 and seen[1:] == [(None, None)]


@pytest.mark.parametrize("text", ["{", "[1]"])
def test_certificates_of_no_solver_are_refused_before_the_work(tmp_path, run, monkeypatch, text):
    monkeypatch.setattr("hystrip.derivation.regenerate", lambda *_, **__: pytest.fail("work before the folder was looked at"))
    (tmp_path / "out").mkdir()
    (tmp_path / "out/certificates.json").write_text(text)
    status, _, err = run("regenerate", "--out", "out")
    assert status == 2 and err.startswith("hystrip: --out: got 'out'; allowed: a new folder, or one whose certificates.json")


def test_what_a_killed_run_left_of_generated_files_is_removed(tmp_path, run, monkeypatch):
    """In the folder and beside it; not what may be still at work, what is not like it, or what a link leads to."""
    killed = "import os; from pathlib import Path; from hystrip.derivation.folder import write_files; "
    killed += "os.replace = lambda *_: os._exit(9); write_files(Path('out'), {'deep/a.py': 'x'})"
    assert subprocess.run([sys.executable, "-c", killed], cwd=tmp_path, check=False).returncode == 9
    (beside,) = tmp_path.glob(".*")
    within = tmp_path / "out" / beside.name
    shutil.copytree(beside, within)
    others = [tmp_path / name for name in (".out.abcdefgh", ".out.settings", ".other.abcdefgh", ".out.a_linked")]
    for other, inside in zip(others, ("out", "mine", "other"), strict=False):
        (other / inside).mkdir(parents=True)
    others[-1].symlink_to(others[1], target_is_directory=True)
    for each in (beside, within, *others[1:3]):
        os.utime(each, (0, 0))
    monkeypatch.setattr("hystrip.derivation.regenerate", lambda *_, **__: None)
    status, _, _ = run("regenerate", "--out", "out")
    assert status == 0 and not beside.exists() and not within.exists()
    assert all(each.exists() for each in others)


def test_moduli_and_times_are_swept(folder):
    path = folder.parent / "scene.toml"
    path.write_text(SCENE.format(solver=""))
    over = {"material.times[0]": [1e-3, 1e-2, 3.0], "material.moduli[1]": [2e10, 0.0]}
    done = hystrip.sweep(path, over=over, out=folder.parent / "out")
    data = done.to_dataset()
    assert (
        data.mu.dims[:2] == ("moduli_2", "times_1")
        and data.moduli_2.units == "Pa/m"
        and data.times_1.units == "s"
        and not done.failed
    )
    base = hystrip.load_scene(path)
    for modulus in over["material.moduli[1]"]:
        for time in over["material.times[0]"]:  # the last is longer than the other: branches keep their moduli
            material = hystrip.Prony(1e9, [MODULI[0], modulus], [time, TIMES[1]])
            run = {"penetration": base.penetration, "velocity": base.velocity, "edge": base.edge, "rtol": base.rtol}
            alone = hystrip.solve(material, base.adhesion, base.levels, **run)
            assert np.array_equal(data.mu.sel(moduli_2=modulus, times_1=time), alone.mu)


def test_an_entry_of_moduli_or_times_is_a_list_or_range(folder):
    path = folder.parent / "scene.toml"
    swept = 'times = [{ start = "1 ms", stop = 0.01, num = 2, spacing = "log" }, 0.1]'
    path.write_text(SCENE.format(solver="").replace('times = ["1 ms", 0.1]', swept))
    with pytest.raises(SceneError, match="for `hystrip sweep`") as error:
        hystrip.load_scene(path)
    assert error.value.field == "material.times[0]"
    done = hystrip.sweep(path, out=folder.parent / "out")
    assert sorted(set(done.columns["times_1 [s]"])) == [1e-3, 1e-2] and not done.failed


@pytest.mark.parametrize(
    ("over", "says"),
    [
        ({"material.times[0]": [1e-3, 0.0]}, "> 0"),
        ({"material.moduli[2]": 1.0}, "did you mean"),
        ({"material.times": 1.0}, "one of"),
    ],
)
def test_a_branch_that_cannot_be_swept_is_refused(folder, over, says):
    path = folder.parent / "scene.toml"
    path.write_text(SCENE.format(solver=""))
    with pytest.raises(InputError, match=says):
        hystrip.sweep(path, over=over, out=folder.parent / "out")


def test_levels_put_into_a_scene_with_a_solver(folder):
    """Its path is seen from the new scene's folder; its code is run only where that is allowed."""
    from hystrip.scene.edit import with_levels, with_solver_seen_from

    source = folder.parent / "scene.toml"
    source.write_text(SCENE.format(solver='solver = "my_solver"'))
    out = folder.parent / "elsewhere" / "out"
    text = with_solver_seen_from(out, source.read_text(), source)
    levels = [{"l": 2e-5, "h": 1e-6}]
    with pytest.raises(SceneError, match="--allow-solver"):
        with_levels(text, levels, folder=out)
    out.mkdir(parents=True)
    (out / "new.toml").write_text(with_levels(text, levels, folder=out, allow_solver=True))
    scene = hystrip.load_scene(out / "new.toml", allow_solver=True)
    assert scene.levels == (hystrip.Level(2e-5, 1e-6),) and scene.material.solver is not None


@pytest.mark.parametrize("edge", ["continuous", "constitutive"])
def test_a_generated_kelvin_voigt_solves_as_the_package_does(folder, edge):
    material = hystrip.load_solver(folder).material("kelvin_voigt", K=1e9, T_eps=1e-3)
    strips = {"l": 1e-5, "A": 1e-6, "D": np.linspace(-1e-6, 2e-6, 23), "V": 1e-3, "edge": edge}
    ours, theirs = (hystrip.solve_strip(m, ADHESION, **strips) for m in (hystrip.KelvinVoigt(1e9, 1e-3), material))
    assert (
        np.array_equal(ours.p_mean, theirs.p_mean)
        and np.array_equal(ours.tau_mean, theirs.tau_mean)
        and np.any(ours.tau_mean > 0)
    )


def test_several_times_without_instantaneous_compliance_are_refused(folder):
    from types import SimpleNamespace

    from hystrip.generated import modes
    from hystrip.inputs.model import ModelMaterial

    def material_modes(c):
        return modes.of_operators((1.0, c, c), (1.0, 0.5 * c, 0.0))

    kernel = SimpleNamespace(
        MODEL="viscous", MODES=2, MATERIAL={"c": ("s", "time")}, MODE_PARAMETERS=(), material_modes=material_modes
    )
    with pytest.raises(InputError, match="a spring in every branch"):
        ModelMaterial(kernel, {"c": 5.0})
