"""Random strips over the extremes of parameters: all are solved and obey their bounds (``tools/stress.py``: the long version)."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))

import stress

REGIMES = {"c", "ac", "acaf", "afc", "cf", "af", "a", "f"}


def test_no_strip_fails():
    outcome = stress.survey(3000, seed=11, chunk=3000, worst=1)
    assert outcome.failures == []
    assert outcome.solved == 3000 and set(outcome.regimes) == REGIMES


def test_no_strip_of_ordinary_size_fails_or_takes_long(monkeypatch):
    asked = []
    for name in ("gap_event", "excess_event"):

        def counted(phase, *constants, event=getattr(stress.kernel, name)):
            asked.append(phase.size)
            return event(phase, *constants)

        monkeypatch.setattr(stress.kernel, name, counted)
    outcome = stress.survey(2000, seed=12, chunk=2000, worst=1, draw=stress.scenes.moderate)
    assert outcome.failures == []
    # six for a strip; and no strip keeps the batch busy alone
    assert 0 < sum(asked) < 10 * 2000 and len(asked) < 1200


def test_a_failure_is_told_by_a_line_that_repeats_it(monkeypatch, capsys):
    """A solver that is wrong is found out, strip by strip."""
    solve = stress.scenes.solve

    def wrong(scene, edge, branch):
        solution = solve(scene, edge, branch)
        solution.p_mean[...] = -1e300
        return solution

    monkeypatch.setattr(stress.scenes, "solve", wrong)
    outcome = stress.survey(12, seed=13)
    assert len({line for _, line in outcome.failures}) == outcome.solved == 12
    what, line = outcome.failures[0]
    assert what == "pressure below the adhesive traction"
    assert stress.replay(line) == 1 and what in capsys.readouterr().out
    monkeypatch.undo()
    assert stress.replay(line) == 0
