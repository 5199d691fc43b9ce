"""What a strip costs by the number of relaxation times: the solver for any number, in batches.

    python tools/modes_cost.py [--strips 4000] [--times 1 2 3]
    python tools/modes_cost.py --of-one [--strips 10000] [--times 2 15]

Random strips in one batch, as `tools/modes.py` draws them, over the same forty materials for each number of times; CPU
microseconds a strip, the median of three. Linear growth is n times the cost with one time; exits with 1 where it is
exceeded, or a strip could not be certified.

``--of-one``: ten thousand strips of all regimes by `hystrip.solve_strip`, with times over twelve decades and with times that are
all but alike, over the cost of the same strips with one time, measured next to it, the median of five; exits with 1 above 20
times with two and 60 with fifteen.
"""

import argparse
import sys
import time
from functools import partial
from pathlib import Path
from unittest.mock import patch

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

import mode_scenes as ms

import hystrip
from hystrip.generated import generalised as kernel
from hystrip.inputs.model import modes_of
from hystrip.orbit.modes import crossing
from hystrip.orbit.modes.engine import solve_modes
from hystrip.orbit.modes.problem import ModeStrips

#: a strip may cost so many times what it does with one time, by number of times
LIMITS = {2: 20, 15: 60}


def strips(n, wide, count, materials=40):
    """Strips of random materials at one speed: ``wide`` or near 1, where several orbits coexist."""
    rng = np.random.default_rng((3, wide))
    drawn = [ms.draw(rng, n, wide) for _ in range(count)]
    few = drawn[:materials]
    columns = {"K": np.ones(materials), "K_i": np.array([s["m"] for s in few]).T, "tau_i": np.array([s["theta"] for s in few]).T}
    _, modes = modes_of(kernel, columns)
    pick = np.arange(count) % materials
    m = kernel.at_speed(type(modes)(*(each[..., pick] for each in modes)), np.ones(count))
    P0, Delta, delta = (np.array([s[name] for s in drawn]) for name in ("P0", "Delta", "delta"))
    return ModeStrips(m, P0, Delta, delta, m.J_0 * P0 >= Delta)


def cost(n, wide, count, times=3):
    """(microseconds, steps of marches to the next event) a strip of both branches together, and how many are not certified:
    measured so many ``times``."""
    batch, seconds = strips(n, wide, count), []
    for _ in range(times):
        start, steps = time.process_time(), []
        with patch.object(crossing, "_safe_step", partial(_counted, crossing._safe_step, steps)):
            found = [solve_modes(kernel, batch, unloading) for unloading in (True, False)]
        seconds.append(time.process_time() - start)
    lost = sum(int((~each.certified).sum()) for each in found)
    return np.median(seconds) / (2 * count) * 1e6, sum(steps) / (2 * count), lost


def public_cost(times, branch, count):
    """Microseconds a strip of ``hystrip.solve_strip``, glassy moduli a hundred times the relaxed one."""
    rng = np.random.default_rng(5)
    A, share, speed = 10.0 ** rng.uniform(-7, -6.3, count), rng.uniform(-0.5, 2.5, count), 10.0 ** rng.uniform(-2, 2, count)
    n, V = len(times), speed * 1e-5 / (2 * np.pi * 1e-2)
    material = hystrip.Prony(K=1e9, moduli=np.full(n, 99e9 / n), times=times)
    start = time.process_time()
    hystrip.solve_strip(
        material, hystrip.Dugdale(p_0=1e2, delta_0=1e-8), l=1e-5, A=A, D=share * A, V=V, edge="constitutive", branch=branch
    )
    return (time.process_time() - start) / count * 1e6


def against_one(numbers, count):
    """Print the cost by number of times over that with one, measured next to each; whether it is within the limits."""
    within = True
    for branch in ("unloading", "loading"):
        for n in numbers:
            for apart, times in (("decades", 10.0 ** np.linspace(-8, 4, n)), ("alike", 1e-2 * 1.5 ** (np.arange(n) - n / 2))):
                pairs = np.array([[public_cost(each, branch, count) for each in ([1e-2], times)] for _ in range(5)])
                micro, ratio = np.median(pairs[:, 1]), np.median(pairs[:, 1] / pairs[:, 0])
                print(f"{branch}, n = {n}, {apart}: {micro:.0f} microseconds, {ratio:.1f} times one time", flush=True)
                within &= ratio <= LIMITS.get(n, np.inf)
    return within


def _counted(safe_step, steps, ahead, *parts):
    steps.append(ahead.shape[1])
    return safe_step(ahead, *parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--of-one", action="store_true", help="over the cost with one time")
    parser.add_argument("--strips", type=int)
    parser.add_argument("--times", type=int, nargs="+", help="numbers of relaxation times")
    options = parser.parse_args()
    if options.of_one:
        return 0 if against_one(options.times or [2, 15], options.strips or 10_000) else 1
    failed = False
    for wide in (False, True):
        base = None
        for n in options.times or [1, 2, 3]:
            micro, steps, lost = cost(n, wide, options.strips or 4000)
            base = base or micro
            print(f"{'wide' if wide else 'near 1'}, n = {n}: {micro:.0f} microseconds, "
                  f"{steps:.0f} steps of marches a strip, {micro / base:.2f} times n = 1; {lost} uncertified",
                  flush=True)  # fmt: skip
            failed |= lost > 0 or micro > n * base
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
