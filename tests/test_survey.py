"""The survey of random scenes: the same from the same seed, with a limit that ends what takes long."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).resolve().parents[1] / "tools"
sys.path.insert(0, str(TOOLS))
import survey  # noqa: E402

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="a scene is a fork of a server")


def test_a_scene_can_be_replayed():
    first, again, other = survey.draw(3, 1), survey.draw(3, 1), survey.draw(3, 2)
    assert repr(first) == repr(again) != repr(other)
    kinds = [survey.draw(3, number) for number in range(60)]
    assert {len(scene["levels"]) for scene in kinds} == {1, 2, 3, 4}
    assert {scene["branch"] for scene in kinds} == {"loading", "unloading"}
    assert {scene["adhesion"].p_0 > 0 for scene in kinds} == {True, False}


# of both branches, with two levels and with four, without adhesion and with it
@pytest.mark.parametrize("number", [0, 1, 3, 5])
def test_wide_scenes_end_well(number):
    scene = survey.draw(20261127, number, wide=True)
    assert repr(scene) != repr(survey.draw(20261127, number))
    seconds, converged, _, problem = survey.solve(scene, 60.0)
    assert seconds < 30 and converged and not problem


def test_a_scene_that_takes_long_is_ended():
    scene = survey.demonstration() | {"velocity": 1e-3, "rtol": 1e-2}
    seconds, converged, strips, problem = survey.solve(scene, 60.0)
    assert 0 < seconds < 60 and converged and strips > 100 and not problem
    seconds, converged, *_ = survey.solve(survey.demonstration() | {"rtol": 1e-11}, 0.2)
    assert math.isinf(seconds) and not converged


def test_what_goes_wrong_is_said():
    *_, problem = survey.solve(survey.demonstration() | {"velocity": -1.0}, 60.0)
    assert problem.startswith("InputError: velocity")
