"""Throw spoiled inputs at hystrip: scenes, ``--over``, calls of the interface, measured moduli, measured surfaces.

    python tools/fuzz.py [--count 2000] [--seed 1] [--seconds 10] [--kind scene ...]
    python tools/fuzz.py --seed 1 --only scene:17,0+2      # one case again, with the first and third of its changes

Each input has to end in an answer that is sound or in an error of hystrip, within the time; ``--solve-seconds`` (60) is that of
inputs that were accepted and solved. A case that does not is made smaller, change by change, and printed with the command
that runs it again. Exit status 1 if there is one.
"""

from __future__ import annotations

import argparse
import collections
import multiprocessing
import random
import sys
import time
import traceback
import warnings
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

from fuzzing.kinds import KINDS

#: bytes of memory that a case may take: an endless list ends here, not the machine
_MEMORY = 4 << 30


def outcome(kind: str, seed: int, number: int, keep: list[int] | None = None) -> tuple[str, str]:
    """``("answer" | "refused" | "wrong", why)`` of a case."""
    import hystrip

    try:
        case = KINDS[kind](random.Random(f"{seed} {kind} {number}"))
        with warnings.catch_warnings():
            warnings.simplefilter("error", RuntimeWarning)
            warnings.simplefilter("ignore", UserWarning)
            case.run([*range(len(case.parts))] if keep is None else keep)
    except hystrip.HystripError as error:
        text = str(error)
        steers = next((each for each in text if not each.isprintable()), "")
        return ("wrong", f"a message with {steers!r}") if steers else ("refused", text)
    except BaseException as error:  # whatever else
        place = traceback.extract_tb(error.__traceback__)[-1]
        return "wrong", f"{type(error).__name__}: {str(error)[:200]} ({Path(place.filename).name}:{place.lineno})"
    return "answer", ""


def work(pipe: Any) -> None:
    """Run cases as they come through the pipe."""
    try:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    except ImportError:
        pass
    while (case := pipe.recv()) is not None:
        pipe.send(outcome(*case))


class Worker:
    """A process that runs one case after the other, and is replaced when it hangs or dies."""

    def __init__(self) -> None:
        self._process: Any = None

    def _start(self) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=work, args=(theirs,), daemon=True)
        self._process.start()
        theirs.close()
        self._pipe.send(("scene", 0, 0, []))  # what is imported at the first case is not what is timed
        self._pipe.recv()

    def run(self, case: tuple[Any, ...], seconds: float) -> tuple[str, str, float]:
        """The outcome and the seconds it took."""
        if self._process is None:
            self._start()
        start = time.monotonic()
        self._pipe.send(case)
        try:
            found = self._pipe.recv() if self._pipe.poll(seconds) else ("wrong", f"hangs: no end after {seconds:g} s")
        except EOFError:
            found = "wrong", "the process died"
        took = time.monotonic() - start
        if found[1].startswith(("hangs", "the process")):
            self.close()
        return (*found, took)

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._process = None


def smallest(worker: Worker, case: tuple[str, int, int], why: str, seconds: float) -> list[int]:
    """The fewest changes that still go wrong in the same way."""
    kind, seed, number = case
    keep = [*range(len(KINDS[kind](random.Random(f"{seed} {kind} {number}")).parts))]
    for each in list(keep):
        fewer = [other for other in keep if other != each]
        status, said, _ = worker.run((*case, fewer), seconds)
        if status == "wrong" and said.partition(":")[0] == why.partition(":")[0]:
            keep = fewer
    return keep


def fuzz(count: int, seed: int, seconds: float, solve_seconds: float, kinds: list[str], say: Any = print) -> list[str]:
    """What went wrong, one text each with the command that runs it again."""
    worker, wrong, counts, slowest = Worker(), [], collections.Counter(), (0.0, "")
    try:
        for number in range(count):
            kind = kinds[number % len(kinds)]
            case = kind, seed, number
            status, why, took = worker.run(case, solve_seconds)
            counts[kind, status] += 1
            if status == "refused" and took > seconds:
                status, why = "wrong", f"refused after {took:.1f} s: {why}"
            slowest = max(slowest, (took, f"{kind}:{number} ({status})"))
            if status == "wrong":
                keep = smallest(worker, case, why, solve_seconds)
                parts = KINDS[kind](random.Random(f"{seed} {kind} {number}")).parts
                again = f"python tools/fuzz.py --seed {seed} --only {kind}:{number},{'+'.join(map(str, keep))}"
                wrong.append(f"{why}\n    {again}\n    " + "\n    ".join(ascii(parts[i])[:300] for i in keep))
                say(wrong[-1])
    finally:
        worker.close()
    for (kind, status), times in sorted(counts.items()):
        say(f"{kind:8} {status:8} {times}")
    say(f"slowest: {slowest[0]:.1f} s, {slowest[1]}; {len(wrong)} of {count} wrong")
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--solve-seconds", type=float, default=60.0)
    parser.add_argument("--kind", action="append", choices=list(KINDS))
    parser.add_argument("--only", help="KIND:NUMBER, or KIND:NUMBER,CHANGES")
    given = parser.parse_args()
    if given.only:
        name, _, changes = given.only.partition(",")
        kind, number = name.split(":")
        keep = [int(each) for each in changes.split("+") if each] if "," in given.only else None
        print(*outcome(kind, given.seed, int(number), keep), sep=": ")
        return 0
    return 1 if fuzz(given.count, given.seed, given.seconds, given.solve_seconds, given.kind or list(KINDS)) else 0


if __name__ == "__main__":
    sys.exit(main())
