"""Run time against error: this solver, the paper's method, a script, a march and Tamaas, on the same scenes, in one run.

    python tools/benchmark.py [--short] [--repeat 3] [--out benchmark]

Writes OUT.csv (every measurement), OUT.png (error over time, a panel for each scene) and OUT.md (the table of the README), and prints the
table. Every time is the median of the repetitions; processor time, so that a busy machine counts less. Errors are of the friction, the largest over the points, relative to
``|tau| + 1e-3 (K h + p_0) h/l``, against this solver at a far tighter tolerance. Methods that are too slow for all points of a scene solve a
few of them, spread evenly; the time is then scaled to all. Tamaas is left out where it is not installed (extra ``bench``).
"""

import argparse
import csv
import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from peers import equal_strips, half_space, march, scripted

import hystrip

MATERIAL = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-4)
SOFT = hystrip.StandardLinearSolid(K=1e9, T_eps=1e-2, T_sigma=1e-3)
NONE = hystrip.Dugdale(gamma=0)
WEAK, STRONG = (hystrip.Dugdale(gamma=gamma, delta_0=1e-8) for gamma in (2.5e-5, 5e-5))
LARGE, SMALL, SMALLEST = hystrip.Level(10e-6, 1e-6), hystrip.Level(500e-9, 100e-9), hystrip.Level(50e-9, 50e-9)


@dataclass(frozen=True)
class Scene:
    """Points (pressure, velocity) on a surface, for one or two adhesions; ``methods``: label, setting and solver of each competitor."""

    name: str
    material: hystrip.StandardLinearSolid
    adhesions: tuple
    levels: tuple
    pressure: np.ndarray
    velocity: np.ndarray
    tolerances: tuple
    reference: float
    others: list = field(default_factory=list)

    @property
    def points(self):
        """Points over all adhesions."""
        return len(self.adhesions) * self.velocity.size

    def solve(self, rtol, index=slice(None)):
        """Friction and strips solved by this solver, at the points ``index`` for every adhesion."""
        p, V = self.pressure[index], self.velocity[index]
        results = [hystrip.solve(self.material, a, self.levels, pressure=p, velocity=V, rtol=rtol) for a in self.adhesions]
        return np.array([r.tau for r in results]), sum(r.counts["strips_solved"] for r in results)

    def errors(self, tau, exact):
        """Relative errors of frictions (adhesions, points)."""
        level = self.levels[0]
        floor = [1e-3 * (self.material.K * level.h + a.p_0) * level.h / level.l for a in self.adhesions]
        return np.abs(tau - exact) / (np.abs(exact) + np.array(floor)[:, None])


@dataclass(frozen=True)
class Other:
    """A competitor: ``solve(scene, adhesion, p, V)`` gives friction at one point (and failures); it solves ``sample`` points of the scene."""

    method: str
    setting: str
    solve: Callable
    sample: int


@dataclass(frozen=True)
class Row:
    """A measurement; ``seconds`` for all points of the scene."""

    scene: str
    method: str
    setting: str
    points: int
    seconds: float
    error: float
    strips: int = 0
    failures: int = 0


def _equal(strips, sample):
    solve = lambda s, a, p, V: (float(equal_strips.friction(s.material, a, s.levels, p, V, strips)[0]), 0)  # noqa: E731
    return Other("equal strips, batched", f"N={strips}", solve, sample)


def _script(sample, strips=100):
    def solve(s, a, p, V):
        tau, _, failures = scripted.friction(s.material, a, s.levels, p, V, strips)
        return tau, failures

    return Other("scripted, strip by strip", f"N={strips}", solve, sample)


def _march(strips, rtol, sample):
    def solve(s, a, p, V):
        D = hystrip.solve_level(s.material, a, s.levels[0], V=V, pressure=p, rtol=1e-9).D
        return march.friction(s.material, s.levels[0], float(D), V, strips, rtol), 0

    return Other("solve_ivp march", f"N={strips}, rtol={rtol:g}", solve, sample)


def _tamaas(points, sample):
    solve = lambda s, a, p, V: (half_space.friction(s.material, s.levels[0], p, V, points, periods=6), 0)  # noqa: E731
    return Other("Tamaas 2.9", f"{points} x {points}", solve, sample)


def scenes(short: bool) -> list[Scene]:
    """The scenes; ``short``: fewer points and tolerances."""
    tolerances = (1e-3, 1e-6) if short else (1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10)
    two = (1e-3, 1e-4) if short else (1e-3, 1e-4, 1e-5, 1e-6)
    strips = (10, 100) if short else (10, 30, 100, 300, 1000, 3000)
    grids = ((16, 32) if short else (16, 32, 64, 128)) if half_space.available() else ()
    one = np.ones
    plain = [_equal(n, 1) for n in strips] + [_script(1), _march(10 if short else 100, 1e-7, 1)] + [_tamaas(n, 1) for n in grids]
    adhesive = [_equal(n, 2) for n in strips] + [_script(1)]
    double = [_equal(n, 1) for n in strips if n <= 1000] + [_script(1)]
    many, few = (60, 4) if short else (1000, 20)
    curve = np.linspace(0, 0.1, 5 if short else 201)[1:]
    return [
        Scene("non-adhesive, one point", SOFT, (NONE,), (LARGE,), one(1) * 100, one(1) * 3e-4, tolerances, 1e-12, plain),
        Scene(
            "non-adhesive, a sweep", SOFT, (NONE,), (LARGE,), one(many) * 100, np.geomspace(1e-5, 1e-2, many), tolerances[:2], 1e-9,
            [_equal(100, 1), *[_tamaas(n, 1) for n in grids[-1:]]],
        ),
        Scene(
            "adhesive, multivalued", MATERIAL, (WEAK,), (SMALL,), np.linspace(-650, 1500, few), one(few) * 7e-4,
            tolerances, 1e-11, adhesive,
        ),
        Scene("Fig. 6, two levels", MATERIAL, (WEAK, STRONG), (LARGE, SMALL), one(curve.size) * 100, curve, two, 1e-7 if short else 1e-8, double),
        Scene(
            "three levels", MATERIAL, (WEAK,), (LARGE, SMALL, SMALLEST), one(2) * 100, np.array([1e-3, 1e-2]),
            (1e-3,) if short else (1e-3, 1e-4), 1e-5 if short else 1e-6,
        ),
    ]  # fmt: skip


def measure(scene: Scene, repeat: int, report=lambda text: None) -> list[Row]:
    """All methods on one scene."""
    report(f"{scene.name}: reference")
    exact, _ = scene.solve(scene.reference)
    rows = []
    for rtol in scene.tolerances:
        report(f"{scene.name}: rtol {rtol:g}")
        seconds, (tau, strips) = timed(lambda rtol=rtol: scene.solve(rtol), repeat)
        worst = scene.errors(tau, exact).max()
        rows.append(Row(scene.name, "hystrip", f"rtol={rtol:g}", scene.points, seconds, worst, strips))
    for other in scene.others:
        report(f"{scene.name}: {other.method}, {other.setting}")
        rows.append(_other(scene, other, exact))
    return rows


def _other(scene: Scene, other: Other, exact) -> Row:
    n = scene.velocity.size
    index = np.unique(np.linspace(0, n - 1, other.sample + 2).round().astype(int)[1:-1])
    taus, failures, spent = np.empty((len(scene.adhesions), index.size)), 0, 0.0
    for i, adhesion in enumerate(scene.adhesions):
        for j, k in enumerate(index):
            start = time.process_time()
            taus[i, j], missed = other.solve(scene, adhesion, float(scene.pressure[k]), float(scene.velocity[k]))
            spent += time.process_time() - start
            failures += missed
    scale = scene.points / taus.size
    worst = scene.errors(taus, exact[:, index]).max()
    return Row(scene.name, other.method, other.setting, taus.size, spent * scale, worst, failures=failures)


def timed(work: Callable, repeat: int):
    """Median processor time of ``repeat`` runs, and the last result."""
    spent = []
    for _ in range(repeat):
        start = time.process_time()
        result = work()
        spent.append(time.process_time() - start)
    return float(np.median(spent)), result


def saturated(velocities: int, repeat: int) -> list[Row]:
    """Eight saturated levels against evaluating the closed form in NumPy."""
    levels = [hystrip.Level(1e-5 / 5**i, 1e-8 / 5**i) for i in range(8)]
    V = np.geomspace(1e-6, 10, velocities)
    K, T_eps, T_sigma = MATERIAL.K, MATERIAL.T_eps, MATERIAL.T_sigma

    def closed_form():
        lengths, h = (np.array([getattr(level, name) for level in levels])[:, None] for name in ("l", "h"))
        tau = 3 * np.pi**2 / 16 * K * V * (T_eps - T_sigma) * h**2 / (lengths**2 + (2 * np.pi * V * T_sigma) ** 2)
        return tau.sum(axis=0)

    here, result = timed(lambda: hystrip.solve(MATERIAL, WEAK, levels, pressure=1e8, velocity=V), repeat)
    there, exact = timed(closed_form, repeat)
    worst = float(np.max(np.abs(result.tau / exact - 1)))
    name = "eight levels, saturated"
    return [Row(name, "hystrip", "closed form", V.size, here, worst), Row(name, "NumPy", "Eq. 16", V.size, there, 0.0)]


def ratios(rows: list[Row]) -> list[str]:
    """What the table says, in sentences."""
    out = []
    for name in dict.fromkeys(row.scene for row in rows):
        mine = [r for r in rows if r.scene == name and r.method == "hystrip"]
        for other in dict.fromkeys(r.method for r in rows if r.scene == name and r.method != "hystrip"):
            best = min((r for r in rows if r.scene == name and r.method == other), key=lambda r: (r.error, r.seconds))
            better = [r for r in mine if r.error <= max(best.error, 1e-15)]
            if better:
                fastest = min(better, key=lambda r: r.seconds)
                gain = best.error / fastest.error if fastest.error > 0 else np.inf
                out.append(
                    f"{name}: {other} ({best.setting}) takes {best.seconds / fastest.seconds:.3g} times the time of hystrip ({fastest.setting}), "
                    f"at {gain:.3g} times its error"
                )
    return out


def table(rows: list[Row]) -> str:
    """The Markdown table."""
    lines = ["| scene | method | setting | ms per point | error | failures |", "|---|---|---|---|---|---|"]
    scene = None
    for row in rows:
        name, scene = (row.scene if row.scene != scene else ""), row.scene
        # a time scaled to all points of the scene is a time per point all the same
        per_point = 1e3 * row.seconds / POINTS[row.scene]
        lines.append(f"| {name} | {row.method} | {row.setting} | {per_point:.3g} | {row.error:.1e} | {row.failures or ''} |")
    return "\n".join(lines)


#: points of every scene of this run
POINTS: dict[str, int] = {}


def draw(rows: list[Row], path: Path) -> None:
    """Error over time per point, a panel for each scene."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    names = [name for name in dict.fromkeys(row.scene for row in rows) if sum(r.scene == name for r in rows) > 2]
    figure, axes = plt.subplots(1, len(names), figsize=(3.6 * len(names), 3.6), sharey=True, layout="constrained")
    methods = list(dict.fromkeys(row.method for row in rows))
    for axis, name in zip(np.atleast_1d(axes), names, strict=True):
        for k, method in enumerate(methods):
            mine = [r for r in rows if r.scene == name and r.method == method]
            if mine:
                x, y = [1e3 * r.seconds / POINTS[name] for r in mine], [max(r.error, 1e-16) for r in mine]
                axis.loglog(x, y, "o-", color=f"C{k}", label=method, lw=1, ms=4)
        axis.set_title(name, fontsize=9)
        axis.set_xlabel("time per point [ms]")
        axis.grid(alpha=0.3)
    np.atleast_1d(axes)[0].set_ylabel("largest relative error of friction")
    handles = {label: h for axis in np.atleast_1d(axes) for h, label in zip(*axis.get_legend_handles_labels(), strict=True)}
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=len(handles), fontsize=8)
    part = path.with_name(path.name + ".part")
    figure.savefig(part, format="png", dpi=150)
    os.replace(part, path)


def write(rows: list[Row], out: Path) -> None:
    """CSV and Markdown next to each other."""
    part = out.with_name(out.name + ".part")
    with open(part, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["scene", "method", "setting", "points_solved", "points_of_scene", "seconds", "error", "strips", "failures"])
        for r in rows:
            writer.writerow([r.scene, r.method, r.setting, r.points, POINTS[r.scene], r.seconds, r.error, r.strips, r.failures])
    os.replace(part, out.with_suffix(".csv"))
    part.write_text(table(rows) + "\n\n" + "\n".join(f"- {line}" for line in ratios(rows)) + "\n")
    os.replace(part, out.with_suffix(".md"))
    draw(rows, out.with_suffix(".png"))


def run(short: bool, repeat: int, only=None, report=lambda text: None, save=lambda rows: None) -> list[Row]:
    """All rows of all scenes (or of those whose name contains ``only``); ``save`` is called with what there is after every scene."""
    rows = []
    for scene in scenes(short):
        if not only or only in scene.name:
            POINTS[scene.name] = scene.points
            rows += measure(scene, repeat, report)
            save(rows)
    if not only or only in "eight levels, saturated":
        POINTS["eight levels, saturated"] = 1000 if short else 100_000
        rows += saturated(POINTS["eight levels, saturated"], repeat)
        save(rows)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--short", action="store_true", help="fewer points, tolerances and strips")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--only", help="scenes whose name contains this")
    parser.add_argument("--out", type=Path, default=Path("benchmark"))
    options = parser.parse_args()
    report = lambda text: print(text, file=sys.stderr, flush=True)  # noqa: E731
    run(options.short, options.repeat, options.only, report, lambda rows: write(rows, options.out))
    print(options.out.with_suffix(".md").read_text())


if __name__ == "__main__":
    main()
