"""The text gate: what is checked in is what the derivation emits, byte by byte."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from derived_once import audited, audited_with, derivations, emitted

from hystrip.derivation import MODELS, check, generated_folder
from hystrip.derivation.drift import compare
from hystrip.derivation.folder import CERTIFICATES, MEASURED, write_files

pytestmark = pytest.mark.xdist_group("derivation")

NAMES = [model.name for model in MODELS]
FILES = ("__init__.py", "stable.py", "modes.py", *(f"{name}.py" for name in NAMES))
PAGES = ("audit/index.html", *(f"audit/{name}.{kind}" for name in NAMES for kind in ("html", "json")))


def drift(folder: Path):
    return compare(folder, {**emitted(), **audited()}, derivations())


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    return Path(shutil.copytree(generated_folder(), tmp_path / "generated", ignore=shutil.ignore_patterns("__pycache__")))


def test_the_emitted_files_are_those_tested_here() -> None:
    assert sorted(emitted()) == sorted(FILES)
    assert sorted(audited()) == sorted(PAGES)


@pytest.mark.parametrize("name", [*FILES, *PAGES])
def test_checked_in_file_is_what_the_derivation_emits(name: str) -> None:
    found = [record for record in drift(generated_folder()) if record.path == name]
    assert not found, "\n".join(map(str, found))


def test_nothing_is_missing_or_stray() -> None:
    assert not drift(generated_folder())


@pytest.mark.parametrize("name", [*FILES, *PAGES])
def test_one_deleted_character_is_drift(copy: Path, name: str) -> None:
    text = (copy / name).read_text(encoding="utf-8")
    place = next(text.index(mark) for mark in ("import numpy", "MODELS", "Derived", "sha256") if mark in text)
    (copy / name).write_text(text[:place] + text[place + 1 :], encoding="utf-8")
    (record,) = drift(copy)
    assert (record.kind, record.path) == ("different", name)
    assert f"--- generated/{name}" in record.diff and f"+++ regenerated/{name}" in record.diff


def test_a_changed_line_ending_is_drift(copy: Path) -> None:
    content = (copy / FILES[1]).read_bytes()
    (copy / FILES[1]).write_bytes(content.replace(b"\n", b"\r\n"))
    assert [record.kind for record in drift(copy)] == ["different"]


@pytest.mark.parametrize("name", [*FILES, *PAGES, CERTIFICATES, MEASURED])
def test_a_missing_file_is_drift(copy: Path, name: str) -> None:
    (copy / name).unlink()
    (record,) = drift(copy)
    assert (record.kind, record.path) == ("missing", name)
    assert record.diff


@pytest.mark.parametrize("name", ["old_model.py", "notes.txt", "audit/old_model.html"])
def test_a_stray_file_is_drift(copy: Path, name: str) -> None:
    (copy / name).parent.mkdir(exist_ok=True)
    (copy / name).write_text("left over\n", encoding="utf-8")
    (record,) = drift(copy)
    assert (record.kind, record.path) == ("stray", name)
    assert "-left over" in record.diff


def test_a_certificate_for_another_solver_is_drift(copy: Path) -> None:
    stored = json.loads((copy / CERTIFICATES).read_text(encoding="utf-8"))
    stored["hash"] = "0" * len(stored["hash"])
    del stored["models"]["standard_linear_solid"]["functions"]["gap_after"]
    (copy / CERTIFICATES).write_text(json.dumps(stored), encoding="utf-8")
    (record,) = drift(copy)
    added = " ".join(line for line in record.diff.splitlines() if line.startswith("+"))
    assert record.path == CERTIFICATES and "gap_after" in added and "hash" in added


NO_FIGURES = (1, {"generalised": 1}, {"generalised": {"functions": 1}}, {"generalised": {"functions": {"gap_after": {}}}})


@pytest.mark.parametrize("name", [CERTIFICATES, MEASURED])
@pytest.mark.parametrize("text", ["{", "[1]", *(json.dumps({"models": each}) for each in NO_FIGURES)])
def test_certificates_and_figures_that_are_none_are_drift(copy: Path, monkeypatch: pytest.MonkeyPatch, name: str, text: str):
    monkeypatch.setattr("hystrip.derivation.drift.derivations_of", lambda *_: derivations())
    monkeypatch.setattr("hystrip.derivation.drift.emit", lambda _: dict(emitted()))
    # most come down to no figures at all, whose pages are made once
    monkeypatch.setattr("hystrip.derivation.drift.audit_texts", lambda made, texts, *figures: audited_with(*figures))
    (copy / name).write_text(text, encoding="utf-8")
    assert name in {record.path for record in check(copy)}


def test_writing_leaves_the_old_file_if_it_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a.py").write_text("old", encoding="utf-8")

    def refuse(source: str, target: str) -> None:
        raise OSError("no")

    with monkeypatch.context() as patch:
        patch.setattr("os.replace", refuse)
        with pytest.raises(OSError, match="no"):
            write_files(tmp_path, {"a.py": "new"})
    assert (tmp_path / "a.py").read_text(encoding="utf-8") == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["a.py"]
