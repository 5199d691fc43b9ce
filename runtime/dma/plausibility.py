"""What about measured moduli and temperatures is hardly that of a rubber: said, not enforced."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..plausibility import COLDEST, HOTTEST

if TYPE_CHECKING:
    from .readings import Readings

#: Pa: softer than any gel that keeps its shape, stiffer than diamond; mPa taken for MPa comes out there
SOFTEST, STIFFEST = 10.0, 1e12
#: tan delta: no solid loses more; per cent without their sign, and moduli of two units, come out there
LOSSIEST = 10.0
#: relative difference of moduli measured twice that is remarked on; frequencies so near, relative, are one
POOR_REPEAT, _SAME = 0.05, 1e-4


class DataWarning(UserWarning):
    """Measured moduli or temperatures of no rubber. Names the column, the unit it was taken for, and what is usual."""


def remark_on(taken: str, storage: np.ndarray, of: str = "rows") -> None:
    """Warn of storage moduli (Pa) of no rubber; ``taken``: what they follow from, and for what unit it was taken."""
    _remark(taken, storage, of, SOFTEST, STIFFEST, "Pa", f"{SOFTEST:g} to {STIFFEST:g} Pa", "another unit?")


def remark_on_loss(taken: str, tan: np.ndarray, of: str = "rows") -> None:
    """Warn of loss over storage modulus of no rubber; ``taken``: what it follows from, and for what unit it was taken."""
    _remark(taken, tan, of, 0.0, LOSSIEST, "of tan delta", f"0 to {LOSSIEST:g}", "per cent, or another unit?")


def remark_on_temperatures(taken: str, kelvin: np.ndarray, of: str = "rows") -> None:
    """Warn of temperatures (K) that no rubber is measured at; ``taken``: where they stand, and for what unit it was taken."""
    usual = f"{COLDEST:g} to {HOTTEST:g} K ({COLDEST - 273.15:g} to {HOTTEST - 273.15:g} degC)"
    _remark(taken, kelvin, of, COLDEST, HOTTEST, "K", usual, "another unit, or degrees and kelvin in one column?")


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


def _remark(taken: str, values: np.ndarray, of: str, low: float, high: float, unit: str, usual: str, question: str) -> None:
    odd = values[(values < low) | (values > high)]
    if odd.size:
        ends = " to ".join(dict.fromkeys(f"{each:.4g}" for each in (odd.min(), odd.max())))
        those = f"{odd.size} of {values.size} {of} {'is' if odd.size == 1 else 'are'}"
        warnings.warn(
            f"{taken}: {those} at {ends} {unit}, where a rubber is within {usual}: {question}", DataWarning, stacklevel=5
        )
