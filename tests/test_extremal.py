"""The branch returned is the extremal one: plain iteration of the period map ends at the same orbit (``tools/extremal.py`` is the
long version)."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))

import extremal


def test_plain_iteration_ends_at_the_same_orbits():
    outcome = extremal.survey(160, seed=1, chunk=160, longest=25, periods=100, classify=10)
    # iteration in doubles can settle on the wrong side of a contact that is only just grazed: the 50-digit march tells
    assert len(outcome.differ) <= 2 and all(extremal.confirmed(text) for _, text in outcome.differ)
    # enough of every kind for this to mean something
    assert outcome.scenes == 160 and outcome.coexisting >= 40
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


#: contact is only just grazed: iteration in doubles settles on its other side
GRAZED = (
    "edge=continuous branch=unloading l=4.049343149261876e-07 A=5.690813337319057e-12 D=-8.64064699124091e-14 V=33.5861941006712 "
    "K=281011.7623571056 T_eps=3.016382852932203e-07 T_sigma=9.39880930860048e-09 "
    "p_0=5.87598780725461e-07 delta_0=4.7755674500481605e-14"
)


def test_the_march_decides_where_iteration_grazes(monkeypatch):
    assert extremal.confirmed(GRAZED)
    solve = extremal.scenes.solve
    monkeypatch.setattr(
        extremal.scenes, "solve", lambda scene, edge, branch: solve(scene | {"D": scene["D"] * 0.99}, edge, branch)
    )
    assert not extremal.confirmed(GRAZED)
