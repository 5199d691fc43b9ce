"""Run time against error: this solver, the paper's method, a script, a march and Tamaas, on the same scenes, in one run.

    python tools/benchmark.py [--quick] [--resume] [--only fig] [--out benchmark] [--readme tools/docs/accuracy.md]

Writes OUT.csv (every measurement, as it comes), OUT.png (error over time, a panel for each scene) and OUT.md (a table of time by
error, what the measurements say, and every setting), and puts table and findings between the two marks of a page if one is
given. ``--resume`` goes on with an OUT.csv of the same code.

Times are processor time of one thread, medians where a run is short. Errors are of the friction, the largest over the points
looked at, relative to ``|tau| + 1e-3 (K h + p_0) h/l`` of level 1, against this solver far below the tolerances compared. Methods
that are too slow for all points of a scene solve a few of them, spread evenly, and the time is scaled; the table says how many.
Every measurement runs in a process of its own and is given up after ``--limit`` seconds of processor time (needs a POSIX system).
Tamaas is left out where it is not installed (extra ``bench``).
"""

import argparse
import math
import os
import resource
import sys
from pathlib import Path

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

import numpy as np  # noqa: E402
from timing import contest, report  # noqa: E402
from timing.scenes import scenes  # noqa: E402

from hystrip.files import Outputs  # noqa: E402


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer points, settings and digits: a few minutes")
    parser.add_argument("--resume", action="store_true", help="keep the rows that OUT.csv has")
    parser.add_argument("--only", default="", help="scenes whose name contains this")
    parser.add_argument("--limit", type=float, help="seconds of processor time for one measurement (300, quick: 60)")
    parser.add_argument("--out", type=Path, default=Path("benchmark"))
    parser.add_argument("--readme", type=Path, help="put table and findings between the marks in this file")
    # what the command asks of its own child processes
    parser.add_argument("--scene", help=argparse.SUPPRESS)
    parser.add_argument("--row", help=argparse.SUPPRESS)
    parser.add_argument("--reference", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    every = scenes(options.quick)
    if options.scene:
        return child(next(scene for scene in every if scene.name == options.scene), options.row, options.reference, options.limit)
    out = options.out.with_suffix(".csv")
    if not options.resume:
        for old in (out, *out.parent.glob(f"{out.stem}-reference-*.npy")):
            old.unlink(missing_ok=True)
    chosen = [scene for scene in every if options.only.lower() in scene.name.lower()]
    limit = options.limit or (60.0 if options.quick else 300.0)
    tell = lambda text: print(text, file=sys.stderr, flush=True)  # noqa: E731
    rows = contest.run(chosen, out, ["--quick"] if options.quick else [], limit, tell)
    order = {(scene.name, c.method, c.setting): k for k, (scene, c) in enumerate((s, c) for s in every for c in s.contestants)}
    rows.sort(key=lambda row: order.get((row.scene, row.method, row.setting), len(order)))
    report.save(rows, options.out)
    if options.readme:
        report.put(report.text(rows), options.readme)
    print(report.text(rows))


def child(scene, row, reference, limit):
    """The reference of a scene into a file, or one row printed; killed after ``limit`` seconds of processor time."""
    resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(limit), math.ceil(limit) + 10))
    if row is None:
        with Outputs(reference.parent) as outputs:
            np.save(outputs.path(reference.name), scene.exact())
        return
    contestant = next(c for c in scene.contestants if f"{c.method}, {c.setting}" == row)
    print(contest.line(contest.measure(scene, contestant, np.load(reference) if reference else None)))


if __name__ == "__main__":
    main()
