"""``tools/compare.py``: two states of the repository, here this one twice."""

import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))

import compare  # noqa: E402


def test_this_state_against_itself():
    """In processes of their own, from copies of the sources; every number is the same."""
    options = ["--quick", "--repeat", "1", "--only", "1 adhesive", "--slower", "9"]
    command = [sys.executable, compare.__file__, compare.HERE, *options]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    row = done.stdout.splitlines()[1]
    assert row.startswith("a lone velocity, 1 adhesive level") and row.endswith("0.0e+00")


def test_differences_count_by_the_errors_that_both_sides_state():
    one = {"values": [1.0, float("nan"), 3.0], "errors": [0.1, float("nan"), 0.2]}
    other = {"values": [1.1, float("nan"), 3.0], "errors": [0.1, float("nan"), 0.0]}
    assert compare.compared(one, other) == pytest.approx(0.5)
    assert compare.compared({"values": 1.0, "errors": 0.0}, {"values": 1.1, "errors": 0.0}) > 1e12
