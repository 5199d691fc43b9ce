"""How long it takes to derive, emit and certify a solver, for the standard linear solid and for n relaxation times.

    python tools/regeneration.py [--times 1 3 6]

A fresh process each, as `hystrip regenerate model.py --out folder` does it. CPU seconds are what counts on a busy
machine; on a quiet one the work is on one core, and the wall clock agrees. Exits with 1 if a solver does not solve, or
takes more CPU than asked: 60 s for the standard linear solid, 600 s for three times.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import hystrip

SOLID = "from hystrip.derivation import STANDARD_LINEAR_SOLID\n\nMODEL = STANDARD_LINEAR_SOLID\n"
PRONY = 'from hystrip.derivation import prony_model\n\nMODEL = prony_model("rubber", modes={})\n'
LIMITS = {0: 60.0, 3: 600.0}


def regenerated(folder: Path, times: int) -> tuple[Path, float, float]:
    """The solver's folder, CPU and wall seconds; 0 times: the standard linear solid."""
    file = folder / f"model_{times}.py"
    file.write_text(PRONY.format(times) if times else SOLID, encoding="utf-8")
    out = folder / f"solver_{times}"
    start, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, "-m", "hystrip", "regenerate", file, "--out", out], check=True, stdout=subprocess.DEVNULL)
    after, wall = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter() - start
    return out, sum(after[:2]) - sum(before[:2]), wall


def solves(out: Path, times: int) -> bool:
    """Whether the solver carries a strip in partial contact."""
    moduli, every = [1e10 / times] * times, np.geomspace(1e-2, 1e-4, times).tolist()
    material = hystrip.Prony(1e9, moduli, every, solver=hystrip.load_solver(out))
    adhesion = hystrip.Dugdale(gamma=2.5e-5, delta_0=1e-8)
    strip = hystrip.solve_strip(material, adhesion, l=1e-5, A=1e-6, D=5e-7, V=1e-3, edge="constitutive")
    return bool(0 < strip.contact_fraction < 1 and strip.tau_mean > 0)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--times", type=int, nargs="+", default=[1, 3, 6])
    options = parser.parse_args()
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for times in (0, *options.times):
            out, cpu, wall = regenerated(Path(folder), times)
            rows = json.loads((out / "certificates.json").read_text(encoding="utf-8"))["models"].values()
            bounds = [row["bound"] for each in rows for row in each["functions"].values()]
            good = times == 0 or solves(out, times)
            failed |= not good or cpu > LIMITS.get(times, np.inf)
            name = f"n = {times}" if times else "standard linear solid"
            print(f"{name}: {cpu:.0f} s CPU, {wall:.0f} s wall; {len(bounds)} functions, bounds up to {max(bounds):g} ulp"
                  f"{'' if good else '; DOES NOT SOLVE'}", flush=True)  # fmt: skip
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
