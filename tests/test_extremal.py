"""The branch returned is the extremal one: plain iteration of the period map ends at the same orbit (``tools/extremal.py`` is the long version)."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))

import extremal


def test_plain_iteration_ends_at_the_same_orbits():
    outcome = extremal.survey(300, seed=5, chunk=300, longest=60, periods=1500, classify=10)
    assert outcome.differ == []
    # enough of every kind for this to mean something
    assert outcome.scenes == 300 and outcome.coexisting >= 40
    assert outcome.settled >= 0.97 * outcome.strips
    assert outcome.ends["fold"] and outcome.ends["graze"]


def test_the_check_tells_branches_apart(monkeypatch):
    """A solver that returned the other branch everywhere would be found out by every strip with coexisting orbits."""
    other = {"unloading": "loading", "loading": "unloading"}
    solve = extremal.scenes.solve
    monkeypatch.setattr(extremal.scenes, "solve", lambda scene, edge, branch: solve(scene, edge, other[branch]))
    outcome = extremal.survey(60, seed=6, chunk=60, longest=10, periods=400, classify=0)
    assert outcome.coexisting > 5
    assert len(outcome.differ) >= 2 * outcome.coexisting * 0.9
