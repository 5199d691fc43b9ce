"""A short run of the fuzzer, and that it finds, shrinks and names what is wrong."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))

import fuzz
from fuzzing import kinds

import hystrip


def test_only_errors_of_ours_or_sound_answers():
    available = [kind for kind in kinds.KINDS if kind != "surface" or pytest.importorskip("SurfaceTopography")]
    assert fuzz.fuzz(60, 5, seconds=10, solve_seconds=60, kinds=available, say=lambda text: None) == []


def failing(error):
    """Cases of five changes of which the second and the fourth together go wrong."""

    def run(keep):
        if {1, 3} <= {*keep}:
            raise error
        raise hystrip.InputError("x", 1, "2")

    return lambda chance: kinds.Case([*"abcde"], run)


class Here:
    """A worker in this process."""

    def run(self, case, seconds):
        return (*fuzz.outcome(*case), 0.0)

    def close(self): ...


@pytest.mark.parametrize(
    "error", [KeyError("k"), RuntimeWarning("w"), RecursionError("deep"), AssertionError("unsound")], ids=repr
)
def test_what_is_wrong_is_found_and_made_small(monkeypatch, error):
    monkeypatch.setattr(fuzz, "Worker", Here)
    monkeypatch.setitem(kinds.KINDS, "scene", failing(error))
    (wrong,) = fuzz.fuzz(1, 7, seconds=10, solve_seconds=10, kinds=["scene"], say=lambda text: None)
    lines = [line.strip() for line in wrong.splitlines()]
    assert lines[0].startswith(type(error).__name__)
    assert lines[1:] == ["python tools/fuzz.py --seed 7 --only scene:0,1+3", "'b'", "'d'"]


def test_a_message_that_steers_the_terminal_is_wrong(monkeypatch):
    class Steering(hystrip.HystripError): ...

    monkeypatch.setitem(kinds.KINDS, "scene", failing(Steering("\x1b[31m")))
    assert fuzz.outcome("scene", 1, 1) == ("wrong", "a message with '\\x1b'")


def test_a_case_that_hangs_is_ended(monkeypatch):
    worker = fuzz.Worker()
    worker._process, worker._pipe = Sleeping(), Sleeping()
    status, why, _ = worker.run(("scene", 0, 0), 0.0)
    assert (status, why) == ("wrong", "hangs: no end after 0 s") and worker._process is None


class Sleeping:
    """A pipe and a process that never answer."""

    def send(self, case): ...

    def poll(self, seconds):
        return False

    def kill(self): ...

    def join(self): ...


def test_the_same_seed_makes_the_same_cases():
    import random

    for kind, make in kinds.KINDS.items():
        if kind == "surface":
            pytest.importorskip("SurfaceTopography")
        assert make(random.Random("5")).parts == make(random.Random("5")).parts
