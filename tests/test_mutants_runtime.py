"""The mutants of tools/mutants_runtime.py are of today's runtime; the tool itself runs them."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tools"))
from mutants_runtime import MUTANTS  # noqa: E402


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda each: each.what)
def test_a_mutant_changes_one_line_and_names_tests(mutant):
    assert (ROOT / "runtime" / mutant.file).read_text("utf-8").count(mutant.before) == 1 and mutant.before != mutant.after
    assert all((ROOT / "tests" / name).exists() for name in mutant.tests.split())
