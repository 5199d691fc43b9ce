"""The command line, run as a person would."""

import csv
import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from scene_text import ONE_LEVEL

from hystrip.scene import load_scene

TWO_LEVELS = ONE_LEVEL + "[[levels]]\nl = 5e-7\nh = 1e-7\n"
SCENE = 'title = "two velocities"\nrtol = 1e-2\n' + TWO_LEVELS.replace("= 100", "= 5e6").replace("= 5e-3", "= [1e-3, 5e-3]")


def rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def visible(folder):
    return sorted(each.name for each in folder.iterdir() if not each.name.startswith("."))


def test_solve_writes_table_csv_and_picture(run, tmp_path):
    (tmp_path / "mine.toml").write_text(SCENE)
    status, out, err = run("solve", "mine.toml", "--out", "a/b")
    assert (status, err) == (0, "")
    assert "two velocities" in out and "level 2" in out
    assert visible(tmp_path / "a/b") == ["mine.csv", "mine.png"]
    table = rows(tmp_path / "a/b/mine.csv")
    assert [float(row["velocity [m/s]"]) for row in table] == [1e-3, 5e-3]
    result = load_scene(tmp_path / "mine.toml").solve()
    assert [float(row["mu"]) for row in table] == list(result.mu)
    for row in table:
        assert float(row["mu of level 1"]) + float(row["mu of level 2"]) == pytest.approx(float(row["mu"]), rel=1e-12)
        assert float(row["share of level 1"]) + float(row["share of level 2"]) == pytest.approx(1, rel=1e-12)


def test_solve_writes_netcdf_and_a_summary(run, tmp_path):
    xarray = pytest.importorskip("xarray")
    text = SCENE.replace("gamma = 2.5e-5", "gamma = 0")  # looking for the pull-off of every level takes a minute
    (tmp_path / "mine.toml").write_text(text)
    status, out, _ = run("solve", "mine.toml", "--netcdf", "--summary", "--no-plot")
    assert status == 0 and "share of mu" in out and "wrote hystrip-out/mine.nc" in out
    with xarray.open_dataset(tmp_path / "hystrip-out/mine.nc", engine="h5netcdf") as data:
        assert data.mu.dims == ("velocity",) and data.attrs["scene"] == text


def test_a_title_is_text_whatever_stands_in_it(run, tmp_path):
    (tmp_path / "mine.toml").write_text(SCENE.replace("two velocities", "[K=1] of [bold]x[/red] in µ"), encoding="utf-8")
    status, out, err = run("solve", "mine.toml", "--no-plot")
    assert (status, err) == (0, "") and "[K=1] of [bold]x[/red] in µ" in out


def test_a_terminal_that_lacks_a_letter(tmp_path):
    (tmp_path / "mine.toml").write_text(SCENE.replace("two velocities", "in µ"), encoding="utf-8")
    command = [sys.executable, "-m", "hystrip", "solve", "mine.toml", "--no-plot"]
    ascii_only = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, env=ascii_only)
    assert done.returncode == 0 and "in ?" in done.stdout, done.stderr


def test_a_sweep_in_which_every_point_fails_has_a_status(run, tmp_path):
    (tmp_path / "mine.toml").write_text(SCENE.replace("gamma = 2.5e-5", "gamma = 0"))
    status, out, err = run("sweep", "mine.toml", "--over", "material.T_sigma=[1.0, 2.0]")
    assert status == 1 and "4 points failed" in err and "wrote" in out


def test_sweep_of_a_scene(run, tmp_path):
    (tmp_path / "mine.toml").write_text(SCENE.replace("gamma = 2.5e-5", "gamma = [0, 1e-5]"))
    status, out, err = run("sweep", "mine.toml")
    assert (status, err) == (0, "") and out.split("\n")[0] == "4 points"
    assert len(rows(tmp_path / "hystrip-out/mine.sweep.csv")) == 4
    status, out, err = run("sweep", "mine.toml", "--netcdf", "--plot")
    assert (status, err) == (0, "") and "1 of 1 batches from before" in out and "wrote hystrip-out/mine.sweep.nc" in out
    assert "wrote hystrip-out/mine.sweep.png" in out and (tmp_path / "hystrip-out/mine.sweep.png").read_bytes()[1:4] == b"PNG"


def test_solve_and_sweep_leave_each_others_tables_alone(run, tmp_path):
    (tmp_path / "mine.toml").write_text(SCENE)
    assert run("solve", "mine.toml", "--no-plot")[0] == 0
    table = (tmp_path / "hystrip-out/mine.csv").read_bytes()
    assert run("sweep", "mine.toml", "--over", "adhesion.gamma=[0, 1e-5]")[0] == 0
    assert (tmp_path / "hystrip-out/mine.csv").read_bytes() == table and len(rows(tmp_path / "hystrip-out/mine.sweep.csv")) == 4


def test_quantities_swept_from_the_command_line(run, tmp_path):
    (tmp_path / "mine.toml").write_text(SCENE)
    over = [
        "--over",
        'material.K=["1 GPa/m", 2e9]',
        "--over",
        "levels[0].h = 1e-6, 5e-7",
        "--over",
        "velocity={start = 1e-3, stop = 5e-3, num = 3}",
    ]
    status, out, err = run("sweep", "mine.toml", *over)
    assert (status, err) == (0, "") and out.split("\n")[0] == "12 points"
    table = rows(tmp_path / "hystrip-out/mine.sweep.csv")
    assert {float(row["K [Pa/m]"]) for row in table} == {1e9, 2e9} and {float(row["h_1 [m]"]) for row in table} == {1e-6, 5e-7}


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ("material.K", "KEY=VALUES"),
        ("material.colour=3", "dotted key"),
        ("material.times[0]=1e-3", "one of levels[0].l"),
        ("material.K=1 GPa/m", "a text with its unit in quotes"),
        ("material.K=true", "a text with its unit in quotes"),
        ('material.K="1 s"', "unit of something else"),
        ("material.K=[]", "one value or more"),
        ("material.K=1e9\nvelocity=3", "a text with its unit in quotes"),
    ],
)
def test_what_cannot_be_swept_is_refused(run, tmp_path, given, says):
    (tmp_path / "mine.toml").write_text(SCENE)
    status, _, err = run("sweep", "mine.toml", "--over", given)
    assert status == 2 and says in " ".join(err.split()) and not (tmp_path / "hystrip-out").exists()


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (("velocity=1e-3", "velocity = 2e-3"), "velocity once, with all its values"),
        (("pressure=1e5, 2e5", "penetration=1e-6"), "one of the two"),
        (("adhesion.p_0=1e3", "adhesion.gamma=[0, 1e-5]", "adhesion.delta_0=1e-8"), "two of the three"),
    ],
)
def test_no_swept_quantity_takes_the_place_of_another(run, tmp_path, given, says):
    (tmp_path / "mine.toml").write_text(SCENE)
    status, _, err = run("sweep", "mine.toml", *(part for each in given for part in ("--over", each)))
    assert status == 2 and says in err and not (tmp_path / "hystrip-out").exists()


def test_solve_without_picture_and_table(run, tmp_path):
    (tmp_path / "mine.toml").write_text(SCENE)
    status, out, _ = run("solve", "mine.toml", "--no-plot", "--no-table")
    assert status == 0
    assert out.split() == ["wrote", "hystrip-out/mine.csv"]
    assert visible(tmp_path / "hystrip-out") == ["mine.csv"]


def test_no_contact_is_told(run, tmp_path):
    """mu = 0 "exact" in a table looks like a surface without friction."""
    (tmp_path / "mine.toml").write_text(SCENE.replace("= 5e6", "= -1e9"))
    status, out, _ = run("solve", "mine.toml", "--no-plot", "--no-table")
    assert status == 0 and out.startswith("note       2 points lie below pull-off: no contact, tau = 0")


def test_one_velocity_has_no_curve_to_draw(run, tmp_path):
    for velocity in ("5e-3", "[5e-3, 5e-3]"):
        (tmp_path / "one.toml").write_text(SCENE.replace("[1e-3, 5e-3]", velocity))
        assert run("solve", "one.toml")[::2] == (0, "")
        assert visible(tmp_path / "hystrip-out") == ["one.csv"]


def test_several_pressures_have_a_row_each_zero_an_empty_mu(run, tmp_path):
    (tmp_path / "some.toml").write_text(
        SCENE.replace("pressure = 5e6", "pressure = [-10, 0, 100]").replace("[[levels]]\nl = 1e-5\nh = 1e-6\n", "")
    )
    status, _, _ = run("solve", "some.toml")
    assert status == 0
    table = rows(tmp_path / "hystrip-out/some.csv")
    assert [float(row["pressure [Pa]"]) for row in table] == [-10, -10, 0, 0, 100, 100]
    assert [row["mu"] == "" for row in table] == [False, False, True, True, False, False]
    assert np.isfinite([float(row["tau [Pa]"]) for row in table]).all()


def test_the_table_has_units_in_its_headings_and_four_digits_of_every_number(run, tmp_path):
    (tmp_path / "two.toml").write_text(SCENE.replace("pressure = 5e6", "penetration = [1e-4, 2e-4]"))
    _, out, _ = run("solve", "two.toml", "--no-plot")
    cells = [[cell.strip(" ┃│") for cell in line.replace("┃", "│").split("│")[1:-1]] for line in out.splitlines()]
    heads, *table = [row for row in cells if row]
    assert heads[:3] == ["penetration [m]", "V [m/s]", "mu"] and len(table) == 4
    for row, given in zip(table, rows(tmp_path / "hystrip-out/two.csv"), strict=True):
        assert float(row[2]) == pytest.approx(float(given["mu"]), rel=5e-4) and len(row[2].lstrip("0.")) == 4
    (tmp_path / "one.toml").write_text(SCENE.replace("pressure = 5e6", "penetration = 5e-3"))
    assert "\npenetration 0.005 m, edge continuous, branch unloading\n" in run("solve", "one.toml", "--no-plot")[1]


def test_init_says_commands_that_a_shell_takes(run):
    assert "try: hystrip solve 'my scene.toml'" in run("init", "my scene.toml")[1]
    assert "now: cd 'my folder'\n" in run("init", "--example", "rubber", "my folder")[1]


def test_init_writes_a_scene_that_solves(run, tmp_path):
    status, out, _ = run("init", "mine.toml")
    assert status == 0 and "hystrip solve mine.toml" in out
    assert len(load_scene(tmp_path / "mine.toml").levels) == 2
    assert run("init", "mine.toml")[0] == 2
    assert run("init", "mine.toml", "--force")[0] == 0


def test_schema_is_json(run):
    status, out, _ = run("schema")
    assert status == 0
    assert json.loads(out)["$schema"].endswith("2020-12/schema")


@pytest.mark.parametrize("arguments", [["--help"], ["-h"], ["solve", "--help"], ["--version"]])
def test_help_and_version(run, arguments):
    status, out, err = run(*arguments)
    assert (status, err) == (0, "") and "hystrip" in out


def test_module_runs_as_a_program(tmp_path):
    done = subprocess.run([sys.executable, "-m", "hystrip", "schema"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and json.loads(done.stdout)


def test_a_reader_that_stops_reading_is_no_traceback(tmp_path):
    command = [sys.executable, "-m", "hystrip", "schema"]
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    process.stdout.close()
    assert process.stderr.read() == ""
    process.wait()


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
def test_ctrl_c_is_one_line_and_leaves_no_file(tmp_path):
    (tmp_path / "big.toml").write_text(
        SCENE.replace("pressure = 5e6", "pressure = 100").replace(
            "[1e-3, 5e-3]", '{ start = 1e-4, stop = 1e-2, num = 5000, spacing = "log" }'
        )
    )
    # what is interrupted is the solving: imports of other packages end as these like
    started = "import hystrip.commands.app; print(flush=True); from hystrip.commands.entry import main; main()"
    command = [sys.executable, "-c", started, "solve", "big.toml"]
    # A session of its own: a shell that runs tests in the background would have it ignore SIGINT.
    process = subprocess.Popen(
        command,
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    process.stdout.readline()
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (130, "", "hystrip: interrupted\n")
    assert [each.name for each in tmp_path.iterdir()] == ["big.toml"]


def test_show_draws_the_contact(run, tmp_path):
    (tmp_path / "mine.toml").write_text(SCENE.replace("= 5e6", "= 1e4").replace("gamma = 2.5e-5", "gamma = 0"))
    status, out, err = run("show", "mine.toml", "--map", "--strip", "1 um", "--velocity", "2 mm/s")
    assert (status, err) == (0, "") and "velocity 0.002 m/s" in out and "pressure 1e+04 Pa" in out
    assert visible(tmp_path / "hystrip-out") == ["mine.map.png", "mine.strip.png"]
    assert "level 1 at a mean pressure of 1e+04 Pa: " in out


@pytest.mark.parametrize("given", [("--map",), ("--strip", 0)])
def test_what_is_pulled_off_is_not_drawn(run, tmp_path, given):
    (tmp_path / "mine.toml").write_text(SCENE)
    status, out, err = run("show", "mine.toml", *given, "--pressure", -1e9)
    assert (status, out) == (2, "") and err.startswith("hystrip: --pressure: got -1000000000.0; allowed: one at which")
    assert not (tmp_path / "hystrip-out").exists()


def test_no_output_takes_the_place_of_another_of_the_same_stem(run, tmp_path):
    for folder, title in (("a", "one"), ("b", "other")):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "mine.toml").write_text(SCENE.replace("two velocities", title))
    assert run("solve", "a/mine.toml", "--no-plot")[0] == 0
    before = (tmp_path / "hystrip-out/mine.csv").read_bytes()
    status, _, err = run("solve", "b/mine.toml", "--no-plot")
    assert status == 2 and "mine.csv in it was made from ../a/mine.toml" in err
    assert (tmp_path / "hystrip-out/mine.csv").read_bytes() == before
    (tmp_path / "a/mine.toml").write_text(SCENE.replace("two velocities", "changed"))
    assert run("solve", "a/mine.toml", "--no-plot")[0] == 0  # the same scene, edited, takes its own place
    (tmp_path / "out/mine.csv").mkdir(parents=True)
    status, out, err = run("solve", "a/mine.toml", "--out", "out")
    assert status == 2 and out == "" and "mine.csv in it is a folder" in err
    head = (tmp_path / "hystrip-out/mine.csv").read_text().splitlines()[:3]
    assert head[0].startswith("# hystrip ") and head[1].startswith("# units: SI") and head[2] == "# scene: changed"


def test_no_output_takes_the_place_of_another_kinds(run, tmp_path):
    """The table of a sweep of x and that of a scene named x.sweep have one name, as the paper's figures and a scene named so."""
    for name in ("x", "x.sweep", "fig7"):
        (tmp_path / f"{name}.toml").write_text(SCENE)
    assert run("sweep", "x.toml")[0] == run("solve", "fig7.toml", "--no-plot")[0] == 0
    before = (tmp_path / "hystrip-out/x.sweep.csv").read_bytes()
    status, out, err = run("solve", "x.sweep.toml", "--no-plot")
    assert (status, out) == (2, "") and "x.sweep.csv in it was made from ../x.toml" in err
    status, out, err = run("figures", "fig7", "--out", "hystrip-out")
    assert (status, out) == (2, "") and "fig7.csv in it was made from ../fig7.toml" in err
    assert (tmp_path / "hystrip-out/x.sweep.csv").read_bytes() == before
    assert run("solve", "x.sweep.toml", "--no-plot", "--out", "other")[0] == 0
    status, out, err = run("sweep", "x.toml", "--out", "other")
    assert (status, out) == (2, "") and "x.sweep.csv in it was made from ../x.sweep.toml" in err
    assert not (tmp_path / "other/x.parts").exists()


def test_names_that_differ_in_case_alone_are_one(run, tmp_path):
    """Where a file system tells them apart too: results are copied to others."""
    for folder, name in (("a", "mine"), ("b", "Mine")):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / f"{name}.toml").write_text(SCENE)
    assert run("solve", "a/mine.toml", "--no-plot")[0] == 0
    status, out, err = run("solve", "b/Mine.toml", "--no-plot")
    assert (status, out) == (2, "")
    assert "mine.csv in it was made from ../a/mine.toml, this would be from ../b/Mine.toml, as Mine.csv" in err
    assert run("sweep", "a/mine.toml")[0] == 0
    status, out, err = run("sweep", "b/Mine.toml")
    assert (status, out) == (2, "") and "this would be from ../b/Mine.toml, as Mine.sweep.csv" in err
    assert not (tmp_path / "hystrip-out/Mine.parts").exists()
    (tmp_path / "hystrip-out/mine.csv").unlink()
    assert run("solve", "b/Mine.toml", "--no-plot")[0] == 0
    assert "mine.csv" not in json.loads((tmp_path / "hystrip-out/.origins.json").read_text())


@pytest.mark.skipif(sys.platform == "win32", reason="no such names there")
def test_a_name_of_two_lines_is_told_on_one(run, tmp_path):
    (tmp_path / "new\nwrote.toml").write_text(SCENE)
    status, out, err = run("solve", "new\nwrote.toml", "--no-plot", "--no-table")
    assert (status, err, out) == (0, "", "wrote hystrip-out/new\\nwrote.csv\n")


def test_measured_data_are_not_replaced(run, tmp_path):
    (tmp_path / "mine.toml").write_text(SCENE)
    (tmp_path / "mine.csv").write_text("f,E_stor,E_loss\n")
    status, out, err = run("solve", "mine.toml", "--out", ".", "--no-plot")
    assert (status, out) == (2, "") and "mine.csv in it was not written by" in err
    assert (tmp_path / "mine.csv").read_text() == "f,E_stor,E_loss\n"


@pytest.mark.skipif(sys.platform == "win32", reason="links need a privilege there")
def test_a_scene_reached_by_a_link_is_the_same_scene(run, tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "a/mine.toml").write_text(SCENE)
    (tmp_path / "link").symlink_to("a", target_is_directory=True)
    for way in ("a/mine.toml", tmp_path / "link/mine.toml"):
        assert run("solve", way, "--no-plot", "--out", "link/out")[::2] == (0, "")
