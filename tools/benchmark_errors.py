"""What the error estimate is worth: random surfaces solved at a tolerance, against the same at a far tighter one.

    python tools/benchmark_errors.py [--scenes 100] [--seed 1] [--tolerances 1e-3 1e-4 1e-5 1e-6 1e-8] [--tighter 1e-4] [--first
    0]
                                     [--levels 1|2|3|4] [--velocities 1] [--limit 600] [--out errors.csv]
    python tools/benchmark_errors.py --march [--scenes 12] ...

Scenes are drawn by ``tests/surfaces.py``: one to three levels, both closures and branches, with and without adhesion, loads from
hardly touching to nearly saturated; the tolerances are taken in turn, 1e-8 for one-level surfaces only. The reference is never
tighter than 1e-12, 1e-8 for several levels. ``--march``: one-level surfaces with adhesion at the penetration that their pressure
takes, every one at all tolerances, against strips that are marched event by event with 30 digits and summed over y by a rule of
its own (``tests/oracle/level.py``): nothing of the library.

Prints how many points meet the tolerance, at how many the estimate bounds the error, and the median of estimate over error; then
every point at which it does not hold, with the scene's number to draw it again. The table goes to the CSV as it grows. Points in
closed form and below pull-off are exact and are not counted, nor are errors that rounding hides, nor points whose reference says
that it did not converge (they are listed). A scene that takes more than
``--limit`` seconds of processor time counts as refused. Exit status 1 if the estimate bounds the error in fewer than 99 of 100
points, its median exceeds 100 times the error, or a scene was refused.
"""

import argparse
import contextlib
import csv
import signal
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

import surfaces
from oracle.level import level_means

import hystrip

#: errors below this, relative to the friction and its floor, are rounding
ROUNDING = 1e-13
NEEDED, PESSIMISTIC = 0.99, 100
#: tolerances finer than this are for surfaces of one level
_FINEST_OF_MANY = 1e-7
#: the tightest references, of one level and of several
_TIGHTEST, _TIGHTEST_OF_MANY = 1e-12, 1e-8
#: accuracy of marched levels
_MARCHED = 1e-9
COLUMNS = ("scene", "levels", "edge", "branch", "point", "rtol", "error", "estimate", "seconds", "seconds_tighter")


@dataclass
class Survey:
    """``points``: rows (scene, index, tolerance, error, estimate), error and estimate relative to friction plus floor;
    ``refused``: (scene, error). ``unknown``: scenes and points whose reference did not converge, which are not counted."""

    points: list = field(default_factory=list)
    refused: list = field(default_factory=list)
    unknown: list = field(default_factory=list)
    exact: int = 0

    @property
    def table(self):
        """The points as an array (n, 5)."""
        return np.array(self.points, float).reshape(-1, 5)

    @property
    def bounded(self):
        """Share of the points whose error the estimate bounds."""
        error, estimate = self.table[:, 3], self.table[:, 4]
        return float(np.mean(error <= np.maximum(estimate, ROUNDING))) if error.size else 1.0

    @property
    def met(self):
        """Share of the points that meet the tolerance."""
        return float(np.mean(self.table[:, 3] <= self.table[:, 2])) if self.points else 1.0

    @property
    def largest(self):
        """The largest error over estimate."""
        error, estimate = self.table[:, 3], self.table[:, 4]
        counted = error > ROUNDING
        return float(np.max(error[counted] / estimate[counted], initial=0.0))

    @property
    def pessimism(self):
        """Median of estimate over error, where the error is more than rounding."""
        rows = self.table[self.table[:, 3] > ROUNDING]
        return float(np.median(rows[:, 4] / rows[:, 3])) if rows.size else 1.0


def survey(scenes, seed, tolerances, tighter, levels=None, report=None, first=0, velocities=3, limit=None):
    """Draw ``scenes`` surfaces from number ``first`` on, solve each at one of the tolerances in turn, and ``tighter`` times that.

    ``report(rows)``: called with the rows (``COLUMNS``) of each scene. ``limit``: seconds of processor time after which a scene
    is refused.
    """
    out = Survey()
    for number in range(first, first + scenes):
        surface = surfaces.draw(np.random.default_rng((seed, number)), velocities=velocities, levels=levels)
        usable = [t for t in tolerances if t > _FINEST_OF_MANY or len(surface.levels) == 1]
        rtol = usable[number % len(usable)]
        try:
            with _limited(limit):
                start = time.process_time()
                coarse = surface.solve(rtol)
                middle = time.process_time()
                fine = surface.solve(max(tighter * rtol, _TIGHTEST if len(surface.levels) == 1 else _TIGHTEST_OF_MANY))
                end = time.process_time()
        except (hystrip.SolverError, ArithmeticError, TimeoutError) as error:
            out.refused.append((number, error))
            continue
        size = np.abs(fine.tau) + surface.floor
        counted = ~(fine.closed_form | (fine.pulled_off & coarse.pulled_off))
        out.exact += int(np.count_nonzero(~counted))
        out.unknown += [(number, i) for i in np.flatnonzero(counted & ~fine.converged).tolist()]
        rows = []
        for i in np.flatnonzero(counted & fine.converged):
            error = abs(coarse.tau[i] - fine.tau[i])
            out.points.append((number, i, rtol, error / size[i], coarse.tau_error[i] / size[i]))
            about = (number, len(surface.levels), surface.edge, surface.branch)
            rows.append((*about, i, *out.points[-1][2:], middle - start, end - middle))
        if report:
            report(rows, out)
    return out


def marched(scenes, seed, tolerances, report=None, first=0, limit=None, accuracy=_MARCHED):
    """Pressure and friction (points 0 and 1) of one-level surfaces with adhesion at given penetration, against strips marched to
    ``accuracy``; as ``survey``."""
    out = Survey()
    for number in range(first, first + scenes):
        surface = surfaces.draw(np.random.default_rng((seed, number)), velocities=1, levels=1)
        (level,), V = surface.levels, surface.velocity[0]
        given = {"V": V, "edge": surface.edge, "branch": surface.branch}
        at = hystrip.solve_level(surface.material, surface.adhesion, level, pressure=surface.pressure, rtol=1e-4, **given)
        if surface.adhesion.p_0 == 0 or at.pulled_off or surface.solve(1e-3).closed_form.all():
            out.exact += 1
            continue
        m, a, D = surface.material, surface.adhesion, float(at.D)
        try:
            with _limited(limit):
                start = time.process_time()
                true = level_means(
                    m.K, m.T_eps, m.T_sigma, V, level.l, level.h, D, a.p_0, a.delta_0, surface.edge, surface.branch, accuracy
                )
                end = time.process_time()
        except (ArithmeticError, TimeoutError) as error:
            out.refused.append((number, error))
            continue
        size = np.abs(true.values[:2]) + [surface.floor * level.l / level.h, surface.floor]
        rows = []
        for rtol in tolerances:
            before = time.process_time()
            found = hystrip.solve_level(m, a, level, D=D, rtol=rtol, **given)
            seconds = time.process_time() - before
            for i, value in enumerate((found.p_mean, found.tau_mean)):
                error = max(abs(float(value) - true.values[i]) - true.change[i], 0.0)
                out.points.append((number, i, rtol, error / size[i], float(found.error_estimate[i]) / size[i]))
                rows.append((number, 1, surface.edge, surface.branch, i, *out.points[-1][2:], seconds, end - start))
        if report:
            report(rows, out)
    return out


@contextlib.contextmanager
def _limited(seconds):
    """``TimeoutError`` after so many seconds of processor time."""

    def stop(*_):
        raise TimeoutError(f"not done after {seconds:g} s of processor time")

    if seconds is None:
        yield
        return
    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tolerances", type=float, nargs="+", default=[1e-3, 1e-4, 1e-5, 1e-6, 1e-8])
    parser.add_argument("--tighter", type=float, default=1e-4, help="tolerance of the reference, relative")
    parser.add_argument("--first", type=int, default=0, help="number of the first scene")
    parser.add_argument("--levels", type=int, choices=(1, 2, 3, 4), help="levels of every scene, instead of one to three")
    parser.add_argument("--velocities", type=int, default=1, help="of each scene")
    parser.add_argument("--limit", type=float, default=600, help="seconds of processor time allowed to a scene")
    parser.add_argument("--march", action="store_true", help="one level with adhesion against marched strips")
    parser.add_argument("--out", type=Path, default=Path("errors.csv"))
    options = parser.parse_args()
    start = time.process_time()
    with options.out.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(COLUMNS)

        def report(rows, out):
            table.writerows([[f"{v:.3g}" if isinstance(v, float) else v for v in row] for row in rows])
            file.flush()
            print(
                f"\r{len(out.points)} points, {100 * out.bounded:.1f} % bounded, median {out.pessimism:.3g}",
                end="",
                file=sys.stderr,
                flush=True,
            )

        if options.march:
            out = marched(options.scenes, options.seed, options.tolerances, report, options.first, options.limit)
        else:
            out = survey(
                options.scenes,
                options.seed,
                options.tolerances,
                options.tighter,
                options.levels,
                report,
                options.first,
                options.velocities,
                options.limit,
            )
    print(file=sys.stderr)
    print(
        f"{options.scenes} scenes, {len(out.points)} points, {out.exact} more exact; "
        f"{time.process_time() - start:.0f} s of processor time"
    )
    print(f"tolerance met:                {100 * out.met:.2f} %")
    print(f"estimate bounds the error:    {100 * out.bounded:.2f} %")
    print(f"largest error over estimate   {out.largest:.3g}")
    print(f"median of estimate over error {out.pessimism:.3g}")
    for number, i, rtol, error, estimate in out.points:
        if error > max(estimate, ROUNDING) or error > rtol:
            print(f"  scene {number}, point {i}, rtol {rtol:g}: error {error:.1e}, estimate {estimate:.1e}")
    for number, i in out.unknown:
        print(f"  scene {number}, point {i}: the reference did not converge")
    for number, error in out.refused:
        print(f"  scene {number} refused: {error}")
    return 1 if out.bounded < NEEDED or out.pessimism > PESSIMISTIC or out.refused else 0


if __name__ == "__main__":
    sys.exit(main())
