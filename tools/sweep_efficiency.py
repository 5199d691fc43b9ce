"""How well a sweep uses several workers, over the serial run: local processes, and a Dask cluster on this machine.

    python tools/sweep_efficiency.py [--points 4000] [--batch N] [--workers 2] [--repeats 3]

Partial contact with adhesion at given penetrations. Each way of running is timed ``--repeats`` times, in turn, and the
median shown. Efficiency is serial time over workers times parallel time; workers are started beforehand for "warm"
rows, by the sweep itself for the others. "one call" is ``hystrip.solve`` over all points: what batches and the disk
cost.

On a machine that does other things too the times say little. The CPU seconds of all processes do: "work" is those of
the serial run over those of this way, the efficiency of a machine with nothing else to do and enough batches.
"""

import argparse
import statistics
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from kill_sweep import scene

import hystrip


def one_call(points: int) -> None:
    solid, adhesion = hystrip.StandardLinearSolid(1e9, 0.01, 1e-4), hystrip.Dugdale(gamma=2e-5, delta_0=1e-8)
    D, V = np.linspace(1e-8, 6e-8, 10)[:, None], np.geomspace(1e-4, 1e-2, points // 10)
    hystrip.solve(solid, adhesion, [hystrip.Level(5e-7, 1e-7)], penetration=D, velocity=V, rtol=1e-2)


def warm(executor, count: int) -> None:
    """Have every worker import what it needs."""
    list(executor.map(_imported, range(4 * count)))


def _imported(_: int) -> None:
    import hystrip.sweeps.batch  # noqa: F401

    hystrip.solve(hystrip.StandardLinearSolid(1e9, 0.01, 1e-4), hystrip.Dugdale(gamma=0), [hystrip.Level(1e-6, 1e-7)],
                  penetration=5e-8, velocity=1e-3, rtol=1e-1)  # fmt: skip


def cpu_seconds(psutil) -> float:
    """CPU time so far of this process and all that it started, ended ones included."""
    each = [psutil.Process(), *psutil.Process().children(recursive=True)]
    return sum(sum(process.cpu_times()[:4]) for process in each)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, default in (("points", 4000), ("batch", None), ("workers", 2), ("repeats", 3)):
        parser.add_argument(f"--{name}", type=int, default=default)
    given = parser.parse_args()
    import distributed
    import psutil

    with (
        tempfile.TemporaryDirectory() as place,
        ProcessPoolExecutor(given.workers, mp_context=get_context("spawn")) as pool,
        distributed.LocalCluster(n_workers=given.workers, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        folder = Path(place)
        (folder / "s.toml").write_text(scene(given.points // 10, given.batch, "2e-5"), encoding="utf-8")
        remote = client.get_executor()
        warm(pool, given.workers)
        warm(remote, given.workers)
        _imported(0)

        def sweep(number, **how):
            return hystrip.sweep(folder / "s.toml", out=folder / f"out{number}", restart=True, **how).path.read_bytes()

        ways = {
            "serial": lambda: sweep(0),
            "one call": lambda: one_call(given.points),
            f"{given.workers} processes": lambda: sweep(1, workers=given.workers),
            f"{given.workers} processes, warm": lambda: sweep(2, executor=pool),
            f"Dask, {given.workers} workers, warm": lambda: sweep(3, executor=remote),
        }
        times: dict[str, list[float]] = {name: [] for name in ways}
        work: dict[str, list[float]] = {name: [] for name in ways}
        files = set()
        for _ in range(given.repeats):
            for name, run in ways.items():
                start, spent = time.perf_counter(), cpu_seconds(psutil)
                files.add(run())
                times[name].append(time.perf_counter() - start)
                work[name].append(cpu_seconds(psutil) - spent)
    assert len(files - {None}) == 1, "the files differ"
    serial = statistics.median(times["serial"])
    effort = statistics.median(work["serial"])
    print(f"{given.points} points in batches of {given.batch or 'default size'}; the same bytes in every way")
    print(f"{'way':24} {'seconds':>8} {'points/s':>9} {'efficiency':>11} {'CPU s':>7} {'work':>6}")
    for name, seconds in times.items():
        median, cpu = statistics.median(seconds), statistics.median(work[name])
        share = f"{serial / (given.workers * median):10.0%}" if name not in ("serial", "one call") else ""
        print(f"{name:24} {median:8.2f} {given.points / median:9.0f} {share:>11} {cpu:7.2f} {effort / cpu:6.0%}")


if __name__ == "__main__":
    main()
