"""What about measured moduli and temperatures is hardly that of a rubber: said, not enforced."""

import warnings
from collections.abc import Sequence

import numpy as np

from ..plausibility import COLDEST, HOTTEST
from .columns import Column
from .readings import Readings

#: Pa: softer than any gel that keeps its shape, stiffer than diamond; mPa taken for MPa comes out there
SOFTEST, STIFFEST = 10.0, 1e12
#: tan delta: no solid loses more; per cent without their sign, and moduli of two units, come out there
LOSSIEST = 10.0
#: relative difference of moduli measured twice that is remarked on; frequencies so near, relative, are one
POOR_REPEAT, _SAME = 0.05, 1e-4


class DataWarning(UserWarning):
    """Measured moduli or temperatures of no rubber. Names the column, the unit it was taken for, and what is usual."""


def remark_on(where: str, column: Column, storage: np.ndarray) -> None:
    """Warn of storage moduli (Pa, one for each row) of no rubber; ``column`` holds what they follow from."""
    _remark(where, column, storage, SOFTEST, STIFFEST, "Pa", f"{SOFTEST:g} to {STIFFEST:g} Pa", "another unit?")


def remark_on_loss(where: str, column: Column, tan: np.ndarray) -> None:
    """Warn of loss over storage modulus (one for each row) of no rubber; ``column`` holds what it follows from."""
    _remark(where, column, tan, 0.0, LOSSIEST, "of tan delta", f"0 to {LOSSIEST:g}", "per cent, or another unit?")


def remark_on_temperatures(where: str, column: Column, kelvin: np.ndarray) -> None:
    """Warn of temperatures (K, one for each row) that no rubber is measured at."""
    usual = f"{COLDEST:g} to {HOTTEST:g} K ({COLDEST - 273.15:g} to {HOTTEST - 273.15:g} degC)"
    _remark(where, column, kelvin, COLDEST, HOTTEST, "K", usual, "another unit, or degrees and kelvin in one column?")


def remark_on_repeats(readings: Readings, isotherms: Sequence[np.ndarray]) -> None:
    """Warn of rows at one frequency of an isotherm, given by its rows' indices, whose moduli differ, with what else does."""
    worst, pooled = POOR_REPEAT, None
    for rows in isotherms:
        rows = rows[np.argsort(readings.omega[rows], kind="stable")]
        omega, size = readings.omega[rows], np.hypot(readings.storage[rows], readings.loss[rows])
        starts = np.flatnonzero(np.append(True, omega[1:] > omega[:-1] * (1 + _SAME)))
        differ = np.maximum.reduceat(size, starts) / np.minimum.reduceat(size, starts) - 1
        if differ.max() > worst:
            worst, pooled = differ.max(), np.split(rows, starts[1:])[int(np.argmax(differ))]
    if pooled is None:
        return
    differing = [name for name, cells in readings.ignored.items() if len(set(cells[pooled])) > 1]
    others = f"; ignored columns that differ there: {', '.join(map(repr, differing[:8]))}" if differing else ""
    f = readings.omega[pooled[0]] / (2 * np.pi)
    warnings.warn(
        f"{readings.where}: {pooled.size} rows at {f:.4g} Hz and one temperature have moduli that differ by up to "
        f"{100 * worst:.2g} %{others}. All count alike: keep those that belong together, such as of one strain",
        DataWarning,
        stacklevel=3,
    )


def _remark(
    where: str, column: Column, values: np.ndarray, low: float, high: float, unit: str, usual: str, question: str
) -> None:
    odd = values[(values < low) | (values > high)]
    if odd.size:
        ends = " to ".join(dict.fromkeys(f"{each:.4g}" for each in (odd.min(), odd.max())))
        rows = "rows is" if odd.size == 1 else "rows are"
        taken = f"{where}, column {column.name!r}, taken for {column.unit or 'a number'}"
        warnings.warn(
            f"{taken}: {odd.size} of {values.size} {rows} at {ends} {unit}, where a rubber is within {usual}: {question}",
            DataWarning,
            stacklevel=5,
        )
