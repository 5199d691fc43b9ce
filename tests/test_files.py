"""Sets of output files: all of them, or none."""

import json
import os
import re
import subprocess
import sys
import threading

import pytest

from hystrip.errors import InputError
from hystrip.files import Outputs, refuse_unwritable, write_text
from hystrip.origins import outputs_from


def filled(folder, *names):
    with Outputs(folder) as files:
        for name in names:
            files.path(name).write_text(name)


def test_all_appear_and_replace_what_was_there(tmp_path):
    write_text(tmp_path / "new" / "a.csv", "old")
    filled(tmp_path / "new", "a.csv", "b.png")
    assert {path.name: path.read_text() for path in (tmp_path / "new").iterdir()} == {"a.csv": "a.csv", "b.png": "b.png"}


def test_a_folder_in_the_place_of_one_file_keeps_all_away(tmp_path):
    (tmp_path / "b.png").mkdir()
    with pytest.raises(IsADirectoryError, match="b.png"):
        filled(tmp_path, "a.csv", "b.png")
    assert [path.name for path in tmp_path.iterdir()] == ["b.png"]


@pytest.mark.skipif(sys.platform == "win32", reason="makes a pipe with a name")
def test_a_pipe_or_a_device_is_not_replaced(run, tmp_path):
    os.mkfifo(tmp_path / "scene.toml")
    with pytest.raises(OSError, match=r"a pipe or a device stands where the file would go: .*scene.toml"):
        filled(tmp_path, "a.csv", "scene.toml")
    status, out, err = run("init", "--force")
    assert (status, out) == (1, "") and err.startswith("hystrip: scene.toml: a pipe or a device")
    assert [path.name for path in tmp_path.iterdir()] == ["scene.toml"] and (tmp_path / "scene.toml").is_fifo()


@pytest.mark.skipif(sys.platform == "win32", reason="makes a link")
def test_a_link_to_nothing_is_not_replaced_without_force(run, tmp_path):
    (tmp_path / "scene.toml").symlink_to("nowhere")
    assert run("init")[0] == run("init", "--example", "rubber", ".")[0] == 2
    assert [path.name for path in tmp_path.iterdir()] == ["scene.toml"] and (tmp_path / "scene.toml").is_symlink()


def test_an_error_leaves_neither_files_nor_the_folders_made_for_them(tmp_path):
    with pytest.raises(KeyError), Outputs(tmp_path / "one" / "two") as files:
        files.path("a.csv").write_text("half")
        raise KeyError
    assert not list(tmp_path.iterdir())


def test_an_error_leaves_what_another_run_has_put_into_the_same_new_folder(tmp_path):
    with pytest.raises(KeyError), Outputs(tmp_path / "shared") as files:
        files.path("mine.csv").write_text("half")
        filled(tmp_path / "shared", "theirs.csv")
        raise KeyError
    assert [path.name for path in (tmp_path / "shared").iterdir()] == ["theirs.csv"]


def test_what_a_killed_run_left_aside_is_removed(tmp_path):
    """Of a process that is gone, or of a day ago; not of one that runs."""
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    code = "import os; from hystrip.files import Outputs\nwith Outputs('.') as f: f.path('a.csv').write_text('x'); os._exit(1)"
    subprocess.run([sys.executable, "-c", code], cwd=tmp_path)
    (left,) = tmp_path.iterdir()
    mine = tmp_path / left.name.replace(f"-{re.search('-([0-9]+).part', left.name)[1]}.", f"-{os.getppid()}.")
    other = tmp_path / ".elsewhere-1.part.a.csv"
    old = tmp_path / ".elsewhere-2.part.a.csv"
    foreign = tmp_path / f".{left.name[1:].rpartition('.part.')[0]}.part.b.csv"
    for path in (mine, other, old, foreign):
        path.write_text("half")
    os.utime(old, (0, 0))
    filled(tmp_path, "a.csv")
    assert {path.name for path in tmp_path.iterdir()} == {"a.csv", mine.name, other.name, foreign.name}


def test_files_are_on_the_disk_before_they_get_their_names(tmp_path, monkeypatch):
    done = []
    monkeypatch.setattr(os, "fsync", lambda file: done.append("sync"))
    replace = os.replace
    monkeypatch.setattr(os, "replace", lambda part, final: (done.append("rename"), replace(part, final)))
    filled(tmp_path, "a.csv", "b.csv")
    assert done == ["sync", "sync", "rename", "rename"]


def test_runs_into_one_folder_at_once_all_note_what_their_files_are_made_from(tmp_path):
    together = threading.Barrier(8)

    def run(source):
        with outputs_from(source, tmp_path, [f"{source}.csv"]) as files:
            files.path(f"{source}.csv").write_text("# hystrip")
            together.wait()

    runs = [threading.Thread(target=run, args=(name,)) for name in "abcdefgh"]
    for each in runs:
        each.start()
    for each in runs:
        each.join()
    assert json.loads((tmp_path / ".origins.json").read_text()) == {f"{name}.csv": name for name in "abcdefgh"}


def test_of_two_runs_at_once_for_files_of_one_name_the_second_is_refused(tmp_path):
    with pytest.raises(InputError, match="made from second, this would be from first"):
        with outputs_from("first", tmp_path, ["a.csv"]) as files:
            with outputs_from("second", tmp_path, ["a.csv"]) as others:
                others.path("a.csv").write_text("# hystrip of the second")
            files.path("a.csv").write_text("# hystrip of the first")
    assert (tmp_path / "a.csv").read_text() == "# hystrip of the second"
    assert sorted(path.name for path in tmp_path.iterdir() if ".part." in path.name) == []


def test_files_are_written_where_no_lock_can_be_had(tmp_path):
    (tmp_path / ".origins.lock").mkdir()
    with outputs_from("a", tmp_path, ["a.csv"]) as files:
        files.path("a.csv").write_text("# hystrip")
    assert json.loads((tmp_path / ".origins.json").read_text()) == {"a.csv": "a"}


@pytest.mark.skipif(not os.path.isdir("/proc/self"), reason="no folder here that its permissions alone make writable")
def test_a_folder_that_only_its_permissions_make_writable_is_refused():
    with pytest.raises(InputError, match="/proc cannot"):
        refuse_unwritable("/proc/x", "--out")
