"""What the measurements say: ratios of time at no larger error, growth of cost, digits."""

from __future__ import annotations

import math

import numpy as np

from . import scenes as s
from .scene import Row


def claims(rows: list[Row]) -> list[str]:
    """Sentences, with the numbers of this run; nothing about what was not measured."""
    rows = [row for row in rows if math.isfinite(row.seconds)]
    return [*_saturated(rows), *_fig_6(rows), *_tamaas(rows), *_digits(rows), *_growth(rows)]


def short(value: float) -> str:
    """Two digits, without an exponent where that is readable."""
    return f"{float(f'{value:.2g}'):.7g}"


def of(rows: list[Row], scene: str, method: str) -> list[Row]:
    return [row for row in rows if row.scene == scene and row.method == method]


def cheapest(rows: list[Row], scene: str, error: float) -> Row | None:
    """This solver's fastest setting with no larger error."""
    good = [row for row in of(rows, scene, s.HERE) if row.error <= error]
    return min(good, key=lambda row: row.seconds, default=None)


def time_at(rows: list[Row], error: float) -> tuple[float, bool] | None:
    """Seconds a method takes to get to ``error``, and whether that is extrapolated: a power law through its settings that nothing
    beats."""
    front: list[Row] = []
    for row in sorted(rows, key=lambda row: row.seconds):
        if row.error > 0 and (not front or row.error < front[-1].error):
            front.append(row)
    if len(front) < 2:
        return None
    t, e = (np.log([getattr(row, name) for row in front]) for name in ("seconds", "error"))
    target = math.log(error)
    if target < e[-1]:
        slope, at = np.polyfit(e, t, 1)
        return math.exp(at + slope * target), True
    return math.exp(np.interp(target, e[::-1], t[::-1])), False


def _saturated(rows):
    here, (plain, checked) = of(rows, s.FULL, s.HERE), ([*of(rows, s.FULL, s.NUMPY), None, None])[:2]
    if here and plain and checked:
        a = here[0].seconds
        yield (
            f"Eight saturated levels, 100,000 velocities: {1e3 * a:.1f} ms, "
            f"{a / plain.seconds:.1f} times the bare formula in NumPy, "
            f"{a / checked.seconds:.2f} times the formula with the check that every level is saturated."
        )


def _fig_6(rows):
    here = next((row for row in of(rows, s.FIG_6, s.HERE) if row.setting == "rtol=1e-06"), None)
    for scripted in of(rows, s.FIG_6, s.SCRIPT)[:1]:
        if here:
            yield (
                f"Fig. 6 ({here.points} points, {here.solved} of them solved): {here.seconds:.0f} s at rtol 1e-6 "
                f"(error {here.error:.0e}); the script takes {short(scripted.seconds / here.seconds)} "
                f"times that ({scripted.solved} points solved) at {scripted.error / here.error:.0e} times the error "
                f"({scripted.failures} failures)."
            )
    for method, error in ((s.SCRIPT, here.error if here else 0.0), (s.EQUAL, 1e-5)):
        there, mine = time_at(of(rows, s.FIG_6, method), error) if error > 0 else None, cheapest(rows, s.FIG_6, error)
        if there and mine:
            how = "extrapolated by a power law" if there[1] else "interpolated"
            yield f"Fig. 6 at an error of {error:.0e}: {method} takes {short(there[0] / mine.seconds)} times as long ({how})."


def _tamaas(rows):
    for scene, what in ((s.POINT, "A lone non-adhesive point"), (s.SWEEP, "A point of a non-adhesive sweep")):
        ratios = []
        for row in of(rows, scene, s.TAMAAS):
            mine = cheapest(rows, scene, row.error)
            if mine:
                ratios.append(
                    f"{short(row.seconds / mine.seconds)} ({row.setting}: error {row.error:.0e}, here {mine.error:.0e})"
                )
        if ratios:
            yield f"{what}: time of Tamaas over ours at an error no larger than its: " + "; ".join(ratios) + "."


def _digits(rows):
    for scene in (s.POINT, s.ADHESIVE, s.FIG_6):
        mine = sorted(of(rows, scene, s.HERE), key=lambda row: -float(row.setting.partition("=")[2]))
        if len(mine) > 1:
            strips = [round(row.strips * row.points / row.solved) for row in mine]
            rising = "growing throughout" if strips == sorted(strips) else "NOT growing throughout"
            digits = [-math.log10(float(row.setting.partition("=")[2])) for row in mine]
            yield (
                f"{scene}: from 1e-{digits[0]:.0f} to 1e-{digits[-1]:.0f} strips grow from {strips[0]} to {strips[-1]}, "
                f"{rising}; the time by "
                f"{mine[-1].seconds / mine[0].seconds:.2g} (square of the digits: {(digits[-1] / digits[0]) ** 2:.2g})."
            )


def _growth(rows):
    for what in (s.VELOCITIES, s.PRESSURES, s.LEVELS):
        found = {int(row.scene.partition(": ")[2]): row.seconds for row in rows if row.scene.startswith(what + ":")}
        if len(found) > 1:
            n = sorted(found)
            slope = np.polyfit(np.log(n), np.log([found[k] for k in n]), 1)[0]
            times = ", ".join(f"{k}: {found[k]:.2g} s" for k in n)
            yield f"{what.capitalize()}: {times}; grows like the power {slope:.2f}."
