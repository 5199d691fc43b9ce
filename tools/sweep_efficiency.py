"""How well a sweep uses several workers, over the serial run: local processes, and a Dask cluster on this machine.

    python tools/sweep_efficiency.py [--points 4000] [--batch 100] [--workers 2] [--repeats 3]

Partial contact with adhesion at given penetrations. Each way of running is timed ``--repeats`` times, in turn, and the
median shown. Efficiency is serial time over workers times parallel time; workers are started beforehand for "warm"
rows, by the sweep itself for the others. "one call" is ``hystrip.solve``
over all points: what going to disk in batches costs.
"""

import argparse
import statistics
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np

import hystrip

SCENE = """
penetration = {{ start = 1e-8, stop = 6e-8, num = 10 }}
velocity = {{ start = 1e-4, stop = 1e-2, num = {velocities}, spacing = "log" }}
rtol = 1e-2
[sweep]
batch = {batch}
[material]
K = 1e9
T_eps = 0.01
T_sigma = 1e-4
[adhesion]
gamma = 2e-5
delta_0 = 1e-8
[[levels]]
l = 5e-7
h = 1e-7
"""


def one_call(points: int) -> None:
    scene = hystrip.StandardLinearSolid(1e9, 0.01, 1e-4), hystrip.Dugdale(gamma=2e-5, delta_0=1e-8)
    D, V = np.linspace(1e-8, 6e-8, 10)[:, None], np.geomspace(1e-4, 1e-2, points // 10)
    hystrip.solve(*scene, [hystrip.Level(5e-7, 1e-7)], penetration=D, velocity=V, rtol=1e-2)


def warm(executor, count: int) -> None:
    """Have every worker import what it needs."""
    list(executor.map(_imported, range(4 * count)))


def _imported(_: int) -> None:
    import hystrip.sweeps.batch  # noqa: F401

    hystrip.solve(hystrip.StandardLinearSolid(1e9, 0.01, 1e-4), hystrip.Dugdale(gamma=0), [hystrip.Level(1e-6, 1e-7)],
                  penetration=5e-8, velocity=1e-3, rtol=1e-1)  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, default in (("points", 4000), ("batch", 100), ("workers", 2), ("repeats", 3)):
        parser.add_argument(f"--{name}", type=int, default=default)
    given = parser.parse_args()
    import distributed

    with (
        tempfile.TemporaryDirectory() as place,
        ProcessPoolExecutor(given.workers, mp_context=get_context("spawn")) as pool,
        distributed.LocalCluster(n_workers=given.workers, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        folder = Path(place)
        (folder / "s.toml").write_text(SCENE.format(velocities=given.points // 10, batch=given.batch), encoding="utf-8")
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
        files = set()
        for _ in range(given.repeats):
            for name, run in ways.items():
                start = time.perf_counter()
                files.add(run())
                times[name].append(time.perf_counter() - start)
    assert len(files - {None}) == 1, "the files differ"
    serial = statistics.median(times["serial"])
    print(f"{given.points} points in batches of {given.batch}; the same bytes in every way")
    print(f"{'way':30} {'seconds':>8} {'points/s':>9} {'efficiency':>11}")
    for name, seconds in times.items():
        median = statistics.median(seconds)
        share = f"{serial / (given.workers * median):10.0%}" if name not in ("serial", "one call") else ""
        print(f"{name:30} {median:8.2f} {given.points / median:9.0f} {share:>11}")


if __name__ == "__main__":
    main()
