"""A sweep on a Dask cluster of two workers, one of which is killed in mid-sweep."""

import json
import subprocess
import sys
import time
from types import SimpleNamespace

import distributed
import pandas
import pytest

import hystrip
from hystrip.sweeps.executors import dask

SCENE = """
pressure = 100
velocity = { start = 4e-3, stop = 6e-3, num = 24 }
rtol = 1e-2
[sweep]
batch = 2
[material]
K = 1e9
T_eps = 0.01
T_sigma = 1e-4
[[levels]]
l = 5e-7
h = 1e-7
"""


# one cluster for all
pytestmark = pytest.mark.xdist_group("dask")


@pytest.fixture(scope="module")
def cluster():
    # without a dashboard; what else the scheduler serves is not on its usual port, which may be taken
    options = {"dashboard_address": None, "scheduler_kwargs": {"dashboard_address": ":0"}}
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, **options) as cluster:
        yield cluster


def test_a_killed_worker_changes_nothing(cluster, tmp_path):
    (tmp_path / "s.toml").write_text(SCENE)
    expected = hystrip.sweep(tmp_path / "s.toml", out=tmp_path / "serial").path.read_bytes()
    victim = list(cluster.workers.values())[0]
    killed = []

    def progress(done, total):
        if done >= 4 and not killed:
            killed.append(victim.pid)
            victim.process.process._process.kill()

    with distributed.Client(cluster, set_as_default=False) as client:
        done = hystrip.sweep(
            tmp_path / "s.toml", out=tmp_path / "dask", executor=client.get_executor(retries=3), progress=progress
        )
    assert killed and done.path.read_bytes() == expected


def test_the_command_line_finds_the_scheduler(cluster, tmp_path):
    (tmp_path / "s.toml").write_text(SCENE.replace("num = 24", "num = 4"))
    command = [sys.executable, "-m", "hystrip", "sweep", "s.toml", "--scheduler", cluster.scheduler_address]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and "wrote hystrip-out/s.sweep.csv" in done.stdout, done.stderr
    values = pandas.read_csv(tmp_path / "hystrip-out/s.sweep.csv", comment="#")
    assert len(values) == 4 and (values["mu"] > 0).all()


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nonsense"])
def test_no_scheduler_is_one_sentence(tmp_path, address):
    """Without so much as an address, too: the client waited 20 s for itself as it was deleted, and ended with a traceback."""
    (tmp_path / "s.toml").write_text(SCENE)
    # the command line, but for waiting a second where it waits ten
    impatient = "def __init__(self, at, timeout, **o): super().__init__(at, timeout=1, **o)"
    code = f"import distributed as d\nclass Client(d.Client):\n    {impatient}\nd.Client = Client\n"
    code += "from hystrip.commands.entry import main\nmain()"
    command = [sys.executable, "-c", code, "sweep", "s.toml", "--scheduler", address]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "no Dask scheduler answers" in done.stderr and "Traceback" not in done.stderr, done.stderr


def test_a_cluster_without_tls_set_up_is_one_sentence():
    with pytest.raises(hystrip.HystripError, match="^scheduler tls://.*answers .TLS expects"), dask("tls://127.0.0.1:9"):
        pass


def test_a_batch_that_kills_every_worker_is_one_sentence(monkeypatch):
    class Client:
        def __init__(self, *address, **options): ...

        def nthreads(self):
            return {}

        def get_executor(self, retries): ...

        def close(self, timeout): ...

    monkeypatch.setattr(distributed, "Client", Client)
    with pytest.raises(hystrip.HystripError, match="tcp://there: .*finished batches are kept"), dask("tcp://there"):
        raise distributed.KilledWorker("solve_batch-1", SimpleNamespace(address="tcp://gone"), 3)


def test_a_lost_scheduler_is_one_sentence(tmp_path):
    (tmp_path / "s.toml").write_text(SCENE.replace("num = 24", "num = 2000"))
    place = tmp_path / "scheduler.json"
    started = []

    def start(*command):
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        started.append(subprocess.Popen([sys.executable, "-m", *command], cwd=tmp_path, **quiet))

    try:
        both = "--no-dashboard", "--host", "127.0.0.1", "--scheduler-file", str(place)
        start("distributed.cli.dask_scheduler", "--port", "0", *both)
        start("distributed.cli.dask_worker", "--nthreads", "1", "--no-nanny", *both)
        until(lambda: place.exists() and place.read_text().endswith("}"))
        command = [sys.executable, "-m", "hystrip", "sweep", "s.toml", "--scheduler", json.loads(place.read_text())["address"]]
        sweep = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        until(lambda: len(list(tmp_path.glob("hystrip-out/s.parts/part-*"))) > 2)
        started[0].kill()
        _, err = sweep.communicate(timeout=60)
    finally:
        for process in started:
            process.kill()
            process.wait()
    assert sweep.returncode == 1 and err.startswith("hystrip: the workers are gone") and err.count("\n") == 1, err


def until(true, seconds=60):
    start = time.monotonic()
    while not true():
        assert time.monotonic() - start < seconds
        time.sleep(0.05)
