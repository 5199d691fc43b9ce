"""Speed and numbers of two states of this repository, interleaved in one run.

    python tools/compare.py BEFORE [AFTER] [--quick] [--repeat 3] [--only NAME ...] [--python-before EXE] [--python-after EXE]

BEFORE and AFTER are folders of checkouts or git revisions of this one; AFTER is this folder as it is if left out. Their sources
are copied aside, so both may be edited meanwhile, and need not be installed: the interpreters need NumPy and SciPy alone.

Each scene runs in turn in one process of either state, the order changing from turn to turn; the least CPU time counts. A row
says how much longer AFTER takes, the strips that either solved, and the largest difference of the friction coefficient (or of a
strip's mean pressure over K A), over what both say that they may err. Exits with 1 where AFTER takes more than ``--slower``
times as long, or a number differs by more than 1.
"""

from __future__ import annotations

import argparse
import io
import json
import shutil
import subprocess
import sys
import tarfile
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

HERE = Path(__file__).resolve().parents[1]
PARTS = {"runtime": "", "generated": "generated", "derivation": "derivation"}


def scenes(quick: bool) -> dict[str, Callable[[], dict]]:
    """Scenes by name: each solves once and returns numbers, what they may err, and the strips that were solved."""
    import numpy as np

    import hystrip

    material = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
    sticky, dry = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8), hystrip.Dugdale(gamma=0)
    stickier = hystrip.Dugdale(gamma=5e-5, delta_0=1e-8)
    paper = [hystrip.Level(10e-6, 1e-6), hystrip.Level(500e-9, 100e-9)]
    similar = [hystrip.Level(1e-5 / 5**i, 1e-6 / 5**i) for i in range(6)]

    def surface(levels, velocity, rtol, adhesion=sticky):
        def run():
            result = hystrip.solve(material, adhesion, levels, pressure=100.0, velocity=velocity, rtol=rtol)
            strips = result.counts.get("strips_solved", 0)
            return {"values": result.mu, "errors": result.error_estimate, "strips": strips}

        return run

    def strips(model, edge, count):
        rng = np.random.default_rng(1)
        fine = rng.random(count) < 0.5
        l, h = np.where(fine, 500e-9, 10e-6), np.where(fine, 100e-9, 1e-6)  # noqa: E741
        V, p_0 = 10 ** rng.uniform(-5, -1, count), 10 ** rng.uniform(-6, -4.3, count) / 1e-8
        y, A, D = rng.random(count), h / 2, rng.uniform(-0.3, 1.5, count) * h
        A = A * np.cos(np.pi * y / 2) ** 2
        D = D - 2 * (h / 2 - A)

        def run():
            found = hystrip.solve_strip(model, hystrip.Dugdale(p_0=p_0, delta_0=1e-8), l=l, A=A, D=D, V=V, edge=edge)
            return {"values": found.p_mean / (1e9 * h), "errors": np.full(count, 1e-11), "strips": count}

        return run

    def law():
        found = hystrip.friction_law(material, sticky, paper[0], V=1e-3, rtol=1e-4)
        p = np.linspace(-600, 5000, 57)
        return {"values": found(p), "errors": np.full(p.size, found.error_estimate), "strips": found.strips}

    two_times = hystrip.Prony(K=1e9, moduli=[3e10, 6e10], times=[1e-2, 1e-4])
    few = 10 if quick else 1
    out = {
        "the demo": surface(paper, np.geomspace(1e-5, 0.1, 60), 1e-4),
        "Fig. 6 at 1e-6": surface(paper, np.geomspace(1e-5, 0.1, 100 // few), 1e-6),
        "Fig. 6, twice the adhesion, even steps": surface(paper, np.linspace(0, 0.1, 50 // few + 1)[1:], 1e-6, stickier),
        **{
            f"a lone velocity, {n} adhesive level{'s' * (n > 1)}": surface(similar[:n], 1e-3, 1e-3)
            for n in ((1, 2) if quick else (1, 2, 4, 6))
        },
        "a whole law, one velocity": law,
        "mixed strips": strips(material, "continuous", 100_000 // few),
        "four levels without adhesion": surface(similar[:4], np.geomspace(1e-5, 0.1, 64), 1e-3, dry),
        "strips with two times": strips(two_times, "constitutive", 1000 // few),
    }
    if quick:
        for name in ("the demo", "a whole law, one velocity"):
            out.pop(name)
    return out


def work(quick: bool) -> None:
    """Run the scenes named on standard input, one a line, and answer each with a line of JSON."""
    # what a library prints must not get between the answers
    answers, sys.stdout = sys.stdout, sys.stderr
    every = scenes(quick)
    print(json.dumps(list(every)), file=answers, flush=True)
    for line in sys.stdin:
        start = time.process_time()
        try:
            found = every[line.strip()]()
        except Exception as error:  # one scene that fails must not end the others
            print(json.dumps({"failed": f"{type(error).__name__}: {error}"}), file=answers, flush=True)
            continue
        found["seconds"] = time.process_time() - start
        found = {name: value.tolist() if hasattr(value, "tolist") else value for name, value in found.items()}
        print(json.dumps(found), file=answers, flush=True)


class Side:
    """One state of the repository, at work in a process of its own."""

    def __init__(self, what: str | None, python: str, folder: Path, quick: bool):
        self.seconds: dict[str, float] = {}
        self.found: dict[str, dict] = {}
        _laid_out(what, folder)
        command = [python, str(Path(__file__).resolve()), "--worker", str(folder), *(["--quick"] if quick else [])]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.names = self._answer()

    def _answer(self):
        line = self.process.stdout.readline()
        if not line:
            raise SystemExit("one of the two states does not run")
        return json.loads(line)

    def run(self, name: str) -> None:
        """Solve a scene once more."""
        print(name, file=self.process.stdin, flush=True)
        found = self._answer()
        self.found[name] = found
        if "seconds" in found:
            self.seconds[name] = min(found["seconds"], self.seconds.get(name, float("inf")))

    def close(self) -> None:
        """End the process."""
        self.process.stdin.close()
        self.process.wait()


def _laid_out(what: str | None, folder: Path) -> None:
    """Copy the sources of a checkout or revision to ``folder`` as the package that an installation would make of them."""
    source = HERE if what is None else Path(what)
    if not (source / "runtime").is_dir():
        command = ["git", "-C", str(HERE), "archive", str(what), "--", *PARTS]
        packed = subprocess.run(command, capture_output=True)
        if packed.returncode:
            raise SystemExit(f"{what}: neither a checkout nor a revision: {packed.stderr.decode().strip()}")
        source = folder / "sources"
        with tarfile.open(fileobj=io.BytesIO(packed.stdout)) as archive:
            archive.extractall(source, filter="data")
    skip = shutil.ignore_patterns("__pycache__", "audit")
    for part, inside in PARTS.items():
        shutil.copytree(source / part, folder / "hystrip" / inside, ignore=skip, dirs_exist_ok=True)


def compared(before: dict, after: dict) -> float:
    """Largest difference of two sets of values over what both say they may err; closed forms, which say nothing, by rounding."""
    values, errors = (zip(*(_flat(found[key]) for found in (before, after)), strict=True) for key in ("values", "errors"))
    worst = 0.0
    for (a, b), error in zip(values, errors, strict=True):
        if a != b and not (a != a and b != b):
            allowed = sum(error) + 16 * sys.float_info.epsilon * max(abs(a), abs(b))
            worst = max(float("inf") if a != a or b != b else abs(a - b) / allowed, worst)
    return worst


def _flat(values) -> list[float]:
    return values if isinstance(values, list) else [values]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", help="folder of a checkout, or a git revision")
    parser.add_argument("after", nargs="?", help="the same; this folder if left out")
    parser.add_argument("--python-before", default=sys.executable, help="interpreter with NumPy and SciPy")
    parser.add_argument("--python-after", default=sys.executable, help="interpreter with NumPy and SciPy")
    parser.add_argument("--repeat", type=int, default=3, help="runs of each scene, of which the least counts")
    parser.add_argument("--only", nargs="+", default=[], help="scenes whose names contain one of these")
    parser.add_argument("--slower", type=float, default=1.1, help="ratio of times from which on the exit code is 1")
    parser.add_argument("--quick", action="store_true", help="fewer velocities, strips and levels")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        sides = [
            Side(what, python, Path(folder) / name, options.quick)
            for name, what, python in (
                ("before", options.before, options.python_before),
                ("after", options.after, options.python_after),
            )
        ]
        try:
            return report(sides, options)
        finally:
            for side in sides:
                side.close()


def report(sides: list[Side], options: argparse.Namespace) -> int:
    """Run and print the scenes; 1 where one is too slow, or a number differs."""
    before, after = sides
    failed = 0
    print(f"{'scene':38s} {'before':>9s} {'after':>9s} {'ratio':>6s} {'strips':>19s} {'difference':>11s}", flush=True)
    for name in before.names:
        if options.only and not any(part in name for part in options.only):
            continue
        for turn in range(options.repeat):
            for side in sides[:: -1 if turn % 2 else 1]:
                side.run(name)
        found = [side.found[name] for side in sides]
        if any("failed" in each for each in found):
            failed = 1
            print(f"{name:38s} {' | '.join(each.get('failed', 'solved') for each in found)}", flush=True)
            continue
        times = [side.seconds[name] for side in sides]
        ratio, difference = times[1] / times[0], compared(*found)
        strips = " > ".join(str(each["strips"]) for each in found)
        failed |= ratio > options.slower or difference > 1
        print(f"{name:38s} {times[0]:8.3f}s {times[1]:8.3f}s {ratio:6.2f} {strips:>19s} {difference:11.1e}", flush=True)
    print("ratio: CPU time after over before, least of each; difference: over the sum of both error estimates")
    return int(failed)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--worker"]:
        sys.path.insert(0, sys.argv[2])
        work("--quick" in sys.argv)
    else:
        sys.exit(main())
