"""What reaches the terminal: no escape sequences, no noise after a signal, files named when the disk is full, progress lines."""

import errno
import os
import signal
import subprocess
import sys
import time

import pytest
from scene_text import ONE_LEVEL

from hystrip.commands import entry, progress
from hystrip.scene import parse_scene
from hystrip.scene.edit import with_material, with_settings

STEERING = "\\u001b[31mred\\u001b]0;owned\\u0007\\u009b2J\\u202e"
SATURATED = ONE_LEVEL.replace("pressure = 100", "pressure = 5e6\nrtol = 1e-2").replace("gamma = 2.5e-5", "gamma = 0")


def steers(text):
    return any(not each.isprintable() for each in text if each != "\n")


@pytest.mark.parametrize("command", ["solve", "sweep"])
def test_a_title_does_not_steer_the_terminal(run, tmp_path, command):
    text = SATURATED.replace("velocity = 5e-3", "velocity = [5e-3, 6e-3]")
    (tmp_path / "mine.toml").write_text(f'title = "{STEERING}"\n{text}', encoding="utf-8")
    status, out, err = run(command, "mine.toml", *(["--summary", "--no-plot"] if command == "solve" else []))
    assert status == 0 and not steers(out) and not steers(err)
    assert command == "sweep" or "\\x1b[31mred" in out


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("K = 1e9", f'"{STEERING}" = 1e9'),
        ("K = 1e9", f'"K{STEERING}"\n'),
        ("K = 1e9", f'K = "1 {STEERING}"'),
        ("K = 1e9", f'K = 1e9\nmodel = "{STEERING}"'),
        ("[material]", f'["{STEERING}"]'),
        ("velocity = 5e-3", f'velocity = {{"{STEERING}" = 1}}'),
    ],
)
def test_a_key_does_not_steer_the_terminal(run, tmp_path, old, new):
    (tmp_path / "mine.toml").write_text(ONE_LEVEL.replace(old, new), encoding="utf-8")
    status, out, err = run("solve", "mine.toml")
    assert status == 2 and not steers(out) and not steers(err)


def test_the_name_of_a_file_does_not_steer_the_terminal(run, tmp_path):
    name = "a\x1b[31m\u202e"
    (tmp_path / f"{name}.toml").write_text(SATURATED, encoding="utf-8")
    for arguments in (["solve", f"{name}.toml"], ["solve", name], ["init", f"{name}.toml"], ["fit", f"{name}.toml"]):
        status, out, err = run(*arguments)
        assert not steers(out) and not steers(err)


@pytest.mark.skipif(sys.platform != "linux", reason="a name that is no text")
def test_the_name_of_a_file_need_not_be_text(run, tmp_path):
    name = os.fsdecode(b"sc\xe8ne.toml")
    (tmp_path / name).write_text(SATURATED, encoding="utf-8")
    for command in (["solve", "--no-plot"], ["sweep", "--over", "velocity=[1e-3, 2e-3]"]):
        status, out, err = run(*command, name)
        assert (status, err) == (0, "") and "sc\\udce8ne" in out
    for path in (tmp_path / "hystrip-out").glob("*.csv"):
        assert "# scene: sc\\udce8ne" in path.read_text(encoding="utf-8")
    text = with_settings(with_material(ONE_LEVEL, {"material": {"K": 1e9, "T_eps": 1, "T_sigma": 0}}, name), {"title": name})
    assert parse_scene(text.encode().decode()).title == "sc\\udce8ne.toml" and "# sc\\udce8ne.toml\n[material]" in text


def test_no_number_is_cut_short_in_a_narrow_terminal(run, tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("NO_COLOR", "1")
    (tmp_path / "mine.toml").write_text(SATURATED.replace("= 5e-3", "= 1.23456e-5") + "[[levels]]\nl = 5e-7\nh = 1e-7\n")
    status, out, err = run("solve", "mine.toml", "--no-plot")
    assert (status, err) == (0, "") and "…" not in out
    cells = [line.split("│") for line in out.splitlines() if line.startswith("│")]
    assert "".join(row[1].strip() for row in cells) == "1.235e-05"


@pytest.mark.skipif(sys.platform == "win32", reason="closes a standard stream in a shell")
def test_no_standard_output_is_no_failure(tmp_path):
    (tmp_path / "mine.toml").write_text(SATURATED)
    command = f"{sys.executable} -m hystrip solve mine.toml >&-"
    done = subprocess.run(command, shell=True, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    assert (done.returncode, done.stderr) == (0, "") and (tmp_path / "hystrip-out/mine.csv").is_file()


@pytest.mark.skipif(sys.platform == "win32", reason="closes a standard stream in a shell")
def test_no_standard_error_is_no_failure(tmp_path):
    (tmp_path / "mine.toml").write_text(SATURATED)
    command = f"{sys.executable} -m hystrip solve mine.toml --no-plot --no-table 2>&-"
    done = subprocess.run(command, shell=True, cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    assert (done.returncode, done.stdout.split()) == (0, ["wrote", "hystrip-out/mine.csv"])


def test_the_progress_bar_shows_a_title_as_text(monkeypatch, capsys):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    with progress.progress("\x1b[31mred") as report:
        report(1, 2)
    assert "\x1b[31mred" not in capsys.readouterr().err


LINES = [  # seconds from the start at which a report comes, and the lines said by then
    (0.0, 0),
    (4.0, 0),
    (6.0, 1),
    (8.0, 1),
    (17.0, 2),
    (18.0, 2),
    (60.0, 3),
]


def test_long_work_speaks_where_there_is_no_terminal(monkeypatch, capsys):
    now = [0.0]
    monkeypatch.setattr(progress, "monotonic", lambda: now[0])
    said = ""
    with progress.progress("sweeping") as report:
        for done, (seconds, lines) in enumerate(LINES):
            now[0] = seconds
            report(done, 7)
            said += capsys.readouterr().err
            assert said.count("\n") == lines
    assert said.splitlines()[0] == "hystrip: sweeping: 2 of 7, after 6 s"


INTERRUPTING = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
class Interrupting:
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            sys.meta_path.remove(self)
            signal.raise_signal({signal})
sys.meta_path.insert(0, Interrupting())
sys.argv = ["hystrip", "solve", "paper_fig7", "--no-plot"]
from hystrip.commands.entry import main
main()
"""


@pytest.mark.parametrize("module", ["numpy", "typer", "msgspec", "hystrip.multilevel", "rich.table"])
@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM"])
def test_a_signal_at_any_time_ends_without_noise(module, number, tmp_path):
    if number == "SIGTERM" and sys.platform == "win32":
        pytest.skip("no such signal")
    code = INTERRUPTING.format(module=module, signal=int(getattr(signal, number)))
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    status, said = {"SIGINT": (130, "interrupted"), "SIGTERM": (143, "terminated")}[number]
    assert (done.returncode, done.stderr) == (status, f"hystrip: {said}\n")


SWEEP = """
penetration = { start = 1e-8, stop = 6e-8, num = 10 }
velocity = { start = 1e-4, stop = 1e-2, num = 400, spacing = "log" }
rtol = 1e-2
[sweep]
batch = 10
[material]
K = 1e9
T_eps = 0.01
T_sigma = 1e-4
[[levels]]
l = 5e-7
h = 1e-7
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
@pytest.mark.parametrize(
    ("number", "group", "early"),
    [("SIGTERM", True, True), ("SIGTERM", False, True), ("SIGTERM", False, False), ("SIGINT", True, True)],
    ids=["SIGTERM to all as workers start", "SIGTERM as workers start", "SIGTERM at work", "SIGINT to all as workers start"],
)
def test_signals_with_workers_end_without_noise(tmp_path, number, group, early):
    (tmp_path / "many.toml").write_text(SWEEP)
    process = subprocess.Popen(
        [sys.executable, "-m", "hystrip", "sweep", "many.toml", "--workers", "2"],
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )  # fmt: skip
    end = time.monotonic() + 120
    first = tmp_path / "hystrip-out/many.parts" / ("plan.json" if early else "part-000000010.json")
    while not first.exists() and process.poll() is None and time.monotonic() < end:
        time.sleep(0.005)
    (os.killpg if group else os.kill)(process.pid, getattr(signal, number))
    out, err = process.communicate(timeout=60)
    status, said = {"SIGINT": (130, "interrupted"), "SIGTERM": (143, "terminated")}[number]
    kept = "hystrip: finished batches are kept; the same command goes on from there"
    lines = [line for line in err.splitlines() if "sweeping: " not in line]
    assert (process.returncode, out, lines) == (status, "", [kept, f"hystrip: {said}"])


def limited(*arguments, folder):
    """A run that can write no file of more than 150 bytes."""
    import resource

    command = [sys.executable, "-m", "hystrip", *arguments]
    limit = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (150, 150))}
    unwritten = {"PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=120, env={**os.environ, **unwritten}, **limit
    )


@pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (["solve", "mine.toml", "--no-plot"], "hystrip-out/mine.csv"),
        (["sweep", "mine.toml"], "hystrip-out/mine.parts/plan.json"),
        (["init", "new.toml"], "new.toml"),
    ],
)
def test_a_file_that_cannot_be_written_whole_is_named(tmp_path, arguments, name):
    (tmp_path / "mine.toml").write_text(SATURATED.replace("velocity = 5e-3", "velocity = [5e-3, 6e-3]"))
    done = limited(*arguments, folder=tmp_path)
    assert done.returncode == 1 and done.stderr == f"hystrip: {name}: {os.strerror(errno.EFBIG)}\n"
    left = {path.name for path in tmp_path.rglob("*")} - {"mine.toml", "hystrip-out", "mine.parts", "lock"}
    assert not left


def test_a_full_disk_names_the_file(run, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    (tmp_path / "mine.toml").write_text(SATURATED)
    monkeypatch.setattr(os, "fsync", full)
    status, _, err = run("solve", "mine.toml", "--no-plot", "--no-table")
    assert status == 1 and err == "hystrip: hystrip-out/mine.csv: No space left on device\n"
    assert [path.name for path in tmp_path.iterdir()] == ["mine.toml"]
    assert entry.FAILED == 1
