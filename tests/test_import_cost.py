"""``import hystrip`` is cheap: what is heavy loads when it is used."""

import statistics
import subprocess
import sys

HEAVY = (
    "sympy",
    "matplotlib",
    "xarray",
    "pandas",
    "scipy.optimize",
    "scipy.special",
    "jinja2",
    "typer",
    "msgspec",
    "pint",
    "rich",
    "distributed",
    "SurfaceTopography",
)
LIMIT = 0.030  # seconds of processor time over numpy's own import: what else runs on the machine does not count


def run(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


def test_nothing_heavy_is_loaded():
    loaded = run(f"import sys, hystrip; print([name for name in {HEAVY!r} if name in sys.modules])")
    assert loaded.strip() == "[]"


def test_cost_over_numpy():
    code = "import time, numpy; start = time.process_time(); import hystrip; print(time.process_time() - start)"
    run(code)  # byte code is compiled at the first
    seconds = [float(run(code)) for _ in range(9)]
    assert statistics.median(seconds) <= LIMIT, seconds
