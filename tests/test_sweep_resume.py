"""Going on with a sweep: never a row of another scene, of another part, or of other code."""

import json
import shutil
from concurrent.futures import Executor, Future
from pathlib import Path

import numpy as np
import pytest

import hystrip
import hystrip.generated

SCENE = """
pressure = 5e6
velocity = { start = 1e-4, stop = 1e-2, num = 20, spacing = "log" }
[sweep]
batch = 2
[material]
K = 1e9
T_eps = 0.01
T_sigma = 1e-4
[[levels]]
l = 1e-5
h = 1e-6
"""
OTHER = SCENE.replace("T_eps = 0.01", "T_eps = 0.02")


class Killed(BaseException):
    """What stands for a kill: nothing catches it."""


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text(SCENE)
    return path


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """The bytes of both sweeps left alone."""
    found = {}
    for text in (SCENE, OTHER):
        folder = tmp_path_factory.mktemp("alone")
        (folder / "s.toml").write_text(text)
        found[text] = hystrip.sweep(folder / "s.toml", out=folder).path.read_bytes()
    assert found[SCENE] != found[OTHER]
    return found


def parts(folder):
    return sorted((folder / "s.parts").glob("part-*"))


@pytest.mark.parametrize("deletions", range(1, 12))
def test_a_restart_killed_at_any_deletion_never_mixes_scenes(scene, expected, tmp_path, monkeypatch, deletions):
    hystrip.sweep(scene, out=tmp_path)
    scene.write_text(OTHER)
    unlink, left = Path.unlink, [deletions]

    def killing(self, *args, **options):
        if self.parent.name == "s.parts" and self.suffix == ".json":
            if not left[0]:
                raise Killed
            left[0] -= 1
        return unlink(self, *args, **options)

    with monkeypatch.context() as patch, pytest.raises(Killed):
        patch.setattr(Path, "unlink", killing)
        hystrip.sweep(scene, out=tmp_path, restart=True)
        raise Killed  # all deleted: the sweep itself is not what is tested
    try:
        found = hystrip.sweep(scene, out=tmp_path).path.read_bytes()
    except hystrip.InputError as refused:
        assert "--restart" in str(refused)
        found = hystrip.sweep(scene, out=tmp_path, restart=True).path.read_bytes()
    assert found == expected[OTHER]


def test_parts_without_a_plan_are_refused(scene, tmp_path):
    hystrip.sweep(scene, out=tmp_path)
    (tmp_path / "s.parts/plan.json").unlink()
    for text in (SCENE, OTHER):
        scene.write_text(text)
        with pytest.raises(hystrip.InputError, match="--restart"):
            hystrip.sweep(scene, out=tmp_path)


def test_parts_of_another_scene_under_the_right_plan_are_solved_again(scene, expected, tmp_path):
    hystrip.sweep(scene, out=tmp_path / "a")
    scene.write_text(OTHER)
    hystrip.sweep(scene, out=tmp_path / "b")
    for part in parts(tmp_path / "a")[:3]:
        shutil.copy(part, tmp_path / "b/s.parts")
    done = hystrip.sweep(scene, out=tmp_path / "b")
    assert done.path.read_bytes() == expected[OTHER] and (done.solved, done.kept) == (3, 7)


def test_a_part_copied_over_another_is_solved_again(scene, expected, tmp_path):
    hystrip.sweep(scene, out=tmp_path)
    first, second = parts(tmp_path)[:2]
    shutil.copy(first, second)
    done = hystrip.sweep(scene, out=tmp_path)
    assert done.path.read_bytes() == expected[SCENE] and (done.solved, done.kept) == (1, 9)


@pytest.mark.parametrize("other", [SCENE, OTHER], ids=["same scene", "other scene"])
def test_a_folder_replaced_under_a_running_sweep(scene, expected, tmp_path, other):
    """The one that lost its folder says so; the one that came later has right numbers, now and when run again."""
    text = scene.read_text()
    later = []

    def replace(done, total):
        if done >= 6 and not later:
            shutil.rmtree(tmp_path / "s.parts")
            scene.write_text(other)
            later.append(hystrip.sweep(scene, out=tmp_path))

    scene.write_text(text)
    with pytest.raises(hystrip.HystripError, match="another run|removed"):
        hystrip.sweep(scene, out=tmp_path, progress=replace)
    assert later[0].path.read_bytes() == expected[other]
    again = hystrip.sweep(scene, out=tmp_path)
    assert again.path.read_bytes() == expected[other] and again.solved == 0


def test_a_folder_removed_under_a_running_sweep_is_one_sentence(scene, tmp_path):
    def remove(done, total):
        shutil.rmtree(tmp_path / "s.parts", ignore_errors=True)

    with pytest.raises(hystrip.HystripError, match="s.parts: .*removed"):
        hystrip.sweep(scene, out=tmp_path, progress=remove)


def test_parts_solved_by_other_code_are_refused(scene, tmp_path, monkeypatch):
    from hystrip.sweeps import code

    hystrip.sweep(scene, out=tmp_path)
    monkeypatch.setattr(code, "code_key", lambda: "another hystrip")
    with pytest.raises(hystrip.InputError, match="version.*--restart"):
        hystrip.sweep(scene, out=tmp_path)


def test_the_code_key_changes_with_the_generated_solver(tmp_path):
    from hystrip.sweeps.code import key_of

    package = Path(hystrip.generated.__file__).parent
    for name in ("a", "b", "c"):
        shutil.copytree(package, tmp_path / name, ignore=shutil.ignore_patterns("audit", "__pycache__"))
    solver = tmp_path / "b/standard_linear_solid.py"
    solver.write_text(solver.read_text() + "# edited\n")
    windows = tmp_path / "c/standard_linear_solid.py"
    windows.write_bytes(windows.read_bytes().replace(b"\n", b"\r\n"))
    a, b, c = (key_of(tmp_path / name) for name in "abc")
    assert a != b and a == c


class Elsewhere(Executor):
    """Workers with another version of hystrip: ``change`` is made on theirs."""

    def __init__(self, change):
        self.change = change

    def submit(self, function, task):
        future = Future()
        try:
            future.set_result(self.change(function, task))
        except Exception as error:
            future.set_exception(error)
        return future


def test_workers_with_other_code_are_refused(scene, tmp_path, monkeypatch):
    from hystrip.sweeps import batch

    def other_code(function, task):
        with monkeypatch.context() as patch:
            patch.setattr(batch, "code_key", lambda: "another hystrip")
            return function(task)

    with pytest.raises(hystrip.HystripError, match="worker.*another hystrip"):
        hystrip.sweep(scene, out=tmp_path, executor=Elsewhere(other_code))
    assert not parts(tmp_path)


def test_workers_too_old_to_say_which_code_they_run_are_refused(scene, tmp_path):
    old = Elsewhere(lambda function, task: (np.zeros((2, 9)), {}))
    with pytest.raises(hystrip.HystripError, match="worker.*another hystrip"):
        hystrip.sweep(scene, out=tmp_path, executor=old)
    assert not parts(tmp_path)


def test_a_solver_edited_while_the_sweep_runs_is_noticed(tmp_path):
    solver = tmp_path / "solver"
    package = Path(hystrip.generated.__file__).parent
    shutil.copytree(package, solver, ignore=shutil.ignore_patterns("audit", "__pycache__"))
    (solver / "__init__.py").write_text('MODELS = ("generalised",)\n')
    scene = tmp_path / "s.toml"
    scene.write_text(
        'pressure = 1e9\nvelocity = [1e-3, 2e-3, 3e-3]\nedge = "constitutive"\n[sweep]\nbatch = 1\n[material]\nmodel = "prony"\n'
        'K = 1e9\nmoduli = [1e9, 2e9]\ntimes = [1e-3, 1e-2]\nsolver = "solver"\n[[levels]]\nl = 1e-5\nh = 1e-6\n'
    )

    def edit(done, total):
        if done == 2:
            with open(solver / "generalised.py", "a") as file:
                file.write("# edited\n")

    with pytest.raises(hystrip.HystripError, match="material.solver.*changed while the sweep ran"):
        hystrip.sweep(scene, out=tmp_path, allow_solver=True, progress=edit)
    assert len(parts(tmp_path)) == 2


def test_each_part_says_whose_it_is(scene, tmp_path):
    """Which sweep, which points: inside what the checksum covers."""
    done = hystrip.sweep(scene, out=tmp_path)
    for number, part in enumerate(parts(tmp_path)):
        _, body = part.read_text().split("\n", 1)
        said = json.loads(body)
        assert (said["sweep"], said["first"], said["points"]) == (done.plan.fingerprint, 2 * number, 2)
        assert set(said["columns"]) >= {"mu", "tau [Pa]"} and all(len(values) == 2 for values in said["columns"].values())
