"""A few mutations of the derivation, each refused by the step that is named; tools/mutants_derivation.py runs them all."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).resolve().parents[1] / "tools"
sys.path.insert(0, str(TOOLS))
from mutants_derivation import MUTANTS, refused_by  # noqa: E402

QUICK = [
    each
    for each in MUTANTS
    if each.run in ("displays", "levels", "tags") or each.by in ("admissibility", "moving frame", "closures")
]


def test_there_are_enough_of_every_kind() -> None:
    assert len(MUTANTS) >= 40
    kinds = {each.subject for each in MUTANTS}
    assert kinds >= {
        "operator",
        "closure",
        "boundary equation",
        "inequality",
        "display",
        "tag",
        "certificate",
        "template",
        "print",
    }


THRESHOLD = [each for each in QUICK if each.by == "saturation threshold"]


@pytest.mark.parametrize("mutant", [*QUICK[::3], *THRESHOLD], ids=lambda each: f"{each.subject}-{each.by}")
def test_a_mutant_is_refused_by_the_step_that_is_named(mutant) -> None:
    assert refused_by(mutant) == mutant.by
