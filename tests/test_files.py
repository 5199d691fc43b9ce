"""Sets of output files: all of them, or none."""

import pytest

from hystrip.files import Outputs, write_text


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
