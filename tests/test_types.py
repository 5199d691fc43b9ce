"""mypy (strict) and pyright find nothing in a script that uses every public name, and every mistake in another."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

import hystrip

ROOT = Path(__file__).resolve().parent.parent
SCRIPTS = Path(__file__).resolve().parent / "typed"
LINE = re.compile(r"wrong\.py:(\d+): error")


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The package laid out as an installed one: checkers do not see through an editable install."""
    package = tmp_path_factory.mktemp("site") / "hystrip"
    package.mkdir()
    for path in (ROOT / "runtime").iterdir():
        (package / path.name).symlink_to(path)
    for folder in ("derivation", "generated"):
        (package / folder).symlink_to(ROOT / folder)
    return package.parent


def mistakes():
    lines = (SCRIPTS / "wrong.py").read_text().splitlines()
    return {number for number, line in enumerate(lines, start=1) if "#:" in line}


def test_mypy(site):
    pytest.importorskip("mypy")
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", f"--cache-dir={ROOT / '.mypy_cache'}"]
    environment = {"MYPYPATH": str(site), "PATH": ""}
    done = subprocess.run([*command, "right.py", "wrong.py"], cwd=SCRIPTS, env=environment, capture_output=True, text=True)
    assert "right.py:" not in done.stdout, done.stdout + done.stderr
    assert {int(number) for number in LINE.findall(done.stdout)} == mistakes(), done.stdout + done.stderr


def test_pyright(site, tmp_path):
    pytest.importorskip("pyright")
    for script in SCRIPTS.glob("*.py"):  # pyright leaves out what a configuration elsewhere includes
        (tmp_path / script.name).write_text(script.read_text())
    (tmp_path / "pyrightconfig.json").write_text(json.dumps({"include": ["."], "extraPaths": [str(site)]}))
    command = [sys.executable, "-m", "pyright", "--outputjson", "--pythonpath", sys.executable, "--project", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True)
    if not done.stdout.startswith("{"):
        pytest.skip(f"pyright does not start here: {done.stderr[-300:]}")
    errors = [each for each in json.loads(done.stdout)["generalDiagnostics"] if each["severity"] == "error"]
    right = [each for each in errors if each["file"].endswith("right.py")]
    assert not right, right
    assert {each["range"]["start"]["line"] + 1 for each in errors} == mistakes()


def test_the_script_uses_every_public_name():
    text = (SCRIPTS / "right.py").read_text()
    # what a solver warns with is for filters of warnings
    unused = [name for name in hystrip.__all__ if not re.search(rf"\b{name}\b", text)]
    assert unused == [name for name in unused if name.endswith("Warning")], unused
