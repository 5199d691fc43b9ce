"""Sweeps: what is solved, how it gets to disk, and that nothing is lost when a run is killed."""

import dataclasses
import json
import os
import random
import signal
import subprocess
import sys
import threading
import time
import tomllib
import warnings
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))

import kill_sweep

import hystrip
from hystrip.scene.validate import validated
from hystrip.sweeps.executors import InProcess, _Pool, local
from hystrip.sweeps.plan import plan_of, short_name
from hystrip.sweeps.sizing import blocks, first_size, next_size

SATURATED = """
pressure = [5e6, 6e6]
velocity = { start = 1e-4, stop = 1e-2, num = 5, spacing = "log" }
[sweep]
batch = 7
[material]
K = [1e9, 1.1e9]
T_eps = 0.01
T_sigma = 1e-4
[adhesion]
gamma = [0, "25 uJ/m^2"]
delta_0 = 1e-8
[[levels]]
l = 1e-5
h = [1e-6, 5e-7]
[[levels]]
l = 5e-7
h = 1e-7
"""


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text(SATURATED)
    return path


def test_grid_is_every_combination(scene, tmp_path):
    done = hystrip.sweep(scene, out=tmp_path / "out")
    assert (done.plan.size, done.solved, done.kept, done.failed) == (80, 12, 0, {})
    assert list(done.columns)[:5] == ["h_1 [m]", "K [Pa/m]", "gamma [J/m^2]", "pressure [Pa]", "velocity [m/s]"]
    data = done.to_dataset()
    assert data.mu.dims == ("h_1", "K", "gamma", "pressure", "velocity") and data.mu_by_level.dims[0] == "level"
    one = hystrip.solve(
        hystrip.StandardLinearSolid(1.1e9, 0.01, 1e-4), hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8),
        [hystrip.Level(1e-5, 5e-7), hystrip.Level(5e-7, 1e-7)], pressure=6e6, velocity=[1e-4, 1e-2],
    )  # fmt: skip
    found = data.mu.sel(h_1=5e-7, K=1.1e9, gamma=2.5e-5, pressure=6e6).isel(velocity=[0, -1])
    assert np.array_equal(found, one.mu)
    data.to_netcdf(tmp_path / "s.nc", engine="h5netcdf")
    import xarray

    with xarray.open_dataset(tmp_path / "s.nc", engine="h5netcdf") as again:
        assert np.array_equal(again.mu, data.mu)


def test_the_table_says_what_was_not_swept(scene, tmp_path):
    scene.write_text(f"strips = 8\n{scene.read_text()}")
    lines = hystrip.sweep(scene, out=tmp_path).path.read_text().splitlines()
    (fixed,) = (line for line in lines if line.startswith("# fixed: "))
    assert "material.T_eps = 0.01, " in fixed and "levels[0].l = 1e-05, " in fixed and "material.K" not in fixed
    assert "# edge continuous, branch unloading, rtol 1e-06, level 1 over 8 equal strips" in lines  # as `hystrip solve` says


def test_what_is_beyond_the_model_is_noted_once_with_its_first_row(scene, tmp_path):
    assert hystrip.sweep(scene, out=tmp_path / "out").notes == []
    prony = SATURATED.replace("T_eps = 0.01\nT_sigma = 1e-4", 'model = "prony"\nmoduli = [1e9]\ntimes = [1e-3]')
    scene.write_text(f"""temperature = [293.15, 353.15]
{prony}
[material.shift]
model = "WLF"
C_1 = 8.86
C_2 = 101.6
T_ref = 293.15
[material.fit]
edges = [10, 1e5]
rms = [0.02]
""")
    noted = hystrip.sweep(scene, over={"levels[1].h": [1e-7, 3e-7, 4e-7]}, out=tmp_path / "noted")
    beyond, steep = noted.notes
    assert beyond.startswith("k V/2 pi goes from 10 to 2e+04 Hz, beyond the 1.95e+04 to") and beyond.endswith("(row 10)")
    assert steep == "level 2: h/l = 0.6 is above 0.3: the model takes slopes as small (row 80)"
    assert hystrip.load(noted.save(tmp_path / "noted.nc")).notes == noted.notes


def test_list_takes_values_together(scene, tmp_path):
    over = {
        "levels[0].h": [1e-6, 5e-7, 2e-7],
        "material.K": 1e9,
        "adhesion.gamma": [0, 1e-5, 2e-5],
        "pressure": 5e6,
        "velocity": [1e-4, 1e-3, 1e-2],
    }
    done = hystrip.sweep(scene, over=over, combine="list", out=tmp_path / "out")
    assert done.plan.shape == (3,) and done.columns["velocity [m/s]"].tolist() == [1e-4, 1e-3, 1e-2]
    assert done.to_dataset().mu.dims == ("point",) and not done.failed


@pytest.mark.parametrize(
    ("over", "said"),
    [
        ({"material.k": [1.0]}, "did you mean 'material.K'"),
        ({"levels[2].h": [1.0]}, "levels\\[1\\].h"),
        ({"velocity": [1.0, -1.0]}, "velocity: got -1.0"),
        ({"material.K": [0.0, 1.0]}, "material.K: got 0.0"),
        ({"pressure": [[1.0]]}, "pressure: got .*one-dimensional"),
        ({"adhesion.gamma": []}, "adhesion.gamma: got"),
        ({"adhesion.delta_0": 0.0}, "adhesion.delta_0: got 0.0; allowed: .* > 0"),
        ({"material.K": -1.0}, "material.K: got -1.0"),
        ({"material.K": 1e9, "material.T_sigma": 0.02}, "material.T_sigma: got 0.02"),
        ({"levels[0].h": 1e-6, "levels[1].l": 1.0}, "levels\\[1\\].l: got 1.0; .* the largest wave comes first"),
        ({"velocity": -1.0}, "velocity: got -1.0"),
    ],
)
def test_wrong_sweeps_are_refused_before_any_work(scene, tmp_path, over, said):
    with pytest.raises(hystrip.InputError, match=said):
        hystrip.sweep(scene, over=over, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("model", "said"),
    [
        ('model = "prony"\nmoduli = [1e9, 2e9]\ntimes = [1e-3, 1e-2]', "edge: got 'continuous'"),
        ('model = "prony"\nmoduli = [1e9, 1e9, 1e9, 1e9]\ntimes = [1, 2, 3, 4]', "edge: got 'continuous'"),
    ],
)
def test_a_material_without_a_solver_is_refused_before_any_work(scene, tmp_path, model, said):
    text = SATURATED.replace("K = [1e9, 1.1e9]", "K = 1e9").replace("T_eps = 0.01\nT_sigma = 1e-4", model)
    scene.write_text(text)
    with pytest.raises(hystrip.InputError, match=said):
        hystrip.sweep(scene, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def planned(points, text=SATURATED):
    values = validated(tomllib.loads(text.replace("batch = 7", "")))
    over = {"levels[0].h": 1e-6, "material.K": 1e9, "adhesion.gamma": 0.0, "pressure": 5e6}
    return plan_of(values, "s", text, over | {"velocity": np.geomspace(1e-4, 1e-2, points)}, None, None)


@pytest.mark.parametrize(
    ("own", "over", "kept"),
    [
        ({"gamma", "delta_0"}, {"p_0"}, {"p_0", "delta_0"}),
        ({"p_0", "delta_0"}, {"gamma"}, {"gamma", "delta_0"}),
        ({"gamma", "p_0"}, {"delta_0"}, {"gamma", "delta_0"}),
        ({"gamma", "p_0"}, {"p_0"}, {"gamma", "p_0"}),
        ({"gamma", "p_0"}, {"p_0", "delta_0"}, {"p_0", "delta_0"}),
        ({"gamma", "delta_0"}, {"gamma", "p_0"}, {"gamma", "p_0"}),
        (set(), {"gamma", "p_0"}, {"gamma", "p_0"}),
    ],
)
def test_what_is_swept_of_adhesion_takes_the_place_of_the_third(own, over, kept):
    """No third is left to contradict two that are swept; of a scene's own the stress goes first, the energy is kept."""
    two = {"gamma": 2.5e-5, "p_0": 2500.0, "delta_0": 1e-8}
    start, stop = SATURATED.index("[adhesion]"), SATURATED.index("[[levels]]")
    table = "[adhesion]\n" + "".join(f"{key} = {two[key]}\n" for key in own) if own else ""
    text = (SATURATED[:start] + table + SATURATED[stop:]).replace("batch = 7", "")
    plan = plan_of(
        validated(tomllib.loads(text)), "s", text, {f"adhesion.{key}": [two[key], 2 * two[key]] for key in over}, None, None
    )
    assert {key for key, each in plan.base["adhesion"].items() if each is not None} == kept


@pytest.mark.parametrize("cost", [lambda n: 1e-4 * n, lambda n: 0.3 * n, lambda n: 0.1 * n**0.57, lambda n: 1.0 + 1e-3 * n])
def test_batches_take_a_few_seconds_whatever_a_point_costs(cost):
    plan = planned(10_000)
    size, sizes = first_size(plan), []
    for _ in range(12):
        sizes.append(size)
        size = next_size(plan, size, cost(size))
    settled = [cost(size) for size in sizes[6:]]
    assert max(settled) < 12 and (min(settled) > 1.5 or min(sizes[6:]) > plan.size)
    assert all(later <= 4 * earlier for earlier, later in zip(sizes, sizes[1:], strict=False))


@pytest.mark.parametrize("points", [2, 33, 1000, 100_000])
def test_blocks_hold_every_point_once(points):
    plan = planned(points)
    assert [point for block in blocks(plan) for point in block] == list(range(points))
    assert len(list(blocks(plan))) <= 64


def test_a_material_for_each_point_begins_with_few_of_them():
    values = validated(tomllib.loads(SATURATED.replace("batch = 7", "")))
    many = {"velocity": 1e-3, "pressure": 5e6, "material.K": np.geomspace(1e9, 2e9, 1000)}
    assert first_size(plan_of(values, "s", SATURATED, many, None, None)) == 4 < first_size(planned(1000)) == 32


def test_nothing_to_sweep_and_unequal_lists(scene, tmp_path):
    with pytest.raises(hystrip.InputError, match="lengths differ"):
        hystrip.sweep(scene, combine="list", out=tmp_path / "out")
    singles = {"levels[0].h": 1e-6, "material.K": 1e9, "adhesion.gamma": 0.0, "pressure": 5e6, "velocity": 1e-3}
    with pytest.raises(hystrip.InputError, match="nothing is swept"):
        hystrip.sweep(scene, over=singles, out=tmp_path / "out")
    assert short_name("levels[1].h") == "h_2" and short_name("material.K") == "K"


def test_a_failed_point_is_recorded_and_the_rest_goes_on(scene, tmp_path):
    done = hystrip.sweep(scene, over={"material.T_sigma": [1e-4, 0.02, 1e-3]}, out=tmp_path / "out")
    bad = done.columns["T_sigma [s]"] == 0.02
    assert np.array_equal(np.isnan(done.columns["mu"]), bad) and len(done.failed) == bad.sum() == 80
    assert all("material.T_sigma: got 0.02" in reason for reason in done.failed.values())
    assert "T_sigma: got 0.02" in done.path.read_text()


def test_an_error_nobody_thought_of_costs_its_point_alone(scene, tmp_path, monkeypatch):
    def fragile(*inputs, velocity, **options):
        if np.any(velocity == 1e-2):
            raise ValueError("nobody thought of this")
        return solve(*inputs, velocity=velocity, **options)

    solve = hystrip.solve
    monkeypatch.setattr(hystrip, "solve", fragile)
    done = hystrip.sweep(scene, out=tmp_path / "out")
    assert set(done.failed.values()) == {"ValueError: nobody thought of this"} and len(done.failed) == 16
    assert np.array_equal(np.isnan(done.columns["mu"]), done.columns["velocity [m/s]"] == 1e-2)


def test_points_that_did_not_converge_are_kept_marked_and_said_once(scene, tmp_path, monkeypatch):
    def half(*inputs, velocity, **options):
        result = solve(*inputs, velocity=velocity, **options)
        warnings.warn("some", hystrip.ConvergenceWarning, stacklevel=2)
        return dataclasses.replace(result, converged=np.broadcast_to(velocity < 1e-2, result.mu.shape))

    solve = hystrip.solve
    monkeypatch.setattr(hystrip, "solve", half)
    with pytest.warns(hystrip.ConvergenceWarning, match="16 of 80 points") as said:
        done = hystrip.sweep(scene, out=tmp_path / "out")
    assert len(said) == 1 and np.array_equal(done.columns["converged"] == 0, done.columns["velocity [m/s]"] == 1e-2)
    assert done.to_dataset().converged.sum() == 64 and not done.failed


def test_lost_workers_are_one_sentence_and_finished_batches_are_kept(scene, tmp_path, monkeypatch):
    class Dying(InProcess):
        def submit(self, function, task):
            if task.first < 3 * 7:
                return super().submit(function, task)
            future = Future()
            future.cancel()
            future.set_running_or_notify_cancel()
            return future

    with pytest.raises(hystrip.HystripError, match="finished batches are kept: run the sweep again"):
        hystrip.sweep(scene, out=tmp_path / "out", executor=Dying())
    assert hystrip.sweep(scene, out=tmp_path / "out").kept == 3
    with pytest.raises(hystrip.InputError, match="executor: got 4; allowed: .*concurrent.futures"):
        hystrip.sweep(scene, out=tmp_path / "out", executor=4)


def test_a_run_that_ends_early_leaves_the_futures_of_local_processes_to_their_own_thread(scene, tmp_path):
    """A future of a process pool that two threads cancel and fail ends one of them with a traceback."""
    held = []

    class Waiting(Executor):
        def submit(self, function, task):
            held.append(Future())
            if len(held) == 3:
                held[0].set_exception(RuntimeError("ended"))
            return held[-1]

    class Local(Waiting, _Pool):
        pass

    for executor, cancelled in ((Waiting(), True), (Local(1), False)):
        held.clear()
        with pytest.raises(RuntimeError, match="ended"):
            hystrip.sweep(scene, out=tmp_path / "out", executor=executor)
        assert [future.cancelled() for future in held[1:]] == [cancelled] * (len(held) - 1) and len(held) > 2


@pytest.mark.parametrize("at_work", [False, True])
def test_local_processes_given_up_leave_no_thread_behind(at_work):
    """The interpreter ends with a traceback where it finds the pool's thread half-way through closing."""
    before = set(threading.enumerate())
    with pytest.raises(RuntimeError, match="ended"), local(2) as (executor, _):
        if at_work:
            executor.submit(os.getpid).result()
        futures = [executor.submit(time.sleep, 60) for _ in range(8)]
        raise RuntimeError("ended")
    assert set(threading.enumerate()) == before and all(future.done() for future in futures)


def test_batches_and_executors_give_the_same_bytes(scene, tmp_path):
    # of a calculation numbers are NumPy's
    first = hystrip.sweep(scene, out=tmp_path / "a", workers=np.int64(1), batch=np.int64(20)).path.read_bytes()
    with ThreadPoolExecutor(2) as threads:
        assert hystrip.sweep(scene, out=tmp_path / "b", executor=threads).path.read_bytes() == first
    assert hystrip.sweep(scene, out=tmp_path / "c", workers=2).path.read_bytes() == first


def test_finished_batches_are_kept_and_damaged_ones_solved_again(scene, tmp_path):
    first = hystrip.sweep(scene, out=tmp_path / "out").path.read_bytes()
    parts = sorted((tmp_path / "out/s.parts").glob("part-*"))
    parts[3].unlink()
    parts[5].write_bytes(parts[5].read_bytes()[:-20])
    parts[6].write_bytes(b"")
    parts[7].write_bytes(b"\xff" * 100)
    done = hystrip.sweep(scene, out=tmp_path / "out")
    assert (done.solved, done.kept) == (4, 8) and done.path.read_bytes() == first
    with pytest.raises(hystrip.InputError, match="--restart"):
        hystrip.sweep(scene, over={"material.K": [2e9]}, out=tmp_path / "out")
    assert hystrip.sweep(scene, over={"material.K": [2e9]}, out=tmp_path / "out", restart=True).kept == 0


def test_in_python_arguments_have_no_names_of_options(scene, tmp_path):
    (tmp_path / "file").touch()
    for wrong in (b"out", tmp_path / "file", ""):
        with pytest.raises(hystrip.InputError, match="^out: got "):
            hystrip.sweep(scene, out=wrong)
    (tmp_path / "s.sweep.csv").write_text("measured, by hand")
    with pytest.raises(hystrip.InputError, match="^out: got .*another folder: s.sweep.csv"):
        hystrip.sweep(scene, out=tmp_path)
    hystrip.sweep(scene, out=tmp_path / "out")
    with pytest.raises(hystrip.InputError, match="^out: got .*restart=True"):
        hystrip.sweep(scene, over={"material.K": [2e9]}, out=tmp_path / "out")


@pytest.mark.parametrize("given", [{"batch": 0}, {"combine": "both"}])
def test_arguments_are_none_of_the_scene(scene, tmp_path, given):
    with pytest.raises(hystrip.InputError, match=f"^{next(iter(given))}: got "):
        hystrip.sweep(scene, out=tmp_path / "out", **given)


def test_partial_contact_batches_do_not_depend_on_what_was_solved_before(tmp_path):
    path = tmp_path / "p.toml"
    path.write_text(
        "pressure = [100, 200]\nvelocity = [4e-3, 5e-3]\nrtol = 1e-2\n[sweep]\nbatch = 3\n"
        "[material]\nK = 1e9\nT_eps = 0.01\nT_sigma = 1e-4\n"
        "[[levels]]\nl = 5e-7\nh = 1e-7\n"
    )
    first = hystrip.sweep(path, out=tmp_path / "out").path.read_bytes()
    (tmp_path / "out/p.parts/part-000000003.json").unlink()
    assert hystrip.sweep(path, out=tmp_path / "out").path.read_bytes() == first


def test_batches_sized_by_their_work_do_not_depend_on_what_was_solved_before(tmp_path):
    path = tmp_path / "p.toml"
    path.write_text(
        "penetration = 5e-8\nvelocity = { start = 1e-4, stop = 1e-2, num = 1000 }\nrtol = 1e-2\n"
        "[material]\nK = 1e9\nT_eps = 0.01\nT_sigma = 1e-4\n[[levels]]\nl = 5e-7\nh = 1e-7\n"
    )
    first = hystrip.sweep(path, out=tmp_path / "out")
    parts = sorted((tmp_path / "out/p.parts").glob("part-*.json"))
    assert [part.name for part in parts[:3]] == ["part-000000000.json", "part-000000128.json", "part-000000512.json"]
    for part in (parts[1], parts[-1]):
        part.unlink()
    with ThreadPoolExecutor(2) as threads:
        again = hystrip.sweep(path, out=tmp_path / "out", executor=threads)
    assert again.path.read_bytes() == first.path.read_bytes() and (again.solved, again.kept) == (2, len(parts) - 2)


def many(folder, points=3000):
    text = SATURATED.replace("num = 5", f"num = {points // 16}").replace("batch = 7", "batch = 10")
    (folder / "many.toml").write_text(text)


def started(folder, *options):
    command = [sys.executable, "-m", "hystrip", "sweep", "many.toml", *options]
    # a shell that runs tests in the background would have it ignore SIGINT
    listening = {"preexec_fn": lambda: signal.signal(signal.SIGINT, signal.default_int_handler), "start_new_session": True}
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **listening)


def parts_in(folder):
    return len(list(folder.glob("hystrip-out/many.parts/part-*.json")))


def wait_for_parts(folder, number, process):
    end = time.monotonic() + 120
    while parts_in(folder) < number and process.poll() is None and time.monotonic() < end:
        time.sleep(0.002)


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGKILL")
def test_killed_five_times_the_final_file_is_the_same(tmp_path):
    """With one worker or two, which solve one after another what the others have left."""
    many(tmp_path, 1600)
    left_alone = hystrip.sweep(tmp_path / "many.toml", out=tmp_path / "whole").path.read_bytes()
    chance, before = random.Random(1), 0
    for workers in (1, 2, 1, 1, 2):
        process = started(tmp_path, "--workers", str(workers))
        wait_for_parts(tmp_path, before + chance.randrange(1, 25), process)
        time.sleep(chance.random() * 0.02)
        process.kill()  # the parent alone: its workers have to notice
        process.communicate(timeout=60)
        assert process.returncode == -signal.SIGKILL
        assert parts_in(tmp_path) >= before and not (tmp_path / "hystrip-out/many.sweep.csv").exists()
        before = parts_in(tmp_path)
    assert 5 <= before < 160
    stamps = {path: path.stat().st_mtime_ns for path in (tmp_path / "hystrip-out/many.parts").glob("part-*.json")}
    last = started(tmp_path)
    out, err = last.communicate(timeout=300)
    assert last.returncode == 0 and f"{before} of 160 batches from before" in out, err
    assert {path: path.stat().st_mtime_ns for path in stamps} == stamps
    assert (tmp_path / "hystrip-out/many.sweep.csv").read_bytes() == left_alone


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
@pytest.mark.parametrize("workers", [1, 2])
def test_ctrl_c_ends_cleanly(tmp_path, workers):
    many(tmp_path)
    process = started(tmp_path, "--workers", str(workers))
    wait_for_parts(tmp_path, 20, process)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: parent and workers
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130 and out == ""
    assert err.splitlines() == ["hystrip: finished batches are kept; the same command goes on from there", "hystrip: interrupted"]
    assert not list(tmp_path.glob("hystrip-out/many.parts/*.tmp")) and not (tmp_path / "hystrip-out/many.sweep.csv").exists()


def test_two_runs_at_once_are_refused(scene, tmp_path):
    def again(done, total):
        with pytest.raises(hystrip.HystripError, match="another run"):
            hystrip.sweep(scene, out=tmp_path / "out")

    hystrip.sweep(scene, out=tmp_path / "out", progress=again)


def test_schema_knows_the_sweep_table():
    from hystrip.scene.schema import json_schema

    assert set(json.loads(json.dumps(json_schema()))["$defs"]["Sweep"]["properties"]) == {"combine", "batch"}


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGKILL")
def test_killed_in_partial_contact_csv_and_netcdf_are_the_same(tmp_path):
    """The short version of ``tools/kill_sweep.py``. (Killed again and again: above.)"""
    assert kill_sweep.compare(tmp_path / "given", points=100, kills=1, workers=2, batch=5, seed=5, say=lambda text: None) == []
